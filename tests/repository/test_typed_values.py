"""What a user types is taken as typed, or refused: each kind of fault, over all commands that read it."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from wheelfmu.fmu.csv_file import read_table
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.progress import bar
from wheelfmu.fmu.values import Fault

MOTION = "time,X_O\n0,0\n1,1\n"
# For each kind: words of the refusal, and what is typed after each command.
FAULTS = {
    "a decimal comma": (
        "the decimal mark is a point",
        "run v=18,5",
        "study --vary theta_start=1,1:1,2:3",
        "study --vary s=0,01,0,02",
        "study --vary s=0,0.1 --set m=12,5",
        "study --vary s=0,0.1 --stop-time 2,5",
        "example car v=18,5",
        "example balance k_theta=2,5",
        "view motion.csv --r_0 0,3 --r 0,05",
    ),
    "no number": (
        "is not a number",
        "run v=fast",
        "run m=1e999",
        "study --vary s=0,1e999",
        "study --vary s=0,,1",
        "study --vary s=0,0.1 --set m=heavy",
        "study --vary s=0,0.1 --interval soon",
        "example car v=fast",
        "view motion.csv --slope steep",
    ),
    "not one of the words, or a part of a whole number": (
        "is not one of",
        "run formulation=2.7",
        "study --vary formulation=1:3:5",
        "study --vary s=0,0.1 --set formulation=2.7",
        "study --vary keep_contact=true,maybe",
        "example car path=1.5",
        "example suspended follow=0.5",
        "example car manoeuvre=loop",
    ),
    "beyond a limit": (
        "must be",
        "run theta_start=200deg",
        "study --vary s=-1:1:3",
        "study --vary s=0,0.1 --set m=-5",
        "example car s=-1",
        "example car slope=95deg",
        "view motion.csv --slope 95deg",
        "view motion.csv --r_0 -1 --r 0",
    ),
    "a name that is not there": (
        "Do you mean ",
        "run thetastart=1",
        "run mu=0.4",
        "run coni",
        "run wheel=coni",
        "run body=tours",
        "study --vary mu=0.4",
        "study --vary brake=60",
        "study --vary s=0,0.1 --set masss=1",
        "study --vary s=0,0.1 --measure a=max(tetha)",
        "study --vary s=0,0.1 --history Thetta",
        "study --vary s=0,0.1 --wheel coni",
        "study --vary s=0,0.1 --body tours",
        "example cra",
        "example car vv=5",
        "example car manoeuvre=lanes",
        "report sped",
    ),
    "given twice": (
        "given twice, as ",
        "run s=0.01 s=0.02",
        "run coin bicycle_wheel",
        "run coin wheel=coin",
        "run body=torus disc",
        "study --vary s=0,0.1 --vary s=1,2",
        "study --vary s=0,0.1 --set m=10 --set m=30",
        "study --vary s=0,0.1 --measure a=theta --measure a=lowest",
        "study --vary s=0,0.1 --out a.zarr --out b.zarr",
        "study --vary s=0,0.1 --stop-time 1 --stop-time 2",
        "example car v=3 v=4",
        "view motion.csv --title a --title b",
    ),
    "an option that is cut short": (
        "unrecognized arguments",
        "study --vary s=0,0.1 --over",
        "report speed --pub",
    ),
    "neither a name nor a value": (
        "of the form",
        "study --vary s=0,0.1 --set m",
        "study --vary =1",
        "study --vary s=0,0.1 --measure low=",
        "example car v",
    ),
    "a file that is read": ("is read", "view motion.csv --output motion.csv", "view motion.csv -o ./motion.csv"),
    "a file of somebody else": ("is not of this command", "view motion.csv --output thesis.html"),
}
# Of ./scripts/run, each with its words.
OF_RUN = {"theta=1": "theta_start", "slope=-8deg": "slope_direction", "s": "neither name=value nor a preset"}
OF_RUN |= {"s=0": "above 0", "m=3m": "kg or g", "v=3furlong": "it takes no unit but m/s or km/h", "hopp": "hoop"}
OF_RUN |= {"method=euler": "1 (automatic), 2 (adams), 3 (bdf), 4 (runge_kutta)", "friction_law=0": "1 (exact), 2 ("}
OF_RUN |= {"output_interval=20": "too long", "wheel=tank": "There is no wheel", "slope_direction=10%": "rad or deg"}
OF_RUN |= {"body=ball": "There is no body", "v=3 phi_dot_start=-2": "phi_dot_start follows from v"}
OF_RUN |= {"body=torus m=12kg J_z=1": "J_z follows from m, r_0 and r with body=torus"}
# Of ./scripts/study.
OF_STUDY = {"--vary s=0:1:one": "write --vary NAME=1,2,3 or NAME=first:last:count", "": "Which wheels? Give an example"}
OF_STUDY |= {
    "fate": "the examples are fates, grip, uptime. Do you mean fates?",
    "--body ball --vary s=0,1": "torus, disc, hoop",
}
OF_STUDY |= {"--body disc --vary J_z=1,2": "'J_z' follows from m, r_0 and r with body disc: leave one of the two out"}
TYPED = [(words, line) for words, *lines in FAULTS.values() for line in lines]
TYPED += [(words, f"run {line}") for line, words in OF_RUN.items()]
TYPED += [(words, f"study {line}") for line, words in OF_STUDY.items()]


def asked(folder: Path, line: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """What the command's reader, by the standard library alone, makes of a line."""
    reads = [sys.executable, "-S", "-B", str(ROOT / "tools"), *line.split()]
    return subprocess.run(reads, cwd=folder, env=os.environ | environment, capture_output=True, text=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("typed")
    (place / "motion.csv").write_text(MOTION)
    (place / "thesis.html").write_text("years of work")
    return place


@pytest.mark.parametrize(("words", "line"), TYPED, ids=[line for _, line in TYPED])
def test_a_fault_of_any_kind_is_refused_by_every_command_in_one_sentence_with_status_2(folder, words, line) -> None:
    done = asked(folder, line)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert words in done.stderr and done.stderr.count("\n") == 1
    assert ((folder / "motion.csv").read_text(), (folder / "thesis.html").read_text()) == (MOTION, "years of work")


TAKEN = ("run v=18.5", "run keep_contact=true method=bdf", "run keep_contact=1 formulation=3", "run coin s=1mm")
TAKEN += ("study --vary formulation=1,multibody --set keep_contact=true --set method=bdf", "study --vary s=0:0.1:3")
TAKEN += ("example car path=1 v=18.5", "example suspended exchange=held")
TAKEN += ("view motion.csv --slope 12% --r_0 30cm --r 5cm",)
TAKEN += ("view motion.csv --output thesis.html --overwrite", "report speed --publish")


@pytest.mark.parametrize("line", TAKEN)
def test_what_is_meant_is_taken(folder, line) -> None:
    done = asked(folder, line, PYTHONOPTIMIZE="2")
    assert (done.returncode, done.stderr) == (0, "")


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


GOOD = "theta_start,phi_dot_start\n75deg,-2\n1.2,0\n"
SPREADSHEETS = {
    "a byte-order mark": "\ufeff" + GOOD,
    "lines of Windows": GOOD.replace("\n", "\r\n"),
    "blanks beside the commas": GOOD.replace(",", " , "),
    "a trailing comma in each row": GOOD.replace("\n", ",\n"),
    "a trailing comma in the first row": GOOD.replace("start\n", "start,\n"),
    "empty rows": GOOD.replace("\n", "\n\n,\n") + ",,\n",
    "quotes": re.sub(r"[^,\n]+", r'"\g<0>"', GOOD),
    "no end of the last line": GOOD.rstrip(),
}


@pytest.mark.parametrize("text", SPREADSHEETS.values(), ids=SPREADSHEETS)
def test_a_table_is_read_as_spreadsheets_write_it(tmp_path: Path, text: str) -> None:
    (tmp_path / "starts.csv").write_text(text, newline="")
    expected = {"theta_start": ["75deg", "1.2"], "phi_dot_start": ["-2", "0"]}
    assert read_table(tmp_path / "starts.csv").columns == expected
    assert asked(tmp_path, "study --list starts.csv").returncode == 0


REFUSED = {
    "theta_start,phi_dot_start\n75deg,-2\n\n1.2,zero\n": 'line 4, column 2: phi_dot_start = "zero" is not a number',
    'theta_start,phi_dot_start\n"1,2","-2,5"\n': 'line 2, column 1: theta_start = "1,2" is not one number',
    "theta_start\n0:0.03:2\n": 'line 2, column 1: theta_start = "0:0.03:2"',
    "formulation\n1\n2.7\n": "line 3, column 1: formulation = 2.7 is not one of",
    "theta_start,theta_start\n1.2,1.3\n": "theta_start is given twice, as column 1 and as column 2",
    "theta_start;phi_dot_start\n1,2;-2\n": "semicolons separate its columns",
    '"theta_start";"phi_dot_start"\n"1.2";"-2"\n': "semicolons separate its columns",
    "theta_start\tphi_dot_start\n1.2\t-2\n": "tabs separate its columns",
    ",theta_start\n0,1.2\n": "column 1 has no name",
    "theta_start,s\n1.2\n": "line 2: 1 values for the 2 names",
    "theta_start,s\n1.2,0,7\n": "line 2: 3 values for the 2 names",
    "theta_start,s\n1.2,\n": 's = "" is not a number',
    "theta_start,s\n": "has no rows",
    "": "has no rows",
    "theta_strat\n1.2\n": "Do you mean theta_start",
}


@pytest.mark.parametrize(("text", "words"), REFUSED.items())
def test_a_table_that_cannot_be_meant_is_refused_with_its_place_and_content(tmp_path: Path, text, words) -> None:
    (tmp_path / "starts.csv").write_text(text)
    done = asked(tmp_path, "study --list starts.csv")
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


def test_a_file_in_another_encoding_is_refused_with_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "starts.csv").write_bytes(GOOD.encode("utf-16"))
    with pytest.raises(Fault, match="it is not UTF-8 text"):
        read_table(tmp_path / "starts.csv")


