"""What the FMU costs apart from the solution itself: co-simulation, instances, long runs, instructions, Python, file.

Each function measures one thing through the driver (scripts/bench/master.c) and returns plain rows for the report.
"""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import fmpy

from .builds import ROOT, Build
from .measure import drive, driver_command, reference_list, run_json
from .scenes import HEADLINE, SCENES, Scene

Rows = list[dict[str, Any]]


def scenes_of(quick: bool) -> tuple[Scene, ...]:
    return SCENES[:2] if quick else SCENES


def cosimulation(build: Build, quick: bool) -> Rows:
    """ns per doStep at the default tolerance, the four outputs read after each step, or none. Best: by the wall clock;
    median: processor time, which no other program disturbs."""
    rows = []
    for scene in scenes_of(quick):
        for step in (1e-3, 1e-2):
            record = drive(build, scene.changes, step=step, stop=scene.stop, seconds=0.3)
            silent = drive(build, scene.changes, outputs=(), step=step, stop=scene.stop, seconds=0.3)
            steps = record["reached"] / step
            row = {"scene": scene.name, "step": step, "read": 1e9 * record["solve_best"] / steps}
            row["read_median"] = 1e9 * record["processor_median"] / steps
            row["unread"] = 1e9 * silent["solve_best"] / steps
            rows.append(row)
    return rows


def crowd(build: Build, quick: bool) -> dict[str, Any]:
    """Many instances of the friction wheel in one process, one thread and two; bits against one alone."""
    count = 1000 if quick else 10000
    options = {"read": reference_list(build, HEADLINE), "instances": count, "step": 0.1, "stop": 1.5}
    record = run_json(driver_command(build, "many", SCENES[1].changes, **options))
    alone = drive(build, SCENES[1].changes, step=0.1, stop=0.1, seconds=0.1)
    record["alone"] = alone["start_median"] + alone["end_median"]
    record["alone_best"] = alone["start_best"] + alone["end_best"]
    return record


def long_runs(build: Build, quick: bool) -> Rows:
    """µs of processor time per simulated second, communication every 0.1 s, over ever longer runs."""
    rows = []
    for scene in SCENES[:2]:
        for stop in (10, 60, 600) if quick else (10, 60, 600, 3600):
            record = drive(build, scene.changes, step=0.1, stop=float(stop), seconds=0.2)
            seconds = record["reached"]
            row = {"scene": scene.name, "stop": stop, "cost": 1e6 * record["processor_best"] / seconds}
            row |= {name: record[name] / seconds for name in ("n_steps", "n_rhs", "n_events")}
            rows.append(row)
    return rows


def instructions(build: Build, quick: bool) -> Rows:
    """Instructions of one simulated second by callgrind, counted inside the driver's solve_scene alone."""
    if not shutil.which("valgrind"):
        return []
    rows = []
    lists = {"read": reference_list(build, HEADLINE)}
    for scene in scenes_of(quick):
        for step in (0.1, 1e-3):
            command = driver_command(build, "solve", scene.changes, **lists, step=step, stop=1.0, repetitions=1)
            options = ["--tool=callgrind", "--toggle-collect=solve_scene", "--callgrind-out-file=/dev/null"]
            result = subprocess.run(["valgrind", *options, *command], capture_output=True, text=True)
            found = re.search(r"Collected : (\d+)", result.stderr)
            if found:  # solve_scene ran twice: once for the result, once for the clock
                rows.append({"scene": scene.name, "step": step, "instructions": int(found[1]) // 2})
    return rows


def wall_time(command: list[str], folder: str, runs: int) -> float:
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def python(build: Build, quick: bool) -> dict[str, float]:
    """Wall time of `fmpy simulate wheel.fmu` (10 s, every 0.01 s) and of simulate_fmu alone, and the FMU's part: the
    driver's time for the same calls."""
    with tempfile.TemporaryDirectory() as folder:
        tool = str(Path(sys.executable).with_name("fmpy"))
        wall = wall_time([tool, "simulate", str(build.fmu)], folder, 2 if quick else 5)
        start = time.perf_counter()
        description = fmpy.read_model_description(str(build.fmu))
        read = time.perf_counter() - start
        start = time.perf_counter()
        unpacked = fmpy.extract(str(build.fmu), folder)
        unpack = time.perf_counter() - start
        inside = []
        for _ in range(3 if quick else 9):
            start = time.perf_counter()
            fmpy.simulate_fmu(unpacked, model_description=description, output_interval=0.01)
            inside.append(time.perf_counter() - start)
    outputs = tuple(v.name for v in description.modelVariables if v.causality == "output")
    record = drive(build, {}, outputs=outputs, step=0.01, stop=10.0, seconds=0.3)
    fmu = record["start_median"] + record["solve_median"] + record["end_median"]
    call = statistics.median(inside)
    return {"wall": wall, "call": call, "fmu": fmu, "read": read, "unpack": unpack, "load": record["load"]}


def archive(build: Build) -> dict[str, float]:
    return {"fmu": build.fmu.stat().st_size, "library": build.library.stat().st_size}


def machine(build: Build) -> dict[str, str]:
    """Footer: what ran, where, from which commit."""

    def output(*command: str) -> str:
        found = shutil.which(command[0])
        result = subprocess.run(command, capture_output=True, text=True, cwd=ROOT) if found else None
        return result.stdout.strip() if result and result.returncode == 0 else ""

    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    model = re.search(r"model name\s*: (.*)", info)
    changed = " with changes not committed" if output("git", "status", "--porcelain", "--untracked-files=no") else ""
    load = ", ".join(f"{x:.1f}" for x in os.getloadavg())
    return {
        "Machine": f"{model[1] if model else 'unknown processor'}, {os.cpu_count()} cores; load at the end {load}",
        "System": f"{output('uname', '-srm')}, {output('ldd', '--version').splitlines()[0]}",
        "Compilers": "; ".join(output(c, "--version").splitlines()[0] for c in dict.fromkeys(build.compilers.values())),
        "Commit": f"{output('git', 'rev-parse', '--short', 'HEAD')}{changed}",
    }
