"""What inputs cost and how exact they are: the paper's free wheel pushed by sines, 10 s in steps of 1 ms.

Error: largest difference over time and headline outputs from tests/reference with the continuous input, each relative
to the output's range. Time: mean of fmi2DoStep alone, less an empty call through the same bridge.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable
from ctypes import c_double, c_int, c_uint
from dataclasses import dataclass
from math import pi, sin
from pathlib import Path
from time import perf_counter_ns

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from reference import Inputs, Start, Wheel, solve

STEP, STOP, EVERY = 0.001, 10.0, 100  # s, s, steps between compared instants
REPEATS = 3  # runs of each case; the quickest counts
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
COUNTERS = ("n_steps", "n_rhs", "n_restarts")
NAMES = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")
AMPLITUDE = (3.0, 2.0, -5.0, 0.3, 0.2, 0.5)  # N and N.m
RATE = (2.0, 3.0, 1.0, 1.0, 2.0, 3.0)  # rad/s
PHASE = (0.0, pi / 2, 0.0, pi / 2, 0.0, 0.0)
CONSTANT = tuple(a * sin(p + 1) for a, p in zip(AMPLITUDE, PHASE, strict=True))


def sines(t: float, order: int = 0) -> tuple[float, ...]:
    """The six inputs, or their derivatives of this order."""
    return tuple(a * w**order * sin(w * t + p + order * pi / 2) for a, w, p in zip(AMPLITUDE, RATE, PHASE, strict=True))


@dataclass(frozen=True)
class Case:
    """How the inputs are given: values(t) set at every `again`-th step, derivatives up to `orders`."""

    label: str
    values: Callable[[float], tuple[float, ...]] | None
    again: bool = True
    orders: int = 0
    truth: str = "sines"
    derivatives: Callable[[float, int], tuple[float, ...]] = sines


CASES = (
    Case("never set", None, truth="none"),
    Case("constant, set once", lambda _t: CONSTANT, again=False, truth="constant"),
    Case("constant, set again at every step", lambda _t: CONSTANT, truth="constant"),
    Case("sines, held over the step", sines),
    Case("sines, held at their value in mid-step", lambda t: sines(t + STEP / 2)),
    Case("sines, first derivative given", sines, orders=1),
    Case("sines, derivatives up to order 2", sines, orders=2),
    Case("sines, derivatives up to order 3", sines, orders=3),
)


@dataclass(frozen=True)
class Outcome:
    """One case, measured."""

    label: str
    table: np.ndarray  # headline outputs every EVERY steps
    steps: int
    rhs: int
    restarts: int
    microseconds: float  # per doStep
    error: float = 0.0


class Bench:
    """One FMU driven through the bare C functions."""

    def __init__(self, fmu: Path) -> None:
        self.folder = extract(str(fmu))
        description = read_model_description(self.folder)
        self.variable = {v.name: v.valueReference for v in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="wheel",
        )
        self.slave.instantiate()
        self.inputs = (c_uint * 6)(*(self.variable[n] for n in NAMES))

    def close(self) -> None:
        """Free all."""
        self.slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def set_inputs(self, case: Case, t: float) -> None:
        """Values, and derivatives if the case has them."""
        dll, c = self.slave.dll, self.slave.component
        dll.fmi2SetReal(c, self.inputs, 6, (c_double * 6)(*case.values(t)))
        for order in range(1, case.orders + 1):
            orders = (c_int * 6)(*[order] * 6)
            dll.fmi2SetRealInputDerivatives(c, self.inputs, 6, orders, (c_double * 6)(*case.derivatives(t, order)))

    def run(self, case: Case, stop: float = STOP) -> Outcome:
        """One simulation from the paper's start."""
        slave, dll, c = self.slave, self.slave.dll, self.slave.component
        slave.reset()
        slave.setupExperiment(startTime=0.0)
        slave.enterInitializationMode()
        if case.values:
            self.set_inputs(case, 0.0)
        slave.exitInitializationMode()
        outputs = [self.variable[n] for n in HEADLINE]
        rows, durations, count = [slave.getReal(outputs)], [], round(stop / STEP)
        for i in range(count):
            if case.values and case.again:
                self.set_inputs(case, i * STEP)
            begin = perf_counter_ns()
            status = dll.fmi2DoStep(c, i * STEP, STEP, 1)
            durations.append(perf_counter_ns() - begin)
            if status:
                raise RuntimeError(f"fmi2DoStep gave status {status} at t = {i * STEP} s")
            if (i + 1) % EVERY == 0:
                rows.append(slave.getReal(outputs))
        counters = slave.getInteger([self.variable[n] for n in COUNTERS])
        slave.terminate()
        cost = (np.mean(durations) - self.bridge_cost()) / 1000
        return Outcome(case.label, np.array(rows), *counters, float(cost))

    def bridge_cost(self) -> float:
        """Nanoseconds of a call that does nothing (reading no variable): the best mean of some batches."""
        dll, c, nothing = self.slave.dll, self.slave.component, (c_double * 1)()
        means = []
        for _ in range(10):
            spent = 0
            for _ in range(500):
                begin = perf_counter_ns()
                dll.fmi2GetReal(c, self.inputs, 0, nothing)
                spent += perf_counter_ns() - begin
            means.append(spent / 500)
        return min(means)


def truths(stop: float = STOP) -> dict[str, np.ndarray]:
    """The reference solutions with continuous inputs, headline outputs by kind of input."""
    times = np.arange(round(stop / STEP / EVERY) + 1) * (STEP * EVERY)
    kinds = {
        "none": Inputs(),
        "constant": Inputs(lambda _t: CONSTANT[:3], lambda _t: CONSTANT[3:]),
        "sines": Inputs(lambda t: sines(t)[:3], lambda t: sines(t)[3:]),
    }
    found = {}
    for kind, inputs in kinds.items():
        solution = solve(Wheel(), Start(), times, inputs)
        found[kind] = np.column_stack([solution[name] for name in HEADLINE])
    return found


def measure(fmu: Path, stop: float = STOP, cases: tuple[Case, ...] = CASES, repeats: int = REPEATS) -> list[Outcome]:
    """All cases, with their errors."""
    known, bench, outcomes = truths(stop), Bench(fmu), []
    try:
        for case in cases:
            runs, truth = [bench.run(case, stop) for _ in range(repeats)], known[case.truth]
            found = min(runs, key=lambda run: run.microseconds)
            error = float((np.abs(found.table - truth).max(axis=0) / np.ptp(truth, axis=0)).max())
            outcomes.append(Outcome(**{**vars(found), "error": error}))
    finally:
        bench.close()
    return outcomes
