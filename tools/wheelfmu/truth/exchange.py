"""The FMU in model exchange: whole motions by a solver of SciPy with the FMU's events.

The solver is not ours and knows nothing of the wheel: it asks for derivatives and event indicators, searches the dense
output of each step for the first sign change, and hands the state at that instant to the event mode of the FMU. SI.
"""

from collections.abc import Callable
from copy import copy

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from wheelfmu.fmu.driver import INDICATORS as INDICATORS
from wheelfmu.fmu.driver import MODEL_EXCHANGE, OK, Array, FMU2Wheel, Value

from .motion import Library

SAMPLES = np.linspace(0, 1, 12)[1:]  # of each step, for the search of an indicator's fall


def loaded(library: Library) -> FMU2Wheel:
    """The library, of which `new` makes instances for model exchange."""
    loaded = copy(library.loaded)
    loaded.kind = MODEL_EXCHANGE
    return loaded


def exchange(library: Library, logging: bool = False, **values: Value) -> FMU2Wheel:
    """A new instance in continuous-time mode at t = 0."""
    wheel = loaded(library).new(logging)
    assert wheel.set(**values) == OK
    assert wheel.initialise() == OK, wheel.sentences
    assert not wheel.decide().terminateSimulation
    assert wheel.enterContinuousTimeMode() == OK
    return wheel


def no_inputs(_t: float) -> dict[str, float]:
    return {}


class Run:
    """One motion: rows of the states and of `also` at the times asked for, instants of all events, and the
    ending; `changed`: which events called the states changed.
    """

    def __init__(self, wheel: FMU2Wheel, rtol: float, inputs: Callable[[float], dict[str, float]]) -> None:
        self.wheel, self.rtol, self.inputs = wheel, rtol, inputs
        self.events: list[float] = []
        self.changed: list[bool] = []
        self.ended: float | None = None
        self.t, self.rhs = 0.0, 0
        self.at(0.0, wheel.x())

    def at(self, t: float, x: Array) -> None:
        values = self.inputs(t)
        if values:
            assert self.wheel.set(**values) == OK
        self.wheel.place(t, x)

    def rate(self, t: float, x: Array) -> Array:
        self.rhs += 1
        self.at(t, x)
        return self.wheel.derivatives()

    def lowest(self, t: float, x: Array) -> float:
        self.at(t, x)
        return float(self.wheel.indicators().min())

    def to(self, stop: float) -> Array:
        """The states at `stop`, or at the end of the model before it."""
        x = self.wheel.x()
        while self.t < stop and self.ended is None:
            scale = self.rtol * np.maximum(1, np.abs(x))
            solver = DOP853(self.rate, self.t, x, stop, rtol=self.rtol, atol=scale, max_step=0.1)
            fall = None
            while solver.status == "running" and fall is None:
                assert solver.step() is None
                fall = self.fall(solver)
            x = solver.y if fall is None else fall[1]
            self.t = solver.t if fall is None else fall[0]
            self.at(self.t, x)
            if fall is not None or self.wheel.wants_event():
                info = self.wheel.event()
                self.events.append(self.t)
                self.changed.append(bool(info.valuesOfContinuousStatesChanged))
                self.ended = self.t if info.terminateSimulation else None
                x = self.wheel.x()
        return x

    def fall(self, solver: DOP853) -> tuple[float, Array] | None:
        """The first instant in the last step at which an indicator falls below zero."""
        dense, t_0, h = solver.dense_output(), solver.t_old, solver.t - solver.t_old
        before = t_0
        for t in t_0 + h * SAMPLES:
            if self.lowest(t, dense(t)) <= 0:
                root = t
                if self.lowest(before, dense(before)) > 0:
                    root = brentq(lambda s: self.lowest(s, dense(s)), before, t, xtol=1e-15, rtol=1e-15)
                return root, dense(root)
            before = t
        return None
