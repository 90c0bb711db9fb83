"""A bicycle that balances itself: two rigid frames on two free wheel.fmu, coupled exactly. SI units.

python bicycle.py [PICTURE.png]. The benchmark of Meijaard, Papadopoulos, Ruina and Schwab (Proc. R. Soc. A 463, 2007,
1955): pushed to the side and left alone, it falls at 3 m/s, rights itself at 5 m/s and slowly capsizes at 7 m/s. It is
stable between its weave speed, 4.292 m/s, and its capsize speed, 6.024 m/s. The program takes half a minute.

Kane's equations of the frames are nonlinear. The generalized speeds are u = q' of q = (x, y, z of the rear hub, heading
psi, tilt theta, pitch about the rear axle, steer angle to the right). Each wheel, in model exchange, takes the force F
and the moments M_1, M_2 of its frame. Its contact force and accelerations are affine in them, and directional
derivatives are the slopes. So u' and all loads follow from one linear system. With V u the velocity of a hub and W u
the angular velocity of its frame, its rows are

    A u' + sum V^T F + W^T (M_1 e1 + M_2 e2) = b          frames
    V u' + V' u = (lambda + F) / m - g (0, 0, 1)          hubs
    W u' + W' u, along e1 and e2, as of theta'', psi''    axles
"""

import sys
from math import atan2, ceil, cos, pi, sin

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from scipy.linalg import expm
from scipy.optimize import brentq

