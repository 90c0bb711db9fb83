"""Nothing is lost, and nothing that is kept is run again, when a caller or a worker is killed or the disk is full."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import psutil
import pytest
from distributed import Client
from studies_support import command, same
from study import Status, Study
from study.__main__ import study_file
from study.compute import run
from study.dataset import open_results
from study.instance import Result
from study.worker import run_chunk

OF_CALLER = signal.getsignal(signal.SIGINT)  # a command in the background ignores it from the start
MANY = """
import numpy as np
from study import Study

study = Study(
    grid={"theta_start": np.radians(np.linspace(60, 89, 150)), "phi_dot_start": -np.linspace(1, 8, 36)},
    values={"s": 0.01},
    measures={"lowest": "lowest"},
)
"""
OFTEN = """
from study import Study

starts = [0.0] * 16 + [-2 - k / 15 for k in range(16)]
study = Study(grid={"phi_dot_start": starts}, history=["theta"], interval=1e-4)
"""


@pytest.fixture
def many(tmp_path: Path) -> Path:
    """A study of some seconds."""
    path = tmp_path / "many.py"
    path.write_text(MANY)
    return path


def until(happened: object, fault: str) -> None:
    """Waits for it, at most a minute."""
    give_up = time.monotonic() + 60
    while not happened():
        assert time.monotonic() < give_up, fault
        time.sleep(0.01)


def chunks(out: Path) -> dict[Path, int]:
    """The chunks whose status is kept, and when each was written."""
    return {path: path.stat().st_mtime_ns for path in out.glob("status/c/**/[0-9]*") if path.is_file()}


def workers_of(process: subprocess.Popen) -> list[psutil.Process]:
    return [p for p in psutil.Process(process.pid).children(recursive=True) if "spawn_main" in " ".join(p.cmdline())]


def stopped(words: tuple, out: Path, ending: int) -> str:
    """Runs the command until it has written a chunk, and stops it; its workers end too. Returns stderr."""
    before, interruptible = chunks(out), lambda: signal.signal(signal.SIGINT, signal.default_int_handler)
    process = command(*words, preexec_fn=interruptible)
    until(lambda: len(chunks(out)) > len(before), "no chunk was written")
    workers = workers_of(process)
    os.kill(process.pid, ending)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == {signal.SIGINT: 130, signal.SIGKILL: -signal.SIGKILL}[ending]
    assert len(workers) == 2
    assert not psutil.wait_procs(workers, timeout=30)[1]
    assert before.items() <= chunks(out).items()
    return errors


def test_a_study_continues_where_it_was_after_an_interrupt_a_killed_caller_and_a_killed_worker(
    many: Path, fmu_path: Path, alone
) -> None:
    out = many.with_suffix(".zarr")
    words = (many, "--fmu", fmu_path, "--out", out, "--workers", 2)
    assert stopped(words, out, signal.SIGINT).splitlines()[-1].startswith("study: stopped; the same command continues")
    stopped(words, out, signal.SIGKILL)
    status = open_results(out)["status"].values
    done = int((status != Status.not_computed).sum())
    assert 0 < done < status.size
    kept = chunks(out)
    process = command(*words)
    until(lambda: len(chunks(out)) > len(kept), "it did not continue")
    workers_of(process)[0].kill()
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0
    assert f"{done} of {status.size} wheels are there already" in errors
    assert kept.items() <= chunks(out).items()
    assert same(alone(study_file(str(many))["study"]), open_results(out))


def full_at(size: int) -> object:
    """Before a process starts: no file may grow beyond that many bytes, which is an error as of a full disk."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def test_a_full_disk_is_a_message_and_the_study_continues_when_there_is_space(
    many: Path, fmu_path: Path, alone
) -> None:
    """A wheel that rolls on for 10 s has a history too large for the limit, one that falls at once has not."""
    many.write_text(OFTEN)
    out = many.with_suffix(".zarr")
    words = (many, "--fmu", fmu_path, "--out", out, "--workers", 1)
    process = command(*words, preexec_fn=full_at(4_000_000))
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 2
    assert errors.strip().splitlines()[-1].startswith(f"study: {out} cannot be written ([Errno 27] File too large")
    kept = chunks(out)
    assert len(kept) == 1
    assert not list(out.rglob("*.partial"))
    assert command(*words).wait(60) == 0
    assert kept.items() <= chunks(out).items()
    assert same(alone(study_file(str(many))["study"]), open_results(out))


def die_at_upright(*task: object) -> Result | None:
    """As a worker does it, but the process dies where a wheel starts at exactly 1.5 rad."""
    if (task[-1]["theta_start"] == 1.5).any():
        os._exit(1)
    return run_chunk(*task)


def test_a_worker_that_dies_costs_one_wheel(fmu_path: Path, crew: Client, tmp_path: Path) -> None:
    study = Study(grid={"theta_start": np.r_[1.2:1.4:32j, 1.5, 1.41:1.49:7j]}, stop_time=1.0)
    crew.cluster.scheduler.allowed_failures = 0
    results = run(study, tmp_path / "d.zarr", fmu=fmu_path, client=crew, quiet=True, chunk=40, work=die_at_upright)
    crew.cluster.scheduler.allowed_failures = 1
    fates = results["status"].values
    assert np.flatnonzero(fates == Status.failed).tolist() == [32]
    assert (np.delete(fates, 32) == Status.reached).all()
    assert "died" in results["message"].values[32]
    assert np.isfinite(np.delete(results["theta_end"].values, 32)).all()


def test_an_interrupt_is_for_the_caller_alone(crew: Client) -> None:
    assert set(crew.run(signal.getsignal, signal.SIGINT).values()) == {signal.SIG_IGN}
    assert signal.getsignal(signal.SIGINT) == OF_CALLER
