"""Bodies on wheels that roll without slip, as one set of equations, integrated by SciPy: the independent check of the
coupled vehicles. Fixed axes, no angles, SI, Z up.

Each wheel is its centre O, the unit vector a along its axle and its angular velocity w; all arrays are (wheels, 3).
With u = (Z - (Z a) a) / |...| the contact point is O - rho, rho = r_0 u + r Z, and no slip means v_O = w x rho. Newton
gives the ground's force lambda, Euler about O, with J = J_x 1 + (J_z - J_x) a a^T,

    (J + m (rho^2 1 - rho rho^T)) w' = M + tau a - (J_z - J_x)(a w) (w x a) - rho x (m w x rho' - F - m g)

Here g is the vector of gravity. tau, the moment of rolling friction and brake about the axle, follows from the law:
rolling with sign sigma of a w it is -sigma (s N + B), held it is what keeps a w at zero. None of this shares code or
formulation with the FMUs.
"""

from types import SimpleNamespace

import numpy as np
from reference.model import Wheel
from scipy.integrate import solve_ivp

Z = np.array([0.0, 0.0, 1.0])
NEXT, LAST = np.array([1, 2, 0]), np.array([2, 0, 1])  # of an axis
Load = SimpleNamespace  # F, M: force and moment on each wheel (wheels, 3); brake: the capacity of its brake (wheels,)
Answer = SimpleNamespace  # to a load: w_dot, force (lambda), v of O, all (wheels, 3), and tau (wheels,)


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row; much quicker than numpy's for few rows."""
    return a.take(NEXT, -1) * b.take(LAST, -1) - a.take(LAST, -1) * b.take(NEXT, -1)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Row by row, as a column."""
    return (a * b).sum(axis=-1, keepdims=True)


def lever(kind: Wheel, a: np.ndarray, w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """rho and its rate."""
    a_dot = cross(w, a)
    across = Z - a[:, 2:] * a
    length = np.sqrt(dot(across, across))
    u = across / length
    rate = -a_dot[:, 2:] * a - a[:, 2:] * a_dot
    return kind.r_0 * u + kind.r * Z, kind.r_0 * (rate - u * dot(u, rate)) / length


def respond(kind: Wheel, a: np.ndarray, w: np.ndarray, load: Load, sigma: np.ndarray) -> Answer:
    """Accelerations and reactions; sigma = -1, 1: the sign of a w while a wheel rolls, 0: it is held."""
    rho, rho_dot = lever(kind, a, w)
    spin = dot(a, w)
    matrix = (kind.J_x + kind.m * dot(rho, rho))[:, :, None] * np.eye(3)
    matrix += (kind.J_z - kind.J_x) * a[:, :, None] * a[:, None, :] - kind.m * rho[:, :, None] * rho[:, None, :]
    at_rest = kind.m * cross(w, rho_dot) - load.F - np.multiply(kind.m, kind.gravity)
    right = load.M - (kind.J_z - kind.J_x) * spin * cross(w, a) - cross(rho, at_rest)
    free, per_tau = np.linalg.solve(matrix, np.stack([right, a], axis=2)).transpose(2, 0, 1)
    N = kind.m * cross(free, rho)[:, 2] + at_rest[:, 2]
    N_per_tau = kind.m * cross(per_tau, rho)[:, 2]
    holding = -dot(free, a)[:, 0] / dot(per_tau, a)[:, 0]
    rolling = -sigma * (kind.s * N + load.brake) / (1 + sigma * kind.s * N_per_tau)
    tau = np.where(sigma == 0, holding, rolling)
    w_dot = free + tau[:, None] * per_tau
    return Answer(w_dot=w_dot, force=kind.m * cross(w_dot, rho) + at_rest, tau=tau, v=cross(w, rho))


class Joint:
    """A vehicle: `size` states, then O, a, w of its n wheels of one `kind`.

    By the vehicle: start() and load(t, y); own_rates(t, y, load, answer), the rates of these states;
    columns(t, y, load, answer), what is compared.
    """

    def wheels(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """O, a, w."""
        return tuple(y[self.size :].reshape(3, self.n, 3))

    def spins(self, y: np.ndarray) -> np.ndarray:
        """a w."""
        _, a, w = self.wheels(y)
        return dot(a, w)[:, 0]

    def answer(self, t: float, y: np.ndarray, sigma: np.ndarray) -> tuple[Load, Answer]:
        """The load, and what the wheels do."""
        load = self.load(t, y)
        return load, respond(self.kind, *self.wheels(y)[1:], load, sigma)

    def rate(self, t: float, y: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """dy/dt on the friction branches sigma."""
        _, a, w = self.wheels(y)
        load, answer = self.answer(t, y, sigma)
        wheels = (answer.v, cross(w, a), answer.w_dot)
        return np.concatenate([self.own_rates(t, y, load, answer), *(x.ravel() for x in wheels)])

    def margins(self, t: float, y: np.ndarray, sigma: np.ndarray) -> np.ndarray:
        """Of each wheel what ends its branch at zero, sigma a w rolling, s N + B - |tau| held; then normal forces."""
        load, answer = self.answer(t, y, sigma)
        N = answer.force[:, 2]
        held = self.kind.s * N + load.brake - np.abs(answer.tau)
        return np.concatenate([np.where(sigma == 0, held, sigma * self.spins(y)), N])

    def solve(self, times: np.ndarray, tolerance: float) -> tuple[dict[str, np.ndarray], tuple[int, float] | None]:
        """The motion at `times` (rising from 0), from one change of a wheel's friction branch to the next, up to where
        a wheel lifts off: which, and when."""
        t, y, rows, lift_off = 0.0, self.start(), [], None
        sigma = np.sign(self.spins(y))

        def least(t: float, y: np.ndarray, sigma: np.ndarray) -> float:
            return self.margins(t, y, sigma).min()

        least.terminal, least.direction = True, -1
        how = {"events": least, "rtol": tolerance, "atol": tolerance, "max_step": 0.05}
        while len(rows) < len(times) and not lift_off:
            found = solve_ivp(self.rate, (t, times[-1]), y, "DOP853", times[len(rows) :], args=(sigma,), **how)
            if not found.success:
                raise RuntimeError(found.message)
            motion = zip(found.t, np.transpose(found.y), strict=True)
            rows += [self.columns(u, x, *self.answer(u, x, sigma)) for u, x in motion]
            if found.status:
                t, y = float(found.t_events[0][0]), found.y_events[0][0].copy()
                first = int(self.margins(t, y, sigma).argmin())
                lift_off = (first - self.n, t) if first >= self.n else None
                sigma = sigma if lift_off else self._change(t + 1e-12, y, sigma, first)  # s: loads may jump there
        columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        return {"time": times[: len(rows)], **columns, "psi": np.unwrap(columns["psi"])}, lift_off

    def _change(self, t: float, y: np.ndarray, sigma: np.ndarray, first: int) -> np.ndarray:
        """The branches after an event: stopped wheels are held if the friction can, held ones set off where it cannot.

        Wheels that change together, as those of one axle do, differ by rounding: all within it change at once.
        """
        margins, answer = self.margins(t, y, sigma)[: self.n], self.answer(t, y, sigma)[1]
        _, a, w = self.wheels(y)
        rolling, slowing = sigma != 0, sigma * dot(answer.w_dot, a)[:, 0] < 0
        stopped, released = rolling & (margins < 1e-9) & slowing, ~rolling & (margins < 1e-6)
        stopped[first], released[first] = rolling[first], not rolling[first]
        after = np.select([released, stopped], [-np.sign(answer.tau), 0.0], sigma)
        w[stopped] -= a[stopped] * dot(a, w)[stopped]
        through = stopped & (self.margins(t, y, after)[: self.n] < 0)
        return np.where(through, -sigma, after)
