"""How far a run can be trusted: by the same motion from another solver of wheel.fmu, at its tightest tolerance.

CVODE's Adams judges; a run by CVODE is judged by DOP853. Slides, and rests in the layer of a law, are the
collocation's under every method, which alone counts Jacobians: there the line says that the solver is the same. The
error is the largest difference of the four headline outputs over the run, relative to each output's range.
Transitions and an early end are compared by their logged instants. Where both runs part, as near an upright start,
the instant is given up to which their first three digits agree.
"""

import re
from ctypes import CFUNCTYPE, c_double, c_int, c_void_p, cast
from time import thread_time
from typing import NamedTuple

import numpy as np
from fmpy.simulation import apply_start_values

from wheelfmu.fmu.driver import HEADLINE, WARNING, Array, FMU2Wheel

from .errors import by_instant
from .motion import Library

DEFAULT, TIGHTEST = 1e-8, 1e-13  # tolerances
RESOLVED = 1e-5  # s, of a run: the difference of two measured times has no smaller ones
REPEATS, LONG = 9, 0.1  # of a run to be timed, and seconds after which none is begun
ROUNDING = 1e-11  # of the range: errors below are those of rounding and of the tightest tolerance too
DIGITS, PARTED = 1e-3, 1e6  # a difference that spoils three digits; its growth where both runs part
STEP = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_int)  # fmi2DoStep
ADAMS, BDF, RUNGE_KUTTA = "2", "3", "4"  # values of `method`
EVENT = re.compile(r"(.*?)\bt = (\S+) s\b(.*)")
LOCATED = ("logEvents", "logStatusDiscard")  # categories whose instants are located; a warning has that of a look
END = "the run ends there"


class Motion(NamedTuple):
    """Rows of the headline outputs at `times`, transitions and the end by instant and words, seconds in fmi2DoStep, the
    last message, whether the collocation took part, who computed it."""

    times: Array
    rows: Array
    events: tuple[tuple[float, str], ...] = ()
    seconds: float = np.nan
    message: str = ""
    collocated: bool = False
    solver: str = ""


def judging(start: dict[str, str]) -> dict[str, str]:
    """The same start for the solver that judges it."""
    return start | {"method": RUNGE_KUTTA if start.get("method") in (ADAMS, BDF) else ADAMS}


class Wheel(Library):
    """wheel.fmu, of which runs are started by texts, as FMPy's command line takes them."""

    def begun(self, start: dict[str, str], tolerance: float, logging: bool) -> tuple[FMU2Wheel, int]:
        """A new instance, and the status of its initialization."""
        wheel = self.wheel(logging)
        apply_start_values(wheel, self.description, start)
        return wheel, wheel.initialise(tolerance)

    def motion(self, start: dict[str, str], times: Array, tolerance: float, repeats: int = 1) -> Motion:
        """A run, read at `times`, and the least time of its repetitions; without rows where the start is refused."""
        wheel, status = self.begun(start, tolerance, logging=True)
        rows: list[list[float]] = []
        with wheel:
            read = wheel.reader(HEADLINE)
            for t in times.tolist():
                status = max(status, wheel.step_to(t)) if rows else status
                if status > WARNING:
                    break
                rows.append(read())
            jacobians = wheel.get_one("n_jac")[1]
        located = [EVENT.match(message.text) for message in wheel.messages if message.category in LOCATED]
        found = [(float(m[2]), re.sub(r" = [-+.\de]+", "", m[1] + m[3])) for m in located if m]
        text, times = wheel.messages[-1].text if wheel.messages else "", times[: len(rows)]
        seconds = float(-np.diff(self.timed(start, times, tolerance, repeats))[0]) if rows else np.nan
        return Motion(times, np.array(rows), tuple(found), seconds, text, jacobians > 0)

    def judge(self, start: dict[str, str], times: Array) -> Motion:
        """The motion by which a run is judged."""
        given = judging(start)
        motion = self.motion(given, times, TIGHTEST)
        solver = "CVODE's Adams" if given["method"] == ADAMS else "DOP853"
        shared = "; slides and rests in a boundary layer are solved by the same solver" if motion.collocated else ""
        return motion._replace(solver=f"estimated with {solver}{shared}")

    def timed(self, start: dict[str, str], times: Array, tolerance: float, repeats: int = 1) -> tuple[float, float]:
        """Least processor times of a run's calls of fmi2DoStep, and of as many empty calls, which are Python's."""
        functions = [cast(f, STEP) for f in (self.loaded.dll.fmi2DoStep, self.loaded.dll.fmi2GetVersion)]
        plan = [*zip(times.tolist(), np.diff(times).tolist(), strict=False)]
        costs: list[tuple[float, float]] = []
        while len(costs) < repeats and sum(sum(cost) for cost in costs) < LONG:
            wheel, _ = self.begun(start, tolerance, logging=False)
            marks = [thread_time()]
            for function in functions:  # the second ignores what it is given
                for t, h in plan:
                    function(wheel.component, t, h, 1)
                marks.append(thread_time())
            wheel.close()
            costs.append((marks[1] - marks[0], marks[2] - marks[1]))
        return tuple(np.min(costs, axis=0).tolist())


