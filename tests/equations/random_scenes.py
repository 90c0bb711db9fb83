"""Random wheels, motions and loads for pointwise tests: tables with one C record per row.

Frames and symbols as in wheel_equations.h. The ranges are wide but stay inside the domain of the
equations: theta between 3 and 177 degrees, inertias that a body can have.
"""

import numpy as np
from support import equations as eq

COUNT = 10_000


def wheels(random: np.random.Generator, rows: int, symmetric: bool) -> np.ndarray:
    wheel = eq.table(eq.Parameters, rows)
    wheel["m"] = 10 ** random.uniform(-1, 3, rows)
    wheel["r_0"] = 10 ** random.uniform(-1, 0.5, rows)
    thin = random.random(rows) < 0.1
    wheel["r"] = np.where(thin, 0, wheel["r_0"] * random.uniform(0, 1, rows))
    # From second moments of the mass, a, b, c >= 0: any inertia that a body can have.
    a, b, c = wheel["m"] * wheel["r_0"] ** 2 * random.uniform(0.05, 1, (3, rows))
    c = np.where(random.random(rows) < 0.2, 0, c)  # the limit J_z = J_x + J_y
    a = b if symmetric else a
    wheel["J_x"], wheel["J_y"], wheel["J_z"] = b + c, a + c, a + b
    wheel["g"] = random.uniform(0, 20, rows)
    sloping = random.random(rows) < 0.5
    for axis in ("g_X", "g_Y"):
        wheel[axis] = np.where(sloping, random.normal(0, 5, rows), 0)
    wheel["s"] = wheel["r_0"] * random.uniform(0, 0.2, rows)
    return wheel


def level(scene: np.ndarray) -> None:
    """Takes the slope out of the scenes."""
    scene["wheel"]["g_X"] = scene["wheel"]["g_Y"] = 0


def scenes(random: np.random.Generator, kind=None, symmetric: bool = True, rows: int = COUNT) -> np.ndarray:
    """Scenes under random loads; kind None draws one of the four laws per row."""
    scene = eq.table(eq.Scene, rows)
    scene["wheel"] = wheels(random, rows, symmetric)
    scene["friction"]["kind"] = random.integers(eq.FRICTIONLESS, eq.REGULARIZED + 1, rows) if kind is None else kind
    scene["friction"]["sigma"] = random.choice([-1.0, 1.0], rows)
    scene["friction"]["omega_s"] = 10 ** random.uniform(-3, 1, rows)
    weight = scene["wheel"]["m"] * 9.81
    scene["load"]["F"] = weight[:, None] * random.normal(size=(rows, 3))
    scene["load"]["M"] = (weight * scene["wheel"]["r_0"])[:, None] * random.normal(size=(rows, 3))
    braked = random.random(rows) < 0.5
    scene["load"]["brake"] = braked * weight * scene["wheel"]["r_0"] * random.uniform(0, 0.5, rows)
    unloaded = random.random(rows) < 0.1
    scene["load"][unloaded] = 0
    return scene


def motions(random: np.random.Generator, rows: int = COUNT) -> np.ndarray:
    motion = eq.table(eq.Motion, rows)
    for angle in ("psi", "phi"):
        motion[angle] = random.uniform(-10, 10, rows)
    motion["theta"] = random.uniform(0.05, np.pi - 0.05, rows)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motion[rate] = random.normal(0, 5, rows)
    for place in ("X_O", "Y_O"):
        motion[place] = random.uniform(-5, 5, rows)
    return motion
