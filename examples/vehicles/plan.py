"""The plan of a coupled run for the C master (examples/master), and its answer."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

from fmpy import platform as fmpy_platform
from fmpy import sharedLibraryExtension

from .component import Component
from .master import Connection, Master, Signal


@dataclass(frozen=True)
class Answer:
    """Medians in microseconds per communication step, and the recorded variables at the end."""

    end: dict[Signal, float]
    exchange: float
    steps: dict[str, float]
    total: float


def lines(master: Master, record: list[Signal], step: float, stop: float, exchange: str) -> list[str]:
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
    return [*text, f"run {step!r} {stop!r} {exchange}"]


def run(
    program: Path,
    components: list[Component],
    connections: list[Connection],
    record: list[Signal],
    step: float,
    stop: float,
    exchange: str,
) -> Answer:
    """The coupled run in C. Raises RuntimeError with what the master said."""
    with Master(components, connections) as master:
        plan = program.parent / "plan.txt"
        plan.write_text("\n".join(lines(master, record, step, stop, exchange)) + "\n")
        done = subprocess.run([str(program), str(plan)], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"The C master said: {done.stderr}")
    words = [line.split() for line in done.stdout.splitlines()]
    values = [float(w[3]) for w in words if w[0] == "record"]
    return Answer(
        dict(zip(record, values, strict=True)),
        next(float(w[1]) for w in words if w[0] == "exchange"),
        {w[1]: float(w[2]) for w in words if w[0] == "step"},
        next(float(w[1]) for w in words if w[0] == "total"),
    )
