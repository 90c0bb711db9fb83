"""The paper's matrices and its system, (1)-(26), written once more in numpy, misprints included; and integrated with
all its states (q, q_dot), which leave the constraints, plain and stabilized (Baumgarte).

An independent transcription: nothing here calls the product. Fixed axes for O and forces, body axes
for rotation, Euler angles psi, theta, phi. Works on whole tables of states (leading axes) and on
complex angles, so that a complex step gives every derivative to rounding.

`printed` names the misprints that are kept as the paper has them: "U_theta" (5), "Q_theta" (9),
"F_beta" (16, no sign). "F_beta_bracket" sets the sign of (16) without the bracket, on its first
term alone. Without any of them the mended equations stand.
"""

from collections.abc import Iterable, Mapping
from functools import cached_property

import numpy as np

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.pointwise import ACCELERATIONS

PSI, THETA, PHI = 3, 4, 5  # places of the angles in (25)


def matrix(*entries: np.ndarray | float) -> np.ndarray:
    """3 x 3 matrices, row by row, from nine numbers or tables of numbers."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in entries))
    out = np.empty((*shape, 9), np.result_type(*entries, float))
    for i, entry in enumerate(entries):
        out[..., i] = entry
    return out.reshape(*shape, 3, 3)


def column(*entries: np.ndarray | float) -> np.ndarray:
    return np.stack(np.broadcast_arrays(*entries), axis=-1)


def transposed(a: np.ndarray) -> np.ndarray:
    return np.swapaxes(a, -1, -2)


def times(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Matrix times column, over tables of both."""
    return (a @ x[..., None])[..., 0]


def scaled(factor: np.ndarray, a: np.ndarray) -> np.ndarray:
    return np.asarray(factor)[..., None, None] * a


def rotation_z(angle: np.ndarray) -> np.ndarray:
    """(3), [psi] and [phi]."""
    s, c = np.sin(angle), np.cos(angle)
    return matrix(c, -s, 0, s, c, 0, 0, 0, 1)


def rotation_x(angle: np.ndarray) -> np.ndarray:
    """(3), [theta]."""
    s, c = np.sin(angle), np.cos(angle)
    return matrix(1, 0, 0, 0, c, -s, 0, s, c)


U_Z = matrix(0, -1, 0, 1, 0, 0, 0, 0, 0)  # (5), [U_psi] = [U_phi]
U_THETA = matrix(0, 0, 0, 0, 0, -1, 0, 1, 0)  # (5) mended
U_THETA_PRINTED = matrix(0, 0, 0, 0, 0, -1, 1, 0, 0)  # (5) as printed


