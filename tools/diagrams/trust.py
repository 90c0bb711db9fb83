"""How far a run can be trusted: the same motion again at the tightest tolerance, by wheel.fmu itself.

The error is the largest difference of the four headline outputs over the run, relative to each output's range. Events
are compared by their logged instants. Where both runs part, as near an upright start, the instant is given up to which
their first three digits agree.

    python -m diagrams.trust FOLDER [argument of ./scripts/run]...

writes FOLDER/SCENE.error for both scenes: the line for the user, then the words for the captions. With error=methods it
also writes the table and the picture error_time of all methods and tolerances.
"""

import re
import sys
from ctypes import CFUNCTYPE, c_double, c_int, c_uint, c_void_p, cast
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from diagrams.start_values import CHECKS, PAPER_S, ROOT, RUN, values, variables

Array = NDArray[np.float64]
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
DEFAULT, TIGHTEST, WARNING = 1e-8, 1e-13, 1  # tolerances; fmi2Warning
REPEATS, LONG = 5, 0.1  # of a run to be timed, and seconds after which none is begun
LEVEL = 1e-9  # of an output's scale: less is no range
ROUNDING = 1e-11  # of the range: errors below are those of rounding and of the tightest tolerance too
DIGITS = 1e-3  # of the range, a difference up to which three digits agree
PARTED = 1e6  # growth of the difference over its largest in the first tenth, at which both runs part
STEP = CFUNCTYPE(c_int, c_void_p, c_double, c_double, c_int)  # fmi2DoStep
EVENT = re.compile(r"(.*?)\bt = (\S+) s\b(.*)")


@dataclass
class Motion:
    """Rows of the headline outputs at `times`; events by instant and words; an ending; seconds in fmi2DoStep."""

    times: Array
    rows: Array
    events: list[tuple[float, str]] = field(default_factory=list)
    seconds: float = np.nan
    trouble: str = ""


class Wheel:
    """wheel.fmu, unpacked and loaded once."""

    def __init__(self, fmu: Path, folder: str) -> None:
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

        extract(str(fmu), folder)
        self.description = read_model_description(folder, validate=False)
        self.number = {v.name: v.valueReference for v in self.description.modelVariables}
        of = {"guid": self.description.guid, "modelIdentifier": self.description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=folder, instanceName="wheel", **of)
        self.log: list[str] = []
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda _e, _n, _s, _c, text: self.log.append(text.decode()))

    def begin(self, start: dict[str, str], tolerance: float, logging: bool) -> None:
        """A new instance after its initialization."""
        from fmpy.simulation import apply_start_values

        self.log.clear()
        self.fmu.instantiate(callbacks=self.callbacks, loggingOn=logging)
        self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
        apply_start_values(self.fmu, self.description, dict(start))
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def motion(self, start: dict[str, str], times: Array, tolerance: float, repeats: int = 1) -> Motion:
        """A run, read at `times`, and the least time of its repetitions."""
        from fmpy.fmi1 import FMICallException

        dll, rows = self.fmu.dll, []
        references, values = (c_uint * 4)(*(self.number[name] for name in HEADLINE)), (c_double * 4)()
        try:
            self.begin(start, tolerance, logging=True)
            dll.fmi2GetReal(self.fmu.component, references, 4, values)
            for t, h in [*zip(times.tolist(), np.diff(times).tolist(), strict=False), (0.0, 0.0)]:
                rows.append(tuple(values))
                if h == 0.0 or dll.fmi2DoStep(self.fmu.component, t, h, 1) > WARNING:
                    break
                dll.fmi2GetReal(self.fmu.component, references, 4, values)
        except FMICallException:
            pass
        matches = filter(None, map(EVENT.match, self.log))
        events = [(float(m[2]), re.sub(r" = [-+.\de]+", "", m[1] + m[3])) for m in matches]
        trouble = self.log[-1] if self.log and len(rows) < len(times) else ""
        self.fmu.fmi2FreeInstance(self.fmu.component)  # freeInstance would unload the library
        found = Motion(times[: len(rows)], np.array(rows), events, trouble=trouble)
        if rows:
            found.seconds = self.timed(start, found.times, tolerance, repeats)
        return found

    def timed(self, start: dict[str, str], times: Array, tolerance: float, repeats: int) -> float:
        """Least time of a run's calls of fmi2DoStep, less that of as many empty calls, which is Python's."""
        plan = [*zip(times.tolist(), np.diff(times).tolist(), strict=False)]
        functions = [STEP(cast(f, c_void_p).value) for f in (self.fmu.dll.fmi2DoStep, self.fmu.dll.fmi2GetVersion)]
        best, first = [np.inf, np.inf], perf_counter()
        while repeats > 0 and perf_counter() - first < LONG:
            repeats -= 1
            self.begin(start, tolerance, logging=False)
            for k, function in enumerate(functions):  # the second ignores what it is given
                begin = perf_counter()
                for t, h in plan:
                    function(self.fmu.component, t, h, 1)
                best[k] = min(best[k], perf_counter() - begin)
            self.fmu.fmi2FreeInstance(self.fmu.component)
        return max(best[0] - best[1], 0.0)


