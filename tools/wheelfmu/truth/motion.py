"""Whole motions of the built FMU: start values and inputs in; columns over time, events, ending and counters out."""

import re
import shutil
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from itertools import chain
from pathlib import Path
from time import perf_counter
from typing import Self

import numpy as np
from fmpy import extract, read_model_description

from wheelfmu.fmu.driver import (
    COUNTERS,
    DISCARD,
    LAST_SUCCESSFUL_TIME,
    OK,
    TERMINATED,
    WARNING,
    Array,
    FMU2Wheel,
    Value,
    Values,
)
from wheelfmu.truth.reference import Start, Wheel

from .schedule import INPUTS, Schedule

TRANSITION = re.compile(r"t = (\S+) s: .*(stick|negative|positive)")
MODES = {"stick": 0, "negative": -1, "positive": 1}


def start_values(wheel: Wheel, start: Start) -> dict[str, float]:
    """A wheel and a start of the reference as start values of the FMU."""
    return asdict(wheel) | {f"{name}_start": value for name, value in asdict(start).items()}


@dataclass
class Run:
    """Columns by name (run["X_O"], the time is run["t"]); an ended run has its last row at the ending.

    status: that of the last call; end: the instant at which an ended run stopped, else None; seconds: spent in
    fmi2DoStep; counters: at the end. With `rates`: columns omega_z_dot and so on.
    """

    columns: dict[str, Array]
    messages: list[str]
    status: int
    end: float | None
    seconds: float
    counters: dict[str, int] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    @property
    def t(self) -> Array:
        return self.columns["t"]

    @property
    def events(self) -> list[tuple[float, int]]:
        """Transitions of the friction as the log has them: instant, and sign of omega_z after it (0 held)."""
        found = [TRANSITION.match(message) for message in self.messages]
        return [(float(match[1]), MODES[match[2]]) for match in found if match]

    @property
    def ended(self) -> str | None:
        """The message of the ending."""
        return None if self.end is None else self.messages[-1]


class Library:
    """The unpacked FMU. Its library is loaded once; instances come and go."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = str(folder)
        self.description = read_model_description(self.folder)
        self.loaded = FMU2Wheel(self.folder, self.description)

    @classmethod
    def unpacked(cls, fmu: Path) -> Self:
        """From a .fmu; `remove` deletes the folder."""
        return cls(extract(str(fmu)))

    def remove(self) -> None:
        shutil.rmtree(self.folder)

    def wheel(self, logging: bool = False, name: str = "wheel") -> FMU2Wheel:
        """A new instance in the state "instantiated"."""
        return self.loaded.new(logging, name)

    def simulate(self, times: Iterable[float], tolerance=None, inputs=None, **start: Value) -> Run:
        """The motion from times[0], read at `times` (rising); it may end early, but is not refused."""
        done = run(self, start, times, tolerance, inputs)
        if done.status > WARNING and done.end is None:
            raise RuntimeError(f"status {done.status}: {' '.join(done.messages[-1:])}")
        return done


def feed(wheel: FMU2Wheel, inputs: Schedule, t: float) -> int:
    """The polynomials of the inputs about t, to the third derivative."""
    if not inputs.pieces:
        return OK
    derivatives = inputs.derivatives(t)
    status = wheel.set(**dict(zip(INPUTS, derivatives[0].tolist(), strict=True)))
    if derivatives[1:].any():
        status = max(status, wheel.set_input_derivatives(INPUTS, derivatives[1:]))
    return status


def run(library: Library, values: Values, times: Iterable[float], tolerance=None, inputs=None, rates=()) -> Run:
    """Steps through `times` (the first is the start) and the jumps of the inputs; a row at each of the times.

    At a jump the row is from the right. A run that is refused has no columns.
    """
    inputs, times, end, seconds = inputs or Schedule(), [float(t) for t in times], None, 0.0
    with library.wheel(logging=True) as wheel:
        status = wheel.set(**values)
        status = max(status, wheel.initialise(tolerance, times[0], set_inputs=lambda: feed(wheel, inputs, times[0])))
        if status > WARNING:
            return Run({}, wheel.sentences, status, None, 0.0)
        names = ("t", *wheel.reals, *(f"{name}_dot" for name in rates), *wheel.integers)
        read = wheel.reader(wheel.reals), wheel.rates(rates), lambda: wheel.getInteger(wheel.refer(*wheel.integers))
        rows: list[tuple[float, ...]] = []
        asked = set(times)
        for t in (times[0], *sorted({*times[1:], *(t for t in inputs.jumps if times[0] < t < times[-1])})):
            if rows:
                before = perf_counter()
                status = wheel.step_to(t)
                seconds += perf_counter() - before
                status = status if status > WARNING else max(status, feed(wheel, inputs, t))
            if status == DISCARD and wheel.status(TERMINATED):
                t = end = wheel.status(LAST_SUCCESSFUL_TIME)
            if status <= WARNING and t in asked or end is not None:
                rows.append((t, *chain(*(values() for values in read))))
            if status > WARNING:
                break
        columns = dict(zip(names, np.array(rows, dtype=float).T, strict=True))
        counters = {name: int(columns.pop(name)[-1]) for name in COUNTERS}
        return Run(columns, wheel.sentences, status, end, seconds, counters)
