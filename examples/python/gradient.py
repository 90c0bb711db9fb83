"""The gradient of a whole run from one run: how theta at its end changes with each piece of a moment M_1 (FMPy, NumPy).

    python examples/python/gradient.py       in the folder with wheel.fmu

By model exchange and the midpoint rule, x_m = x + h f(x) / 2, x' = x + h f(x_m). Directional derivatives of f give its
columns by states and by M_1, and the sensitivities S = dx/dM follow the same rule. SI units.
"""

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description

PIECES, STOP, H = 4, 2.0, 0.005  # of M_1, each held as long; s
fmu = read_model_description("wheel.fmu")
rates = [unknown.variable for unknown in fmu.derivatives]
names = {v.name: v.valueReference for v in fmu.modelVariables}
x_refs, f_refs, M_1 = [v.derivative.valueReference for v in rates], [v.valueReference for v in rates], names["M_1"]
wheel = instantiate_fmu(extract("wheel.fmu"), fmu, "ModelExchange")


def rate_of(x, moment):
    """f and its derivatives by x and M_1."""
    wheel.setReal([*x_refs, M_1], [*x, moment])
    columns = [wheel.getDirectionalDerivative(f_refs, [known], [1.0]) for known in (*x_refs, M_1)]
    return np.array(wheel.getReal(f_refs)), np.transpose(columns[:-1]), np.array(columns[-1])


def run(moments):
    """theta at the end, and its derivatives by the moments."""
    wheel.reset()
    wheel.setupExperiment()
    wheel.enterInitializationMode()
    wheel.exitInitializationMode()
    wheel.enterContinuousTimeMode()
    x, S = np.array(wheel.getReal(x_refs)), np.zeros((len(x_refs), PIECES))
    for k in range(round(STOP / H)):
        piece = np.eye(PIECES)[int(k * H / STOP * PIECES)]
        f, A, B = rate_of(x, piece @ moments)
        f_m, A_m, B_m = rate_of(x + H / 2 * f, piece @ moments)
        S_m = S + H / 2 * (A @ S + np.outer(B, piece))
        x, S = x + H * f_m, S + H * (A_m @ S_m + np.outer(B_m, piece))
    return x[x_refs.index(names["theta"])], S[x_refs.index(names["theta"])]


moments = np.array([3.0, -2.0, 1.0, 0.0])  # N m
_, gradient = run(moments)
differences = [(run(moments + e)[0] - run(moments - e)[0]) / 2e-4 for e in 1e-4 * np.eye(PIECES)]
print("d theta / d M_1 [rad/(N m)], from one run:  ", *(f"{g:8.5f}" for g in gradient))
print("from differences of eight runs:             ", *(f"{g:8.5f}" for g in differences))