class Paper:
    """The matrices at states y = (q, q_dot), (25), for wheels with the header's constants."""

    def __init__(self, wheel: np.ndarray, y: np.ndarray, printed: Iterable[str] = ()) -> None:
        self.wheel, self.printed = wheel, frozenset(printed)
        self.place = y[..., 0], y[..., 1], y[..., 2]
        self.height = y[..., 2]  # Z_O
        self.psi, self.theta, self.phi = (y[..., i] for i in (3, 4, 5))
        self.q_dot, self.beta_dot = y[..., 6:], y[..., 9:]
        self.sin_theta, self.cos_theta = np.sin(self.theta), np.cos(self.theta)
        self.sin_phi, self.cos_phi = np.sin(self.phi), np.cos(self.phi)
        self.phi_matrix = rotation_z(self.phi)
        self.rho = wheel["r_0"] + wheel["r"] * self.sin_theta

    @cached_property
    def J(self) -> np.ndarray:  # (2)
        w = self.wheel
        return matrix(w["J_x"], 0, 0, 0, w["J_y"], 0, 0, 0, w["J_z"])

    @cached_property
    def A(self) -> np.ndarray:  # (4)
        return rotation_z(self.psi) @ rotation_x(self.theta) @ self.phi_matrix

    @cached_property
    def A_psi(self) -> np.ndarray:  # (6)
        return U_Z @ self.A

    @cached_property
    def A_theta(self) -> np.ndarray:  # (6) with (5)
        generator = U_THETA_PRINTED if "U_theta" in self.printed else U_THETA
        return self.A @ transposed(self.phi_matrix) @ generator @ self.phi_matrix

    @cached_property
    def A_phi(self) -> np.ndarray:  # (6)
        return self.A @ U_Z

    @cached_property
    def A_dot(self) -> np.ndarray:  # (7)
        psi_dot, theta_dot, phi_dot = (self.beta_dot[..., i] for i in range(3))
        return scaled(psi_dot, self.A_psi) + scaled(theta_dot, self.A_theta) + scaled(phi_dot, self.A_phi)

    @cached_property
    def Q(self) -> np.ndarray:  # (8)
        s, sp, cp = self.sin_theta, self.sin_phi, self.cos_phi
        return matrix(s * sp, cp, 0, s * cp, -sp, 0, self.cos_theta, 0, 1)

    @cached_property
    def Q_theta(self) -> np.ndarray:  # (9)
        c, sp, cp = self.cos_theta, self.sin_phi, self.cos_phi
        last = 0 if "Q_theta" in self.printed else -self.sin_theta
        return matrix(c * sp, 0, 0, c * cp, 0, 0, last, 0, 0)

    @cached_property
    def Q_phi(self) -> np.ndarray:  # (9)
        s, sp, cp = self.sin_theta, self.sin_phi, self.cos_phi
        return matrix(s * cp, -sp, 0, -s * sp, -cp, 0, 0, 0, 0)

    @cached_property
    def Q_dot(self) -> np.ndarray:  # (10)
        return scaled(self.beta_dot[..., 1], self.Q_theta) + scaled(self.beta_dot[..., 2], self.Q_phi)

    @cached_property
    def r(self) -> np.ndarray:  # (11)
        rho, eta, sp, cp = self.rho, self.wheel["r"] * self.cos_theta, self.sin_phi, self.cos_phi
        return matrix(0, eta, -rho * cp, -eta, 0, rho * sp, rho * cp, -rho * sp, 0)

    @cached_property
    def contact(self) -> np.ndarray:
        """O to the contact in body axes, read off the cross-product matrix (11)."""
        return column(self.r[..., 2, 1], self.r[..., 0, 2], self.r[..., 1, 0])

    @cached_property
    def r_theta(self) -> np.ndarray:  # (12)
        s, c = self.wheel["r"] * self.sin_theta, self.wheel["r"] * self.cos_theta
        sp, cp = self.sin_phi, self.cos_phi
        return matrix(0, -s, -c * cp, s, 0, c * sp, c * cp, -c * sp, 0)

    @cached_property
    def r_phi(self) -> np.ndarray:  # (12)
        rho, sp, cp = self.rho, self.sin_phi, self.cos_phi
        return matrix(0, 0, rho * sp, 0, 0, rho * cp, -rho * sp, -rho * cp, 0)

    @cached_property
    def r_dot(self) -> np.ndarray:  # (13)
        return scaled(self.beta_dot[..., 1], self.r_theta) + scaled(self.beta_dot[..., 2], self.r_phi)

    def F(self, load: np.ndarray | None = None) -> np.ndarray:  # (15), generalized
        w = self.wheel
        weight = column(w["m"] * w["g_X"], w["m"] * w["g_Y"], -w["m"] * w["g_n"])
        if load is None:
            return np.concatenate([weight, np.zeros_like(weight)], axis=-1)
        moment = times(transposed(self.phi_matrix), load["M"])  # carrier to body axes
        return np.concatenate([weight + load["F"], moment], axis=-1)

    @cached_property
    def F_beta(self) -> np.ndarray:  # (16)
        first = times(self.J @ self.Q_dot, self.beta_dot)
        second = times(transposed(self.A) @ self.A_dot @ self.J @ self.Q, self.beta_dot)
        if "F_beta" in self.printed:
            return first + second
        return second - first if "F_beta_bracket" in self.printed else -(first + second)

    @cached_property
    def M(self) -> np.ndarray:  # (18)
        out = np.zeros((*np.shape(self.theta), 6, 6), self.theta.dtype)
        out[..., :3, :3] = scaled(self.wheel["m"], np.eye(3))
        out[..., 3:, 3:] = self.J @ self.Q
        return out

    @cached_property
    def B(self) -> np.ndarray:  # (19)
        turning = self.A @ transposed(self.r) @ self.Q
        return np.concatenate([np.broadcast_to(np.eye(3), turning.shape), turning], axis=-1)

    @cached_property
    def B_dot(self) -> np.ndarray:  # (20)
        r_T, r_dot_T = transposed(self.r), transposed(self.r_dot)
        turning = self.A_dot @ r_T @ self.Q + self.A @ r_dot_T @ self.Q + self.A @ r_T @ self.Q_dot
        return np.concatenate([np.zeros_like(turning), turning], axis=-1)

    @cached_property
    def omega_z(self) -> np.ndarray:  # (21)
        return (self.Q[..., 2, :] * self.beta_dot).sum(-1)

    def B_tilde(self, kappa: np.ndarray | float) -> np.ndarray:  # (22), (23)
        """kappa stands for omega_z / |omega_z|."""
        B_star = matrix(0, 0, 0, 0, 0, 0, 0, 0, -self.wheel["s"] * kappa)
        lower = self.r @ transposed(self.A) + B_star
        return np.concatenate([np.broadcast_to(np.eye(3), lower.shape), lower], axis=-2)

    def system(self, kappa: np.ndarray | float, load: np.ndarray | None = None) -> tuple:
        """Matrix and column of (24)."""
        K = np.zeros((*np.shape(self.theta), 9, 9), self.theta.dtype)
        K[..., :6, :6], K[..., :6, 6:], K[..., 6:, :6] = self.M, -self.B_tilde(kappa), self.B
        F_tilde = np.concatenate([np.zeros_like(self.F_beta), self.F_beta], axis=-1)  # (17)
        forces = self.F(load) + F_tilde
        return K, np.concatenate([forces, -times(self.B_dot, self.q_dot)], axis=-1)

    def solve(self, kappa: np.ndarray | float = 0, load: np.ndarray | None = None) -> np.ndarray:
        """q_ddot and lambda of (24) with the axle moment -s lambda_3 kappa."""
        K, right = self.system(kappa, load)
        return np.linalg.solve(K, right[..., None])[..., 0]

    def solve_held(self, load: np.ndarray | None = None) -> np.ndarray:
        """q_ddot, lambda and tau: (24) bordered by omega_z_dot = 0 and the axle moment tau."""
        K, right = self.system(0, load)
        n = K.shape[-1]
        bordered = np.zeros((*K.shape[:-2], n + 1, n + 1), K.dtype)
        bordered[..., :n, :n] = K
        bordered[..., 5, n] = -self.wheel["J_z"]  # the unknown is tau / J_z: all columns of one size
        bordered[..., n, 3:6] = self.Q[..., 2, :]
        drift = (self.Q_dot[..., 2, :] * self.beta_dot).sum(-1)
        right = np.concatenate([right, -drift[..., None]], axis=-1)
        size = np.abs(bordered).max(axis=-1, keepdims=True)  # and all rows: rounding stays small
        x = np.linalg.solve(bordered / size, right[..., None] / size)[..., 0]
        return np.concatenate([x[..., :n], (self.wheel["J_z"] * x[..., n])[..., None]], axis=-1)

    @cached_property
    def slip(self) -> np.ndarray:
        """[B]{q_dot}, m/s."""
        return times(self.B, self.q_dot)

    @cached_property
    def height_error(self) -> np.ndarray:
        """Z_O less the height of (32), m."""
        return self.height - self.wheel["r_0"] * self.sin_theta - self.wheel["r"]

    @property
    def rate(self) -> np.ndarray:
        """(q_dot, q_ddot) of the free wheel."""
        return np.concatenate([self.q_dot, self.solve()[..., :6]], axis=-1)

    @cached_property
    def omega(self) -> np.ndarray:  # (8), in body axes
        return times(self.Q, self.beta_dot)

    @cached_property
    def energy(self) -> np.ndarray:
        v, w = self.q_dot[..., :3], self.wheel
        turning = (self.omega * times(self.J, self.omega)).sum(-1)
        fallen = w["g_X"] * self.place[0] + w["g_Y"] * self.place[1] - w["g_n"] * self.place[2]
        return 0.5 * (w["m"] * (v * v).sum(-1) + turning) - w["m"] * fallen


