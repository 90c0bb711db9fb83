"""Reference of a wheel on a carrier that steers and leans: its axle is a given function of time.

Fixed axes throughout, attitude as a rotation matrix, all reactions unknown: the force of the ground and the carrier's
moment across the axle. No Euler angle appears but in the course of the axle a, whose second derivative is an equation
like the others:

    m v' - lambda                            = F + weight           Newton
    I w' - c x lambda - M_a - tau a          = M - w x I w          Euler about O; M_a across the axle
    w' x a                                   = a'' - w x (w x a)    two components, across the axle
    v' + w' x c                              = -w x c'              rolling; of a wheel that slides the vertical part,
    lambda_X, lambda_Y                       = -mu N d              and friction against the slip, along d

c points from O to the contact.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyint, polyval
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from .model import Road, Start, Wheel

Array = NDArray[np.float64]
UP = np.array([0.0, 0.0, 1.0])
POSITION, VELOCITY, SPIN, TURN = slice(0, 3), slice(3, 6), slice(6, 9), slice(9, 18)
PHI, WORK, STATES = 18, 19, 20


class Piece(NamedTuple):
    """From `begin` to `end`, s: rates of the carrier, and loads by the names of the inputs, all as coefficients of
    1, t, t^2, t^3, t counted from `begin`."""

    begin: float
    end: float
    psi_dot: Sequence[float]
    theta_dot: Sequence[float]
    loads: dict[str, Sequence[float]] = {}


class Now(NamedTuple):
    """At one instant, fixed axes: accelerations of O and of rotation; force of the ground; the carrier's moment along
    e1 and e2; moment about the axle, and the brake's capacity; power of all; the axle, and the arm to the contact."""

    a: Array
    alpha: Array
    force: Array
    carrier: Array
    tau: float
    brake: float
    power: float
    axle: Array
    c: Array


class Margin:
    """An event for solve_ivp: a margin that falls through zero."""

    terminal, direction = True, -1

    def __init__(self, value: Callable[[float, Array], float]) -> None:
        self.value = value

    def __call__(self, t: float, y: Array) -> float:
        return self.value(t, y)


