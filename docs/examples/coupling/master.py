"""A parallel (Jacobi) master for FMI 2.0 co-simulation on top of fmpy: fixed steps, optional signal derivatives.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. With derivatives, the inputs follow
straight lines over the step: fmi2GetRealOutputDerivatives of the source, fmi2SetRealInputDerivatives of the sink.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass, field
from graphlib import TopologicalSorter
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

Signal = tuple[str, str]  # component, variable


@dataclass
class Component:
    """One FMU in the system."""

    name: str
    path: Path
    start: dict[str, float] = field(default_factory=dict)

    def load(self) -> None:
        """Unpack and instantiate; parameters and start values are set."""
        self.folder = extract(str(self.path))
        self.description = read_model_description(self.folder)
        self.variable = {v.name: v for v in self.description.modelVariables}
        self.fmu = FMU2Slave(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=self.name,
        )
        self.fmu.instantiate()
        self.fmu.setupExperiment(startTime=0.0)
        for name, value in self.start.items():
            setter = self.fmu.setBoolean if self.variable[name].type == "Boolean" else self.fmu.setReal
            setter(self.references([name]), [value])

    def free(self) -> None:
        """End the run and remove the unpacked files."""
        self.fmu.terminate()
        self.fmu.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def references(self, names: list[str]) -> list[int]:
        """Value references of variables."""
        return [self.variable[name].valueReference for name in names]

    def feeds(self, output: str) -> list[str]:
        """Inputs on which an output depends directly; undeclared dependencies mean all."""
        unknown = next(u for u in self.description.outputs if u.variable.name == output)
        if unknown.dependencies is None:
            return [v.name for v in self.description.modelVariables if v.causality == "input"]
        return [v.name for v in unknown.dependencies]


@dataclass(frozen=True)
class Transfer:
    """Outputs of one component that can be read together, and the inputs they go to."""

    source: Component
    sinks: list[tuple[Component, list[int], list[int]]]  # component, its references, positions among the outputs
    outputs: list[int]

    def values(self) -> None:
        """Hand the values over."""
        values = self.source.fmu.getReal(self.outputs)
        for sink, references, at in self.sinks:
            sink.fmu.setReal(references, [values[i] for i in at])

    def derivatives(self) -> None:
        """Hand the first derivatives over."""
        n = len(self.outputs)
        rates = self.source.fmu.getRealOutputDerivatives(self.outputs, [1] * n)
        for sink, references, at in self.sinks:
            sink.fmu.setRealInputDerivatives(references, [1] * len(at), [rates[i] for i in at])


class Master:
    """Components and connections [(source, output), (sink, input)], stepped together."""

    def __init__(self, components: list[Component], connections: list[tuple[Signal, Signal]]) -> None:
        self.components = {c.name: c for c in components}
        for component in components:
            component.load()
        self.transfers = self._order(connections)

    def _order(self, connections: list[tuple[Signal, Signal]]) -> list[Transfer]:
        """Transfers such that each output is read after the inputs it depends on; refuses algebraic loops."""
        source_of = {sink: source for source, sink in connections}
        graph: dict[Signal, set[Signal]] = {}
        for source in source_of.values():
            inputs = [(source[0], name) for name in self.components[source[0]].feeds(source[1])]
            graph[source] = {source_of[i] for i in inputs if i in source_of}
        sorter, transfers = TopologicalSorter(graph), []
        sorter.prepare()
        while sorter.is_active():
            ready = sorter.get_ready()
            for name in dict.fromkeys(signal[0] for signal in ready):
                transfers.append(self._transfer(name, [s for s in ready if s[0] == name], connections))
            sorter.done(*ready)
        return transfers

    def _transfer(self, name: str, signals: list[Signal], connections: list[tuple[Signal, Signal]]) -> Transfer:
        sinks = []
        for sink in self.components.values():
            pairs = [(t[1], signals.index(s)) for s, t in connections if s in signals and t[0] == sink.name]
            if pairs:
                sinks.append((sink, sink.references([p[0] for p in pairs]), [p[1] for p in pairs]))
        source = self.components[name]
        return Transfer(source, sinks, source.references([s[1] for s in signals]))

    def run(
        self,
        stop: float,
        step: float,
        record: list[Signal],
        derivatives: bool = False,
        every: int = 1,
        reject: bool = False,
    ) -> np.ndarray:
        """Simulate from 0 to `stop`; a record array of time and "component.variable", every `every` steps.

        reject: every step is taken, undone from a snapshot, and taken again, as an error-controlled master may do.
        """
        fmus = [c.fmu for c in self.components.values()]
        for fmu in fmus:
            fmu.enterInitializationMode()
        self._exchange(derivatives=False)
        for fmu in fmus:
            fmu.exitInitializationMode()
        rows = []
        count = round(stop / step)
        for i in range(count + 1):
            self._exchange(derivatives)
            if i % every == 0:
                rows.append((i * step, *self._read(record)))
            if i < count:
                self._step(i * step, (i + 1) * step - i * step, reject)
        names = ["time", *(f"{c}.{v}" for c, v in record)]
        return np.array(rows, dtype=[(name, float) for name in names])

    def _step(self, t: float, h: float, reject: bool) -> None:
        for component in self.components.values():
            fmu = component.fmu
            if reject:
                state = fmu.getFMUstate()
                fmu.doStep(t, h, False)
                fmu.setFMUstate(state)
                fmu.freeFMUstate(state)
            fmu.doStep(t, h, not reject)

    def _exchange(self, derivatives: bool) -> None:
        for transfer in self.transfers:
            transfer.values()
        for transfer in self.transfers if derivatives else ():
            transfer.derivatives()

    def _read(self, record: list[Signal]) -> list[float]:
        read = []
        for name, variable in record:
            component = self.components[name]
            read += component.fmu.getReal(component.references([variable]))
        return read

    def close(self) -> None:
        """End all FMUs."""
        for component in self.components.values():
            component.free()
