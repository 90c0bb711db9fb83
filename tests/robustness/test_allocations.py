"""Memory that runs short: every allocation of an instance's life fails in turn, once, or from there on for good."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from support.driver import ERROR, OK
from support.paths import ROOT

pytestmark = pytest.mark.contract

FAULTS = ROOT / "tests" / "robustness" / "faults"
HEADERS = Path(importlib.util.find_spec("fmpy").submodule_search_locations[0]) / "c-code"

# formulation, friction law, method (4: Runge-Kutta): here every allocation is our own. SUNDIALS does not survive each
# of its own that fails (docs/decisions/memory.md), so its methods are not played with.
SCENES = {
    "reduced": (2, 1, 4),
    "multibody": (3, 1, 4),
    "reduced, regularized": (2, 2, 4),
}

Play = Callable[..., subprocess.CompletedProcess[str]]


def compile_c(output: Path, *sources: str, options: tuple[str, ...] = ()) -> Path:
    rows = [ROOT / "cmake" / "variable_rows.py", ROOT / "modelDescription.xml", output.parent / "variables.inc"]
    subprocess.run([sys.executable, *map(str, rows)], check=True)
    clean = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    folders = (HEADERS, output.parent, ROOT / "tests" / "support")
    flags = ["-std=c11", "-O1", "-g", "-Wall", "-Wextra", "-Werror", *(f"-I{folder}" for folder in folders)]
    files = [str(FAULTS / source) for source in sources]
    subprocess.run(["cc", *flags, *options, *files, "-o", str(output), "-ldl"], check=True, env=clean)
    return output


@pytest.fixture(scope="module")
def play(tmp_path_factory: pytest.TempPathFactory, description) -> Play:
    """play(library, scene, companions): all lives of an instance of the library, by faults.c."""
    program = compile_c(tmp_path_factory.mktemp("faults") / "faults", "faults.c", "memory.c", "unit.c")

    def run(library: Path, scene: tuple[int, ...] = (1, 1, 1), companions: int = 0, seconds: int = 120):
        arguments = [str(program), str(library), description.guid, *map(str, scene), str(companions), str(seconds)]
        return subprocess.run(arguments, capture_output=True, text=True, check=False, timeout=300)

    return run


@pytest.fixture(scope="module")
def library(fmu: str) -> Path:
    paths = Path(fmu).glob("binaries/*linux*/wheel.so")  # a release also holds one for arm
    return max(paths, key=lambda path: path.parent.name == "linux64")


@pytest.fixture(scope="module")
def counted(play: Play, library: Path) -> dict[str, dict[str, int]]:
    """What faults.c counted in each scene."""
    results = {name: play(library, scene) for name, scene in SCENES.items()}
    assert {(result.returncode, result.stderr) for result in results.values()} == {(0, "")}
    return {name: json.loads(result.stdout) for name, result in results.items()}


def test_no_failed_allocation_crashes_hangs_leaks_goes_untold_or_changes_a_later_bit(counted):
    # the instance and the table of instances; a state and the table of states, the scratch instance that judges bytes,
    # and the state that they become: each failed
    assert {(n["failed_once"], n["failed_for_good"]) for n in counted.values()} == {(6, 6)}


def test_an_instance_is_one_block_and_runs_without_any_more_memory(counted):
    for n in counted.values():
        assert n["start"] == 2  # the second is the table of live instances, where it grows
        assert n["run"] == 0
        assert n["snapshots"] == 4
        assert n["bytes"] < 12_500  # 11,736


def test_the_table_of_live_instances_grows_or_refuses_the_instance(play, library):
    # It has 16 places and is doubled when half full: for the ninth instance, not for the eighth.
    failed = {}
    for companions in (7, 8):
        result = play(library, SCENES["reduced"], companions)
        assert (result.returncode, result.stderr) == (0, "")
        failed[companions] = json.loads(result.stdout)["failed_once"]
    assert failed == {7: 5, 8: 6}


@pytest.mark.parametrize(
    ("flaw", "status", "broken"),
    [
        ("CRASHES", -signal.SIGSEGV, ""),
        ("HANGS", -signal.SIGALRM, ""),
        ("LEAKS", 1, "memory has leaked"),
        ("KEEPS_SILENT", 1, "no sentence"),
        ("STAYS_BROKEN", 1, "a reset instance does not run"),
        ("COUNTS_ELSE", 1, "other bits"),
        ("READS_UNWRITTEN", 1, "other bits"),
    ],
)
def test_each_flaw_of_a_careless_unit_is_found(play, tmp_path, flaw, status, broken):
    """The partners: a unit that takes memory in four places, with one flaw each."""
    careless = compile_c(tmp_path / "careless.so", "careless.c", options=("-shared", "-fPIC", f"-DFLAW={flaw}"))
    result = play(careless, seconds=2 if flaw == "HANGS" else 120)
    crash_reported = "AddressSanitizer: SEGV" in result.stderr  # in place of the signal
    assert result.returncode == (1 if crash_reported else status)
    assert broken in result.stderr
    assert crash_reported <= (flaw == "CRASHES")


def test_a_sound_unit_passes_and_all_its_allocations_failed(play, tmp_path):
    sound = compile_c(tmp_path / "sound.so", "careless.c", options=("-shared", "-fPIC", "-DFLAW=NONE"))
    result = play(sound)
    assert (result.returncode, result.stderr) == (0, "")
    counts = json.loads(result.stdout)
    assert (counts["start"], counts["run"], counts["snapshots"]) == (1, 1, 2)
    assert counts["failed_once"] == counts["failed_for_good"] == 4


def test_a_solver_that_gives_up_tells_its_reason_in_one_sentence_with_the_callers_time(wheel):
    w = wheel().start(start=7.0, method=2)
    assert (w.step(0.5), w.take_messages()) == (OK, [])
    assert (w.set(M_3=1e300), w.step(0.5)) == (OK, ERROR)
    (message,) = w.take_messages()
    assert message.text.startswith("The solver stopped at t = 7.5 s, where omega_z = ")
    assert message.text.endswith("rad/s: the error stays too large however small the step.")
