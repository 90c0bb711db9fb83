"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends

Loading, order and initialization are here; the loop over the steps between two waits is in C (../master).
"""

import re
from collections.abc import Iterable, Iterator
from ctypes import c_void_p, cast
from graphlib import TopologicalSorter
from itertools import chain, groupby
from pathlib import Path

import numpy as np
from cffi import FFI
from fmpy import sharedLibraryExtension
from tqdm import tqdm

from .component import Component
from .options import EXCHANGES

Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink
HEADER = (Path(__file__).resolve().parents[1] / "master" / "master.h").read_text()
ffi = FFI()
ffi.cdef("typedef void *fmi2Component, *fmi2FMUstate; typedef unsigned fmi2ValueReference;")
ffi.cdef("".join(f"typedef void {function};" for function in re.findall(r"fmi2\w+TYPE", HEADER)))
ffi.cdef("\n".join(line for line in HEADER.splitlines() if not line.startswith("#")))


class Master:
    """Loaded components and their connections [(source, output), (sink, input)], stepped together by the loop in C,
    which is beside one of the FMUs."""

    def __init__(self, components: Iterable[Component], connections: Iterable[Connection]) -> None:
        self.components = {c.name: c for c in components}
        self.source_of = {sink: source for source, sink in connections}
        self.levels = self._order()
        self.owned = []
        libraries = (c.path.with_name(f"master{sharedLibraryExtension}") for c in self.components.values())
        self.c = ffi.dlopen(str(next(path for path in libraries if path.exists())))

    def _order(self) -> list[list[Signal]]:
        """Connected outputs, those together that depend on outputs before them alone; refuses algebraic loops."""
        graph = {}
        for component, output in self.source_of.values():
            inputs = [(component, name) for name in self.components[component].feeds(output)]
            graph[component, output] = {self.source_of[i] for i in inputs if i in self.source_of}
        sorter, levels = TopologicalSorter(graph), []
        sorter.prepare()
        while sorter.is_active():
            levels.append(list(sorter.get_ready()))
            sorter.done(*levels[-1])
        return levels

    def _own(self, kind: str, values: object) -> object:
        """Memory of the loop, as long as this master."""
        self.owned.append(ffi.new(kind, values))
        return self.owned[-1]

    def _prepare(self, exchange: str) -> object:
        """The loop's tables of components, transfers and signals."""
        number = {signal: k for k, signal in enumerate(chain(*self.levels))}
        transfers = []
        for level in self.levels:
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((1, [(source, source) for source in level]), (0, sinks)):
                for place, (name, component) in enumerate(self.components.items()):
                    of = [(variable, number[source]) for (owner, variable), source in ends if owner == name]
                    variables = self._own("unsigned[]", component.references([v for v, _ in of]))
                    signals = self._own("int[]", [k for _, k in of])
                    transfers += [(place, reads, len(of), variables, signals)] * bool(of)
        functions = [name for name, _ in ffi.typeof("Component").fields if name.startswith("fmi2")]
        components = []
        for fmu in (component.fmu for component in self.components.values()):
            addresses = [*(cast(getattr(fmu.dll, name), c_void_p).value for name in functions), fmu.component]
            components.append([ffi.cast("void *", address) for address in addresses])
        counts = (len(components), len(transfers), len(number))
        tables = (self._own("Component[]", components), self._own("Transfer[]", transfers))
        arrays = (self._own("double[]", len(number)) for _ in range(6))
        return self._own("Master *", [EXCHANGES.index(exchange), 0, *counts, *tables, *arrays])

    def steps(
        self, stop: float, h: float, exchange: str, every: int = 1, progress: bool = False, ends: Iterable[Signal] = ()
    ) -> Iterator[float]:
        """Simulates from 0 to `stop`, and waits after the exchange at the communication points 0, `every`, ...: yields
        the time, at which variables may be read, and inputs set that are not connected.

        `at_end`: values of the signals `ends` at the end of the steps before a wait, before the exchange there. Raises
        component.Ended.
        """
        self.loop, self.at_end, count = self._prepare(exchange), [], round(stop / h)
        self.spent = np.zeros((count, len(self.components) + 1))
        self._require(self.c.master_exchange(self.loop, False), 0.0)
        for component in self.components.values():
            component.asked(component.fmu.exitInitializationMode)
        for begin in tqdm(range(0, count + 1, every), disable=not progress, leave=False):
            self._require(self.c.master_exchange(self.loop, exchange != "held"), begin * h)
            yield begin * h
            end = min(count, begin + every)
            done = self.c.master_run(self.loop, h, begin, end, ffi.from_buffer("double[]", self.spent))
            self._require(done == end, done * h)
            self.at_end.append(self.read(ends))

    def read(self, signals: Iterable[Signal], rates: bool = False) -> list[float]:
        """Their values, or their first derivatives."""
        found = []
        for component, of in groupby(signals, lambda signal: self.components[signal[0]]):
            numbers = component.references([name for _, name in of])
            more = (component.fmu.getRealOutputDerivatives, [1] * len(numbers)) if rates else (component.fmu.getReal,)
            found += more[0](numbers, *more[1:])
        return found

    def _require(self, done: bool, t: float) -> None:
        """Raises the ending of the component that refused a call after t."""
        if not done:
            raise list(self.components.values())[self.loop.refused].ended(t)

    def cost(self) -> dict[str, float]:
        """Medians over the steps in microseconds: of all, of the exchange, and of each component."""
        total, *each = np.median(self.spent, axis=0)
        exchange = float(np.median(self.spent[:, 0] - self.spent[:, 1:].sum(axis=1)))
        return {"total": float(total), "exchange": exchange, **dict(zip(self.components, each, strict=True))}
