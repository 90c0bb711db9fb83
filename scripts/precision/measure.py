"""One measurement of one set-up: the driver, a C++ peer or the Python worker is asked, and answers with a record.

A record has status (0: solved), solve_best and solve_median (s), rows (t and the four outputs), counts as far as the
solver gives them, and a note if it failed. Errors are relative to the range of each output over the grid.
"""

from __future__ import annotations

import json
import selectors
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from .builds import ROOT, Build
from .scenes import COUNTERS, HEADLINE, POINTS, Scene, Setup

Record = dict[str, Any]
TIME_LIMIT = 6.0  # s, for one answer of a program
WORKER_LIMIT = 40.0  # s, of the Python worker: the first answer may have to compile


def failed(note: str) -> Record:
    return {"status": 3, "note": note}


def run_json(command: list[str]) -> Record:
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        return failed(f"gave no answer in {TIME_LIMIT:.0f} s")
    try:
        return json.loads(result.stdout)
    except json.JSONDecodeError:
        if result.returncode == 0:
            return failed("no finite result")
        return failed(f"ended with status {result.returncode}: {result.stderr.strip()[:200]}")


def driver_command(build: Build, mode: str, values: dict[str, float], **options: Any) -> list[str]:
    """The driver's command line; values by variable name, options by the driver's own names."""
    command = [str(build.program("master")), mode, "--library", str(build.library), "--guid", build.guid]
    for name, value in values.items():
        kind, reference = build.references[name]
        command += ["--set", f"{kind}{reference}={float(value)!r}"]
    for name, value in options.items():
        if value is True:
            command.append(f"--{name}")
        elif value is not None and value is not False:
            command += [f"--{name}", str(value)]
    return command


def reference_list(build: Build, names: tuple[str, ...]) -> str:
    return ",".join(str(build.references[name][1]) for name in names)


def drive(build: Build, values: dict[str, float], outputs: tuple[str, ...] = HEADLINE, **options: Any) -> Record:
    """The FMU through the driver, counters by name."""
    lists = {"read": reference_list(build, outputs) or None, "count": reference_list(build, COUNTERS)}
    record = run_json(driver_command(build, "solve", values, **lists, **options))
    if "counters" in record:
        record.update(zip(COUNTERS, record.pop("counters"), strict=True))
        record["evaluations"], record["events"] = record["n_rhs"], record["n_events"]
        record["steps"] = record["n_steps"]
    if record["status"] > 1:
        record.setdefault("note", f"stopped at t = {record.get('reached', 0):.3g} s")
    return record


class Worker:
    """The Python peers in a process of their own, kept so that compiled solvers are compiled once."""

    def __init__(self, build: Build) -> None:
        self.build = build
        own = ROOT / ".venv-peers" / "bin" / "python"
        self.python = str(own) if own.exists() else sys.executable
        self.process: subprocess.Popen[str] | None = None

    def ask(self, request: dict[str, Any]) -> Record:
        if self.process is None or self.process.poll() is not None:
            script = Path(__file__).with_name("worker.py")
            command = [self.python, str(script), str(self.build.folder), str(self.build.program("rhs.so"))]
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, stderr=subprocess.DEVNULL
            )
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            if not selector.select(WORKER_LIMIT):
                self.close()
                return failed(f"gave no answer in {WORKER_LIMIT:.0f} s")
        line = self.process.stdout.readline()
        return json.loads(line) if line else failed("the process ended")

    def close(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


def measure(build: Build, worker: Worker, scene: Scene, setup: Setup, tolerance: float, seconds: float) -> Record:
    if setup.family == "fmu":
        values = {**scene.changes, **setup.options}
        step = scene.stop / (POINTS - 1)
        return drive(build, values, tolerance=tolerance, step=step, stop=scene.stop, seconds=seconds, rows=True)
    request = {**scene.values, **setup.options, "tolerance": tolerance, "stop": scene.stop, "seconds": seconds}
    if setup.family == "python":
        return worker.ask({**request, "points": POINTS})
    program = str(request.pop("program"))
    if program in build.missing:
        return failed(build.missing[program])
    pairs = [f"{name}={value}" for name, value in request.items()]
    record = run_json([str(build.program(program)), *pairs, f"points={POINTS}", "rows=1"])
    if record["status"]:
        record.setdefault("note", "did not reach the end")
    return record


def error_of(record: Record, reference: np.ndarray) -> float | None:
    """Largest difference over grid and headline outputs, each relative to its range; None: not solved."""
    rows = record.get("rows")
    if record["status"] > 1 or rows is None or len(rows) != len(reference):
        return None
    difference = np.abs(np.array(rows, dtype=float)[:, 1:] - reference).max(axis=0)
    error = float((difference / np.ptp(reference, axis=0)).max())
    return error if np.isfinite(error) else None
