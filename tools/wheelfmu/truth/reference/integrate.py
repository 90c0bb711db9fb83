"""Integration of the wheel that rolls, slides and grips again through its modes, every transition located.

One mode after another is integrated by SciPy's DOP853, which never crosses a transition: each step is searched for the
first fall of a margin, the instant is refined by steps from the step's own start, and outputs are reached in the same
way, so that nothing rests on the dense output. While the wheel slides, the steps run in a progress sigma in which |u|
falls exponentially to zero; where the direction of slip is stiff, layer.py steps.
"""

from collections.abc import Sequence
from math import atan2, hypot
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import DOP853, solve_ivp

from .crossing import NODES, first_fall
from .frames import rotation, slope
from .layer import Array, LayerStep, layer_step, stiff
from .model import Inputs, Options, Road, Start, Wheel
from .modes import FREE, GRIPS, SLIDES, Contacts, Mode, Side
from .motion import CHI, OMEGA_Z, SPEED, TIME, State, initial_state
from .outputs import Ending, Row, Solution, solution

LONGEST = 0.1  # s, of a step
INSTANT = 4e-16  # relative to the time: two units in the last place
CIRCLE, CIRCLE_TIME = 20, 1e-6  # so many transitions within so many seconds are chatter, an error
NEAR, REST = 0.05, 1e-12  # of sqrt(g (r_0 + r)): the speed at which sigma departs from time; at which u counts as 0
LAYER = 0.02  # s, the first try of a step in the layer
SHARE = (17 / 21) ** 0.5  # of the states while the wheel rolls, in the mean square over all


class Fall(NamedTuple):
    """A margin's fall in a step: at the fraction x of it, with d(margin)/dx = slope there."""

    x: float
    name: str
    slope: float
    side: Side


class ExplicitStep:
    """A step of DOP853 over h in sigma, with true integration to any part of it."""

    def __init__(self, contacts: Contacts, mode: Mode, solver: DOP853, start: State, near: float) -> None:
        self.contacts, self.mode, self.start, self.near = contacts, mode, start, near
        self.end, self.h = solver.y.copy(), solver.t - solver.t_old
        self._polynomial, self._from = solver.dense_output(), solver.t_old

    def dense(self, x: Array) -> Array:
        return self._polynomial(self._from + x * self.h).T

    def part(self, x: float) -> State:
        rate = self.contacts.by_progress(self.mode, self.near)
        return run_through(rate, 0.0, self.start, x * self.h, self.contacts.options.rtol)

    def to(self, t: float) -> State:
        rate = self.contacts.by_time(self.mode)
        return run_through(rate, float(self.start[TIME]), self.start, t, self.contacts.options.rtol)


Step = LayerStep | ExplicitStep


def solver_of(rate: Any, t: float, y: State, bound: float, first: float, rtol: float) -> DOP853:
    rtol *= SHARE
    scale = np.full(len(y), 0.1 * rtol)
    scale[[SPEED, TIME]] = 1e-6 * rtol, np.inf  # |u| counts by its own size, time has no error
    return DOP853(rate, t, y, bound, LONGEST, rtol, scale, first_step=min(first, bound - t, LONGEST))


def run_through(rate: Any, t: float, y: State, bound: float, rtol: float) -> State:
    if bound <= t:
        return y
    solver = solver_of(rate, t, y, bound, bound - t, rtol)
    while solver.status == "running":
        solver.step()
    return solver.y


