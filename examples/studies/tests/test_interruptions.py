"""Nothing is lost, and nothing that is kept is run again, when a caller or a worker is killed or the disk is full."""

import os
import re
import resource
import shlex
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
from study.__main__ import arguments_of
from study.dataset import open_results
from study.worker import Result, run_chunk

MANY = shlex.split(
    "--vary theta_start=60deg:89deg:150 --vary phi_dot_start=-1:-8:36 --set s=0.01 --measure lowest=lowest"
)
# Sixteen wheels that fall at once and sixteen that roll on, with a long history.
SPINS = ",".join(map(str, [0.0] * 16 + [-2 - k / 15 for k in range(16)]))
OFTEN = ["--vary", f"phi_dot_start={SPINS}", "--history", "theta", "--interval", "1e-4"]


def chunks(out: Path) -> dict[Path, int]:
    """The chunks whose status is kept, and when each was written."""
    return {path: path.stat().st_mtime_ns for path in out.glob("status/c/**/[0-9]*") if path.is_file()}


def begun(words: list[object], out: Path) -> tuple[subprocess.Popen, list[psutil.Process]]:
    """The command when it has written a chunk, in a new session, and its two workers."""
    before, interruptible = chunks(out), lambda: signal.signal(signal.SIGINT, signal.default_int_handler)
    process = command(*words, preexec_fn=interruptible, start_new_session=True)
    give_up = time.monotonic() + 60
    while len(chunks(out)) <= len(before):
        assert time.monotonic() < give_up, "no chunk was written"
        time.sleep(0.01)
    children = psutil.Process(process.pid).children(recursive=True)
    workers = [p for p in children if "spawn_main" in " ".join(p.cmdline())]
    assert len(workers) == 2
    return process, workers


def test_a_study_continues_after_an_interrupt_a_killed_caller_and_a_killed_worker(tmp_path, fmu_path, alone) -> None:
    """An interrupt, as by Ctrl-C, reaches the whole session; it is for the caller alone."""
    out, kept = tmp_path / "many.zarr", {}
    words = [*MANY, "--fmu", fmu_path, "--out", out, "--workers", 2]
    for stop, code, word in ((signal.SIGINT, 130, "study: stopped; the same"), (signal.SIGKILL, -signal.SIGKILL, "")):
        process, workers = begun(words, out)
        (os.killpg if stop == signal.SIGINT else os.kill)(process.pid, stop)
        _, errors = process.communicate(timeout=60)
        assert process.returncode == code and errors.splitlines()[-1].startswith(word)
        assert not psutil.wait_procs(workers, timeout=30)[1]
        assert kept.items() <= (kept := chunks(out)).items()
    status = open_results(out)["status"].values
    done = int((status != Status.not_computed).sum())
    assert 0 < done < status.size
    process, workers = begun(words, out)
    workers[0].kill()
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0 and f"{done} of {status.size} wheels are there already" in errors
    assert kept.items() <= chunks(out).items()
    assert same(alone(arguments_of(MANY).study), open_results(out))


def full() -> None:
    """Before a process starts: no file may grow beyond four megabytes, which is an error as of a full disk."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (4_000_000, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def test_a_full_disk_is_a_message_and_the_study_continues_when_there_is_space(tmp_path, fmu_path, alone) -> None:
    """A wheel that rolls on for 10 s has a history too large for the limit, one that falls at once has not."""
    out = tmp_path / "often.zarr"
    words = [*OFTEN, "--fmu", fmu_path, "--out", out, "--workers", 1]
    process = command(*words, preexec_fn=full)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 2
    assert re.search(rf"^study: {out}: \[Errno 27\] File too large; results so far are kept; the", errors, re.MULTILINE)
    kept = chunks(out)
    assert len(kept) == 1 and not list(out.rglob("*.partial"))
    assert command(*words).wait(60) == 0
    assert kept.items() <= chunks(out).items()
    assert same(alone(arguments_of(OFTEN).study), open_results(out))


def die_at_upright(*task: object) -> Result | None:
    """As a worker does it, but the process dies where a wheel starts at exactly 1.5 rad."""
    if (task[-1]["theta_start"] == 1.5).any():
        os._exit(1)
    return run_chunk(*task)


def test_a_worker_that_dies_costs_one_wheel(conduct, crew: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew.cluster.scheduler, "allowed_failures", 0)
    study = Study(grid={"theta_start": np.r_[1.2:1.4:32j, 1.5, 1.41:1.49:7j]}, stop_time=1.0)
    results = conduct(study, chunk=40, work=die_at_upright)
    died = results["theta_start"] == 1.5
    assert (results["status"] == np.where(died, Status.failed, Status.reached)).all()
    assert "died" in results["message"].values[died].item()
    assert (np.isfinite(results["theta_end"]) == ~died).all()
