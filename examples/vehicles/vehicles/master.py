"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. Over the step the inputs are one of

    held         constant: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends

Loading, order and initialization are here; the loop over the steps is in C (../master).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from ctypes import c_void_p, cast
from dataclasses import dataclass, field
from functools import cache
from graphlib import TopologicalSorter
from itertools import pairwise
from pathlib import Path

import numpy as np
from cffi import FFI
from fmpy import sharedLibraryExtension
from tqdm import tqdm

from .component import Component, Ended
from .options import EXCHANGES

Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink
KINDS = ("value", "rate", "at_end")  # of a record, as in master.h
FUNCTIONS = {
    **{"get": "GetReal", "set": "SetReal", "rates": "GetRealOutputDerivatives", "set_rates": "SetRealInputDerivatives"},
    **{"step": "DoStep", "keep": "GetFMUstate", "restore": "SetFMUstate", "forget": "FreeFMUstate"},
}
HEADER = Path(__file__).resolve().parents[1] / "master" / "master.h"
PIECES = 100  # of a run, between which the progress is shown and Ctrl-C is heard
ffi = FFI()


@cache
def library(folder: Path):
    """The loop in C, with the declarations of its header."""
    text = HEADER.read_text()
    types = "".join(f"typedef void fmi2{name}TYPE;" for name in FUNCTIONS.values())
    types += "typedef void* fmi2Component; typedef unsigned fmi2ValueReference;"
    declared = "\n".join(line for line in text.splitlines() if not line.startswith("#")).replace("MASTER_API", "")
    ffi.cdef(types + declared, override=True)
    return ffi.dlopen(str(folder / f"master{sharedLibraryExtension}"))


