"""The first moments of a slide, and every slide along which the direction is stiff: collocation of high order in time.

At |u| = 0 the direction obeys |u| chi' = turn(chi), which is 0 = turn(chi) there: no explicit start, but one smooth
solution where turn' < 0. Radau's points leave out the start of the step, so that |u| = 0 there needs no division; all
else is not stiff and is found by fixed-point iteration around Newton's method for chi.
"""

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from .modes import Contacts, Mode
from .motion import CHI, SPEED, TIME, State

Array = NDArray[np.float64]
COUNT = 12
POINTS = (np.append(roots_jacobi(COUNT - 1, 1, 0)[0], 1.0) + 1) / 2
SWEEPS, NEWTON = 80, 6
TAIL = 3e-14  # of the rates' last two coefficients, times the step, to the size of the state
SMALLEST = 1e-9  # s
STIFF_RATE, STIFF_RATIO = 300.0, 30.0  # of settling, 1/s, and to that of |u|: beyond both, explicit steps are slow
SETTLED = 0.05  # rad, off the direction that does not turn


def _integrals(x: Array) -> Array:
    """Row j: the integrals of the Legendre polynomials from 0 to x_j, on (0, 1)."""
    higher = legendre.legvander(2 * x - 1, COUNT)
    k = np.arange(1, COUNT)
    rest = (higher[:, 2:] - higher[:, :-2]) / (2 * (2 * k + 1))
    return np.column_stack([x, rest])


_TO_COEFFICIENTS = np.linalg.inv(legendre.legvander(2 * POINTS - 1, COUNT - 1))
_Q = _integrals(POINTS) @ _TO_COEFFICIENTS


class Unfit(Exception):
    """The step is too long for one polynomial."""


class LayerStep:
    """One step from y_0 over h seconds."""

    def __init__(self, contacts: Contacts, mode: Mode, y_0: State, h: float) -> None:
        self.contacts, self.mode, self.start, self.h = contacts, mode, y_0, h
        self.rates = self._solved(self._guess())

    def _guess(self) -> Array:
        found, now = self.contacts.rates(self.mode, self.start)
        assert now.push
        return np.tile(np.array((*found, now.push.grow, 0.0, 1.0)), (COUNT, 1))

    def _solved(self, rates: Array) -> Array:
        scale, least = 1 + np.abs(self.start), np.inf
        for _ in range(SWEEPS):
            new = self._sweep(rates)
            change = float(np.max(np.abs(self.h * _Q @ (new - rates)) / scale))
            rates = new
            if not np.isfinite(change) or change > 1e3:
                raise Unfit
            if change < 1e-16 or (change < 1e-14 and change >= 0.5 * least):
                break
            least = min(least, change)
        else:
            raise Unfit
        tail = np.abs((_TO_COEFFICIENTS @ rates)[-2:]).sum(axis=0) * self.h / scale
        tail[SPEED] /= 1 + abs(self.start[SPEED])
        if tail.max() > TAIL:
            raise Unfit
        return rates

    def _sweep(self, rates: Array) -> Array:
        """Newton for chi on the states of the last sweep, then all rates with it."""
        mu, contacts, mode = self.contacts.road.mu_slide, self.contacts, self.mode
        states = self.start + self.h * _Q @ rates
        at = [contacts.sliding_at(mode, y) for y in states]
        speed, chi_rate = states[:, SPEED], rates[:, CHI].copy()
        for _ in range(NEWTON):
            chi = self.start[CHI] + self.h * _Q @ chi_rate
            turn = np.array([a.push(mu, c).turn for a, c in zip(at, chi, strict=True)])
            slopes = np.array([a.turning(mu, c) for a, c in zip(at, chi, strict=True)])
            jacobian = slopes[:, None] * self.h * _Q - np.diag(speed)
            step = np.linalg.solve(jacobian, turn - speed * chi_rate)
            chi_rate = chi_rate - step
            if np.abs(self.h * _Q @ step).max() < 1e-15:
                break
        states[:, CHI] = self.start[CHI] + self.h * _Q @ chi_rate
        new = np.empty_like(rates)
        for j, (y, a) in enumerate(zip(states, at, strict=True)):
            found, now = contacts.rates(mode, y, a)
            assert now.push
            new[j] = (*found, now.push.grow, chi_rate[j], 1.0)
        return new

    def dense(self, x: Array) -> Array:
        """States at fractions x of the step, rows."""
        return self.start + self.h * _integrals(x) @ (_TO_COEFFICIENTS @ self.rates)

    def part(self, x: float) -> State:
        """The state at a fraction x: the polynomial is as good inside as at its end."""
        return self.dense(np.array([x]))[0]

    def to(self, t: float) -> State:
        return self.part((t - float(self.start[TIME])) / self.h)

    @property
    def end(self) -> State:
        return self.part(1.0)


def layer_step(contacts: Contacts, mode: Mode, y_0: State, h: float) -> LayerStep:
    """The longest step up to h, by halving, that one polynomial can follow."""
    while True:
        try:
            return LayerStep(contacts, mode, y_0, h)
        except (Unfit, np.linalg.LinAlgError):
            h /= 2
            if h < SMALLEST:
                raise RuntimeError(f"no step from t = {y_0[TIME]!r} s follows the slide") from None


def stiff(contacts: Contacts, mode: Mode, y: State) -> bool:
    """True where the direction has settled and does so much faster than |u| changes, or at |u| = 0."""
    speed, mu = float(y[SPEED]), contacts.road.mu_slide
    if speed == 0:
        return True
    found = contacts.sliding_at(mode, y)
    push, settles = found.push(mu, float(y[CHI])), -found.turning(mu, float(y[CHI]))
    fast = settles > STIFF_RATE * speed and settles > STIFF_RATIO * abs(push.grow)
    return fast and abs(push.turn) < SETTLED * settles
