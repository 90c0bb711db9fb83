"""The car's layout, car/car.toml, and what follows from it; SI, from the chassis' centre of mass."""

import tomllib

import numpy as np

from .options import EXAMPLES, Manoeuvre, manoeuvres

LAYOUT = tomllib.loads((EXAMPLES / "car" / "car.toml").read_text())
WHEELS: dict[str, dict[str, float | str]] = LAYOUT["wheel"]
NAMES = {wheel: str(of["name"]) for wheel, of in WHEELS.items()}
X_REAR = float(np.mean([w["x"] for w in WHEELS.values() if not w["steer"]]))  # rear point
WHEELBASE = float(np.mean([w["x"] for w in WHEELS.values() if w["steer"]])) - X_REAR
TRACK = float(np.ptp([w["y"] for w in WHEELS.values() if w["steer"]]))  # of the steered wheels
R_0, R, M_WHEEL, J_Z, G = 0.3, 0.35, 20.0, 1.8, 9.81  # the wheels' defaults
MASS = LAYOUT["chassis"]["m_B"] + M_WHEEL * len(WHEELS)
MANOEUVRES = manoeuvres("car")
STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST = MANOEUVRES.values()
COMPARED = ("X", "Y", "psi", "roll", "pitch", "v", "omega")
# Wheels that stand side by side, by the axle's name.
PLACES = sorted({float(w["x"]) for w in WHEELS.values()}, reverse=True)
AXLES = {
    {PLACES[-1]: "rear", PLACES[0]: "front"}.get(x, f"axle {k + 1}"): [n for n, w in WHEELS.items() if w["x"] == x]
    for k, x in enumerate(PLACES)
}


def chassis_start(manoeuvre: Manoeuvre) -> dict[str, float]:
    """Parameters of chassis.fmu."""
    return {"v_start": manoeuvre["v"], **manoeuvre.of("chassis")}


def driver_start(manoeuvre: Manoeuvre) -> dict[str, float]:
    """Parameters of driver.fmu."""
    return {"v_0": manoeuvre["v"], "v_1": manoeuvre["v"], "L": WHEELBASE, **manoeuvre.of("driver")}
