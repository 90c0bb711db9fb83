"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps, on FMPy; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends
"""

import shutil
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from graphlib import TopologicalSorter
from math import ceil
from pathlib import Path
from typing import NamedTuple

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2LastSuccessfulTime
from fmpy.simulation import apply_start_values

from wheelfmu.fmu.progress import bar

# The orders of the derivatives that are exchanged at a communication point, one after the other: values once more in
# the end, because some depend on an input's derivative, such as the moment of a carrier whose rates change.
ORDERS = {"held": (0,), "derivatives": (0, 1, 0), "rollback": (0, 1, 0)}
Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink


@dataclass(eq=False)
class Ended(Exception):  # noqa: N818 - an ending, such as a wheel's lift-off, is no error
    """A component ended the run at `time` [s]; `message`: the FMU's."""

    component: str
    time: float
    message: str


@dataclass
class Component:
    """One FMU: its name in the system, its file, and the start values of its parameters."""

    name: str
    path: Path
    start: dict[str, float] = field(default_factory=dict)
    fmu: FMU2Slave | None = field(default=None, init=False)

    def load(self) -> None:
        """Unpack, instantiate and initialize up to initialization mode."""
        self.folder, self.log = extract(str(self.path)), []
        self.description = read_model_description(self.folder)
        self.number = {v.name: v.valueReference for v in self.description.modelVariables}
        of = {"guid": self.description.guid, "modelIdentifier": self.description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=self.folder, instanceName=self.name, **of)
        callbacks = fmi2CallbackFunctions()  # fmpy's own logger serves one instance per process
        callbacks.logger = fmi2CallbackLoggerTYPE(lambda _e, _n, _s, _c, text: self.log.append(text.decode()))
        self.fmu.instantiate(callbacks=callbacks)
        self.fmu.setupExperiment(startTime=0.0)
        apply_start_values(self.fmu, self.description, self.start)
        self.fmu.enterInitializationMode()

    def ended(self) -> Ended:
        """How it ended the run in a step. FMI 2.0 doubles the characters % and # of a message."""
        message = (self.log[-1] if self.log else "it refused a step").replace("%%", "%").replace("##", "#")
        return Ended(self.name, self.fmu.getRealStatus(fmi2LastSuccessfulTime), message)

    def free(self) -> None:
        """End the run and remove the unpacked files."""
        if self.fmu:
            self.fmu.freeInstance()
            shutil.rmtree(self.folder, ignore_errors=True)

    def feeds(self, output: str) -> list[str]:
        """Inputs on which an output depends directly; undeclared dependencies mean all."""
        declared = {u.variable.name: u.dependencies for u in self.description.outputs}.get(output)
        inputs = [v for v in self.description.modelVariables if v.causality == "input"]
        return [v.name for v in (inputs if declared is None else declared)]


@contextmanager
def loaded(*components: Component) -> Iterator[None]:
    """With the components in initialization mode; they are freed in the end."""
    with ExitStack() as stack:
        for component in components:
            stack.callback(component.free)
            component.load()
        yield


class Transfer(NamedTuple):
    """Variables of one component that are read (outputs) or set (inputs) together, with their places in the arrays of
    all signals."""

    component: Component
    reads: bool
    numbers: list[int]
    at: list[int]

    def __call__(self, order: int, signals: np.ndarray) -> None:
        """The values (order 0), or derivatives of this order."""
        fmu, orders = self.component.fmu, [order] * len(self.at)
        if self.reads and order:
            signals[self.at] = fmu.getRealOutputDerivatives(self.numbers, orders)
        elif self.reads:
            signals[self.at] = fmu.getReal(self.numbers)
        elif order:
            fmu.setRealInputDerivatives(self.numbers, orders, signals[self.at])
        else:
            fmu.setReal(self.numbers, signals[self.at])


