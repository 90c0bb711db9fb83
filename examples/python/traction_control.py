"""Traction control on ice: a driven quarter car starts with spinning wheel, and with a torque limited to the grip. SI.

The wheel carries its corner of the car in its own mass m. The limit is one Newton step before each step, by the
directional derivative of mu_required.
"""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
folder, h, end, grip, slide = extract("wheel.fmu"), 0.002, 5.0, 0.15, 0.1
START = {"m": 320.0, "theta_start": pi / 2, "psi_start": 0, "X_O_start": 0, "phi_dot_start": 0}
START |= {"mu_max": grip, "mu_slide": slide}
DRIVE, MU = [ref["M_3"]], [ref["mu_required"]]


def distance(controlled):
    """After `end`, m, under 400 N m of drive torque, or as much of it as the ice transmits."""
    wheel = instantiate_fmu(folder, description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setBoolean([ref["guided"]], [True])
    wheel.setReal([ref[n] for n in START], [float(x) for x in START.values()])
    wheel.exitInitializationMode()
    torque = 1.0  # N m; forward is negative M_3
    for n in range(round(end / h)):
        wheel.setReal(DRIVE, [-torque])
        wheel.doStep(n * h, h)
        wanted = min(torque + 2e3 * h, 400.0)
        if controlled:  # one Newton step from the present torque to the grip
            mu, (slope,) = wheel.getReal(MU)[0], wheel.getDirectionalDerivative(MU, DRIVE, [-1.0])
            wanted = min(wanted, torque + (0.99 * grip - mu) / slope)
        torque = wanted
    (X,) = wheel.getReal([ref["X_O"]])
    wheel.freeInstance()
    return X


for controlled, mu in ((False, slide), (True, 0.99 * grip)):
    how = "with" if controlled else "without"
    print(f"{how} control: {distance(controlled):.2f} m; mu g t^2 / 2 = {mu * 9.81 * end**2 / 2:.2f} m")
