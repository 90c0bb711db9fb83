"""How far a run can be trusted: by the same motion from another solver of wheel.fmu, at its tightest tolerance.

CVODE's Adams judges; a run by CVODE is judged by DOP853. Slides and stiff layers are the collocation's under every
method, which alone counts Jacobians: there the line says that the engine is the same. The error is the largest
difference of the four headline outputs over the run, relative to each output's range. Transitions and an early end are
compared by their logged instants. Where both runs part, as near an upright start, the instant is given up to which
their first three digits agree.
"""

import re
from ctypes import CFUNCTYPE, c_double, c_int, c_uint, c_void_p, cast
from pathlib import Path
from time import thread_time
from typing import NamedTuple

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.simulation import apply_start_values
from numpy.typing import NDArray

Array = NDArray[np.float64]
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
DEFAULT, TIGHTEST, WARNING = 1e-8, 1e-13, 1  # tolerances; fmi2Warning
REPEATS, LONG = 9, 0.1  # of a run to be timed, and seconds after which none is begun
LEVEL = 1e-9  # of an output's scale: less is no range
ROUNDING = 1e-11  # of the range: errors below are those of rounding and of the tightest tolerance too
DIGITS, PARTED = 1e-3, 1e6  # a difference that spoils three digits; its growth where both runs part
STEP = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_int)  # fmi2DoStep
ADAMS, BDF, RUNGE_KUTTA = "2", "3", "4"  # values of `method`
EVENT = re.compile(r"(.*?)\bt = (\S+) s\b(.*)")
LOCATED = (b"logEvents", b"logStatusDiscard")  # categories whose instants are located; a warning has that of a look
END = "the run ends there"


class Motion(NamedTuple):
    """Rows of the headline outputs at `times`, transitions and the end by instant and words, seconds in fmi2DoStep, the
    last message, who computed it."""

    times: Array
    rows: Array
    events: tuple[tuple[float, str], ...] = ()
    seconds: float = np.nan
    message: str = ""
    solver: str = ""


def judging(start: dict[str, str]) -> dict[str, str]:
    """The same start for the solver that judges it."""
    return start | {"method": RUNGE_KUTTA if start.get("method") in (ADAMS, BDF) else ADAMS}


class Wheel:
    """wheel.fmu, unpacked and loaded once."""

    def __init__(self, fmu: Path, folder: str) -> None:
        extract(str(fmu), folder)
        self.description = read_model_description(folder, validate=False)
        number = {v.name: v.valueReference for v in self.description.modelVariables}
        self.read, self.n_jac = ((c_uint * 4)(*(number[name] for name in HEADLINE)), 4), number["n_jac"]
        of = {"guid": self.description.guid, "modelIdentifier": self.description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=folder, instanceName="wheel", **of)
        self.log: list[tuple[int, str]] = []
        self.jacobians = 0  # of the last motion
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda *of: self.log.append((of[3], of[4].decode())))

    def begin(self, start: dict[str, str], tolerance: float, logging: bool) -> None:
        """A new instance after its initialization."""
        self.log.clear()
        self.fmu.instantiate(callbacks=self.callbacks, loggingOn=logging)
        self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
        apply_start_values(self.fmu, self.description, start)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def end(self) -> None:
        """Of the instance; FMPy's freeInstance would unload the library."""
        self.fmu.fmi2FreeInstance(self.fmu.component)

    def motion(self, start: dict[str, str], times: Array, tolerance: float, repeats: int = 1) -> Motion:
        """A run, read at `times`, and the least time of its repetitions."""
        dll, rows, values, self.jacobians = self.fmu.dll, [], (c_double * 4)(), 0
        try:
            self.begin(start, tolerance, logging=True)
            for t, h in zip(times.tolist(), [*np.diff(times).tolist(), 0.0], strict=True):
                dll.fmi2GetReal(self.fmu.component, *self.read, values)
                rows.append(tuple(values))
                if h and dll.fmi2DoStep(self.fmu.component, t, h, 1) > WARNING:
                    break
            (self.jacobians,) = self.fmu.getInteger([self.n_jac])
        except FMICallException:  # a start that is refused
            pass
        self.end()
        located = [EVENT.match(text) for kind, text in self.log if kind in LOCATED]
        found = [(float(m[2]), re.sub(r" = [-+.\de]+", "", m[1] + m[3])) for m in located if m]
        message, times = "".join(text for _, text in self.log[-1:]), times[: len(rows)]
        seconds = float(-np.diff(self.timed(start, times, tolerance, repeats))[0]) if rows else np.nan
        return Motion(times, np.array(rows), tuple(found), seconds, message)

    def judge(self, start: dict[str, str], times: Array) -> Motion:
        """The motion by which a run is judged."""
        given = judging(start)
        motion = self.motion(given, times, TIGHTEST)
        solver = "CVODE's Adams" if given["method"] == ADAMS else "DOP853"
        shared = "; slides and stiff layers are the same engine's" if self.jacobians else ""
        return motion._replace(solver=f"by {solver}{shared}")

    def timed(self, start: dict[str, str], times: Array, tolerance: float, repeats: int = 1) -> tuple[float, float]:
        """Least processor times of a run's calls of fmi2DoStep, and of as many empty calls, which are Python's."""
        functions = [cast(f, STEP) for f in (self.fmu.dll.fmi2DoStep, self.fmu.dll.fmi2GetVersion)]
        plan = [*zip(times.tolist(), np.diff(times).tolist(), strict=False)]
        costs: list[tuple[float, float]] = []
        while len(costs) < repeats and sum(sum(cost) for cost in costs) < LONG:
            self.begin(start, tolerance, logging=False)
            marks = [thread_time()]
            for function in functions:  # the second ignores what it is given
                for t, h in plan:
                    function(self.fmu.component, t, h, 1)
                marks.append(thread_time())
            self.end()
            costs.append((marks[1] - marks[0], marks[2] - marks[1]))
        return tuple(np.min(costs, axis=0).tolist())


def differences(rows: Array, truth: Array, scales: Array | float = 1.0) -> Array:
    """By instant: the largest difference of a column, over its range; over its scale where it has hardly any range."""
    span = np.ptp(truth, axis=0)
    return (np.abs(rows - truth) / np.where(span > LEVEL * scales, span, scales)).max(axis=1)


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
        return f"{label}: {unstable}{self.short} {self.judge}{located}; computing time {1e3 * self.seconds:.3g} ms."


def trust(run: Motion, truth: Motion, scales: Array | float = 1.0) -> Trust:
    """Of a run, by the one that judges it."""
    few = min(len(run.rows), len(truth.rows))
    apart, lean = differences(run.rows[:few], truth.rows[:few], scales), np.abs(truth.rows[:few, 1] - np.pi / 2)
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
