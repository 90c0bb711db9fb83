"""Three brakes on a wet road: locked, anti-lock, and limited to the grip. SI units.

The wheel carries its corner of the car in its own mass m, so one guided wheel.fmu is the whole quarter car. Coulomb
friction has no stable slip: mu_max as long as the wheel rolls, mu_slide at any slip. So an anti-lock brake gains only
in the moments in which the wheel grips again, and a brake that stays below the grip is the best one.
"""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
MU, BRAKE, READ = [ref["mu_required"]], [ref["M_brake"]], [ref[n] for n in ("X_O", "X_O_dot", "slip_x")]
v, h, grip, slide = 20.0, 0.001, 0.6, 0.4
START = {"m": 320.0, "theta_start": pi / 2, "psi_start": 0, "X_O_start": 0, "phi_dot_start": -v / 0.35}
START |= {"mu_max": grip, "mu_slide": slide}


def limited(wheel, wanted, grip):
    """Sets the capacity `wanted`, or as much as the road transmits: mu_required = grip. On a straight line one step of
    Newton's method is exact; in a turn mu_required is the root of a sum of squares, and some more are needed."""
    for _ in range(20):
        wheel.setReal(BRAKE, [wanted])
        over = wheel.getReal(MU)[0] - grip
        if over <= 1e-12 * grip or (slope := wheel.getDirectionalDerivative(MU, BRAKE, [1.0])[0]) <= 0:
            break
        wanted = max(0.0, wanted - over / slope)
    return wanted


def distance(control):
    """In which the quarter car stops, m."""
    wheel = instantiate_fmu(extract("wheel.fmu"), description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setBoolean([ref["guided"]], [True])
    wheel.setReal([ref[n] for n in START], [float(x) for x in START.values()])
    if control == "limited":  # must not slide: a run in which it would ends
        wheel.setReal([ref["mu_slide"]], [0.0])
    wheel.exitInitializationMode()
    t, brake, level, (X, speed, slip) = 0.0, 0.0, 0.0, wheel.getReal(READ)
    while speed > 1e-6:
        brake = min(brake + 2e4 * h, 3000.0)  # N m
        if control == "anti-lock" and slip > 0:  # lets go; then a little less than what locked the wheel
            level, brake = 0.97 * (brake - 2e4 * h) or level, 0.0
        elif control == "anti-lock" and level:
            brake = level = level + 100 * h
        if control == "limited":
            brake = limited(wheel, brake, 0.99 * grip)
        wheel.setReal(BRAKE, [brake])
        wheel.doStep(t, h)
        t, (X, speed, slip) = t + h, wheel.getReal(READ)
    wheel.freeInstance()
    return X


if __name__ == "__main__":
    for control in ("locked", "anti-lock", "limited"):
        print(f"{control}: {distance(control):.1f} m")
    shortest = [v**2 / (2 * mu * 9.81) for mu in (slide, grip)]
    print("v^2 / (2 mu g): {:.1f} m sliding, {:.1f} m at the limit of grip".format(*shortest))