@dataclass
class Carried:
    """One wheel, which starts at `at` but for the rates of its axle. `omega_s`: width of a regularized law, or 0."""

    wheel: Wheel
    at: Start
    road: Road
    omega_s: float = 0.0
    rtol: float = 1e-12
    transitions: list[tuple[float, str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.psi, self.theta = self.at.psi, self.at.theta  # at the begin of the piece

    # ---- the course of the axle ----

    def angles(self, piece: Piece, t: float) -> tuple[Array, Array]:
        """psi and theta, with their first and second derivatives."""
        tau = t - piece.begin
        rows = []
        for start, rate in ((self.psi, piece.psi_dot), (self.theta, piece.theta_dot)):
            angle = polyint(np.asarray(rate, float), k=start)
            rows.append(np.array([polyval(tau, polyder(angle, k)) for k in range(3)]))
        return rows[0], rows[1]

    def axle(self, piece: Piece, t: float) -> tuple[Array, Array, Array]:
        """a and its derivatives."""
        (p, p1, p2), (q, q1, q2) = self.angles(piece, t)
        e1 = np.array([np.cos(p), np.sin(p), 0.0])
        left = np.array([-np.sin(p), np.cos(p), 0.0])
        # a = -sin(theta) left + cos(theta) up
        a = -np.sin(q) * left + np.cos(q) * UP
        a1 = -q1 * np.cos(q) * left + p1 * np.sin(q) * e1 - q1 * np.sin(q) * UP
        a2 = (q1**2 * np.sin(q) - q2 * np.cos(q)) * left + 2 * q1 * p1 * np.cos(q) * e1
        a2 += p2 * np.sin(q) * e1 + p1**2 * np.sin(q) * left - (q2 * np.sin(q) + q1**2 * np.cos(q)) * UP
        return a, a1, a2

    def contact(self, a: Array, a1: Array) -> tuple[Array, Array]:
        """c and its derivative: -(r_0 e2 + r up), e2 the part of `up` across the axle at length one."""
        slope, rate = UP - a * a[2], -a1 * a[2] - a * a1[2]
        size = np.linalg.norm(slope)
        e2 = slope / size
        e2_rate = (rate - e2 * (e2 @ rate)) / size
        return -(self.wheel.r_0 * e2 + self.wheel.r * UP), -self.wheel.r_0 * e2_rate

    def carrier_axes(self, a: Array) -> Array:
        """e1, e2, e3 as columns."""
        e1 = np.cross(UP - a * a[2], a)
        e1 /= np.linalg.norm(e1)
        return np.column_stack([e1, np.cross(a, e1), a])

    # ---- the equations ----

    def solve(self, piece: Piece, mode: tuple[str, int], t: float, y: Array) -> Now:
        """Accelerations and reactions. mode: grips or slides; the sign of the spin, 0: held."""
        contact, sign = mode
        w, R = y[SPIN], y[TURN].reshape(3, 3)
        a, a1, a2 = self.axle(piece, t)
        c, c1 = self.contact(a, a1)
        E = self.carrier_axes(a)
        load = {name: float(polyval(t - piece.begin, np.asarray(row, float))) for name, row in piece.loads.items()}
        weight = self.wheel.m * np.array(self.wheel.gravity)
        F = weight + [load.get(name, 0.0) for name in ("F_X", "F_Y", "F_Z")]
        M = E @ [load.get(name, 0.0) for name in ("M_1", "M_2", "M_3")]
        brake = max(load.get("M_brake", 0.0), 0.0)
        inertia = R @ np.diag([self.wheel.J_x, self.wheel.J_y, self.wheel.J_z]) @ R.T
        K, right = np.zeros((12, 12)), np.zeros(12)  # v', w', lambda, M_a along e1 and e2, tau
        K[0:3, 0:3], K[0:3, 6:9], right[0:3] = self.wheel.m * np.eye(3), -np.eye(3), F
        K[3:6, 3:6], K[3:6, 6:9] = inertia, -skew(c)
        K[3:6, 9:11], K[3:6, 11] = -E[:, :2], -a
        right[3:6] = M - np.cross(w, inertia @ w)
        K[6:8, 3:6] = E[:, :2].T @ -skew(a)  # w' x a
        right[6:8] = E[:, :2].T @ (a2 - np.cross(w, np.cross(w, a)))
        K[8:11, 0:3], K[8:11, 3:6], right[8:11] = np.eye(3), -skew(c), -np.cross(w, c1)
        if contact == "slides":
            u = y[VELOCITY] + np.cross(w, c)
            d = u[:2] / np.linalg.norm(u[:2])
            K[8:10], right[8:10] = 0, 0
            K[8:10, 6:8], K[8:10, 8] = np.eye(2), self.road.mu_slide * d
        if sign == 0 and self.rubs(piece):  # held: w' along the axle is zero
            K[11, 3:6] = a
        else:
            kappa = np.tanh(a @ w / self.omega_s) if self.omega_s else sign
            K[11, 11], K[11, 8], right[11] = 1, self.wheel.s * kappa, -brake * kappa
        x = np.linalg.solve(K, right)
        slip = y[VELOCITY] + np.cross(w, c)
        power = F @ y[VELOCITY] + M @ w + (E[:, :2] @ x[9:11]) @ w + x[11] * (a @ w) + x[6:9] @ slip
        return Now(x[0:3], x[3:6], x[6:9], x[9:11], float(x[11]), brake, float(power), a, c)

    def rubs(self, piece: Piece) -> bool:
        """The exact law holds it, or not."""
        return not self.omega_s and (self.wheel.s > 0 or "M_brake" in piece.loads)

    def rate(self, piece: Piece, mode: tuple[str, int]) -> Callable[[float, Array], Array]:
        def rates(t: float, y: Array) -> Array:
            found = self.solve(piece, mode, t, y)
            w, (p, q) = y[SPIN], self.angles(piece, t)
            phi_dot = w @ found.axle - p[1] * np.cos(q[0])
            turn = skew(w) @ y[TURN].reshape(3, 3)
            return np.concatenate([y[VELOCITY], found.a, found.alpha, turn.ravel(), [phi_dot, found.power]])

        return rates

    # ---- what ends a mode ----

    def margins(self, piece: Piece, mode: tuple[str, int]) -> dict[str, Callable[[float, Array], float]]:
        contact, sign = mode
        found: dict[str, Callable[[float, Array], float]] = {}

        def spin(t: float, y: Array) -> float:
            return sign * float(y[SPIN] @ self.axle(piece, t)[0])

        def reserve(t: float, y: Array) -> float:
            now = self.solve(piece, mode, t, y)
            return self.wheel.s * now.force[2] + now.brake - abs(now.tau)

        def grip(t: float, y: Array) -> float:
            x, z, N = self.solve(piece, mode, t, y).force / (self.wheel.m * self.wheel.g)
            return self.road.mu_max**2 * N * abs(N) - x * x - z * z

        def slip(t: float, y: Array) -> float:
            """Falls through zero where the slip turns back."""
            u = (y[VELOCITY] + np.cross(y[SPIN], self.contact(*self.axle(piece, t)[:2])[0]))[:2]
            return float(np.linalg.norm(u)) - 1e-9

        if self.rubs(piece):
            found["spin" if sign else "held"] = spin if sign else reserve
        if contact == "slides":
            found["slip"] = slip
        elif self.road.mu_max < np.inf:
            found["grip"] = grip
        return found

    def mode_at(self, piece: Piece, t: float, y: Array, contact: str, stopped: bool) -> tuple[str, int]:
        """Held before rolling, where the spin is zero."""
        spin = float(y[SPIN] @ self.axle(piece, t)[0])
        if not self.rubs(piece) or not (stopped or spin == 0):
            return contact, int(np.sign(spin))
        now = self.solve(piece, (contact, 0), t, y)
        if abs(now.tau) <= self.wheel.s * now.force[2] + now.brake + 1e-9:
            return contact, 0
        return contact, -int(np.sign(now.tau))

    # ---- a run ----

    def start(self, piece: Piece) -> Array:
        a, a1, _ = self.axle(piece, piece.begin)
        (p, p1, _), (q, q1, _) = self.angles(piece, piece.begin)
        E = self.carrier_axes(a)
        w = np.cross(a, a1) + a * (self.at.phi_dot + p1 * np.cos(q))
        c, _ = self.contact(a, a1)
        left = np.array([-np.sin(p), np.cos(p), 0.0])
        y = np.zeros(STATES)
        y[POSITION] = [0, 0, self.wheel.r_0 * np.sin(q) + self.wheel.r]
        y[VELOCITY] = -np.cross(w, c) + self.road.slip[0] * E[:, 0] + self.road.slip[1] * left
        y[SPIN] = w
        y[TURN] = (E @ Rotation.from_euler("z", self.at.phi).as_matrix()).ravel()
        y[PHI] = self.at.phi
        return y

    def run(self, pieces: Sequence[Piece], times: Sequence[float]) -> dict[str, Array]:
        """Columns by the FMU's names at `times`, from the left at the end of a piece."""
        y, contact = self.start(pieces[0]), "slides" if any(self.road.slip) else "grips"
        rows: list[tuple[float, dict[str, float]]] = []
        stopped = False
        for piece in pieces:
            t = piece.begin
            while t < piece.end:
                mode = self.mode_at(piece, t, y, contact, stopped)
                margins = self.margins(piece, mode)
                functions = [Margin(value) for value in margins.values()]
                done = solve_ivp(self.rate(piece, mode), (t, piece.end), y, "DOP853", rtol=self.rtol, atol=1e-13,
                                 dense_output=True, events=functions or None)  # fmt: skip
                rows += [(at, self.read(piece, mode, at, done.sol(at))) for at in times
                         if t <= at <= done.t[-1] and not any(at == row[0] for row in rows)]  # fmt: skip
                t, y = float(done.t[-1]), done.y[:, -1]
                stopped = mode[1] == 0
                if done.status != 1:
                    continue
                event = [*margins][next(k for k, found in enumerate(done.t_events) if found.size)]
                self.transitions.append((t, event))
                contact, stopped, y = self.passed(piece, mode, event, t, y)
            self.psi, self.theta = (float(angle[0]) for angle in self.angles(piece, piece.end))
        return {name: np.array([row[name] for _, row in rows]) for name in rows[0][1]}

    def passed(self, piece: Piece, mode: tuple[str, int], event: str, t: float, y: Array) -> tuple[str, bool, Array]:
        """Contact, whether the spin stands at zero, and the state, behind an event."""
        contact, sign = mode
        y = y.copy()
        a, a1, _ = self.axle(piece, t)
        c, _ = self.contact(a, a1)
        if event == "spin":
            y[SPIN] -= a * (a @ y[SPIN])
            if contact == "grips":
                y[VELOCITY] = -np.cross(y[SPIN], c)
        if event == "slip":
            y[VELOCITY] = -np.cross(y[SPIN], c)
            contact = "grips"
        if event == "grip":
            contact = "slides"
            y[VELOCITY][:2] += 1e-8 * self.direction(piece, sign, t, y)
        return contact, event in ("spin", "held") or (sign == 0), y

    def direction(self, piece: Piece, sign: int, t: float, y: Array) -> Array:
        """In which the slip grows along itself, by repeating d -> rate of the slip under friction against d."""
        force = self.solve(piece, ("grips", sign), t, y).force[:2]
        d = -force / np.linalg.norm(force)
        a, a1, _ = self.axle(piece, t)
        c, c1 = self.contact(a, a1)
        for _ in range(400):
            tried = y.copy()
            tried[VELOCITY][:2] += 1e-9 * d
            now = self.solve(piece, ("slides", sign), t, tried)
            growth = (now.a + np.cross(now.alpha, c) + np.cross(tried[SPIN], c1))[:2]
            d = d + 0.2 * growth / np.linalg.norm(growth)
            d /= np.linalg.norm(d)
        return d

    def read(self, piece: Piece, mode: tuple[str, int], t: float, y: Array) -> dict[str, float]:
        now, (p, q) = self.solve(piece, mode, t, y), self.angles(piece, t)
        e1, left = np.array([np.cos(p[0]), np.sin(p[0]), 0]), np.array([-np.sin(p[0]), np.cos(p[0]), 0])
        u = y[VELOCITY] + np.cross(y[SPIN], now.c)
        row = {"X_O": y[0], "Y_O": y[1], "Z_O": y[2], "psi": p[0], "theta": q[0], "phi": y[PHI], "psi_dot": p[1]}
        row |= {"theta_dot": q[1], "omega_z": y[SPIN] @ now.axle, "omega_z_dot": now.alpha @ now.axle}
        row |= {"v_x": y[VELOCITY] @ e1, "v_y": y[VELOCITY] @ left, "lambda_3": now.force[2]}
        row |= {"lambda_x": now.force @ e1, "lambda_y": now.force @ left, "tau": now.tau}
        row |= {"M_guide_1": now.carrier[0], "M_guide_2": now.carrier[1], "slip_x": u @ e1, "slip_y": u @ left}
        return {name: float(value) for name, value in row.items()}


def skew(v: Array) -> Array:
    """v x."""
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
