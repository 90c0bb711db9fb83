"""Studies on clusters: the same bits with one worker and with many, after a kill, and on a scheduler elsewhere."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from study import Status, Study, StudyError, compute
from study.__main__ import arguments_of, study_file, study_of_options
from study.compute import run
from study.store import open_results
from study.worker import run_block

ROOT = Path(__file__).resolve().parents[3]
GUIDE = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
EXAMPLE = re.findall(r"^```python\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)[0]


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two results agree to the bit, times of computing aside."""
    timed = ["wall_time", "fmu_time"]
    return a.drop_vars(timed).load().identical(b.drop_vars(timed).load())


def command(*options: object, **more: object) -> subprocess.Popen:
    """The command behind ./scripts/study, in the Python of the tests."""
    path = os.pathsep.join(str(ROOT / folder) for folder in ("examples/studies", "."))
    words = [sys.executable, "-m", "study", *map(str, options)]
    return subprocess.Popen(words, env=os.environ | {"PYTHONPATH": path}, stderr=subprocess.PIPE, text=True, **more)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("study") / "grid.py"
    path.write_text(EXAMPLE)
    return path


@pytest.fixture(scope="module")
def here(fates: Study, fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The study of all fates, run by one worker on this machine."""
    out = tmp_path_factory.mktemp("here") / "fates.zarr"
    run(fates, out, fmu=fmu_path, workers=1, quiet=True, block=4)
    return out


def kill(process: subprocess.Popen) -> None:
    """SIGKILL to the process and to its workers, which are in its session."""
    os.killpg(process.pid, signal.SIGKILL)
    process.communicate()


def test_the_guide_keeps_its_promise_of_ten_lines() -> None:
    assert len(EXAMPLE.splitlines()) <= 10


def test_the_guides_command_line_is_the_study_of_its_file(file: Path) -> None:
    words = shlex.split(re.search(r"scripts/study (--vary.*?)```", GUIDE, re.DOTALL)[1].replace("\\\n", " "))
    assert study_of_options(arguments_of(words)).spec() == study_file(str(file))["study"].spec()
    other = ["s=0.02" if word == "s=0.01" else word for word in words]
    assert study_of_options(arguments_of(other)).spec() != study_file(str(file))["study"].spec()


def test_a_killed_study_goes_on_where_it_was_and_has_the_bits_of_one_worker(file: Path, fmu_path: Path) -> None:
    first, whole = file.with_name("killed.zarr"), file.with_name("whole.zarr")
    options = (file, "--fmu", fmu_path, "--out")
    process = command(*options, first, "--workers", 2, start_new_session=True)
    give_up = time.monotonic() + 60
    while not list(first.glob("status/c/*/*")) and time.monotonic() < give_up:
        time.sleep(0.02)
    kill(process)
    done = open_results(first)["status"].load()
    left = int((done == Status.not_computed).sum())
    assert 0 < left < done.size
    kept = {path: path.stat().st_mtime_ns for path in first.glob("lowest/c/*/*")}
    process = command(*options, first, "--workers", 2)
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 0
    assert f"{done.size - left} of {done.size} wheels are there already" in errors
    untouched = [path for path, when in kept.items() if path.stat().st_mtime_ns == when]
    assert 252 * len(untouched) >= done.size - left  # the blocks are 7 x 36 wheels
    study = study_file(str(file))["study"]
    assert same(open_results(first), run(study, whole, fmu=fmu_path, workers=1, quiet=True))


def test_results_are_labelled_and_carry_what_is_needed_to_repeat_them(fates: Study, here: Path, fmu_path: Path) -> None:
    results = open_results(here).load()
    assert dict(results.sizes) == {"theta_start": 3, "s": 2, "phi_dot_start": 4, "time": 101}
    assert results["theta"].dims == ("theta_start", "s", "phi_dot_start", "time")
    assert results["lowest"].attrs["units"] == results["theta_start"].attrs["units"] == "rad"
    fates_seen = {Status(code).name for code in np.unique(results["status"])}
    assert fates_seen == {"reached", "flat", "lifted_off", "refused"}
    assert set(results.attrs) >= {"fmu_sha256", "fmu_version", "fmu_guid", "seed", "numpy_version", "study"}
    begun = results.sel(theta_start=np.radians(75.0), s=0.03, phi_dot_start=-2.0)
    assert float(begun["theta"][0]) == np.radians(75.0)
    with pytest.raises(StudyError, match="another study"):
        run(Study(grid={"s": [0.0]}), here, fmu=fmu_path, quiet=True)
    assert same(results, run(fates, here, fmu=fmu_path, scheduler="tcp://nobody:1", quiet=True))  # nothing left to run


def die_at_upright(upload: str, job: object, points: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """As a worker does it, but the process dies where a wheel starts at exactly 1.5 rad."""
    if (points["theta_start"] == 1.5).any():
        os._exit(1)
    return run_block(upload, job, points)


def test_an_interrupt_is_for_the_caller_alone() -> None:
    ask = [sys.executable, "-c", "import signal; print(signal.getsignal(signal.SIGINT).name)"]
    with compute.uninterrupted():
        assert subprocess.check_output(ask, text=True).strip() == "SIG_IGN"
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    assert subprocess.run(ask, capture_output=True, check=False).returncode == 1  # Python's own handler has no name


def test_a_worker_that_dies_costs_one_point(fmu_path: Path, tmp_path: Path) -> None:
    study = Study(grid={"theta_start": [1.2, 1.3, 1.4, 1.5]}, stop_time=1.0)
    results = run(study, tmp_path / "d.zarr", fmu=fmu_path, workers=1, quiet=True, block=4, work=die_at_upright)
    assert results["status"].values.tolist() == [Status.reached] * 3 + [Status.failed]
    assert "died" in results["message"].values[3]
    assert np.isfinite(results["theta_end"].values[:3]).all()


def address_in(path: Path) -> str:
    """The address that a scheduler has written into its file, as soon as the file is complete."""
    give_up = time.monotonic() + 60
    while time.monotonic() < give_up:
        with suppress(OSError, json.JSONDecodeError):
            return json.loads(path.read_text())["address"]
        time.sleep(0.05)
    raise TimeoutError("The scheduler did not start within a minute.")


@contextmanager
def elsewhere(folder: Path, workers: int = 1) -> Iterator[str]:
    """A scheduler and workers with two threads as one starts them on other machines: without this package's path."""
    address_file = folder / "scheduler.json"
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    quiet = {"env": clean, "cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    dask = [sys.executable, "-m", "dask"]
    shared = ["--scheduler-file", str(address_file), "--no-dashboard", "--interface", "lo"]
    options = ["--nthreads", "2", "--no-nanny", "--no-dashboard", "--interface", "lo"]
    scheduler = subprocess.Popen([*dask, "scheduler", *shared, "--port", "0"], **quiet)
    started = []
    try:
        address = address_in(address_file)  # before the workers start: they stop at a file that is only half there
        started += [subprocess.Popen([*dask, "worker", address, *options], **quiet) for _ in range(workers)]
        yield address
    finally:
        for process in (*started, scheduler):
            process.terminate()
            process.wait(30)


def test_a_cluster_elsewhere_gives_the_same_bits(fates: Study, here: Path, fmu_path: Path, tmp_path: Path) -> None:
    with elsewhere(tmp_path) as address:
        there = run(fates, tmp_path / "there.zarr", fmu=fmu_path, scheduler=address, quiet=True, block=8)
    assert same(there, open_results(here))


def test_a_study_without_workers_says_so(
    fates: Study, fmu_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute, "LOST", 2.0)
    with elsewhere(tmp_path, workers=0) as address, pytest.raises(StudyError, match="no worker"):
        run(fates, tmp_path / "nobody.zarr", fmu=fmu_path, scheduler=address, quiet=True)


def test_the_command_exports_tables_and_says_in_a_sentence_what_is_wrong(fmu_path: Path, tmp_path: Path) -> None:
    starts = tmp_path / "starts.csv"
    starts.write_text("theta_start,phi_dot_start\n75deg,-2\n1.2,0\n")
    out = ("--fmu", fmu_path, "--out", tmp_path / "list.zarr")
    process = command("--list", starts, *out, "--workers", 1, "--csv", "--netcdf", stdout=subprocess.PIPE)
    told, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    assert "1 flat" in told
    table = (tmp_path / "list.csv").read_text().splitlines()
    assert len(table) == 3
    assert table[0].startswith("wheel,")
    assert xr.open_dataset(tmp_path / "list.nc")["theta_start"].values[0] == np.radians(75)
    process = command("--vary", "s=zero", *out)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 2
    assert errors.strip().startswith("study: --vary s=zero: write")
