"""The Python peers: a process that reads one request per line (JSON) and answers with one line.

Run by the interpreter of .venv-peers where it exists. A package that is not there is an answer that says so.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import time
import warnings
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
HOME = {"heyoka": "heyoka_wheel", "numbalsoda_lsoda": "numbalsoda_wheel", "numbalsoda_dop853": "numbalsoda_wheel"}


def repeat(solve: Callable[[], float | None], seconds: float) -> list[float]:
    """Durations of at least one solution; solve may return the seconds that count."""
    times: list[float] = []
    begin = time.perf_counter()
    while not times or (time.perf_counter() - begin < seconds and len(times) < 10000):
        start = time.perf_counter()
        inside = solve()
        times.append(time.perf_counter() - start if inside is None else inside)
    return times


def answer(request: dict[str, Any]) -> dict[str, Any]:
    grid = np.linspace(0, request["stop"], int(request["points"]))
    try:
        peer = importlib.import_module(HOME.get(request["solver"], "scipy_wheel"))
        problem = peer.prepare(request, grid)
        times = sorted(repeat(problem.solve, request["seconds"]))
        rows = problem.rows()
    except (ImportError, RuntimeError, ValueError, ArithmeticError, NotImplementedError) as trouble:
        return {"status": 3, "note": str(trouble).split("\n")[0]}
    record = {"status": 0, "solve_best": times[0], "solve_median": times[len(times) // 2], "repetitions": len(times)}
    record.update(problem.counts())
    record["rows"] = np.column_stack([grid[: len(rows)], rows]).tolist()
    return record


def versions() -> dict[str, str]:
    found = {"Python": sys.version.split()[0]}
    for package in ("numpy", "scipy", "heyoka", "numba", "numbalsoda"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "not installed"
    return found


def main() -> None:
    build, shim = sys.argv[1:3]
    os.environ["WHEEL_BUILD"], os.environ["WHEEL_RHS"] = build, shim
    sys.path[:0] = [str(HERE), str(HERE.parents[1] / "tests")]
    warnings.simplefilter("ignore", RuntimeWarning)  # of Radau's difference quotients
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # some solvers write there from C
    for line in sys.stdin:
        request = json.loads(line)
        print(json.dumps(versions() if "versions" in request else answer(request)), file=answers, flush=True)


if __name__ == "__main__":
    main()