class Trust(NamedTuple):
    """What the comparison of a run with the one that judges it gives."""

    error: float
    shift: float | None  # s, of transitions and end; None where not all are there in both
    counts: tuple[int, int]  # transitions, there and in the run that judges
    ends: bool  # early
    seconds: float
    until: float | None  # s, up to where three digits hold in a motion whose runs part
    judge: str

    @property
    def short(self) -> str:
        """For a caption."""
        if self.until is not None:
            return f"three digits hold up to {self.until:.3g} s"
        return f"error {self.error:.1e} of the range" if self.error > ROUNDING else "error below 1e-11 of the range"

    def said(self, label: str) -> str:
        """One line for the user."""
        (count, other), located = self.counts, ""
        if self.shift is None:
            located = f"; {count} transitions, {other} by the other solver"
        elif count or self.ends:
            found = [f"{count} transition{'s' * (count > 1)}"] * (count > 0) + ["the end"] * self.ends
            shifted = f"shifted by up to {self.shift:.1e} s" if self.shift else "not shifted"
            located = f"; {' and '.join(found)}, {shifted}"
        unstable = "unstable or chaotic: " * (self.until is not None)
        time = f"{1e3 * self.seconds:.3g}" if not self.seconds < RESOLVED else f"below {1e3 * RESOLVED:g}"
        return f"{label}: {unstable}{self.short}, {self.judge}{located}; computing time {time} ms."


def trust(run: Motion, truth: Motion, scales: Array | float = 1.0) -> Trust:
    """Of a run, by the one that judges it."""
    few = min(len(run.rows), len(truth.rows))
    apart, lean = by_instant(run.rows[:few], truth.rows[:few], scales), np.abs(truth.rows[:few, 1] - np.pi / 2)
    grows = apart.max() > PARTED * max(apart[: max(2, few // 10)].max(), 1e-16)
    tips = lean[0] < 1e-12  # exactly upright: by rounding
    parts = (apart > DIGITS) & grows | (lean > DIGITS) & tips
    kinds = [[words for _, words in motion.events] for motion in (run, truth)]
    shifts = (abs(a - b) for (a, _), (b, _) in zip(run.events, truth.events, strict=False))
    shift = max(shifts, default=0.0) if kinds[0] == kinds[1] else None
    until = float(run.times[np.argmax(parts)]) if parts.any() else None
    ends = [any(END in words for words in kind) for kind in kinds]
    counts = len(kinds[0]) - ends[0], len(kinds[1]) - ends[1]
    return Trust(float(apart.max()), shift, counts, ends[0], run.seconds, until, truth.solver)
