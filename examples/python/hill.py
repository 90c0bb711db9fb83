"""A road that changes during a run: a wheel rolls onto a hill and up it until it stands. SI units."""

from math import pi, sin

from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
number = {v.name: v.valueReference for v in description.modelVariables}
STATE = [number["X_O"], number["omega_z"]]

v, SLOPE, h, t = 25.0, 0.1, 0.001, 1.0
start = {"psi_start": 0, "theta_start": pi / 2, "X_O_start": 0, "phi_dot_start": -v / 0.35}
wheel = instantiate_fmu(extract("wheel.fmu"), description)
wheel.setupExperiment(startTime=0.0)
wheel.enterInitializationMode()
wheel.setReal([number[name] for name in start], [float(x) for x in start.values()])
wheel.exitInitializationMode()
wheel.doStep(0.0, t)  # to the foot of the hill
foot = wheel.getReal(STATE)[0]
wheel.setReal([number["slope"]], [SLOPE])  # rises towards X
while wheel.getReal(STATE)[1] < 0:
    wheel.doStep(t, h)
    t += h
distance, inertia = wheel.getReal(STATE)[0] - foot, 1 + 1.8 / (20 * 0.35**2)  # 1 + J_z / (m R^2)
energy = v**2 / (2 * 9.81 * sin(SLOPE)) * inertia
print(f"Distance uphill: {distance:.2f} m; v^2 / (2 g sin(slope)) * inertia = {energy:.2f} m.")
