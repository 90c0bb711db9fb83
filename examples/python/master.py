"""A master of one's own on plain FMPy: a wheel on a suspension is braked to a stop; then again from a snapshot, harder;
and how far the result can be trusted.

python master.py [wheel.fmu]. SI units, angles in rad; signs: docs/brake_hold_steer.md.
"""

import shutil
import sys
from math import pi

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi2 import FMU2Slave

path, h = (sys.argv[1:] or ["wheel.fmu"])[0], 0.001  # the FMU; the communication step, s
description = read_model_description(path)
number = {v.name: v.valueReference for v in description.modelVariables}
inputs = [number[name] for name in ("M_1", "M_brake")]
outputs = [number[name] for name in ("theta", "theta_dot", "omega_z", "X_O")]
folder = extract(path)


def started(tolerance: float = 1e-8) -> FMU2Slave:
    """A wheel that stands upright and rolls forward at 3.5 m/s."""
    wheel = instantiate_fmu(folder, description, "CoSimulation")
    wheel.setupExperiment(tolerance=tolerance, startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setReal([number["theta_start"], number["phi_dot_start"]], [pi / 2, -10.0])
    wheel.exitInitializationMode()
    return wheel


def drive(wheel: FMU2Slave, begin: int, end: int, brake: float) -> list[list[float]]:
    """The outputs at each step from `begin` to `end` under a brake of this capacity, or until the wheel stands."""
    rows = []
    for step in range(begin, end):
        rows.append(wheel.getReal(outputs))
        theta, theta_dot, omega_z, _ = rows[-1]
        if omega_z == 0.0:
            break
        camber = -3000.0 * (theta - pi / 2) - 100.0 * theta_dot  # the suspension's moment about e1
        wheel.setReal(inputs, [camber, brake])
        wheel.doStep(step * h, h)  # raises where the wheel falls flat or lifts off
    return rows


def error(brake: float) -> float:
    """The largest difference from the same run at the tightest tolerance, over each output's range."""
    runs = []
    for tolerance in (1e-8, 1e-13):
        wheel = started(tolerance)
        runs.append(np.array(drive(wheel, 0, 5000, brake)))
        wheel.freeInstance()
    found, truth = (run[: min(map(len, runs))] for run in runs)
    span = np.ptp(truth, axis=0)
    return float((abs(found - truth).max(axis=0) / np.where(span > 1e-9, span, 1.0)).max())


wheel = started()
drive(wheel, 0, 1000, 0.0)
snapshot = wheel.getFMUState()
for brake in (30.0, 60.0):
    wheel.setFMUState(snapshot)
    stop = 1.0 + h * (len(drive(wheel, 1000, 5000, brake)) - 1)
    print(f"A brake of {brake:g} N m stops the wheel at t = {stop:.3f} s.")
wheel.freeFMUState(snapshot)
wheel.terminate()
wheel.freeInstance()
print(f"The error is at most {max(error(30.0), 1e-11):.1e} of the range.")  # below 1e-11 it is rounding
shutil.rmtree(folder, ignore_errors=True)
