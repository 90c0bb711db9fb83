"""A quarter car on a guided wheel: a body on a spring strut and a bushing, braked to a stop. SI units."""

from math import pi

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
READ = [ref[n] for n in ("X_O", "X_O_dot", "Z_O", "Z_O_dot", "omega_z", "lambda_3")]
SET = [ref[n] for n in ("F_X", "F_Z", "M_brake")]
R, r, m, J_z = 0.35, 0.05, 20.0, 1.8  # of the wheel: r_0 + r
m_B, g, h, v, M_brake = 300.0, 9.81, 0.001, 20.0, 600.0
START = {"m": m, "r_0": R - r, "r": r, "J_z": J_z, "g": g}
START |= {"theta_start": pi / 2, "psi_start": 0, "X_O_start": 0, "phi_dot_start": -v / R}

wheel = instantiate_fmu(extract("wheel.fmu"), description)
wheel.setupExperiment(startTime=0.0)
wheel.enterInitializationMode()
wheel.setBoolean([ref["guided"]], [True])
wheel.setReal([ref[n] for n in START], [float(x) for x in START.values()])
wheel.exitInitializationMode()

X, X_dot, Z, Z_dot, t = 0.0, v, 0.6, 0.0, 0.0  # of the body, 0.1 m below the free length of its spring
while (now := wheel.getReal(READ))[4] < 0:
    X_O, X_O_dot, Z_O, Z_O_dot, _, _ = now
    F_X = 60e3 * (X - X_O) + 2e3 * (X_dot - X_O_dot)  # on the wheel
    F_Z = 20e3 * (Z - Z_O - 0.5) + 1.5e3 * (Z_dot - Z_O_dot)
    wheel.setReal(SET, [F_X, F_Z, M_brake])
    wheel.doStep(t, h)
    X_ddot, Z_ddot = -F_X / m_B, -F_Z / m_B - g
    X, X_dot, Z, Z_dot = X + h * X_dot + h**2 / 2 * X_ddot, X_dot + h * X_ddot, Z + h * Z_dot, Z_dot + h * Z_ddot
    t += h
a = M_brake / R / (m_B + m + J_z / R**2)  # the wheel's spin is slowed down too
print(f"Stopping distance: {X:.2f} m; v^2 / (2 a) = {v**2 / (2 * a):.2f} m.")
print(f"Wheel load at the end: {now[-1]:.1f} N; m g = {(m_B + m) * g:.1f} N.")
