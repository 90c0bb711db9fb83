"""Hours of the paper's wheel: energy, phase, memory and cost per simulated second; releases that grow ever weaker.

Times in s of the model unless said. Memory is the process's own, from /proc/self/statm.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

import numpy as np
from support.driver import COUNTERS, WARNING, FMU2Wheel, Values
from support.motion import Library

HOUR = 3600.0


@dataclass
class LongRun:
    """Per interval: its end, cost in us per simulated second, energy and counters there; worst: largest rise of the
    energy between two readings, largest |omega_z| while held, J and rad/s."""

    name: str
    tolerance: float
    rows: list[list[float]] = field(default_factory=list)
    rise: float = 0.0
    held: float = 0.0
    status: int = 0
    memory: int = 0

    def column(self, i: int) -> np.ndarray:
        return np.array([row[i] for row in self.rows])

    @property
    def cost(self) -> np.ndarray:
        return self.column(1)

    @property
    def energy(self) -> np.ndarray:
        return self.column(2)

    @property
    def events(self) -> np.ndarray:
        return self.column(3 + COUNTERS.index("n_events"))


def resident() -> int:
    """Bytes."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def stretch(wheel: FMU2Wheel, ends: np.ndarray, length: float, result: LongRun) -> Iterator[tuple[float, float]]:
    """(t, wall seconds) of each stretch, reading the friction mode at 10 instants in each."""
    read = wheel.reader(("E", "omega_z"))
    before, slack = read()[0], 1e-13
    for end in ends:
        spent = 0.0
        for t in end - length + length * np.arange(1, 11) / 10:
            clock = perf_counter()
            result.status = max(result.status, wheel.step_to(float(t)))
            spent += perf_counter() - clock
            energy, omega_z = read()
            result.rise = max(result.rise, energy - before - slack * before)
            before = energy
            if wheel.get("friction_mode")[0] == 0:
                result.held = max(result.held, abs(omega_z))
        yield float(end), spent


def long_run(library: Library, name: str, values: Values, duration: float, tolerance: float = 1e-8) -> LongRun:
    result = LongRun(name, tolerance)
    length = duration / 60
    with library.wheel() as wheel:
        wheel.set(**values)
        wheel.initialise(tolerance)
        wheel.step_to(0.0)
        start, read = resident(), wheel.reader(("E",))
        result.rows.append([0.0, np.nan, *read(), *wheel.get(*COUNTERS)])
        for end, spent in stretch(wheel, length * np.arange(1, 61), length, result):
            result.rows.append([end, 1e6 * spent / length, *read(), *wheel.get(*COUNTERS)])
            if result.status > WARNING:
                break
        result.memory = resident() - start
    return result


def study(library: Library, full_day: bool) -> list[LongRun]:
    runs = [
        long_run(library, "free, 1 h", {}, HOUR),
        long_run(library, "friction, 1 h", {"s": 0.03}, HOUR),
        long_run(library, "multibody, 1 h", {"formulation": "multibody"}, HOUR),
    ]
    if full_day:
        runs.append(long_run(library, "free, 24 h", {}, 24 * HOUR))
        runs.append(long_run(library, "friction, 24 h", {"s": 0.03}, 24 * HOUR))
    return runs


def resolved(library: Library, duration: float = HOUR) -> list[tuple[float, float, float]]:
    """(tolerance, transitions, energy at the end in J) of the friction scene: are weak releases resolved?"""
    found = []
    for tolerance in (1e-6, 1e-8, 1e-10, 1e-12):
        with library.wheel() as wheel:
            wheel.set(**{"s": 0.03})
            wheel.initialise(tolerance)
            wheel.step_to(duration)
            found.append((tolerance, int(wheel.get("n_events")[0]), wheel.reader(("E",))()[0]))
    return found
