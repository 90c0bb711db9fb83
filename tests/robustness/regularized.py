"""The regularized law -s N tanh(omega_z / omega_s) against the exact one, in the paper's scene with friction, 10 s.

Error: largest of the headline outputs over 101 times, relative to the output's range.
"""

import numpy as np
from support.bounds import range_error
from support.driver import HEADLINE, WARNING, Values
from support.motion import Library, Run, run
from support.scenes import wheel_of

FRICTION: Values = {"s": 0.03}
TIMES = np.linspace(0.0, 10.0, 101)
THRESHOLD = 1000.0  # decay number from which automatic takes the law for stiff: `stiff` in fmu-src/wheel/law.cpp
WIDTH_FACTOR, TOLERANCE_FACTOR = 5.0, 100.0  # error of the law allowed: per rad/s of its width, per tolerance


def error_against(truth: Run, found: Run) -> float:
    """nan where the run did not get to the end."""
    if found.status > WARNING or len(found["t"]) != len(truth["t"]):
        return float("nan")
    return range_error(found, truth, HEADLINE)


def decay_number(values: Values) -> float:
    """s m g / (omega_s (J_z + m rho^2)), times sqrt(rho / g), rho = r_0 + r: how often friction could stop the spin in
    one swing of the wheel."""
    w = wheel_of(values)
    rho = w.r_0 + w.r
    return w.s * w.m * w.g / (float(values["omega_s"]) * (w.J_z + w.m * rho**2)) * (rho / w.g) ** 0.5


def is_layered(library: Library, values: Values) -> bool:
    """Whether method = automatic takes the law for stiff: only BDF, where omega_z sticks in the layer, evaluates
    Jacobians."""
    return run(library, values, np.array([0.0, 3.0]), 1e-6).counters["n_jac"] > 0