def test_every_progress_bar_is_the_one_for_terminals(monkeypatch: pytest.MonkeyPatch) -> None:
    texts = {path.name: path.read_text() for part in ("tools", "examples") for path in (ROOT / part).rglob("*.py")}
    assert [name for name, text in texts.items() if re.search(r"\btqdm\(", text)] == ["progress.py"]
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
    """The second waits for the first; at another place it does not."""
    program = "import sys, time; from wheelfmu.fmu.outputs import alone; from pathlib import Path; t = time.monotonic\n"
    program += "with alone(Path(sys.argv[1])): print(t(), flush=True); time.sleep(1); print(t())"

    def spans(*places: str) -> list[list[float]]:
        commands = [[sys.executable, "-c", program, tmp_path / place] for place in places]
        started = [subprocess.Popen(c, stdout=subprocess.PIPE, text=True) for c in commands]
        return sorted([float(t) for t in one.communicate()[0].split()] for one in started)

    first, second = spans("a", "a")
    assert first[1] <= second[0]
    first, second = spans("a", "b")
    assert second[0] < first[1]


def test_what_a_killed_command_leaves_goes_with_the_next(tmp_path: Path) -> None:
    program = "import os, sys; from wheelfmu.fmu.outputs import new_folder; from pathlib import Path\n"
    program += (
        "with new_folder(Path(sys.argv[1])) as new: (new / 'part').touch(); os.kill(os.getpid(), 9 * len(sys.argv[2:]))"
    )
    for words, left in ((["killed"], 1), ([], 0)):
        subprocess.run([sys.executable, "-c", program, tmp_path, *words], check=False)
        assert len([*tmp_path.iterdir()]) == left