def states() -> np.ndarray:
    """A thousand random q, q_dot."""
    random = np.random.default_rng(24)
    y = random.normal(0, 2, (1000, 12))
    y[:, THETA] = random.uniform(0.05, np.pi - 0.05, len(y))
    return y


def paper_table(**changes: float) -> np.ndarray:
    """The paper's wheel (27)-(31) as one row of a table of constants."""
    return np.array([eq.values(eq.paper_wheel(**changes))]).view(np.dtype(eq.Parameters))[0, 0]


def set_rolling(wheel: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """(q, q_dot) of (25) of wheels that begin to roll so: height and velocity of O by (32), (33)."""
    height = wheel["r_0"] * np.sin(motions["theta"]) + wheel["r"]
    names = ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot")
    psi, theta, phi, *beta_dot = (motions[name] for name in names)
    still = np.zeros_like(psi)
    y = column(motions["X_O"], motions["Y_O"], height, psi, theta, phi, still, still, still, *beta_dot)
    y[..., 6:9] = -Paper(wheel, y).slip
    return y


# ---- all twelve states integrated: how far the constraints of (24) drift ----


class Stabilized(Paper):
    """(24) with -[B_dot]{q_dot} - a [B]{q_dot} in its last rows, and a height that falls to that of (32) at the rate a
    (Baumgarte): errors of the constraints decay, on the constraints nothing changes."""

    @cached_property
    def decay_rate(self) -> np.ndarray:
        """a = 5 sqrt(g / (r_0 + r) + |omega|^2), 1/s: never the stiffest part of the motion."""
        w = self.wheel
        return 5 * np.sqrt(w["g_n"] / (w["r_0"] + w["r"]) + (self.omega**2).sum(axis=-1))

    def system(self, kappa: np.ndarray | float, load: np.ndarray | None = None) -> tuple:
        K, right = super().system(kappa, load)
        right[..., 6:] -= self.decay_rate[..., None] * self.slip
        return K, right

    @property
    def rate(self) -> np.ndarray:
        out = super().rate
        out[..., 2] -= self.decay_rate * self.height_error
        return out


FORMS = {"plain": Paper, "stabilized": Stabilized}


def marched(form: type[Paper], wheel: np.ndarray, y: np.ndarray, step: float, count: int) -> np.ndarray:
    """The state of the free wheel after `count` steps of the classical Runge-Kutta method, s each."""

    def rate(at: np.ndarray) -> np.ndarray:
        return form(wheel, at).rate

    for _ in range(count):
        k_1 = rate(y)
        k_2 = rate(y + step / 2 * k_1)
        k_3 = rate(y + step / 2 * k_2)
        k_4 = rate(y + step * k_3)
        y = y + step / 6 * (k_1 + 2 * k_2 + 2 * k_3 + k_4)
    return y


# ---- a wheel carrier; the laws of friction ----


class Carried(Paper):
    """(24) of a wheel on its carrier, whose moments about e1 and e2 give psi_ddot and theta_ddot, `turn`: two
    unknowns more. `slip`: one that slides, with coefficient and direction from X: its force stands in the place of two
    constraints."""

    slip_of: tuple[np.ndarray, np.ndarray] | None = None
    turn: np.ndarray | float = 0.0

    def system(self, kappa: np.ndarray | float, load: np.ndarray | None = None) -> tuple:
        K, right = super().system(kappa, load)
        if self.slip_of:
            mu, chi = self.slip_of
            K[..., 6:8, :], right[..., 6:8] = 0, 0
            K[..., 6, 6] = K[..., 7, 7] = 1
            K[..., 6, 8], K[..., 7, 8] = mu * np.cos(chi), mu * np.sin(chi)
        bordered = np.zeros((*K.shape[:-2], 11, 11), K.dtype)
        bordered[..., :9, :9] = K
        bordered[..., 3:6, 9:] = -transposed(self.phi_matrix)[..., :2]  # e1 and e2 in body axes
        bordered[..., 9, PSI] = bordered[..., 10, THETA] = 1
        return bordered, np.concatenate([right, np.zeros_like(right[..., :2]) + self.turn], axis=-1)


def solved(paper: Paper, scenes: np.ndarray, load: Mapping | np.ndarray | None = None) -> np.ndarray:
    """q_ddot, lambda and tau row by row, with each scene's law and load, or another load (complex too)."""
    load = scenes["load"] if load is None else load
    brake = load["brake"]
    friction, kind = scenes["friction"], scenes["friction"]["kind"]
    soft = np.tanh(paper.omega_z / friction["omega_s"])
    kappa = np.select([kind == eq.ROLLING, kind == eq.REGULARIZED], [friction["sigma"], soft], 0)
    braked = {"F": load["F"], "M": load["M"] - (brake * kappa)[..., None] * np.array([0, 0, 1])}
    grip = np.where(paper.solve(kappa, braked)[:, 8].real > 0, kappa, 0)  # no pressure, no friction but the brake's
    x = paper.solve(grip, braked)
    x = np.column_stack([x, -scenes["wheel"]["s"] * grip * x[:, 8] - brake * kappa])
    return np.where((kind == eq.HELD)[:, None], paper.solve_held(load), x)


def omega_z_dot(paper: Paper, x: np.ndarray, scenes: np.ndarray) -> np.ndarray:
    """Derivative of (21); zero by definition while the spin is held."""
    rate = (paper.Q[:, 2, :] * x[:, 3:6] + paper.Q_dot[:, 2, :] * paper.beta_dot).sum(axis=1)
    return np.where(scenes["friction"]["kind"] == eq.HELD, 0, rate)


def dynamics_of(paper: Paper, x: np.ndarray, scenes: np.ndarray) -> np.ndarray:
    """WheelDynamics from what `solved` returns; tau is its last column."""
    out = eq.table(eq.Dynamics, len(x))
    for i, name in enumerate(ACCELERATIONS):
        out[name] = x[:, i]
    out["lambda_"], out["tau"] = x[:, 6:9], x[:, -1]
    out["omega_z_dot"] = omega_z_dot(paper, x, scenes)
    return out