g, w, c, TILT = 9.81, 1.02, 0.08, pi / 10  # gravity, wheelbase, trail, tilt of the steering axis
WHEELS = (0.3, 2.0, 0.0603, 0.12), (0.35, 3.0, 0.1405, 0.28)  # radius, m, J_x, J_z: rear, front
REAR = 85.0, (0.3, 0.9), (9.2, 11.0, 2.8, 2.4)  # frame with rider: m; centre of mass; I_xx, I_yy, I_zz, I_xz, z down
FORK = 4.0, (0.9, 0.7), (0.05892, 0.06, 0.00708, -0.00756)
RIDES, STEP = {3.0: 2.8, 5.0: 4.0, 7.0: 15.0}, 0.004  # seconds by speed, m/s; step of the method, s
SLOWEST, FASTEST = 3.0, 8.0  # m/s, between which the limits of stability are searched
LIES = 1.0  # rad, a lean that ends a ride
SMALL = 3e-6  # rad/s, a push whose square, the share of nonlinear terms, is as small as the rounding of theta over it
# The published linear equations M q'' + v C_1 q' + (g K_0 + v^2 K_2) q = 0 of q = (lean, steer), both to the right.
# They hold for the numbers above, whatever g is.
M = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
C_1 = np.array([[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])
K_0 = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
K_2 = np.array([[0, 76.59734589573222], [0, 2.65431523794604]])

# Axes of the frames: forward, up, right. Places from the rear contact; the steering axis meets the ground in S.
UP, RIGHT, STEER = np.array([0, 0, 1.0]), np.array([0, 0, 1.0]), np.array([sin(TILT), -cos(TILT), 0])
S, REAR_HUB, FRONT_HUB = np.array([[w + c, 0, 0], [0, WHEELS[0][0], 0], [w, WHEELS[1][0], 0]])


def cross(a):
    """The matrix of a x."""
    x, y, z = a
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def turn(axis, angle):
    """The matrix of a rotation."""
    return np.eye(3) + sin(angle) * cross(axis) + (1 - cos(angle)) * cross(axis) @ cross(axis)


def carrier(psi, theta):
    """e1, e2, e3 of a wheel."""
    s, c, p, q = sin(theta), cos(theta), sin(psi), cos(psi)
    return np.array([[q, p, 0], [-c * p, c * q, s], [s * p, -s * q, c]])


class Frame:
    """A rigid frame: axes R, angular velocity omega = W u, angular acceleration W u' + rest."""

    def __init__(self, m, centre, inertia, R, W, u, rest):
        xx, yy, zz, xz = inertia
        self.I = R @ [[xx, -xz, 0], [-xz, zz, 0], [0, 0, yy]] @ R.T
        self.m, self.centre, self.R, self.W, self.omega, self.rest = m, np.array([*centre, 0]), R, W, W @ u, rest

    def point(self, base, r):
        """Of the point at r from another: velocity by u, the rest of the acceleration, place."""
        (V, rest, at), r = base, self.R @ r
        turning = cross(self.rest) @ r + cross(self.omega) @ cross(self.omega) @ r
        return V - cross(r) @ self.W, rest + turning, at + r

    def kane(self, centre):
        """Its share of A and b."""
        V, rest, _ = centre
        moment = self.I @ self.rest + cross(self.omega) @ self.I @ self.omega
        return self.m * V.T @ V + self.W.T @ self.I @ self.W, -self.m * V.T @ (rest + g * UP) - self.W.T @ moment


def axle(frame):
    """A wheel on it: psi, theta and their rates; e1 and e2; what the angular acceleration has besides that of psi'' and
    theta'', less what the frame's has besides W u'."""
    n = frame.R[:, 2]
    psi, theta = atan2(n[0], -n[1]), np.arccos(n[2])
    e1, e2, _ = carrier(psi, theta)
    psi_dot, theta_dot = frame.omega @ e2 / sin(theta), frame.omega @ e1
    own = psi_dot * UP + theta_dot * e1  # angular velocity of e1, e2, e3
    turning = psi_dot * theta_dot * cross(UP) @ e1 + cross(own) @ frame.omega - frame.rest
    return psi, theta, psi_dot, theta_dot, np.array([e1, e2]), turning


class Wheel:
    """A free wheel.fmu with r = 0."""

    def __init__(self, radius, m, J_x, J_z):
        description = read_model_description("wheel.fmu")
        ref = {v.name: v.valueReference for v in description.modelVariables}
        self.states = [ref[n] for n in ("X_O", "Y_O", "psi", "theta", "psi_dot", "theta_dot", "omega_z")]
        self.loads = [ref[n] for n in ("F_X", "F_Y", "F_Z", "M_1", "M_2")]
        self.answers = [ref[n] for n in ("lambda_1", "lambda_2", "lambda_3", "theta_ddot", "psi_ddot")]
        self.radius, self.m, self.fmu = radius, m, instantiate_fmu(extract("wheel.fmu"), description, "ModelExchange")
        start = {"m": m, "r_0": radius, "r": 0, "J_x": J_x, "J_y": J_x, "J_z": J_z, "g": g, "theta_start": pi / 2}
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        self.fmu.setReal([ref[n] for n in start], [float(x) for x in start.values()])
        self.fmu.exitInitializationMode()
        self.fmu.enterContinuousTimeMode()

    def rows(self, hub, frame, u):
        """Its rows of the system: factors of u' and of its five loads, right side; and its columns in those of A."""
        (V, rest, at), (psi, theta, *rates, across, turning) = hub, axle(frame)
        self.fmu.setReal(self.states, [*at[:2], psi, theta, *rates, -(V @ u) @ across[0] / self.radius])
        slopes = np.transpose([self.fmu.getDirectionalDerivative(self.answers, [load], [1.0]) for load in self.loads])
        scale = np.array([1 / self.m] * 3 + [1, sin(theta)])
        right = scale * self.fmu.getReal(self.answers) + [*(-rest - g * UP), *(across @ turning)]
        loads = np.diag([1 / self.m] * 3 + [0, 0]) + scale[:, None] * slopes
        return np.vstack([V, across @ frame.W]), -loads, right, np.hstack([V.T, frame.W.T @ across.T])


wheels = [Wheel(*values) for values in WHEELS]


def frames(q, u):
    """Rear frame and fork, the wheels' hubs, and A and b of the frames alone."""
    psi, theta, pitch, steer = q[3:]
    e1, _, e3 = E = carrier(psi, theta)
    own, W = u[3] * UP + u[4] * e1, np.zeros((3, 7))
    W[:, 3:6] = np.transpose([UP, e1, e3])
    R, rest = E.T @ turn(RIGHT, pitch), u[3] * u[4] * cross(UP) @ e1 + u[5] * cross(own) @ e3
    rear = Frame(*REAR, R, W, u, rest)
    R, rest = R @ turn(STEER, steer), rest + u[6] * cross(rear.omega) @ R @ STEER
    W = W + np.outer(R @ STEER, np.eye(7)[6])
    fork = Frame(*FORK, R, W, u, rest)
    hub = np.eye(3, 7), np.zeros(3), q[:3]
    head = rear.point(hub, S - REAR_HUB)
    shares = rear.kane(rear.point(hub, rear.centre - REAR_HUB)), fork.kane(fork.point(head, fork.centre - S))
    return (rear, fork), (hub, fork.point(head, FRONT_HUB - S)), *(sum(of) for of in zip(*shares, strict=True))


def accelerations(q, u):
    """u' for a place and speeds."""
    bodies, hubs, A, b = frames(q, u)
    system, right = np.zeros((17, 17)), np.zeros(17)
    system[:7, :7], right[:7] = A, b
    for wheel, hub, frame, at in zip(wheels, hubs, bodies, (7, 12), strict=True):
        to = slice(at, at + 5)
        system[to, :7], system[to, to], right[to], system[:7, to] = wheel.rows(hub, frame, u)
    return np.linalg.solve(system, right)[:7]


def ride(v, push, times):
    """Lean, steer and their rates; `push`: the rate of leaning to the right at the start, rad/s; NaN from where
    the bicycle lies. By the Runge-Kutta method in equal steps: with a small push, an adaptive one would follow the
    rounding of theta."""

    def rates(y):
        return np.concatenate([y[7:], accelerations(y[:7], y[7:])])

    y = np.zeros(14)
    y[[2, 4, 7, 8, 11]] = WHEELS[0][0], pi / 2, v, -WHEELS[0][0] * push, push
    found = [y]
    for span in np.diff(times):
        if not abs(y[4] - pi / 2) < LIES:
            found.append(np.full(14, np.nan))
            continue
        n = ceil(span / STEP - 1e-9)
        h = span / n
        for _ in range(n):
            k_1 = rates(y)
            k_2 = rates(y + h / 2 * k_1)
            k_3 = rates(y + h / 2 * k_2)
            y = y + h / 6 * (k_1 + 2 * k_2 + 2 * k_3 + rates(y + h * k_3))
        found.append(y)
    return np.transpose(found)[[4, 6, 11, 13]] - [[pi / 2], [0], [0], [0]]


def linear(v, push, times):
    """The same by the published equations."""
    matrix = np.vstack([np.eye(2, 4, 2), -np.linalg.solve(M, np.hstack([g * K_0 + v**2 * K_2, v * C_1]))])
    return np.transpose([expm(matrix * t)[:, 2] * push for t in times])


def eigenvalues(v, of=ride, dt=0.04):
    """Of the matrix that best takes each instant of a short ride to the next; 1/s, by rising real part."""
    y = of(v, SMALL, np.arange(0, 1.0, dt))
    return np.sort_complex(np.log(np.linalg.eigvals(y[:, 1:] @ np.linalg.pinv(y[:, :-1])).astype(complex)) / dt)


def limits():
    """Speeds at which the largest real part of the eigenvalues changes its sign, m/s."""
    tried = np.arange(SLOWEST, FASTEST + 0.5)  # 1 m/s apart
    largest = [eigenvalues(v)[-1].real for v in tried]
    changes = [k for k in range(len(tried) - 1) if largest[k] * largest[k + 1] < 0]
    return [brentq(lambda v: eigenvalues(v)[-1].real, *tried[k : k + 2], xtol=1e-7) for k in changes]


def draw(path, push=0.02):
    """The rides after a larger push, rad/s, as a picture."""
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(len(RIDES), figsize=(7, 7 / 3 * len(RIDES)), squeeze=False, layout="constrained")
    panels = panels[:, 0]
    for panel, (v, stop) in zip(panels, RIDES.items(), strict=True):
        t = np.linspace(0, stop, 301)
        for name, x, y in zip(("lean", "steer"), ride(v, push, t), linear(v, push, t), strict=False):
            panel.plot(t, np.degrees(x), label=name)
            panel.plot(t, np.degrees(y), "k:", label="published linear equations" if name == "steer" else None)
        panel.set(xlabel="t [s]", ylabel="to the right [deg]", title=f"{v:g} m/s")
    panels[0].legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    for v, stop in RIDES.items():
        found, exact = (of(v, SMALL, np.linspace(0, stop, 301))[:2] for of in (ride, linear))
        lean, steer = np.abs(found - exact).max(1) / np.abs(exact).max(1)
        print(f"At {v:g} m/s, off the benchmark, over the largest value: lean {lean:.0e}, steer {steer:.0e}.")
    print("Eigenvalues at 5 m/s:", ", ".join(f"{x:.6g}".removesuffix("+0j") for x in eigenvalues(5.0)))
    changes = ", ".join(f"{v:.5f}" for v in limits()) or f"no speed from {SLOWEST:g} to {FASTEST:g}"
    print("Stability changes at", changes, "m/s.")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
