"""The car's layout, car/car.toml, and what follows from it; SI, from the chassis' centre of mass."""

import tomllib

import numpy as np

from .options import EXAMPLES, manoeuvres

LAYOUT = tomllib.loads((EXAMPLES / "car" / "car.toml").read_text())
WHEELS: dict[str, dict[str, float | str]] = LAYOUT["wheel"]
NAMES = {wheel: str(of["name"]) for wheel, of in WHEELS.items()}
X_REAR = float(np.mean([w["x"] for w in WHEELS.values() if not w["steer"]]))  # rear point
WHEELBASE = float(np.mean([w["x"] for w in WHEELS.values() if w["steer"]])) - X_REAR
TRACK = float(np.ptp([w["y"] for w in WHEELS.values() if w["steer"]]))  # of the steered wheels
R_0, R, M_WHEEL, J_Z, G = 0.3, 0.35, 20.0, 1.8, 9.81  # the wheels' defaults
MASS = LAYOUT["chassis"]["m_B"] + M_WHEEL * len(WHEELS)
MANOEUVRES = manoeuvres("car")
STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST, SPLIT = MANOEUVRES.values()
AXLES = {w["axle"]: [n for n, other in WHEELS.items() if other["axle"] == w["axle"]] for w in WHEELS.values()}
