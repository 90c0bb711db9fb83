"""The brake limited to the friction of the road by Newton's method before each communication step. SI units."""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
number = {v.name: v.valueReference for v in description.modelVariables}
MU, BRAKE, STATE = [number["mu_required"]], [number["M_brake"]], [number["X_O"], number["omega_z"]]


def brake(wheel, wanted, grip):
    """Sets the capacity `wanted`, or as much as the road transmits: mu_required = grip. On a straight line one step of
    Newton's method is exact; in a turn mu_required is the root of a sum of squares, and some more are needed."""
    for _ in range(20):
        wheel.setReal(BRAKE, [wanted])
        over = wheel.getReal(MU)[0] - grip
        if over <= 1e-12 * grip or (slope := wheel.getDirectionalDerivative(MU, BRAKE, [1.0])[0]) <= 0:
            break
        wanted = max(0.0, wanted - over / slope)
    return wanted


def started(**values):
    wheel = instantiate_fmu(extract("wheel.fmu"), description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setReal([number[name] for name in values], [float(x) for x in values.values()])
    wheel.exitInitializationMode()
    return wheel


if __name__ == "__main__":
    v, grip, h, t = 25.0, 0.4, 0.001, 0.0
    start = {"psi_start": 0, "theta_start": pi / 2, "X_O_start": 0, "phi_dot_start": -v / 0.35, "s": 0.004}
    wheel = started(**start)
    while wheel.getReal(STATE)[1] < 0:
        brake(wheel, 500.0, grip)
        wheel.doStep(t, h)
        t += h
    print(f"Stopping distance: {wheel.getReal(STATE)[0]:.2f} m; v^2 / (2 mu g) = {v**2 / (2 * grip * 9.81):.2f} m.")
