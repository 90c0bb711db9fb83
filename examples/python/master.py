"""A master of one's own on plain FMPy: a guided wheel is braked to a stop; then again from a snapshot, harder.

python master.py [wheel.fmu]. SI units, angles in rad; signs: docs/brake_hold_steer.md.
"""

import shutil
import sys
from math import pi

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu

path, h = (sys.argv[1:] or ["wheel.fmu"])[0], 0.001  # the FMU; the communication step, s
description = read_model_description(path)
number = {v.name: v.valueReference for v in description.modelVariables}

folder = extract(path)
wheel = instantiate_fmu(folder, description, "CoSimulation")
wheel.setupExperiment(startTime=0.0)
wheel.enterInitializationMode()
wheel.setBoolean([number["guided"]], [True])  # a wheel carrier keeps its axle's direction
wheel.setReal([number["theta_start"], number["phi_dot_start"]], [pi / 2, -10.0])  # upright, forward at 3.5 m/s
wheel.exitInitializationMode()


def drive(begin: int, end: int, brake: float) -> float | None:
    """Steps from `begin` to `end` under a brake of this capacity; the first time at which the wheel stands."""
    wheel.setReal([number["M_brake"]], [brake])
    for step in range(begin, end):
        if wheel.getReal([number["omega_z"]]) == [0.0]:
            return step * h
        wheel.doStep(step * h, h)  # raises where the wheel lifts off
    return None


def error(seconds: float, **start: float) -> float:
    """Of a run at the default tolerance: the largest difference of four outputs from the run of another solver, CVODE's
    Adams at the tightest tolerance, over each output's range. Below 1e-10 it is rounding."""
    names = ["X_O", "theta", "phi_dot", "psi_dot"]
    how = {"fmi_type": "CoSimulation", "stop_time": seconds, "output_interval": 0.01}
    how |= {"output": names}
    runs = [
        simulate_fmu(path, relative_tolerance=tolerance, start_values=start | {"method": method}, **how)
        for tolerance, method in ((1e-8, 1), (1e-13, 2))
    ]
    rows = min(map(len, runs))  # a run that ends early
    found, truth = (np.array([run[name][:rows] for name in names]) for run in runs)
    return float((np.abs(found - truth).max(axis=1) / np.ptp(truth, axis=1)).max())


drive(0, 1000, 0.0)
snapshot = wheel.getFMUState()
for brake in (30.0, 60.0):
    wheel.setFMUState(snapshot)
    print(f"A brake of {brake:g} N m stops the wheel at t = {drive(1000, 5000, brake):.3f} s.")
wheel.freeFMUState(snapshot)
wheel.terminate()
wheel.freeInstance()
shutil.rmtree(folder, ignore_errors=True)
print(f"Error of the paper's wheel after 10 s of friction: {error(10.0, s=0.03):.1e} of the range.")