class Master:
    """Loaded components and their connections [(source, output), (sink, input)], stepped together."""

    def __init__(self, components: Iterable[Component], connections: Iterable[Connection]) -> None:
        self.components = {c.name: c for c in components}
        self.source_of = {sink: source for source, sink in connections}
        self.transfers: list[Transfer] = []
        place: dict[Signal, int] = {}
        for level in self._levels():
            place |= {source: len(place) + k for k, source in enumerate(level)}
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((True, [(source, source) for source in level]), (False, sinks)):
                for name, component in self.components.items():
                    of = {component.number[end[1]]: place[source] for end, source in ends if end[0] == name}
                    if of:
                        self.transfers.append(Transfer(component, reads, [*of], [*of.values()]))
        self.sets = [transfer for transfer in self.transfers if not transfer.reads]
        self.value, self.rate, self.begin_value, self.begin_rate = np.zeros((4, len(place)))

    def _levels(self) -> Iterator[list[Signal]]:
        """Connected outputs, those together that depend on outputs before them alone; rejects algebraic loops."""
        graph = {}
        for component, output in self.source_of.values():
            inputs = [(component, name) for name in self.components[component].feeds(output)]
            graph[component, output] = {self.source_of[i] for i in inputs if i in self.source_of}
        sorter = TopologicalSorter(graph)
        sorter.prepare()
        while sorter.is_active():
            yield (level := list(sorter.get_ready()))
            sorter.done(*level)

    def steps(self, stop: float, h: float, exchange: str, every: int = 1, progress: bool = False) -> Iterator[float]:
        """Simulates from 0 to `stop`, with a shorter last step where h does not divide it, and waits after the exchange
        at the communication points 0, `every`, ... and `stop`: yields the time, at which variables may be read, and
        inputs set that are not connected. Raises Ended."""
        count = ceil(stop / h - 1e-9)
        self._exchange(ORDERS["held"])
        for component in self.components.values():
            component.fmu.exitInitializationMode()
        for i in bar(range(count + 1), shown=progress, leave=False):
            t, to = (k * h if k < count else stop for k in (i, i + 1))
            self._exchange(ORDERS[exchange])
            if i % every == 0 or i == count:
                yield t
            if i < count and exchange == "rollback":
                self._step_twice(t, to - t, i == 0)
            elif i < count:
                self._step(t, to - t, no_way_back=True)

    def _step(self, t: float, h: float, no_way_back: bool) -> None:
        for component in self.components.values():
            try:
                component.fmu.doStep(t, h, no_way_back)
            except FMICallException:
                raise component.ended() from None

    def _step_twice(self, t: float, h: float, first: bool) -> None:
        """On parabolas with the second derivatives of the last step, and again on the cubics through both ends."""
        second = (self.rate - self.begin_rate) / h
        self.begin_value[:], self.begin_rate[:] = self.value, self.rate
        if not first:
            self._transfer(self.sets, 2, second)
        states = [(component.fmu, component.fmu.getFMUstate()) for component in self.components.values()]
        self._step(t, h, no_way_back=False)
        self._exchange(ORDERS["rollback"])
        for fmu, state in states:
            fmu.setFMUstate(state)
            fmu.freeFMUstate(state)
        mean, begin, end = (self.value - self.begin_value) / h, self.begin_rate, self.rate
        cubic = (self.begin_value, begin, 2 * (3 * mean - 2 * begin - end) / h, 6 * (begin + end - 2 * mean) / (h * h))
        for order, signals in enumerate(cubic):
            self._transfer(self.sets, order, signals)
        self._step(t, h, no_way_back=False)

    def _exchange(self, orders: tuple[int, ...]) -> None:
        for order in orders:
            self._transfer(self.transfers, order, self.rate if order else self.value)

    @staticmethod
    def _transfer(transfers: Iterable[Transfer], order: int, signals: np.ndarray) -> None:
        for transfer in transfers:
            transfer(order, signals)

    def read(self, component: str, names: Iterable[str]) -> list[float]:
        """Values of variables."""
        of = self.components[component]
        return of.fmu.getReal([of.number[name] for name in names])
