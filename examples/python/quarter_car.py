"""A quarter car on a guided wheel: a body on a link, a brake that falls as soon as the wheel slips. SI units."""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
folder, R, m_B, g, h = extract("wheel.fmu"), 0.35, 300.0, 9.81, 0.001
READ, SET = ([ref[n] for n in names] for names in (("X_O", "X_O_dot", "slip_x"), ("F_X", "F_Z", "M_brake")))


def distance(v, anti_lock):
    """In which the quarter car stops from v, m."""
    wheel = instantiate_fmu(folder, description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setBoolean([ref["guided"]], [True])
    start = {
        "theta_start": pi / 2,
        "psi_start": 0,
        "X_O_start": 0,
        "phi_dot_start": -v / R,
        "mu_max": 0.6,
        "mu_slide": 0.4,
    }
    wheel.setReal([ref[n] for n in start], [float(x) for x in start.values()])
    wheel.exitInitializationMode()
    X, X_dot, brake, t = 0.0, v, 0.0, 0.0  # of the body
    while X_dot > 0:
        X_O, X_O_dot, slip = wheel.getReal(READ)
        kappa = -slip / max(X_O_dot, 0.1)  # slip ratio, braking negative
        brake = 400.0 if anti_lock and kappa < -0.001 else min(brake + 4e3 * h, 1500.0)  # N m
        F_X = 60e3 * (X - X_O) + 2e3 * (X_dot - X_O_dot)  # of the link
        wheel.setReal(SET, [F_X, -m_B * g, brake])  # the body's weight comes by the suspension
        wheel.doStep(t, h)
        X, X_dot, t = X + X_dot * h - F_X / m_B * h**2 / 2, X_dot - F_X / m_B * h, t + h
    wheel.freeInstance()
    return X


for anti_lock in (False, True):
    print(f"Anti-lock {'on' if anti_lock else 'off'}: {distance(20.0, anti_lock):.1f} m.")
low, high = (20.0**2 / (2 * mu * g) for mu in (0.6, 0.4))
print(f"v^2 / (2 mu g): {low:.1f} m with mu_max, {high:.1f} m with mu_slide, for a brake that acts at once.")
