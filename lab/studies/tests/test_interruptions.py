"""Nothing is lost, and nothing that is kept is run again, when a caller or a worker is killed or the disk is full."""

import os
import re
import resource
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import psutil
import pytest
import xarray as xr
from distributed import LocalCluster

from lab.studies import Status, Study
from lab.studies.__main__ import main
from lab.studies.dataset import open_results
from lab.studies.options import arguments_of

from .studies_support import die_at_upright, same

# A chunk of wheels that fall at once, and three of wheels that roll on for 10 s, with a long history.
SPINS = [0.0] * 24 + [-2 - k / 60 for k in range(72)]
WORDS = ["--vary", f"phi_dot_start={','.join(map(str, SPINS))}", "--history", "theta", "--interval", "1e-4"]


def chunks(folder: Path) -> dict[Path, int]:
    """The chunks whose status is kept, and when each was written."""
    return {path: path.stat().st_mtime_ns for path in folder.glob("z/status/c/**/[0-9]*") if path.is_file()}


@pytest.fixture(scope="module")
def whole(alone) -> xr.Dataset:
    return alone(arguments_of(WORDS).study)


def at_a_terminal(space: int) -> None:
    """Ctrl-C interrupts. No file may grow beyond so many bytes, an error as of a full disk."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    resource.setrlimit(resource.RLIMIT_FSIZE, (space, space))


@pytest.mark.parametrize(
    ("space", "stop", "code", "words"),
    [
        (2**40, lambda caller: os.killpg(caller, signal.SIGINT), 130, "^study: stopped; the same command"),
        (2**40, lambda caller: os.kill(caller, signal.SIGKILL), -signal.SIGKILL, ""),
        (1_500_000, lambda _: None, 2, r"^study: .*/z: \[Errno 27\] File too large; results so far are kept"),
    ],
    ids=["an interrupt, as by Ctrl-C", "a killed caller", "a full disk"],
)
def test_a_study_continues_after(space, stop, code, words, tmp_path, fmu_path, crew, whole, capsys) -> None:
    """An interrupt reaches the whole session; it is for the caller alone."""
    options, place = [*WORDS, "--fmu", str(fmu_path), "--out", str(tmp_path / "z")], tmp_path
    how = {"cwd": place, "stderr": subprocess.PIPE, "text": True, "start_new_session": True}
    how |= {"preexec_fn": partial(at_a_terminal, space)}
    process = subprocess.Popen([sys.executable, "-m", "lab.studies", *options, "--workers", "1"], **how)
    give_up = time.monotonic() + 1800
    while not chunks(tmp_path) and time.monotonic() < give_up:
        time.sleep(0.01)
    workers = psutil.Process(process.pid).children(recursive=True)
    stop(process.pid)
    _, errors = process.communicate(timeout=1800)
    assert process.returncode == code and re.search(words, errors, re.MULTILINE)
    gone, alive = psutil.wait_procs(workers, timeout=1800)
    assert (gone or code == 2) and not alive
    kept, done = chunks(tmp_path), int((open_results(tmp_path / "z")["status"] != Status.not_computed).sum())
    assert 0 < done < len(SPINS) and not list(tmp_path.rglob("*.partial"))
    assert main([*options, "--scheduler", crew.scheduler_address]) == 0
    assert f"{done} of {len(SPINS)} wheels are there already" in capsys.readouterr().err
    assert main(options) == 0 and f"{len(SPINS)} of {len(SPINS)} wheels are there already" in capsys.readouterr().err
    assert kept.items() <= chunks(tmp_path).items()
    assert same(whole, open_results(tmp_path / "z"))


def test_a_worker_that_dies_costs_one_wheel(conduct, crew: LocalCluster, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crew.scheduler, "allowed_failures", 0)
    study = Study(grid={"theta_start": np.r_[1.2:1.4:32j, 1.5, 1.41:1.49:7j]}, stop_time=1.0)
    results = conduct(study, chunk=40, work=die_at_upright)
    died = results["theta_start"] == 1.5
    assert (results["status"] == np.where(died, Status.failed, Status.reached)).all()
    assert "died" in results["message"].values[died].item()
    assert (np.isfinite(results["theta_end"]) == ~died).all()
