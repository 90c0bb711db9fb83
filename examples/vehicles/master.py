"""A parallel (Jacobi) master for FMI 2.0 co-simulation with fixed steps; the connections are a table.

At every communication point all outputs are brought up to date with the inputs just set, in the order that the
dependencies in the model descriptions allow, and then all FMUs step alone. What the inputs do over the step is one of

    held         they keep their values: order 1
    derivatives  straight lines, from the first derivatives of the sources' outputs: order 2
    rollback     parabolas whose second derivatives are predicted from the last step; the step is undone, and taken
                 again on the cubics through the values and first derivatives at both ends
"""

from __future__ import annotations

from collections.abc import Iterable
from graphlib import TopologicalSorter

import numpy as np
from tqdm import tqdm

from .component import Component, Values

Signal = tuple[str, str]  # component, variable
Connection = tuple[Signal, Signal]  # source, sink
EXCHANGES = ("held", "derivatives", "rollback")


class Transfer:
    """Outputs of one component that can be read together, and the inputs they go to."""

    def __init__(self, source: Component, signals: list[Signal], connections: list[Connection], sinks: list[Component]):
        self.source = source.name
        self.outputs = Values(source, [variable for _, variable in signals])
        self.value, self.rate = np.zeros(len(signals)), np.zeros(len(signals))
        self.sinks: list[tuple[Values, np.ndarray]] = []
        for sink in sinks:
            pairs = [(t[1], signals.index(s)) for s, t in connections if s in signals and t[0] == sink.name]
            if pairs:
                self.sinks.append((Values(sink, [p[0] for p in pairs]), np.array([p[1] for p in pairs])))

    def hand_values(self, values: np.ndarray | None = None) -> None:
        """Read (unless given) and set the values."""
        self.value[:] = self.outputs.get() if values is None else values
        for inputs, at in self.sinks:
            inputs.set(self.value[at])

    def hand_rates(self) -> None:
        """Read and set the first derivatives."""
        self.rate[:] = self.outputs.rates()
        self.hand(1, self.rate)

    def hand(self, order: int, values: np.ndarray) -> None:
        """Set derivatives of this order."""
        for inputs, at in self.sinks:
            inputs.set_derivative(order, values[at])


class Master:
    """Components and connections [(source, output), (sink, input)], stepped together."""

    def __init__(self, components: list[Component], connections: Iterable[Connection]) -> None:
        self.components = {c.name: c for c in components}
        for component in components:
            component.load()
        self.transfers = self._order(list(connections))

    def __enter__(self) -> Master:
        return self

    def __exit__(self, *_: object) -> None:
        for component in self.components.values():
            component.free()

    def _order(self, connections: list[Connection]) -> list[Transfer]:
        """Transfers such that each output is read after the inputs it depends on; refuses algebraic loops."""
        source_of = {sink: source for source, sink in connections}
        graph: dict[Signal, set[Signal]] = {}
        for source in source_of.values():
            inputs = [(source[0], name) for name in self.components[source[0]].feeds(source[1])]
            graph[source] = {source_of[i] for i in inputs if i in source_of}
        sorter, transfers = TopologicalSorter(graph), []
        sorter.prepare()
        sinks = list(self.components.values())
        while sorter.is_active():
            ready = sorter.get_ready()
            for name in dict.fromkeys(signal[0] for signal in ready):
                signals = [s for s in ready if s[0] == name]
                transfers.append(Transfer(self.components[name], signals, connections, sinks))
            sorter.done(*ready)
        return transfers

    def run(
        self,
        stop: float,
        step: float,
        record: list[Signal],
        exchange: str = "held",
        every: int = 1,
        reject: bool = False,
        progress: bool = False,
    ) -> np.ndarray:
        """Simulate from 0 to `stop`; a record array of time and "component.variable", every `every` steps.

        reject: every step is taken, undone from a snapshot, and taken again, as an error-controlled master may do.
        Raises component.Ended; what was recorded until then is `self.rows`.
        """
        if exchange not in EXCHANGES:
            raise ValueError(f"exchange is {exchange}; it is one of {', '.join(EXCHANGES)}.")
        self._initialize()
        self.names = ["time", *(f"{c}.{v}" for c, v in record)]
        self.rows: list[tuple[float, ...]] = []
        readers, count = self._readers(record), round(stop / step)
        for i in tqdm(range(count + 1), disable=not progress, unit=" steps", leave=False):
            self._exchange(exchange != "held")
            if i % every == 0:
                self.rows.append((i * step, *(x for reader in readers for x in reader.get().tolist())))
            if i < count:
                self._step(i * step, (i + 1) * step - i * step, exchange == "rollback", reject)
        return self.table()

    def table(self) -> np.ndarray:
        """What was recorded."""
        return np.array(self.rows, dtype=[(name, float) for name in self.names])

    def _initialize(self) -> None:
        fmus = [c.fmu for c in self.components.values()]
        for fmu in fmus:
            fmu.enterInitializationMode()
        self._exchange(rates=False)
        for fmu in fmus:
            fmu.exitInitializationMode()
        self.last: list[np.ndarray] = []

    def _readers(self, record: list[Signal]) -> list[Values]:
        """The recorded signals, neighbours of one component read together."""
        groups: list[tuple[str, list[str]]] = []
        for name, variable in record:
            if not groups or groups[-1][0] != name:
                groups.append((name, []))
            groups[-1][1].append(variable)
        return [Values(self.components[name], variables) for name, variables in groups]

    def _exchange(self, rates: bool) -> None:
        for transfer in self.transfers:
            transfer.hand_values()
        for transfer in self.transfers if rates else ():
            transfer.hand_rates()

    def _step(self, t: float, h: float, rollback: bool, reject: bool) -> None:
        if rollback:
            self._predict_and_correct(t, h)
            return
        for component in self.components.values():
            if reject:
                component.keep()
                component.step(t, h, True)
                component.restore()
            component.step(t, h, reject)

    def _predict_and_correct(self, t: float, h: float) -> None:
        begin = [(transfer.value.copy(), transfer.rate.copy()) for transfer in self.transfers]
        for i, transfer in enumerate(self.transfers if self.last else ()):
            transfer.hand(2, (transfer.rate - self.last[i]) / h)
        self.last = [rate for _, rate in begin]
        for component in self.components.values():
            component.keep()
            component.step(t, h, True)
        self._exchange(rates=True)
        for component in self.components.values():
            component.restore()
        for transfer, (value, rate) in zip(self.transfers, begin, strict=True):
            mean = (transfer.value - value) / h
            second = 2 * (3 * mean - 2 * rate - transfer.rate) / h
            third = 6 * (rate + transfer.rate - 2 * mean) / h**2
            transfer.hand_values(value)
            for order, derivative in enumerate((rate, second, third), 1):
                transfer.hand(order, derivative)
        for component in self.components.values():
            component.step(t, h, True)
