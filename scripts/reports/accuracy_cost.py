"""What it costs: nanoseconds of a right-hand side, steps and microseconds of a solution."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from time import perf_counter_ns

import numpy as np
from support.driver import COUNTERS, WARNING
from support.motion import Library

from .machine import ROOT, build_folder, busy, cached
from .markdown import table
from .part import Part

REPETITIONS = 41
SCENES = {
    "free": {},
    "free, bdf": {"method": 3},
    "free, multibody": {"formulation": 3},
    "friction": {"s": 0.03},
    "friction, bdf": {"s": 0.03, "method": 3},
    "friction, multibody": {"s": 0.03, "formulation": 3},
    "friction, regularized": {"s": 0.03, "friction_law": 2},
}


def right_hand_sides() -> Part:
    build, bench = build_folder(), ROOT / "scripts" / "bench" / "rhs_time.c"
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "rhs"
        flags = ["-std=c11", "-O2", "-D_POSIX_C_SOURCE=200809L", f"-I{ROOT / 'fmu-src' / 'equations'}"]
        link = [str(build / "libwheel_equations.so"), f"-Wl,-rpath,{build}"]
        subprocess.run([cached("CMAKE_C_COMPILER"), *flags, str(bench), "-o", str(program), *link], check=True)
        output = subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout
        lines = output.splitlines()
    rows = [(name, friction, float(median), float(least)) for name, friction, median, least in map(str.split, lines)]
    smallest = {(name, friction): least for name, friction, _, least in rows}
    ratio = smallest["multibody", "none"] / smallest["reduced", "none"]
    text = f"""## One right-hand side

Nanoseconds a call through `wheel_equations.h`, median and smallest of 501 repetitions (`scripts/bench/rhs_time.c`).
The reduced formulation is {ratio:.0f} times as fast as the paper's (24), by the smallest.
{busy()}

{table(["formulation", "moment about the axle", "median, ns", "smallest, ns"], rows)}"""
    return Part(text)


def solve_once(product: Library, start: dict[str, float], tolerance: float | None) -> tuple[float, dict[str, int]]:
    """Microseconds of one fmi2DoStep over 10 s, and the solver's counters after it."""
    with product.wheel() as wheel:
        wheel.start(tolerance=tolerance, **start)
        begin = perf_counter_ns()
        status = wheel.step_to(10.0)
        spent = (perf_counter_ns() - begin) / 1e3
        if status > WARNING:
            raise RuntimeError(" ".join(wheel.sentences[-1:]))
        return spent, {name: int(wheel.get(name)[0]) for name in COUNTERS}


def solutions(product: Library) -> Part:
    rows = []
    for name, start in SCENES.items():
        for tolerance in (None, 1e-4, 1e-12) if "," not in name else (None,):
            used = "default" if tolerance is None else f"{tolerance:g}"
            try:
                runs = [solve_once(product, start, tolerance) for _ in range(REPETITIONS)]
            except RuntimeError as fault:
                rows.append((name, used, *["-"] * len(COUNTERS), f"failed: {fault}", "-"))
                continue
            counters, times = runs[0][1], [spent for spent, _ in runs]
            rows.append(
                (name, used, *(counters[c] for c in COUNTERS), round(float(np.median(times))), round(min(times)))
            )
    header = [
        "scene",
        "tolerance",
        "steps",
        "rhs",
        "Jacobians",
        "root functions",
        "events",
        "restarts",
        "median, µs",
        "smallest, µs",
    ]
    text = f"""## One solution of 10 s

One fmi2DoStep of 10 s, called through fmpy in one process; microseconds: median and smallest of {REPETITIONS} runs.

{table(header, rows)}"""
    return Part(text)


def parts(product: Library, folder: Path) -> list[Part]:
    return [right_hand_sides(), solutions(product)]
