"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends

Loading, order, initialization and records are here; the loop over the steps between two records is in C (../master).
"""

import re
from collections.abc import Callable, Iterable
from ctypes import c_void_p, cast
from graphlib import TopologicalSorter
from pathlib import Path

import numpy as np
from cffi import FFI
from fmpy import sharedLibraryExtension
from tqdm import tqdm

from .component import Component
from .options import EXCHANGES

Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink
Signals = list[Signal]
Act = Callable[[float], None] | None
HEADER = (Path(__file__).resolve().parents[1] / "master" / "master.h").read_text()
LIBRARY = f"master{sharedLibraryExtension}"
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
        self.rows, self.owned = [], []
        libraries = (c.path.with_name(LIBRARY) for c in self.components.values())
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

    def _prepare(self, exchange: int) -> None:
        """Fills the loop's tables of components, transfers and signals."""
        number = {signal: k for k, signal in enumerate(signal for level in self.levels for signal in level)}
        transfers = []
        for level in self.levels:
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((1, [(source, source) for source in level]), (0, sinks)):
                for place, (name, component) in enumerate(self.components.items()):
                    of = [(variable, number[source]) for (owner, variable), source in ends if owner == name]
                    variables = self._own("unsigned[]", component.references([v for v, _ in of]))
                    signals = self._own("int[]", [k for _, k in of])
                    transfers += [(place, reads, len(of), variables, signals)] * bool(of)
        of_component = {name for name, _ in ffi.typeof("Component").fields if name.startswith("fmi2")}
        components = [
            {name: ffi.cast("void *", cast(getattr(c.fmu.dll, name), c_void_p).value) for name in of_component}
            | {"instance": ffi.cast("void *", c.fmu.component)}
            for c in self.components.values()
        ]
        counts = {"components": len(components), "transfers": len(transfers), "signals": len(number)}
        tables = {"component": self._own("Component[]", components), "transfer": self._own("Transfer[]", transfers)}
        names = ("value", "rate", "begin_value", "begin_rate", "second", "third")
        arrays = {name: self._own("double[]", len(number)) for name in names}
        self.loop = self._own("Master *", {"exchange": exchange, **counts, **tables, **arrays})

    def run(
        self, stop: float, h: float, record: Signals, exchange: str, every: int, progress: bool = False, act: Act = None
    ) -> np.ndarray:
        """Simulate from 0 to `stop`; a record array of time and "component.variable", every `every` steps h.

        act(t) is called after the exchange at every communication point and may set inputs that are not connected.
        A variable after "rate " or "at_end " is its derivative, or its value at the end of the step that begins there.
        Raises component.Ended; what was recorded until then is `self.table()`.
        """
        self._prepare(EXCHANGES.index(exchange))
        self.names = ["time", *(f"{c}.{v}" for c, v in record)]
        count, pace = round(stop / h), 1 if act else every
        self.places: dict[Signal, dict[int, int]] = {}  # value references by column, by component and kind
        for place, (name, variable) in enumerate(record, 1):
            *kind, variable = variable.split()
            (reference,) = self.components[name].references([variable])
            self.places.setdefault((name, *(kind or ["value"])), {})[place] = reference
        self.spent = np.zeros((count, len(self.components) + 1))
        spent = ffi.from_buffer("double[]", self.spent)
        self._require(self.c.master_exchange(self.loop, False), 0.0)
        for component in self.components.values():
            component.asked(component.fmu.exitInitializationMode)
        for begin in tqdm(range(0, count + 1, pace), disable=not progress, leave=False):
            self._require(self.c.master_exchange(self.loop, exchange != "held"), begin * h)
            if begin % every == 0:
                self.rows.append(np.full(len(self.names), begin * h))
                self._read("value", "rate")
            if act and begin < count:
                act(begin * h)
            end = min(count, begin + pace)
            done = self.c.master_run(self.loop, h, begin, end, spent)
            self._require(done == end, done * h)
            self._read("at_end")
        return self.table()

    def _read(self, *kinds: str) -> None:
        """Fills the columns of these kinds in the last row."""
        for (name, kind), columns in self.places.items():
            if kind in kinds:
                fmu, references = self.components[name].fmu, list(columns.values())
                rates = kind == "rate" and fmu.getRealOutputDerivatives(references, [1] * len(references))
                self.rows[-1][list(columns)] = rates or fmu.getReal(references)

    def _require(self, done: bool, t: float) -> None:
        """Raises the ending of the component that refused a call after t."""
        if not done:
            raise list(self.components.values())[self.loop.refused].ended(t)

    def table(self) -> np.ndarray:
        """The records."""
        return np.array(self.rows).view([(name, float) for name in self.names])[:, 0]

    def cost(self) -> dict[str, float]:
        """Medians over the steps in microseconds: of all, of the exchange, and of each component."""
        total, *each = np.median(self.spent, axis=0)
        exchange = float(np.median(self.spent[:, 0] - self.spent[:, 1:].sum(axis=1)))
        return {"total": float(total), "exchange": exchange, **dict(zip(self.components, each, strict=True))}
