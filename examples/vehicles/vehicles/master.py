"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps, on FMPy; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends
"""

from collections.abc import Iterable, Iterator
from ctypes import POINTER, byref, c_double, c_int, c_uint, c_void_p
from graphlib import TopologicalSorter
from itertools import groupby
from math import ceil

import numpy as np
from fmpy.fmi1 import FMICallException
from tqdm import tqdm

from .component import Component

Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink


class Transfer:
    """Variables of one component that are read (outputs) or set (inputs) together: elements of the arrays of all
    signals."""

    def __init__(self, component: Component, reads: bool, variables: list[str], signals: list[int]) -> None:
        n, fmu = len(variables), component.fmu
        self.component, self.reads, self.signals, self.numbers = component, reads, np.array(signals), np.zeros(n)
        self.variables = fmu.component, (c_uint * n)(*component.references(variables)), n
        self.values = self.numbers.ctypes.data_as(POINTER(c_double))
        self.orders = [(c_int * n)(*[order] * n) for order in range(4)]
        self.of_values = fmu.fmi2GetReal if reads else fmu.fmi2SetReal
        self.of_derivatives = fmu.fmi2GetRealOutputDerivatives if reads else fmu.fmi2SetRealInputDerivatives

    def __call__(self, order: int, signals: np.ndarray) -> None:
        """The values (order 0), or derivatives of this order."""
        if not self.reads:
            self.numbers[:] = signals[self.signals]
        if order:
            self.of_derivatives(*self.variables, self.orders[order], self.values)
        else:
            self.of_values(*self.variables, self.values)
        if self.reads:
            signals[self.signals] = self.numbers


class Master:
    """Loaded components and their connections [(source, output), (sink, input)], stepped together."""

    def __init__(self, components: Iterable[Component], connections: Iterable[Connection]) -> None:
        self.components = {c.name: c for c in components}
        self.source_of = {sink: source for source, sink in connections}
        self.transfers, self.number = [], {}
        for level in self._levels():
            self.number |= {source: len(self.number) + k for k, source in enumerate(level)}
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((True, [(source, source) for source in level]), (False, sinks)):
                for name, component in self.components.items():
                    if of := [(variable, self.number[source]) for (owner, variable), source in ends if owner == name]:
                        self.transfers.append(Transfer(component, reads, *map(list, zip(*of, strict=True))))
        self.sets = [transfer for transfer in self.transfers if not transfer.reads]

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
        inputs set that are not connected. Raises component.Ended."""
        self.value, self.rate, self.begin_value, self.begin_rate = np.zeros((4, len(self.number)))
        self.states, count = {name: c_void_p() for name in self.components}, ceil(stop / h - 1e-9)
        self._exchange(0.0, rates=False)
        for component in self.components.values():
            component.asked(component.fmu.exitInitializationMode)
        try:
            for i in tqdm(range(count + 1), disable=not progress, leave=False):
                t, to = (k * h if k < count else stop for k in (i, i + 1))
                self._exchange(t, rates=exchange != "held")
                if i % every == 0 or i == count:
                    yield t
                if i < count and exchange == "rollback":
                    self._step_twice(t, to - t, i == 0)
                elif i < count:
                    self._all(t, "fmi2DoStep", t, to - t, 1)
        finally:
            for name, state in self.states.items():
                self.components[name].fmu.freeFMUState(state)

    def _step_twice(self, t: float, h: float, first: bool) -> None:
        """On parabolas with the second derivatives of the last step, and again on the cubics through both ends."""
        second = (self.rate - self.begin_rate) / h
        self.begin_value[:], self.begin_rate[:] = self.value, self.rate
        if not first:
            self._transfer(t, self.sets, 2, second)
        for name, component in self.components.items():
            component.fmu.fmi2GetFMUstate(component.fmu.component, byref(self.states[name]))
            self._call(t, component, "fmi2DoStep", t, h, 0)
        self._exchange(t, rates=True)
        for name, component in self.components.items():
            self._call(t, component, "fmi2SetFMUstate", self.states[name])
        mean, begin, end = (self.value - self.begin_value) / h, self.begin_rate, self.rate
        cubic = (self.begin_value, begin, 2 * (3 * mean - 2 * begin - end) / h, 6 * (begin + end - 2 * mean) / (h * h))
        for order, signals in enumerate(cubic):
            self._transfer(t, self.sets, order, signals)
        self._all(t, "fmi2DoStep", t, h, 0)

    def _exchange(self, t: float, rates: bool) -> None:
        self._transfer(t, self.transfers, 0, self.value)
        if rates:
            self._transfer(t, self.transfers, 1, self.rate)

    def _transfer(self, t: float, transfers: list[Transfer], order: int, signals: np.ndarray) -> None:
        for transfer in transfers:
            try:
                transfer(order, signals)
            except FMICallException:
                raise transfer.component.ended(t) from None

    def _all(self, t: float, function: str, *arguments: object) -> None:
        for component in self.components.values():
            self._call(t, component, function, *arguments)

    def _call(self, t: float, component: Component, function: str, *arguments: object) -> None:
        """Of an FMU; raises the ending of a component that rejects a call after t."""
        try:
            getattr(component.fmu, function)(component.fmu.component, *arguments)
        except FMICallException:
            raise component.ended(t) from None

    def read(self, signals: Iterable[Signal]) -> list[float]:
        """Their values."""
        found = []
        for component, of in groupby(signals, lambda signal: self.components[signal[0]]):
            found += component.fmu.getReal(component.references([name for _, name in of]))
        return found
