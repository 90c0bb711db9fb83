"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps, on FMPy; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends
"""

import shutil
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from ctypes import POINTER, byref, c_double
from dataclasses import dataclass, field
from graphlib import TopologicalSorter
from itertools import groupby
from math import ceil
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2FMUstate,
    fmi2Integer,
    fmi2LastSuccessfulTime,
    fmi2Real,
    fmi2ValueReference,
)
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
        """Unpack, instantiate and initialize up to initialization mode; a ValueError has the FMU's message."""
        self.folder, self.log = extract(str(self.path)), []
        self.description = read_model_description(self.folder)
        self.variable = {v.name: v for v in self.description.modelVariables}
        self.references(self.start)  # a name that does not exist
        of = {"guid": self.description.guid, "modelIdentifier": self.description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=self.folder, instanceName=self.name, **of)
        callbacks = fmi2CallbackFunctions()  # fmpy's own logger serves one instance per process
        callbacks.logger = fmi2CallbackLoggerTYPE(lambda _e, _n, _s, _c, text: self.log.append(text.decode()))
        self.fmu.instantiate(callbacks=callbacks)
        self.fmu.setupExperiment(startTime=0.0)
        self.asked(apply_start_values, self.fmu, self.description, self.start)
        self.asked(self.fmu.enterInitializationMode)

    def asked(self, function: Callable, *arguments: object) -> None:
        """Calls a function of the FMU; where it refuses, a ValueError with its last message."""
        try:
            function(*arguments)
        except FMICallException as refusal:
            raise ValueError(f"{self.name}: {self.last_message(str(refusal))}") from refusal

    def ended(self, t: float) -> Ended:
        """How it ended the run in a step from t on."""
        message, last = self.last_message("it refused a call"), c_double(t)
        self.fmu.dll.fmi2GetRealStatus(self.fmu.component, fmi2LastSuccessfulTime, byref(last))
        return Ended(self.name, last.value, message)

    def last_message(self, otherwise: str) -> str:
        """FMI 2.0 doubles the characters % and # of a message."""
        return self.log[-1].replace("%%", "%").replace("##", "#") if self.log else otherwise

    def free(self) -> None:
        """End the run and remove the unpacked files."""
        if self.fmu:
            self.fmu.freeInstance()
            shutil.rmtree(self.folder, ignore_errors=True)

    def references(self, names: Iterable[str]) -> list[int]:
        """Value references of variables."""
        if unknown := [name for name in names if name not in self.variable]:
            raise ValueError(f"{self.name} has no variable {unknown[0]}.")
        return [self.variable[name].valueReference for name in names]

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


class Transfer:
    """Variables of one component that are read (outputs) or set (inputs) together, with their places in the arrays of
    all signals. The buffers are built once: a step of the car makes a hundred such calls."""

    def __init__(self, component: Component, reads: bool, references: list[int], at: list[int]) -> None:
        size = len(at)
        self.component, self.reads, self.at, self.values = component, reads, np.array(at), np.zeros(size)
        self.head = component.fmu.component, (fmi2ValueReference * size)(*references), size
        self.orders = [(fmi2Integer * size)(*[order] * size) for order in range(4)]
        self.place = self.values.ctypes.data_as(POINTER(fmi2Real))

    def __call__(self, order: int, signals: np.ndarray) -> None:
        fmu, more = self.component.fmu, (self.orders[order], self.place) if order else (self.place,)
        if self.reads:
            (fmu.fmi2GetRealOutputDerivatives if order else fmu.fmi2GetReal)(*self.head, *more)
            signals[self.at] = self.values
        else:
            self.values[:] = signals[self.at]
            (fmu.fmi2SetRealInputDerivatives if order else fmu.fmi2SetReal)(*self.head, *more)


class Master:
    """Loaded components and their connections [(source, output), (sink, input)], stepped together."""

    def __init__(self, components: Iterable[Component], connections: Iterable[Connection]) -> None:
        self.components = {c.name: c for c in components}
        self.source_of = {sink: source for source, sink in connections}
        self.transfers: list[Transfer] = []
        number: dict[Signal, int] = {}
        for level in self._levels():
            number |= {source: len(number) + k for k, source in enumerate(level)}
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((True, [(source, source) for source in level]), (False, sinks)):
                for name, component in self.components.items():
                    if of := {variable: number[source] for (owner, variable), source in ends if owner == name}:
                        self.transfers.append(Transfer(component, reads, component.references(of), [*of.values()]))
        self.sets = [transfer for transfer in self.transfers if not transfer.reads]
        self.value, self.rate, self.begin_value, self.begin_rate = np.zeros((4, len(number)))

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
        self.states, count = {name: fmi2FMUstate() for name in self.components}, ceil(stop / h - 1e-9)
        self._exchange(0.0, ORDERS["held"])
        for component in self.components.values():
            component.asked(component.fmu.exitInitializationMode)
        try:
            for i in bar(range(count + 1), shown=progress, leave=False):
                t, to = (k * h if k < count else stop for k in (i, i + 1))
                self._exchange(t, ORDERS[exchange])
                if i % every == 0 or i == count:
                    yield t
                if i < count and exchange == "rollback":
                    self._step_twice(t, to - t, i == 0)
                elif i < count:
                    self._step(t, to - t, no_way_back=True)
        finally:
            for name, state in self.states.items():
                self.components[name].fmu.freeFMUState(state)

    def _step(self, t: float, h: float, no_way_back: bool) -> None:
        for component in self.components.values():
            try:
                component.fmu.doStep(t, h, no_way_back)
            except FMICallException:
                raise component.ended(t) from None

    def _step_twice(self, t: float, h: float, first: bool) -> None:
        """On parabolas with the second derivatives of the last step, and again on the cubics through both ends."""
        second = (self.rate - self.begin_rate) / h
        self.begin_value[:], self.begin_rate[:] = self.value, self.rate
        if not first:
            self._transfer(t, self.sets, 2, second)
        for name, component in self.components.items():
            component.fmu.fmi2GetFMUstate(component.fmu.component, byref(self.states[name]))
        self._step(t, h, no_way_back=False)
        self._exchange(t, ORDERS["rollback"])
        for name, component in self.components.items():
            component.fmu.setFMUState(self.states[name])
        mean, begin, end = (self.value - self.begin_value) / h, self.begin_rate, self.rate
        cubic = (self.begin_value, begin, 2 * (3 * mean - 2 * begin - end) / h, 6 * (begin + end - 2 * mean) / (h * h))
        for order, signals in enumerate(cubic):
            self._transfer(t, self.sets, order, signals)
        self._step(t, h, no_way_back=False)

    def _exchange(self, t: float, orders: tuple[int, ...]) -> None:
        for order in orders:
            self._transfer(t, self.transfers, order, self.rate if order else self.value)

    def _transfer(self, t: float, transfers: Iterable[Transfer], order: int, signals: np.ndarray) -> None:
        """The values (order 0), or derivatives of this order."""
        for transfer in transfers:
            try:
                transfer(order, signals)
            except FMICallException:
                raise transfer.component.ended(t) from None

    def read(self, signals: Iterable[Signal]) -> list[float]:
        """Their values."""
        found = []
        for component, of in groupby(signals, lambda signal: self.components[signal[0]]):
            found += component.fmu.getReal(component.references([name for _, name in of]))
        return found