class Run:
    """One solve() in progress."""

    contacts: Contacts

    def __init__(self, wheel: Wheel, road: Road, options: Options, times: Sequence[float], y: State) -> None:
        self.road, self.options, self.times, self.y = road, options, [float(t) for t in times], y
        self.rows: list[Row] = []
        self.events: list[tuple[float, int]] = []
        self.slides: list[tuple[float, int]] = []
        self.ended: Ending | None = None
        contact = FREE if road.mu_max == 0 else SLIDES if y[SPEED] > 0 else GRIPS
        self.mode = Mode(contact, int(np.sign(y[OMEGA_Z])), 1)  # until the first choice
        self.first_step, self.layer = 1e-4, LAYER
        speed = np.sqrt(wheel.g * (wheel.r_0 + wheel.r))
        self.near, self.rest = NEAR * speed, REST * speed

    @property
    def t(self) -> float:
        return float(self.y[TIME])

    # ---- one mode ----

    def follow(self, stop: float) -> str:
        """Integrate the present mode up to `stop`, or to the fall of a margin: its name."""
        solver: DOP853 | None = None
        rolls_from_zero = self.mode.sigma != 0 and self.y[OMEGA_Z] == 0
        while self.t < stop:
            from_zero = {"rolls"} if rolls_from_zero else set()
            step: Step
            if self._stiff():
                solver, step = None, self._layer_step(stop)
                from_zero |= {"rest"} if self.y[SPEED] == 0 else set()
            else:
                solver = solver or self._solver(stop)
                message = solver.step()
                if solver.status == "failed":
                    raise RuntimeError(f"the solver gave up at t = {self.t!r} s: {message}")
                step = ExplicitStep(self.contacts, self.mode, solver, self.y, self.near)
                self.first_step = step.h
                if solver.status == "finished":
                    step.end[TIME] = stop
            fall = self._search(step, stop, from_zero)
            end = step.end.copy() if fall is None else self._land(step, fall, stop)
            self._record(step, float(end[TIME]))
            self.y, rolls_from_zero = end, False
            if fall is not None:
                return fall.name
        return "stop"

    def _stiff(self) -> bool:
        return self.mode.contact == SLIDES and stiff(self.contacts, self.mode, self.y)

    def _layer_step(self, stop: float) -> LayerStep:
        h = min(2 * self.layer, stop - self.t)
        grow = self.contacts.by_time(self.mode)(self.t, self.y)[SPEED] if self.y[SPEED] > 0 else 0.0
        if grow < 0:
            h = min(h, 1.2 * float(self.y[SPEED]) / -grow)
        step = layer_step(self.contacts, self.mode, self.y, h)
        self.layer = max(step.h, 1e-6)
        return step

    def _solver(self, stop: float) -> DOP853:
        rate = self.contacts.by_progress(self.mode, self.near)
        bound = 1e9 if self.mode.contact == SLIDES else stop - self.t
        return solver_of(rate, 0.0, self.y, bound, self.first_step, self.options.rtol)

    def _margins(self, step: Step, side: Side, y: State, stop: float) -> tuple[dict[str, float], Side]:
        found, side = self.contacts.margins(self.mode, side, y)
        if isinstance(step, LayerStep):
            found["rest"] = float(y[SPEED])
        elif self.mode.contact == SLIDES:
            found |= {"rest": float(y[SPEED]) - self.rest, "stop": stop - float(y[TIME])}
        return found, side

    def _search(self, step: Step, stop: float, from_zero: set[str]) -> Fall | None:
        """The first fall of a margin in the step."""
        sides = [slope(rotation(*self.y[:4].tolist())[2])[:2]]
        values = []
        for y in step.dense(NODES):
            margins, side = self._margins(step, sides[-1], y, stop)
            values.append(margins)
            sides.append(side)
        falls = []
        for name in values[0]:
            fall = first_fall(np.array([row[name] for row in values]), name in from_zero)
            if fall is not None:
                falls.append(Fall(fall[0], name, fall[1], sides[int(np.searchsorted(NODES, fall[0]))]))
        return min(falls, default=None)

    def _land(self, step: Step, fall: Fall, stop: float) -> State:
        """Newton on the margin with the polynomial's slope; each state by true integration."""
        if fall.name == "stop":
            return step.to(stop).copy()
        x, y = fall.x, step.start
        for _ in range(8 if x > 0 else 0):
            y = step.part(x)
            margins, _ = self._margins(step, fall.side, y, stop)
            dx = -margins[fall.name] / fall.slope
            if abs(dx) * step.h <= INSTANT * abs(y[TIME]):
                break
            x = min(max(x + dx, 0.0), 1.0)
        return y.copy()

    def _record(self, step: Step, t_1: float) -> None:
        """Rows of every asked time in [present, t_1)."""
        while len(self.rows) < len(self.times) and self.times[len(self.rows)] < t_1:
            t = self.times[len(self.rows)]
            self.rows.append(Row(t, self.y if t <= self.t else step.to(t), self.mode))

    # ---- from mode to mode ----

    def through(self, contacts: Contacts, stop: float) -> None:
        """Mode after mode up to `stop`; the inputs are smooth there."""
        self.contacts = contacts
        if self.mode.ground > 0:
            self._enter(contacts.choose(self.y))
        while self.t < stop and self.ended is None:
            name = self.follow(stop)
            if name != "stop":
                self._turn(name)

    def _turn(self, name: str) -> None:
        """Enter the next mode, or end, after the fall of a margin at the present."""
        y, contacts = self.y, self.contacts
        if name in ("flat", "room") or (name == "presses" and not self.options.keep_contact):
            self.ended = Ending({"flat": "flat", "room": "jams", "presses": "lift-off"}[name], self.t)
        elif name == "presses":
            self._cross_over()
        elif name == "rest":
            self._come_to_rest()
            self._enter(contacts.choose(y))
        elif name in ("rises", "falls"):
            self._enter(contacts.choose(y, self.mode.ground, sigma=1 if name == "rises" else -1))
        elif name == "rolls":
            y[OMEGA_Z] = 0.0
            self._enter(contacts.choose(y, self.mode.ground))
        else:
            self._enter(contacts.choose(y, gone=self.mode.contact))

    def _come_to_rest(self) -> None:
        """|u| to exactly 0: it falls linearly over what is left of it."""
        y = self.y
        if y[SPEED] > 0:
            rate = self.contacts.by_time(self.mode)(self.t, y)
            left = -float(y[SPEED] / rate[SPEED])
            chi = y[CHI]
            y += left * rate
            y[CHI] = chi
        y[SPEED] = 0.0

    def _cross_over(self) -> None:
        """To the other sign of N: there a road with slip has no friction, and the slip is u_X and u_Y."""
        u, ground = self.contacts.slip(self.mode, self.y), -self.mode.ground
        if ground < 0:
            self.y[SPEED], self.y[CHI] = u
        elif self.road.mu_max > 0:
            self.y[SPEED], self.y[CHI] = hypot(*u), atan2(u[1], u[0])
        self._enter(self.contacts.choose(self.y, ground))

    def _enter(self, found: tuple[Mode, float] | None) -> None:
        """Go on in a mode, or end where there is none; refuses to chatter."""
        if found is None:
            lifts = self.contacts.now(Mode(self.contacts.pulled, self.mode.sigma, 1), self.y).force[2] < 0
            if lifts and self.options.keep_contact and self.mode.ground > 0:
                self._cross_over()
            else:
                self.ended = Ending("lift-off" if lifts else "jams", self.t)
            return
        (mode, chi), slides = found, int(found[0].contact != GRIPS)
        if mode.contact == SLIDES and self.y[SPEED] == 0:
            self.y[CHI], self.layer = chi, LAYER
        if mode.contact == GRIPS:
            self.y[SPEED] = self.y[CHI] = 0.0
        if self.contacts.watched(mode.ground) and (not self.events or mode.sigma != self.events[-1][1]):
            self.events.append((self.t, mode.sigma))
        if not self.slides or slides != self.slides[-1][1] or (mode.contact == SLIDES and self.y[SPEED] == 0):
            self.slides.append((self.t, slides))
        for log in (self.events, self.slides):
            if len(log) > CIRCLE and self.t - log[-CIRCLE][0] < CIRCLE_TIME:
                raise RuntimeError(f"no mode of friction holds at t = {self.t!r} s")
        self.mode = mode


