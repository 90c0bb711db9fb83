"""What a user types after ./scripts/run is taken as typed, or refused; its results are of one run."""

import os
import re
import resource
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from support.typed import typing_tests

from wheelfmu.commands import MODULES
from wheelfmu.fmu.outputs import fresh
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.progress import bar

# What is typed, and words of the refusal. Tests of the other commands are beside them.
REFUSED = {
    "run v=18,5": "the decimal mark is a point",
    "run v=fast": "is not a number",
    "run m=1e999": "is not a number",
    "run formulation=2.7": "is not one of",
    "run theta_start=200deg": "must be",
    "run thetastart=1": "Do you mean ",
    "run mu=0.4": "Do you mean ",
    "run coni": "Do you mean ",
    "run s=0.01 s=0.02": "given twice, as ",
    "run coin bicycle_wheel": "given twice, as ",
    "run theta=1": "theta_start",
    "run slope=-8deg": "slope_direction",
    "run s": "neither name=value nor a preset wheel",
    "run s=0": "above 0",
    "run m=3m": "kg or g",
    "run v=3furlong": "it takes no unit but m/s or km/h",
    "run method=euler": "1 (automatic), 2 (adams), 3 (bdf), 4 (runge_kutta)",
    "run friction_law=0": "1 (exact), 2 (",
    "run output_interval=20": "too long",
    "run slope_direction=10%": "rad or deg",
    "run v=3 phi_dot_start=-2": "phi_dot_start follows from v",
}
TAKEN = ("run v=18.5", "run keep_contact=true method=bdf", "run keep_contact=1 formulation=3", "run coin s=1mm")

test_a_fault_is_refused_in_one_sentence_with_status_2, test_what_is_meant_is_taken = typing_tests(REFUSED, TAKEN)


def test_the_doors_differ_in_their_names_alone() -> None:
    texts = {path.name: path.read_text() for path in (ROOT / "scripts").iterdir()}
    assert {text.replace(f" {name} ", " NAME ") for name, text in texts.items()} == {
        texts["run"].replace(" run ", " NAME ")
    }


def test_a_command_is_the_same_through_a_link_and_whatever_the_environment(tmp_path: Path) -> None:
    command = ROOT / "scripts" / "run"
    (tmp_path / "link").symlink_to(command)
    (tmp_path / "scripts").mkdir()
    (tmp_path / "scripts" / "run").symlink_to("../link")
    unusual = os.environ | {"CDPATH": f".:{tmp_path}:{ROOT}", "PYTHONOPTIMIZE": "2"}
    done = [
        subprocess.run([path, "--help"], cwd=cwd, env=env, capture_output=True, text=True, check=True)
        for path, cwd, env in (
            (command, ROOT, dict(os.environ)),
            ("scripts/run", ROOT, unusual),
            ("scripts/run", tmp_path, unusual),
        )
    ]
    assert {(one.stdout, one.stderr) for one in done} == {(done[0].stdout, "")} and "phi_dot_start" in done[0].stdout


def test_a_progress_bar_is_for_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    for terminal in (False, True):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        assert bar([]).disable is not terminal


# ./scripts/run in another folder, without build and pictures; FMPy's stub leaves the mass, and fails where it is 13 kg.
RUN = """
import sys
from pathlib import Path
from wheelfmu.commands import build, processes, run
run.ROOT, run.PAGE = Path.cwd(), Path("none")
build.build = processes.status = lambda *_: 0
run.draw = lambda *_: []
run.simulation = lambda *options: ["bash", "-c", STUB, "fmpy", *options]
try:
    run.main(sys.argv[1:])
except processes.Failed as failed:
    sys.exit(failed.status)
"""
STUB = """while [ "$1" != --output-file ]; do shift; done
case " $* " in *" m 13 "*) echo "[ERROR] m = 13 is unlucky." && exit 1 ;; esac
sleep 0.5
echo "$*" | sed "s/.* m //; s/ .*//" >"$2"
"""


@pytest.fixture
def simulated(tmp_path: Path) -> Path:
    (tmp_path / "build" / "release").mkdir(parents=True)
    (tmp_path / "build" / "release" / "wheel.fmu").touch()
    return tmp_path


def runs(*words: str) -> list[str]:
    return [sys.executable, "-c", f"STUB = {STUB!r}\n{RUN}", *words]


def results(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in (folder / "results").iterdir()}


def test_the_results_of_a_run_stay_until_the_next_has_succeeded(simulated: Path) -> None:
    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(runs(*words), cwd=simulated, capture_output=True, text=True)

    assert run("m=12").returncode == 0
    (simulated / "results" / "mine.txt").write_text("notes")
    before = results(simulated)
    tables = {"free.csv": "12\n", "friction.csv": "12\n"}
    assert before == tables | {"free.log": "", "friction.log": "", "mine.txt": "notes"}
    done = run("m=13")
    assert done.returncode == 1 and "m = 13 is unlucky." in done.stderr and results(simulated) == before
    assert run("m=14").returncode == 0 and results(simulated) == before | {"free.csv": "14\n", "friction.csv": "14\n"}


