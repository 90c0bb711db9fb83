"""Nothing is lost, and nothing that is kept is run again, when a caller or a worker is killed or the disk is full."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import psutil
import pytest
from distributed import Client
from studies_support import as_one_worker, command
from study import Status, Study
from study.__main__ import study_file
from study.compute import run
from study.crew import uninterrupted
from study.results import open_results
from study.runs import Runner
from study.worker import Errand, Part, run_parts

MANY = """
import numpy as np
from study import Study

study = Study(
    grid={"theta_start": np.radians(np.linspace(60, 89, 150)), "phi_dot_start": -np.linspace(1, 8, 36)},
    values={"s": 0.01},
    measures={"lowest": "lowest"},
)
"""


@pytest.fixture
def many(tmp_path: Path) -> Path:
    """A study of some seconds."""
    path = tmp_path / "many.py"
    path.write_text(MANY)
    return path


def until(happened: object, what: str) -> None:
    """Waits for it, at most a minute."""
    give_up = time.monotonic() + 60
    while not happened():
        assert time.monotonic() < give_up, what
        time.sleep(0.01)


def chunks(out: Path, name: str) -> dict[Path, int]:
    """The chunks of a column that are kept, and when each was written."""
    return {path: path.stat().st_mtime_ns for path in out.glob(f"{name}/c/*/*") if path.suffix != ".partial"}


def workers_of(process: subprocess.Popen) -> list[psutil.Process]:
    return [p for p in psutil.Process(process.pid).children(recursive=True) if "spawn_main" in " ".join(p.cmdline())]


def test_a_study_whose_caller_and_then_a_worker_are_killed_goes_on_where_it_was(
    many: Path, fmu_path: Path, runner: Runner
) -> None:
    out = many.with_suffix(".zarr")
    process = command(many, "--fmu", fmu_path, "--out", out, "--workers", 2, stderr=subprocess.DEVNULL)
    until(lambda: chunks(out, "status"), "no chunk was written")
    workers = workers_of(process)
    process.kill()
    process.wait()
    assert len(workers) == 2
    assert not psutil.wait_procs(workers, timeout=30)[1]
    status = open_results(out)["status"].values
    done = int((status != Status.not_computed).sum())
    assert 0 < done < status.size
    kept = chunks(out, "status")

    process = command(many, "--fmu", fmu_path, "--out", out, "--workers", 2)
    until(lambda: len(chunks(out, "status")) > len(kept), "it did not go on")
    workers_of(process)[0].kill()
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0
    assert f"{done} of {status.size} wheels are there already" in errors
    after = chunks(out, "status")
    assert all(after[path] == when for path, when in kept.items())
    assert as_one_worker(runner, study_file(str(many))["study"], open_results(out))


def full_at(size: int) -> object:
    """Before a process starts: no file may grow beyond that many bytes, which is an error as of a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def test_a_full_disk_is_a_sentence_and_the_study_goes_on_when_there_is_space(
    many: Path, fmu_path: Path, runner: Runner
) -> None:
    """A wheel that rolls on for 10 s has a history too large for the limit, one that falls at once has not."""
    starts, often = [0.0] * 16 + np.linspace(-2, -3, 16).tolist(), 1e-4  # s
    many.write_text(
        f'import study\nstudy = study.Study(grid={{"phi_dot_start": {starts}}}, history=["theta"], interval={often})\n'
    )
    out = many.with_suffix(".zarr")
    words = (many, "--fmu", fmu_path, "--out", out, "--workers", 1)
    process = command(*words, preexec_fn=full_at(4_000_000))
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 2
    assert errors.strip().splitlines()[-1].startswith(f"study: {out} cannot be written ([Errno 27] File too large")
    kept = {path: path.stat().st_mtime_ns for path in out.glob("status/c/*")}
    assert len(kept) == 1
    assert not list(out.rglob("*.partial"))
    assert command(*words).wait(60) == 0
    assert all(path.stat().st_mtime_ns == when for path, when in kept.items())
    assert as_one_worker(runner, study_file(str(many))["study"], open_results(out))


def die_at_upright(errand: Errand, parts: list[Part]) -> tuple[list[object], float]:
    """As a worker does it, but the process dies where a wheel starts at exactly 1.5 rad."""
    if any((part.points["theta_start"] == 1.5).any() for part in parts):
        os._exit(1)
    return run_parts(errand, parts)


def test_a_worker_that_dies_costs_one_point(fmu_path: Path, crew: Client, tmp_path: Path) -> None:
    study = Study(grid={"theta_start": np.r_[1.2:1.4:32j, 1.5, 1.41:1.49:7j]}, stop_time=1.0)
    crew.cluster.scheduler.allowed_failures = 0
    results = run(study, tmp_path / "d.zarr", fmu=fmu_path, client=crew, quiet=True, chunk=40, work=die_at_upright)
    crew.cluster.scheduler.allowed_failures = 1
    assert np.flatnonzero(results["status"] == Status.failed).tolist() == [32]
    assert (np.delete(results["status"].values, 32) == Status.reached).all()
    assert "died" in results["message"].values[32]
    assert np.isfinite(np.delete(results["theta_end"].values, 32)).all()


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Interrupts raise, also where the shell that started the tests had them ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_is_for_the_caller_alone() -> None:
    ask = [sys.executable, "-c", "import signal; print(signal.getsignal(signal.SIGINT).name)"]
    with uninterrupted():
        assert subprocess.check_output(ask, text=True).strip() == "SIG_IGN"
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    assert subprocess.run(ask, capture_output=True, check=False).returncode == 1  # Python's own handler has no name