def differences(rows: Array, truth: Array, scales: Array) -> Array:
    """By instant: the largest difference of a column, over its range; over its scale where it has hardly any range."""
    span = np.ptp(truth, axis=0)
    return (np.abs(rows - truth) / np.where(span > LEVEL * scales, span, scales)).max(axis=1)


def scales_of(given: dict[str, str]) -> Array:
    """Of the headline outputs, by the wheel's size: its radius, 1 rad, and the rate of a fall."""
    known = variables("parameter")
    r_0, r, g = (float(given.get(name, known[name].start)) for name in ("r_0", "r", "g"))
    return np.array([r_0 + r, 1.0, np.sqrt(g / (r_0 + r)), np.sqrt(g / (r_0 + r))])


@dataclass
class Trust:
    """What the comparison of a run with the one at the tightest tolerance says."""

    error: float
    shift: float | None  # s, of the events' instants; None where not all are there in both
    counts: tuple[int, int]
    seconds: float
    until: float | None  # s, up to where three digits hold in a motion whose runs part

    @property
    def short(self) -> str:
        """For a caption."""
        if self.until is not None:
            return f"three digits hold up to {self.until:.3g} s"
        return f"error {self.error:.1e} of the range" if self.error > ROUNDING else "error below 1e-11 of the range"

    def said(self, label: str) -> str:
        """One line for the user."""
        first = f"unstable or chaotic: {self.short}" if self.until is not None else self.short
        ours, theirs = self.counts
        if self.shift is None:
            first += f"; {ours} events, {theirs} at the tightest tolerance"
        elif ours:
            first += f"; {ours} event{'s' * (ours != 1)}, shifted by up to {self.shift:.1e} s"
        return f"{label}: {first}; computing time {1e3 * self.seconds:.3g} ms."


def trust(run: Motion, truth: Motion, scales: Array) -> Trust:
    """Of a run, by the same at the tightest tolerance."""
    rows = min(len(run.rows), len(truth.rows))
    apart, lean = differences(run.rows[:rows], truth.rows[:rows], scales), np.abs(truth.rows[:rows, 1] - np.pi / 2)
    kinds = [[words for _, words in motion.events] for motion in (run, truth)]
    alike = kinds[0] == kinds[1]
    shift = max((abs(a[0] - b[0]) for a, b in zip(run.events, truth.events, strict=False)), default=0.0)
    parts = apart > DIGITS if apart.max() > PARTED * max(apart[: max(2, rows // 10)].max(), 1e-16) else apart > np.inf
    if lean[0] < 1e-12:  # exactly upright: what tips it is rounding
        parts |= lean > DIGITS
    until = float(run.times[np.argmax(parts)]) if parts.any() else None
    return Trust(float(apart.max()), shift if alike else None, (len(kinds[0]), len(kinds[1])), run.seconds, until)


@dataclass(frozen=True)
class Race:
    """A scene, to be run by any method at any tolerance."""

    wheel: Wheel
    start: dict[str, str]
    truth: Motion
    plan: Array
    scales: Array

    def run(self, method: dict[str, str], tolerance: float) -> dict[str, Any]:
        """The error, or why there is none."""
        found = self.wheel.motion(self.start | method, self.plan, tolerance)
        rows = len(self.truth.rows)
        if abs(len(found.rows) - rows) > 1:
            return {"error": np.nan, "note": found.trouble or f"ends after {found.times[-1]:.3g} s"}
        few = min(rows, len(found.rows))
        return {"error": float(differences(found.rows[:few], self.truth.rows[:few], self.scales).max()), "note": ""}

    def seconds(self, method: dict[str, str], tolerance: float) -> float:
        return self.wheel.timed(self.start | method, self.truth.times, tolerance, 1)


def main(folder: str, *arguments: str) -> None:
    """Both scenes of ./scripts/run."""
    given = values(list(arguments))
    asked = given.pop("error", CHECKS["estimate"])
    if asked == CHECKS["no"]:
        return
    stop, interval = (float(given.pop(name, v.start)) for name, v in RUN.items())
    times, found = np.append(np.arange(0, stop * (1 - 1e-9), interval), stop), {}
    scenes = {"free": ("No friction", "0"), "friction": ("With friction", given.get("s", str(PAPER_S)))}
    with TemporaryDirectory() as unpacked:
        wheel, scales = Wheel(ROOT / "wheel.fmu", unpacked), scales_of(given)
        for name, (label, s) in scenes.items():
            truth = wheel.motion(given | {"s": s}, times, TIGHTEST)
            if len(truth.rows) > 1:
                one = trust(wheel.motion(given | {"s": s}, times, DEFAULT, REPEATS), truth, scales)
                (Path(folder) / f"{name}.error").write_text(f"{one.said(label)}\n{one.short}\n", encoding="utf-8")
                found[label] = Race(wheel, given | {"s": s}, truth, times, scales)
        if asked == CHECKS["methods"] and found:
            from diagrams import races

            races.write(found, Path(folder))


if __name__ == "__main__":
    main(*sys.argv[1:])