def test_of_two_runs_at_once_each_prints_that_its_own_results_are_ready(simulated: Path) -> None:
    """One waits for the other: the results in the folder are of one run."""
    at_once = [
        subprocess.Popen(runs(f"m={m}"), cwd=simulated, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for m in (12, 14)
    ]
    said = [one.communicate() for one in at_once]
    assert all(one.returncode == 0 for one in at_once) and sum(len(errors) > 0 for _, errors in said) <= 1
    found = results(simulated)
    assert found["free.csv"] == found["friction.csv"] and found["free.csv"] in ("12\n", "14\n")


def test_only_one_process_at_a_time_uses_a_place(tmp_path: Path) -> None:
    """The second waits for the first; at another place it does not. Each has its own TMPDIR, as host and container."""
    program = "import sys, time; from wheelfmu.fmu.outputs import alone; from pathlib import Path; t = time.monotonic\n"
    program += "with alone(Path(sys.argv[1])): print(t(), flush=True); time.sleep(1); print(t())"

    def spans(*places: str) -> list[list[float]]:
        commands = [[sys.executable, "-c", program, tmp_path / place] for place in places]
        started = []
        for k, words in enumerate(commands):
            (own := tmp_path / f"tmp_{k}").mkdir(exist_ok=True)
            how = {"env": os.environ | {"TMPDIR": str(own)}, "stdout": subprocess.PIPE, "text": True}
            started.append(subprocess.Popen(words, **how))
        return sorted([float(t) for t in one.communicate()[0].split()] for one in started)

    first, second = spans("a", "a")
    assert first[1] <= second[0]
    first, second = spans("a", "b")
    assert second[0] < first[1]


def test_two_processes_of_one_number_as_in_two_containers_write_to_files_of_their_own(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(os, "getpid", lambda: 7)
    with fresh(tmp_path / "a") as one, fresh(tmp_path / "a") as other:
        assert one != other and one.parent == other.parent == tmp_path
        one.touch()
        other.touch()


SMALL = 500_000  # bytes that a file may have, an error as of a full disk
WRITES = {"run": ("run", "wheel.fmu"), "view": ("view rolls.csv", "rolls.html")}  # a study: lab/studies/tests
WRITES = {name: how for name, how in WRITES.items() if name in MODULES}


@pytest.mark.parametrize("name", WRITES)
def test_a_full_disk_ends_a_command_with_one_sentence_and_leaves_nothing_half_written(tmp_path: Path, name) -> None:
    def files() -> dict[Path, int]:
        places = [tmp_path.iterdir(), ROOT.glob("wheel.fmu"), ROOT.glob(".*.wheel.fmu"), ROOT.glob("results/.new-*/*")]
        return {path: path.stat().st_mtime_ns for place in places for path in place}

    (tmp_path / "rolls.csv").write_text("time,X_O,Y_O,psi,theta,phi\n0,0,0,0,1.5,0\n1,1,0,0,1.5,-3\n")
    before, (line, written) = files(), WRITES[name]
    words = [sys.executable, "-P", "-m", "wheelfmu", *line.split()]
    limit = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (SMALL, SMALL))
    # The programs of ./scripts: a different cmake would build all anew, under the limit.
    path = {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    how = {"env": os.environ | path, "preexec_fn": limit, "capture_output": True, "text": True}
    done = subprocess.run(words, cwd=tmp_path, **how)
    said = re.sub("^Waiting for another process.*\n", "", done.stderr)
    assert re.fullmatch(rf"{name}: .*{written}: File too large\.\n", said) and done.returncode == 2, done
    assert files() == before


def test_a_full_disk_behind_the_output_is_one_sentence_and_a_reader_that_has_gone_none() -> None:
    words = [sys.executable, "-P", "-m", "wheelfmu", "help"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(words, stdout=full, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (2, "help: the output: No space left on device.\n")
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(words, stdout=writer, stderr=subprocess.PIPE, text=True)
    os.close(writer)
    assert (done.returncode, done.stderr) == (128 + signal.SIGPIPE, "")


def test_a_folder_in_the_place_of_a_file_is_named(simulated: Path) -> None:
    (simulated / "wheel.fmu").mkdir()
    (simulated / "wheel.fmu" / "mine.txt").touch()
    done = subprocess.run(runs(), cwd=simulated, capture_output=True, text=True)
    assert done.stderr.endswith(
        "wheel.fmu is a folder, and a file is to be written there: rename or delete the folder.\n"
    )
    assert (simulated / "wheel.fmu" / "mine.txt").exists()


def test_what_a_killed_command_leaves_goes_with_the_next(tmp_path: Path) -> None:
    program = "import os, sys; from wheelfmu.fmu.outputs import new_folder; from pathlib import Path\n"
    program += (
        "with new_folder(Path(sys.argv[1])) as new: (new / 'part').touch(); os.kill(os.getpid(), 9 * len(sys.argv[2:]))"
    )
    for words, left in ((["killed"], 1), ([], 0)):
        subprocess.run([sys.executable, "-c", program, tmp_path, *words], check=False)
        assert len([*tmp_path.glob(".new-*")]) == left
