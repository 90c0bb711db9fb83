"""The plan of a coupled run for the C master (examples/master), and its answer."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import platform as fmpy_platform
from fmpy import sharedLibraryExtension

from .component import Component, Ended
from .master import Connection, Master, Signal


@dataclass(frozen=True)
class Answer:
    """The table of the run; medians in microseconds per communication step; the component that ended it early."""

    table: np.ndarray
    exchange: float
    steps: dict[str, float]
    total: float
    ending: Ended | None


def lines(master: Master, record: list[Signal], run: tuple[float, float, str, int]) -> list[str]:
    """The plan, line by line; master/plan.h says what they mean. Start values must be Real."""
    text = []
    for name, c in master.components.items():
        identifier = c.description.coSimulation.modelIdentifier
        library = Path(c.folder) / "binaries" / fmpy_platform / f"{identifier}{sharedLibraryExtension}"
        text.append(f"component {name} {library} {c.description.guid}")
        text += [f"real {name} {c.references([v])[0]} {float(value)!r}" for v, value in c.start.items()]
    for transfer in master.transfers:
        text.append(f"transfer {transfer.source} {' '.join(map(str, transfer.outputs.references))}")
        for inputs, at in transfer.sinks:
            pairs = " ".join(f"{r}={i}" for r, i in zip(inputs.references, at, strict=True))
            text.append(f"sink {inputs.fmu.instanceName} {pairs}")
    text += [f"record {name} {master.components[name].references([v])[0]}" for name, v in record]
    step, stop, exchange, every = run
    return [*text, f"run {step!r} {stop!r} {exchange} {every}"]


def run(
    program: Path,
    components: list[Component],
    connections: list[Connection],
    record: list[Signal],
    step: float,
    stop: float,
    exchange: str,
    every: int = 1,
) -> Answer:
    """The coupled run in C. Raises RuntimeError with what the master said."""
    with Master(components, connections) as master, TemporaryDirectory() as folder:
        plan = Path(folder) / "plan.txt"
        plan.write_text("\n".join(lines(master, record, (step, stop, exchange, every))) + "\n")
        done = subprocess.run([str(program), str(plan)], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"The C master said: {done.stderr}")
    words = [line.split() for line in done.stdout.splitlines()]
    names = ["time", *(f"{c}.{v}" for c, v in record)]
    rows = [tuple(map(float, w[1:])) for w in words if w[0] == "row"]
    cost = {" ".join(w[:-2]): float(w[-2]) for w in words if w[-1] == "us"}
    ended = [Ended(w[1], float(w[2]), done.stderr.strip().split(": ", 1)[-1]) for w in words if w[0] == "ended"]
    return Answer(
        np.array(rows, dtype=[(name, float) for name in names]),
        cost.get("exchange", 0.0),
        {c.name: cost.get(f"step {c.name}", 0.0) for c in components},
        cost.get("total", 0.0),
        ended[0] if ended else None,
    )
