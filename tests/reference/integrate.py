"""Integration of the rolling wheel through its modes, every transition located.

One mode after another is integrated by SciPy's DOP853, which never crosses a transition: each step
is searched for the first fall of a margin, the instant is refined by steps from the step's own
start, and outputs are reached in the same way, so that nothing rests on the dense output.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import DOP853

from .crossing import NODES, first_fall
from .frames import rotation, slope
from .model import Inputs, Start, Wheel
from .motion import OMEGA_Z, State, derivative, initial_state
from .outputs import Ending, Row, Solution, build
from .switching import CLEAR, ROLL, Mode, Options, Side, Switch

LONGEST = 0.1  # s, of a step
INSTANT = 4e-16  # relative to the time: two units in the last place
CIRCLE, CIRCLE_TIME = 20, 1e-6  # so many transitions within so many seconds are chatter, an error

Rate = Callable[[float, State], State]


class Fall(NamedTuple):
    """A margin's fall in a step: at the fraction x of it, with d(margin)/dx = slope there."""

    x: float
    margin: int
    slope: float
    side: Side


class Run:
    """One solve() in progress: the present (t, y, mode) and what was recorded."""

    switch: Switch
    mode: Mode

    def __init__(self, options: Options, times: Sequence[float], y: State) -> None:
        self.options = options
        self.times = [float(t) for t in times]
        self.t, self.y = self.times[0], y
        self.rows: list[Row] = []
        self.events: list[tuple[float, int]] = []
        self.ended: Ending | None = None
        self.first_step = 1e-4

    def reach(self, rate: Rate, t_1: float) -> State:
        """The state at t_1, by one separate step from the present."""
        h = t_1 - self.t
        if h <= 0:
            return self.y
        solver = self._solver(rate, t_1, h)
        while solver.status == "running":
            solver.step()
        return solver.y

    def _solver(self, rate: Rate, t_1: float, first_step: float) -> DOP853:
        rtol = self.options.rtol
        first = min(first_step, t_1 - self.t, LONGEST)
        return DOP853(rate, self.t, self.y, t_1, LONGEST, rtol, 0.1 * rtol, first_step=first)

    def record(self, rate: Rate, t_1: float) -> None:
        """Rows of every asked time in [present, t_1)."""
        while len(self.rows) < len(self.times) and self.times[len(self.rows)] < t_1:
            t = self.times[len(self.rows)]
            self.rows.append(Row(t, self.reach(rate, t), self.mode))

    def follow(self, stop: float) -> int | None:
        """Integrate the present mode up to `stop`, or to the fall of a margin: its number."""
        rate = derivative(self.switch.contact, self.switch.inputs, self.switch.law(self.mode, self.t))
        from_zero = self.mode.sigma != 0 and self.y[OMEGA_Z] == 0
        solver = self._solver(rate, stop, self.first_step)
        while self.t < stop:
            message = solver.step()
            if solver.status == "failed":
                raise RuntimeError(f"the solver gave up at t = {self.t!r} s: {message}")
            fall = self._search(solver, from_zero)
            h = solver.t - self.t
            t, y = (float(solver.t), solver.y.copy()) if fall is None else self._land(rate, h, fall)
            self.record(rate, t)
            self.first_step = h
            self.t, self.y, from_zero = t, y, False
            if fall is not None:
                return fall.margin
        return None

    def _search(self, solver: DOP853, from_zero: bool) -> Fall | None:
        """The first fall of a margin in the solver's last step."""
        t_nodes = self.t + NODES * (solver.t - self.t)
        states = solver.dense_output()(t_nodes).T
        sides = [slope(rotation(*self.y[:4].tolist())[2])[:2]]
        values = []
        for t, y in zip(t_nodes, states, strict=True):
            margins, side = self.switch.margins(self.mode, sides[-1], t, y)
            values.append(margins)
            sides.append(side)
        falls = []
        for number, column in enumerate(np.array(values).T):
            fall = first_fall(column, from_zero and number == ROLL)
            if fall is not None:
                x, slope_x = fall
                falls.append(Fall(x, number, slope_x, sides[int(np.searchsorted(NODES, x))]))
        return min(falls, default=None)

    def _land(self, rate: Rate, h: float, fall: Fall) -> tuple[float, State]:
        """Newton on the margin with the polynomial's slope; each state by true integration."""
        x, t, y = fall.x, self.t, self.y
        for _ in range(6 if x > 0 else 0):
            t = self.t + x * h
            y = self.reach(rate, t)
            margins, _ = self.switch.margins(self.mode, fall.side, t, y)
            dx = -margins[fall.margin] / fall.slope
            if abs(dx) * h <= INSTANT * abs(t):
                break
            x = min(max(x + dx, 0.0), 1.0)
        return float(t), y.copy()

    def turn(self, margin: int) -> None:
        """Enter the next mode, or end flat, after the fall of a margin at the present."""
        if margin == CLEAR:
            self.ended = Ending("flat", self.t)
            return
        if margin == ROLL and self.mode.sigma != 0:
            self.y[OMEGA_Z] = 0.0
        self.enter(self.switch.after(self.mode, margin, self.t, self.y))

    def enter(self, mode: Mode) -> None:
        """Go on in `mode`, or end where the ground would pull; refuses to chatter."""
        if self.switch.switches and (not self.events or mode.sigma != self.mode.sigma):
            self.events.append((self.t, mode.sigma))
            if len(self.events) > CIRCLE and self.t - self.events[-CIRCLE][0] < CIRCLE_TIME:
                raise RuntimeError(f"no mode of friction holds at t = {self.t!r} s")
        self.mode = mode
        if mode.ground < 0 and not self.options.keep_contact:
            self.ended = Ending("lift-off", self.t)

    def through(self, switch: Switch, stop: float) -> None:
        """Mode after mode up to `stop`; the inputs are smooth there."""
        self.switch = switch
        self.enter(switch.choose(self.t, self.y))
        while self.t < stop and self.ended is None:
            margin = self.follow(stop)
            if margin is not None:
                self.turn(margin)


def solve(wheel: Wheel, start: Start, times: Sequence[float], inputs: Inputs | None = None, **how: Any) -> Solution:
    """The motion from `start` at times[0], reported at `times` (rising); `how`: the fields of Options.

    An ended run has its last row at the ending.
    """
    inputs, options = inputs or Inputs(), Options(**how)
    run = Run(options, times, initial_state(wheel, start))
    t_end = run.times[-1]
    for stop in [*sorted(t for t in inputs.jumps if run.t < t < t_end), t_end]:
        if run.ended is None:
            run.through(Switch(wheel, inputs.before(stop), options), stop)
    run.rows.append(Row(run.t, run.y, run.mode))
    return build(Switch(wheel, inputs, options), run.rows, run.events, run.ended)
