"""The car in the plane as one system of equations, without its FMUs and their master: the judge of its coupling.

A rigid body at r with heading psi on four upright wheels that roll without slip at u_i along their headings psi +
delta_i. With a_i = r_i - r, the force of a bushing on its wheel is, in the body's axes, -k_h d - c_h d' of the
displacement d = R^T a_i - p_i:

    (m + J_z / R^2) u_i' = f_i e_i - (brake_i - drive_i) / R        r_i' = u_i e_i
    m_B r'' = -sum f_i        (J_3 + 4 J_x) psi' + J_x sum delta_i' = P,  P' = -sum a_i x f_i

The road is level, without rolling resistance, and the car moves forward; it neither rolls nor pitches.
"""

from math import cos, sin, tan

import numpy as np
from scipy.integrate import solve_ivp

from .car import Table
from .judges import car, rise
from .manoeuvres import J_X, J_Z, M_WHEEL, WHEELS, Manoeuvre, R

LEVEL = {"J_1": 1e15, "J_2": 1e15}  # kg m2: with these the chassis FMU stays in the plane for seconds, to 1e-10 rad


def solved(run: Manoeuvre, times: np.ndarray) -> Table:
    """Its motion at some instants: the columns of the car that are compared."""
    c, hubs = car(run), np.array([[run[f"x_{w}"], run[f"y_{w}"]] for w in WHEELS])
    steer = np.array([1.0, 1.0, 0.0, 0.0])
    drive, brake = (np.array([run[f"{name}_{w}"] for w in WHEELS]) for name in ("drive", "brake"))
    ahead = hubs[:, 0] - c.x_rear
    v_0, v_1 = (run.start()["driver"][name] for name in ("v_0", "v_1"))

    def parted(y: np.ndarray) -> tuple:
        """Place and velocity of the body; heading, P, steer angle, distance lost; places and speeds of the wheels."""
        return y[:2], y[2:4], y[4:8], y[8:16].reshape(4, 2), y[16:]

    def steered(delta: float, rate: float) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the wheels (Ackermann), and their rates."""
        a, b = steer * ahead * tan(delta), c.wheelbase - steer * hubs[:, 1] * tan(delta)
        turn = (b * ahead + a * hubs[:, 1]) / (a**2 + b**2) / cos(delta) ** 2
        return np.arctan2(a, b), steer * turn * rate

    def moved(t: float, y: np.ndarray) -> tuple:
        """Steering rate, angles of the wheels, yaw rate, axes of the body, speed of the rear point."""
        _, v, (psi, P, delta, _), *_ = parted(y)
        rate = (run["delta_0"] * rise(t, run["t_delta"], run["ramp_delta"]) - delta) / run["T_delta"]
        angles, rates = steered(delta, rate)
        axes = np.array([[cos(psi), -sin(psi)], [sin(psi), cos(psi)]])
        return rate, angles, (P - J_X * rates.sum()) / (c.J_3 + 4 * J_X), axes, (v @ axes)[0]

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        r, v, (psi, _, _, lost), places, u = parted(y)
        rate, angles, omega, axes, speed = moved(t, y)
        e = np.stack([np.cos(psi + angles), np.sin(psi + angles)], axis=1)
        arms = (places - r) @ axes
        d_dot = (u[:, None] * e - v) @ axes - omega * np.stack([-arms[:, 1], arms[:, 0]], axis=1)
        f = -run["k_h"] * (arms - hubs) - run["c_h"] * d_dot
        late = v_0 + (v_1 - v_0) * rise(t, run["t_v"], run["ramp_v"]) - speed
        braked = run["B_0"] * rise(t, run["t_brake"], run["ramp_M"])
        axle = drive * (run["k_v"] * late + run["k_i"] * lost) - brake * braked
        u_dot = (np.sum(f @ axes.T * e, axis=1) + axle / R) / (M_WHEEL + J_Z / R**2)
        P_dot = np.sum(arms[:, 1] * f[:, 0] - arms[:, 0] * f[:, 1])
        motion = [omega, P_dot, rate, late], (u[:, None] * e).ravel(), u_dot
        return np.concatenate([v, -axes @ f.sum(0) / c.m_B, *motion])

    at, v = np.zeros(2), run["v_start"]  # along X
    y_0 = np.concatenate([at, [v, 0], np.zeros(4), (at + hubs).ravel(), [v] * 4])
    found = solve_ivp(rates, (0, times[-1]), y_0, "DOP853", times, rtol=1e-11, atol=1e-11)
    _, _, omega, _, speed = zip(*map(moved, found.t, found.y.T), strict=True)
    level = np.zeros_like(times)
    of = {"X": found.y[0], "Y": found.y[1], "psi": found.y[4], "roll": level, "pitch": level}
    return {"time": times, **of, "v": np.array(speed), "omega": np.array(omega)}
