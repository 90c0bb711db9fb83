"""A car that steers, in the plane: a body on four guided wheels, whose carriers turn the front ones. SI units.

python car.py [PICTURE.png]. Links of stiffness k and damping c hold the wheels' centres in the body; forces are held
over each step. A steady turn is compared with closed forms of rigid links. Signs: docs/vehicle.md.
"""

import sys
from math import atan, cos, pi, sin, tan

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description

description = read_model_description("wheel.fmu")
ref = {v.name: v.valueReference for v in description.modelVariables}
READ = [ref[n] for n in ("X_O", "Y_O", "X_O_dot", "Y_O_dot", "psi", "M_guide_2", "lambda_y")]
SET = [ref[n] for n in ("F_X", "F_Y", "F_Z", "psi_dot_guide")]
HUBS = np.array([[1.2, 0.75], [1.2, -0.75], [-1.4, 0.75], [-1.4, -0.75]])  # of the body: forward, left
m_B, J_B, L, m, J_x, R, r = 1200.0, 1900.0, 2.6, 20.0, 0.9, 0.35, 0.05  # body, wheelbase; a wheel, R = r_0 + r
k, c, h, v = 3e5, 4e3, 0.004, 12.0


def steer(hub, t):
    """Angle of a wheel to the left: 3 degrees within a second, all wheels about one point (Ackermann)."""
    bend = tan(np.radians(3) * min(t, 1.0)) / L if hub[0] > 0 else 0.0  # 1/m
    return atan(bend * L / (1 - bend * hub[1]))


def started(x, y):
    wheel = instantiate_fmu(extract("wheel.fmu"), description)
    wheel.setupExperiment(startTime=0.0)
    wheel.enterInitializationMode()
    wheel.setBoolean([ref["guided"]], [True])
    start = {"m": m, "r_0": R - r, "r": r, "J_x": J_x, "J_y": J_x, "J_z": 2 * J_x}
    start |= {"theta_start": pi / 2, "psi_start": 0, "X_O_start": x, "Y_O_start": y, "phi_dot_start": -v / R}
    wheel.setReal([ref[n] for n in start], [float(value) for value in start.values()])
    wheel.exitInitializationMode()
    return wheel


wheels = [started(*hub) for hub in HUBS]
place, psi, velocity, omega, path = np.zeros(2), 0.0, np.array([v, 0.0]), 0.0, []
for n in range(1000):
    t = n * h
    X, Y, X_dot, Y_dot, heading, M_guide, lambda_y = np.transpose([wheel.getReal(READ) for wheel in wheels])
    arms = HUBS @ [[cos(psi), sin(psi)], [-sin(psi), cos(psi)]]
    lag = np.stack([X, Y], 1) - place - arms
    rate = np.stack([X_dot, Y_dot], 1) - velocity - omega * np.stack([-arms[:, 1], arms[:, 0]], 1)
    F = -k * lag - c * rate  # of the links on the wheels
    for wheel, hub, at, force in zip(wheels, HUBS, heading, F, strict=True):
        turn = (psi + h * omega + steer(hub, t + h) - at) / h  # to where the carrier will be: no drift
        wheel.setReal(SET, [*force, -m_B * 9.81 / 4, turn])
        wheel.doStep(t, h)
    a = -F.sum(0) / m_B
    alpha = (np.sum(arms[:, 1] * F[:, 0] - arms[:, 0] * F[:, 1]) - M_guide.sum()) / (J_B + 4 * J_x)  # held rates
    place, velocity = place + h * velocity + h**2 / 2 * a, velocity + h * a
    psi, omega = psi + h * omega + h**2 / 2 * alpha, omega + h * alpha
    path.append([t, *place, psi, omega, *lambda_y, *X, *Y])

rear = np.hypot(*velocity) * cos(atan(1.4 * tan(np.radians(3)) / L))  # speed of the rear axle's middle
front = rear * omega * (m_B * 1.4 / L + 2 * m)
print(f"Yaw rate: {omega:.4f} rad/s; v tan(delta) / L = {rear * tan(np.radians(3)) / L:.4f} rad/s.")
print(f"Lateral force of the front axle: {sum(lambda_y[:2]):.0f} N; m_front v psi_dot = {front:.0f} N.")

if len(sys.argv) > 1:
    import matplotlib.pyplot as plt

    t, x, y, _, turn, *rest = np.transpose(path)
    axes = plt.subplots(3, 1, figsize=(7, 7), layout="constrained")[1]
    axes[0].plot(x, y, "k", label="body")
    for i, name in enumerate(("front left", "front right", "rear left", "rear right")):
        axes[0].plot(rest[4 + i], rest[8 + i], lw=0.7, label=name)
        axes[2].plot(t, rest[i], label=name)
    axes[1].plot(t, turn)
    axes[0].set(xlabel="X [m]", ylabel="Y [m]", aspect="equal", title="A car that steers into a turn")
    axes[1].set(xlabel="t [s]", ylabel="yaw rate [rad/s]")
    axes[2].set(xlabel="t [s]", ylabel="force of the road to the left [N]")
    axes[0].legend()
    axes[2].legend()
    plt.savefig(sys.argv[1], dpi=80)
