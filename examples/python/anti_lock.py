"""Three brakes on a wet road: locked, anti-lock, and limited to the grip. SI units.

The wheel carries its corner of the car in its own mass m, so one guided wheel.fmu is the whole quarter car. Coulomb
friction has no stable slip: mu_max as long as the wheel rolls, mu_slide at any slip. So an anti-lock brake gains only
in the moments in which the wheel grips again, and a brake that stays below the grip is the best one.
"""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
folder, v, h, grip, slide = extract("wheel.fmu"), 20.0, 0.001, 0.6, 0.4
START = {"m": 320.0, "theta_start": pi / 2, "psi_start": 0, "X_O_start": 0, "phi_dot_start": -v / 0.35}
START |= {"mu_max": grip, "mu_slide": slide}
READ, BRAKE, MU = [ref[n] for n in ("X_O", "X_O_dot", "slip_x")], [ref["M_brake"]], [ref["mu_required"]]


def distance(control):
    """In which the quarter car stops, m."""
    wheel = instantiate_fmu(folder, description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setBoolean([ref["guided"]], [True])
    wheel.setReal([ref[n] for n in START], [float(x) for x in START.values()])
    wheel.exitInitializationMode()
    t, brake, level, (X, speed, slip) = 0.0, 20.0, 0.0, wheel.getReal(READ)  # N m
    wheel.setReal(BRAKE, [brake])
    while speed > 1e-6:
        wanted = min(brake + 2e4 * h, 3000.0)
        if control == "anti-lock" and slip > 0:  # lets go; then a little less than what locked the wheel
            level, wanted = 0.97 * brake or level, 0.0
        elif control == "anti-lock" and level:
            wanted = level = level + 100 * h
        elif control == "limited":  # one Newton step from the present brake to the grip
            mu, (slope,) = wheel.getReal(MU)[0], wheel.getDirectionalDerivative(MU, BRAKE, [1.0])
            wanted = min(wanted, brake + (0.99 * grip - mu) / slope)
        brake = wanted
        wheel.setReal(BRAKE, [brake])
        wheel.doStep(t, h)
        t, (X, speed, slip) = t + h, wheel.getReal(READ)
    wheel.freeInstance()
    return X


for control in ("locked", "anti-lock", "limited"):
    print(f"{control}: {distance(control):.1f} m")
print(
    f"v^2 / (2 mu g): {v**2 / (2 * slide * 9.81):.1f} m sliding, {v**2 / (2 * grip * 9.81):.1f} m at the limit of grip"
)
