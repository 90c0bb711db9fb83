"""Which contact holds: the wheel grips, slides, or has no friction; its motion in each, and the margins that end it.

While it grips, all reactions are unknown (newton_euler.py); while it slides, friction is a force at the contact
(sliding_contact.py).
"""

from collections.abc import Callable
from math import atan2, cos, hypot, inf, sin, tanh
from typing import NamedTuple

import numpy as np

from .frames import Matrix, rotation, slope, to_body, to_fixed
from .model import Inputs, Options, Road, Vector, Wheel, released
from .motion import CHI, OMEGA_Z, SPEED, TIME, State, angle_rates, with_weight
from .newton_euler import Contact, Law, axle_moment, carrier_moment
from .sliding_contact import Push, Sliding, respond, resting_directions

GRIPS, SLIDES, FREE = "grips", "slides", "free"
# Below this part of m (g + |w|^2 (r_0 + r)), or of the moment that it has with r_0, a margin counts as kept: rounding
# leaves about 1e-15 of it, so that a wheel without weight rolling straight (N = 0 for ever) has no transitions.
ROUNDING = 1e-12
TIGHT, JAMMED = 0.05, 1e-12
Side = tuple[float, float]


class Mode(NamedTuple):
    """One smooth branch: the contact; the sign of w_z, 0 held; +1 while the ground presses, -1 while it pulls."""

    contact: str
    sigma: int
    ground: int


class Now(NamedTuple):
    """The answer of the equations in one mode: a, alpha in body axes, force of the ground, slip rate in fixed ones."""

    R: Matrix
    a: Vector
    alpha: Vector
    force: Vector
    tau: float
    push: Push | None
    slip_rate: tuple[float, float]