def solve(
    wheel: Wheel,
    start: Start,
    times: Sequence[float],
    inputs: Inputs | None = None,
    road: Road | None = None,
    **how: Any,
) -> Solution:
    """The motion from `start` at times[0], reported at `times` (rising); `how`: the fields of Options.

    An ended run has its last row at the ending.
    """
    inputs, road, options = inputs or Inputs(), road or Road(), Options(**how)
    run = Run(wheel, road, options, times, initial_state(wheel, start, road, times[0]))
    t_end = run.times[-1]
    for stop in [*sorted(t for t in inputs.jumps if run.t < t < t_end), t_end]:
        if run.ended is None:
            run.through(Contacts(wheel, road, inputs.before(stop), options), stop)
    run.rows.append(Row(run.t, run.y, run.mode))
    return solution(Contacts(wheel, road, inputs, options), run.rows, run.events, run.ended, run.slides)


def solve_stiffly(wheel: Wheel, start: Start, times: Sequence[float], omega_s: float) -> Solution:
    """By SciPy's LSODA: a wheel that rolls without inputs under the regularized law of a width however narrow."""
    contacts, mode = Contacts(wheel, Road(), Inputs(), Options(omega_s=omega_s)), Mode(GRIPS, 0, 1)
    state, span = initial_state(wheel, start), (times[0], times[-1])
    found = solve_ivp(contacts.by_time(mode), span, state, "LSODA", times, rtol=1e-11, atol=1e-13)
    rows = [Row(t, y, mode) for t, y in zip(times, found.y.T, strict=True)]
    return solution(contacts, rows, [], None, [])