class Master:
    """Components and connections [(source, output), (sink, input)], stepped together by the loop in C: in `folder`, or
    beside one of the FMUs."""

    def __init__(
        self, components: list[Component], connections: Iterable[Connection], folder: Path | None = None
    ) -> None:
        self.components = {c.name: c for c in components}
        self.places = {name: place for place, name in enumerate(self.components)}
        self.source_of = {sink: source for source, sink in connections}
        self.loop, self.loaded = None, []
        try:
            for component in components:
                self.loaded.append(component)
                component.load()
            self.levels = self._order()
        except BaseException:
            self.__exit__()
            raise
        folders = [folder] if folder else [c.path.parent for c in components]
        self.c = library(next(f for f in folders if (f / f"master{sharedLibraryExtension}").exists()))

    def __enter__(self) -> Master:
        return self

    def __exit__(self, *_: object) -> None:
        if self.loop:
            self.c.master_free(self.loop)
        self.loop = None
        for component in self.loaded:
            component.free()

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

    def _prepare(self, exchange: str, reject: bool, record: list[Signal]) -> None:
        """Hands components, transfers and records to the loop."""
        self.loop, room = self.c.master_new(EXCHANGES.index(exchange), reject), []
        for component in self.components.values():
            dll = component.fmu.dll
            functions = {key: address(getattr(dll, f"fmi2{name}")) for key, name in FUNCTIONS.items()}
            instance = ffi.cast("void *", component.fmu.component)
            room.append(self.c.master_component(self.loop, instance, ffi.new("Functions *", functions)))
        number = {signal: k for k, signal in enumerate(signal for level in self.levels for signal in level)}
        for level in self.levels:
            sinks = [(sink, source) for sink, source in self.source_of.items() if source in level]
            for reads, ends in ((1, [(source, source) for source in level]), (0, sinks)):
                for name, component in self.components.items():
                    of = [(variable, number[source]) for (owner, variable), source in ends if owner == name]
                    if of:
                        variables, signals = component.references([v for v, _ in of]), [k for _, k in of]
                        place = self.places[name]
                        room.append(self.c.master_transfer(self.loop, place, reads, len(of), variables, signals))
        for name, variable in record:
            *kind, variable = variable.split()
            reference = self.components[name].references([variable])[0]
            which = KINDS.index(kind[0] if kind else "value")
            room.append(self.c.master_record(self.loop, self.places[name], reference, which))
        if not all(room):
            raise ValueError("The system has more components, signals or records than master/master.c has room for.")

    def run(
        self,
        stop: float,
        step: float,
        record: list[Signal],
        exchange: str = "held",
        every: int = 1,
        reject: bool = False,
        progress: bool = False,
        act: Callable[[float], None] | None = None,
    ) -> np.ndarray:
        """Simulate from 0 to `stop`; a record array of time and "component.variable", every `every` steps.

        act(t) is called after the exchange at every communication point and may set inputs that are not connected.
        reject: every step is taken, undone from a snapshot, and taken again, as an error-controlled master may do.
        A variable after "rate " or "at_end " is its derivative, or its value at the end of the step that begins there.
        Raises component.Ended; what was recorded until then is `self.table()`.
        """
        self._prepare(exchange, reject, record)
        self.names = ["time", *(f"{c}.{v}" for c, v in record)]
        count = round(stop / step)
        self.rows = np.full((count // every + 1, len(self.names)), np.nan)
        self.spent = np.zeros((count + 1, len(self.components) + 1))
        if not self.c.master_exchange(self.loop, 0):
            raise self._refusal(0.0)
        for component in self.components.values():
            component.asked(component.fmu.exitInitializationMode)
        rows, spent = (ffi.from_buffer("double[]", x) for x in (self.rows, self.spent))
        pieces = np.unique(np.linspace(0, count, (count if act else PIECES) + 1).astype(int)).tolist()
        for begin, end in tqdm([(0, 0), *pairwise(pieces)], disable=not progress, leave=False):
            if act and end:
                act(begin * step)
            done = self.c.master_run(self.loop, step, begin, end, every, rows, spent)
            if done < end:
                raise self._refusal(done * step)
        return self.table()

    def _refusal(self, t: float) -> Ended:
        return list(self.components.values())[self.c.master_refused(self.loop)].ended(t)

    def table(self) -> np.ndarray:
        """The records."""
        known = self.rows[np.isfinite(self.rows[:, 0])]
        return known.view([(name, float) for name in self.names])[:, 0]

    def cost(self) -> dict[str, float]:
        """Medians over the steps in microseconds: of all, of the exchange, and of each component."""
        total, *each = np.median(self.spent[:-1], axis=0)
        exchange = float(np.median(self.spent[:-1, 0] - self.spent[:-1, 1:].sum(axis=1)))
        return {"total": float(total), "exchange": exchange, **dict(zip(self.components, each, strict=True))}


def address(function) -> object:
    """Of a C function that ctypes loaded, for cffi."""
    return ffi.cast("void *", cast(function, c_void_p).value)


@dataclass(frozen=True)
class System:
    """FMUs and their connections; columns of the components in `bare` go by the variable's name alone."""

    name: str
    components: list[Component]
    connections: list[Connection]
    step: float  # s
    stop: float  # s
    bare: tuple[str, ...] = ()
    folder: Path | None = None  # of the loop in C, where it is not beside one of the FMUs


@dataclass(frozen=True)
class Run:
    """Columns "component.variable" on a grid; how it ended, if early; microseconds per step, as Master.cost has it."""

    table: dict[str, np.ndarray]
    ending: Ended | None = None
    cost: dict[str, float] = field(default_factory=dict)


def simulate(system: System, record: list[Signal], exchange: str, grid: float, **how: bool) -> Run:
    """The system to its stop, or to where a component ends the run; recorded every `grid`, or every step."""
    ending = None
    with Master(system.components, system.connections, system.folder) as master:
        try:
            every = max(1, round(grid / system.step))
            master.run(system.stop, system.step, record, exchange, every, **how)
        except Ended as end:
            ending = end
        rows, cost = master.table(), master.cost()
    names = {n: n.split(".")[-1] if n.split(".")[0] in system.bare else n for n in rows.dtype.names}
    return Run({short: rows[name] for name, short in names.items()}, ending, cost)


def whole(run: Run) -> dict[str, np.ndarray]:
    """The table of a run that reached its end; raises Ended for another."""
    if run.ending:
        raise run.ending
    return run.table