class Contacts:
    """Equations and margins of one wheel on one road under smooth inputs."""

    def __init__(self, wheel: Wheel, road: Road, inputs: Inputs, options: Options) -> None:
        self.wheel, self.road, self.inputs, self.options = wheel, road, inputs, options
        self.grip = Contact(wheel)
        self.brakes = inputs.brake is not released
        self.weight = wheel.m * wheel.g
        self.pulled = GRIPS if road.mu_max == inf else FREE  # the contact of a ground that pulls, or of such a road

    # ---- laws ----

    def s(self, ground: int) -> float:
        """The lever of N in the law of rolling resistance; N < 0 where the ground pulls."""
        return self.wheel.s if ground > 0 else -self.options.pulled * self.wheel.s

    def watched(self, ground: int) -> bool:
        """True where sigma switches."""
        return self.options.omega_s == 0 and (self.brakes or self.s(ground) != 0)

    def least(self, y: State) -> float:
        """The normal force that is only rounding."""
        spin = float(y[4:7] @ y[4:7]) * (self.wheel.r_0 + self.wheel.r)
        return ROUNDING * self.wheel.m * (self.wheel.g + spin)

    def law(self, mode: Mode, t: float, w_z: float) -> Law:
        s, brake = self.s(mode.ground), self.inputs.brake(t)
        if self.options.omega_s > 0:
            return Law(s, tanh(w_z / self.options.omega_s), brake=brake)
        return Law(s, mode.sigma, hold=mode.sigma == 0 and self.watched(mode.ground), brake=brake)

    # ---- the equations of a mode ----

    def sliding_at(self, mode: Mode, y: State) -> Sliding:
        """The wheel under any friction in the direction of slip."""
        t = float(y[TIME])
        return respond(self.wheel, *self._loads(t, y.tolist()), self.law(mode, t, float(y[OMEGA_Z])))

    def _loads(self, t: float, y: list[float]) -> tuple[Matrix, Vector, Vector, Vector]:
        R = rotation(y[0], y[1], y[2], y[3])
        F = to_body(R, with_weight(self.wheel, self.inputs.force(t)))
        return R, (y[4], y[5], y[6]), F, carrier_moment(R[2], self.inputs.moment(t))

    def now(self, mode: Mode, y: State, found: Sliding | None = None) -> Now:
        t = float(y[TIME])
        if mode.contact == GRIPS:
            R, w, F, M = self._loads(t, y.tolist())
            answer = self.grip.respond(R[2], w, F, M)
            tau = axle_moment(self.law(mode, t, w[2]), answer)
            x = [b + tau * u for b, u in zip(answer.base, answer.unit, strict=True)]
            return Now(R, tuple(x[0:3]), tuple(x[3:6]), to_fixed(R, tuple(x[6:9])), tau, None, (0.0, 0.0))
        R = rotation(*y[:4].tolist())
        found = found or self.sliding_at(mode, y)
        push = None if mode.contact == FREE else found.push(self.road.mu_slide, float(y[CHI]))
        f = push.force if push else (0.0, 0.0)
        x = found.at(*f)
        return Now(R, tuple(x[0:3]), tuple(x[3:6]), (*f, x[6]), x[7], push, found.slip_rate(*f))

    def rates(self, mode: Mode, y: State, at: Sliding | None = None) -> tuple[list[float], Now]:
        """dy/dt of all but the slip and the time.  at: sliding_at(mode, y) where it is known."""
        now = self.now(mode, y, at)
        t, state = float(y[TIME]), y.tolist()
        R, alpha = now.R, now.alpha
        if mode.sigma == 0 and self.watched(mode.ground):
            alpha = (alpha[0], alpha[1], 0.0)
        q0, q1, q2, q3, wx, wy, wz = state[:7]
        psi_dot, _, phi_dot = angle_rates(R[2], (wx, wy, wz))
        F, M, v = self.inputs.force(t), carrier_moment(R[2], self.inputs.moment(t)), state[10:13]
        power = F[0] * v[0] + F[1] * v[1] + F[2] * v[2] + M[0] * wx + M[1] * wy + M[2] * wz
        turning = [-q1 * wx - q2 * wy - q3 * wz, q0 * wx + q2 * wz - q3 * wy]
        turning += [q0 * wy + q3 * wx - q1 * wz, q0 * wz + q1 * wy - q2 * wx]
        loss = -self.road.mu_slide * now.push.N * state[SPEED] if now.push else 0.0
        a = to_fixed(R, now.a)
        return [*(q / 2 for q in turning), *alpha, *v, *a, psi_dot, phi_dot, power, now.tau * wz, loss], now

    def by_time(self, mode: Mode) -> Callable[[float, State], State]:
        """dy/dt."""

        def rate(_t: float, y: State) -> State:
            found, now = self.rates(mode, y)
            slip = (now.push.grow, now.push.turn / y[SPEED]) if now.push else now.slip_rate
            return np.array((*found, *slip, 1.0))

        return rate

    def by_progress(self, mode: Mode, near: float) -> Callable[[float, State], State]:
        """dy/d(sigma), dt = |u| / (|u| + near) x / (x + TIGHT) d(sigma), x the room before the wheel jams.

        Regular down to |u| = 0 and to x = 0, where N grows without bound; neither is reached at a finite sigma.
        """
        if mode.contact != SLIDES:
            return self.by_time(mode)

        def rate(_sigma: float, y: State) -> State:
            found, now = self.rates(mode, y)
            assert now.push
            turning = now.push.room / (now.push.room + TIGHT) / (y[SPEED] + near)
            share = y[SPEED] * turning
            slip = (now.push.grow * share, now.push.turn * turning)
            return np.array((*(share * x for x in found), *slip, share))

        return rate

    # ---- the end of a mode ----

    def margins(self, mode: Mode, side: Side, y: State) -> tuple[dict[str, float], Side]:
        """By name, each positive while the mode lasts; `rises` and `falls` release a held wheel to w_z > 0 and < 0.

        side: e2 in body axes shortly before; where e2 has turned over since, the wheel has passed flat, and
        s = sin(theta) counts as negative. Returns the side here as well.
        """
        now = self.now(mode, y)
        ux, uy, s = slope(now.R[2])
        over = -1.0 if ux * side[0] + uy * side[1] < 0 else 1.0
        found = {} if self.options.flat is None else {"flat": over * s - self.options.flat}
        N = now.push.N * now.push.room if now.push else now.force[2]
        found["presses"] = mode.ground * N + self.least(y)
        if mode.contact == GRIPS and self.road.mu_max < inf:
            found["grips"] = self.grip_margin(now)
        if now.push:
            found["room"] = now.push.room - JAMMED
        if self.watched(mode.ground):
            if mode.sigma == 0:
                limit = self.limit(mode, float(y[TIME]), now)
                found |= {"rises": limit + now.tau, "falls": limit - now.tau}
            else:
                found["rolls"] = mode.sigma * float(y[OMEGA_Z])
        return found, (over * ux, over * uy)

    def limit(self, mode: Mode, t: float, now: Now) -> float:
        """s N + brake."""
        return self.s(mode.ground) * now.force[2] + self.inputs.brake(t)

    def grip_margin(self, now: Now) -> float:
        """(mu_max N)^2 - f^2, over the weight squared; of the sign of mu_max N - |f|, smooth where f = 0."""
        if self.road.mu_max == inf:
            return 1.0
        x, y, N = (component / self.weight for component in now.force)
        return self.road.mu_max**2 * N * abs(N) - x * x - y * y

    # ---- the next mode ----

    def choose(self, y: State, ground: int = 0, gone: str = "", sigma: int | None = None) -> tuple[Mode, float] | None:
        """The mode, and the slip direction if it starts now, in which the motion goes on; None: there is none.

        ground: 0 where N decides.  gone: a contact that has just ended.  sigma: the sign that w_z has to take.
        Tried in the order: held before rolling; grips, slides.
        """
        w_z = float(y[OMEGA_Z])
        if ground < 0 or self.road.mu_max in (0, inf):
            options = [(self.pulled, 0.0)]
        elif y[SPEED] > 0:
            options = [(SLIDES, float(y[CHI]))]
        else:
            options = [(contact, 0.0) for contact in (GRIPS, SLIDES) if contact != gone]
        for contact, chi in options:
            for sign in self._signs(w_z, ground or 1, sigma):
                mode = Mode(contact, sign, ground or 1)
                starts = [chi] if contact != SLIDES or y[SPEED] > 0 else self.directions(mode, y)
                for start in starts:
                    if self._holds(mode, y, start, sigma):
                        return mode, start
        return None

    def _signs(self, w_z: float, ground: int, sigma: int | None) -> list[int]:
        if sigma is not None:
            return [sigma]
        return [(w_z > 0) - (w_z < 0)] if w_z or not self.watched(ground) else [0, 1, -1]

    def _holds(self, mode: Mode, y: State, chi: float, sigma: int | None) -> bool:
        at = y.copy()
        if mode.contact == SLIDES:
            at[CHI] = chi
        now = self.now(mode, at)
        least = self.least(y)
        if mode.ground * now.force[2] < -least or (now.push and now.push.room <= 0):
            return False
        if mode.contact == GRIPS and self.grip_margin(now) < -ROUNDING:
            return False
        if sigma is not None or y[OMEGA_Z] or not self.watched(mode.ground):
            return True
        if mode.sigma == 0:
            return abs(now.tau) <= self.limit(mode, float(y[TIME]), now) + least * self.wheel.r_0
        return mode.sigma * now.alpha[2] >= 0

    def directions(self, mode: Mode, y: State) -> list[float]:
        """Slip directions in which a wheel at |u| = 0 can start: the slip grows along d, and d draws neighbours in.

        The nearest to the opposite of grip's force first. For mu_slide = mu_max at the loss of grip that one has no
        acceleration at the start, or a negative one by rounding.
        """
        found, mu = self.sliding_at(mode, y), self.road.mu_slide
        f_X, f_Y = found.grip()
        against, least = atan2(-f_Y, -f_X), ROUNDING * 100 * hypot(*found.free)
        starts = []
        for chi in resting_directions(found, mu):
            push = found.push(mu, chi)
            if push.grow > -least and push.room > 0 and found.turning(mu, chi) < 0:
                starts.append(chi)
        return sorted(starts, key=lambda chi: -cos(chi - against))

    def slip(self, mode: Mode, y: State) -> tuple[float, float]:
        """u along X and Y."""
        if mode.contact == GRIPS:
            return 0.0, 0.0
        if mode.contact == FREE:
            return float(y[SPEED]), float(y[CHI])
        return float(y[SPEED]) * cos(y[CHI]), float(y[SPEED]) * sin(y[CHI])
