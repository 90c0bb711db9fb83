"""The examples of the documents run as they are written. The scenes are the paper's, SI units."""

import os
import re
import subprocess
import sys
from importlib.metadata import distributions
from pathlib import Path

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.printed import PAGES

from wheelfmu.commands import MODULES
from wheelfmu.fmu.paths import ROOT, build_folder
from wheelfmu.truth.closed_forms import fall_inertia
from wheelfmu.truth.measure import paper_errors
from wheelfmu.truth.scenes import PAPER

README, TOOLS, RECIPES = (PAGES[name] for name in ("README.md", "docs/in_your_tool.md", "docs/recipes.md"))
VEHICLE, CONTROL = PAGES["docs/vehicle.md"], PAGES["docs/linearize_and_control.md"]
HEADER_PAGE = PAGES["docs/c_header.md"]
EXAMPLES = ROOT / "examples" / "python"


def blocks(language: str, page: str = README) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.MULTILINE | re.DOTALL)


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """A folder that looks like the project's root after a build and a release, without results/."""
    for name in ("build", "dist"):
        (tmp_path / name).mkdir()
    (tmp_path / "build" / "release").symlink_to(build_folder())
    for name in ("fmu-src", "examples", "scripts"):
        (tmp_path / name).symlink_to(ROOT / name)
    for name in ("wheel.fmu", "dist/wheel.fmu"):
        (tmp_path / name).symlink_to(build_folder() / "wheel.fmu")
    return tmp_path


def run(*command: str | Path, folder: Path) -> str:
    """What the command prints. The environment is that of an activated .venv, without a screen; what a user's pip
    installs is in it, and stays alone: FMPy's own CMake would build all anew."""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    environment |= {"MPLBACKEND": "Agg", "PIP_NO_DEPS": "1"}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=1800)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def bash(commands: str, folder: Path) -> str:
    return run("bash", "-euc", commands, folder=folder)


def python(lines: str, folder: Path) -> str:
    return run("python", "-c", lines, folder=folder)


def table(path: Path) -> np.ndarray:
    return np.genfromtxt(path, delimiter=",", names=True)


def test_the_python_example_has_a_few_lines_and_draws_the_papers_wheel(root, references):
    (shown,) = blocks("python")
    assert len(shown.splitlines()) <= 6
    free = shown.replace('"s": 0.03', '"s": 0')
    for scene, other, lines in (("friction", "free", shown), ("free", "friction", free)):
        python(f"{lines}import numpy\nnumpy.save('run.npy', run)", root)
        picture = root / "theta.png"
        assert picture.read_bytes().startswith(b"\x89PNG")
        picture.unlink()
        theta = np.load(root / "run.npy")["theta"][::10]
        within(np.abs(theta - references[scene]["theta"]).max(), 3e-8, "theta off the reference, rad")
        beyond(np.abs(theta - references[other]["theta"]).max(), 0.08, "theta off that of the other scene, rad")


def test_the_readme_names_the_packages_that_root_installs():
    rows = [line.split() for line in (ROOT / "tools" / "packages").read_text(encoding="utf-8").splitlines()]
    sentence = re.search(r"install the Debian packages (.*?), as far as", README, re.DOTALL)[1]
    assert re.findall("`(.*?)`", sentence) == sorted(row[1] for row in rows if row[0] == ".")


@pytest.mark.parametrize("scene", ["free", "friction"])
def test_the_readmes_errors_are_those_that_the_glossary_defines(library, scene):
    figure = float(re.search(rf"([\d.e-]+)<!--accuracy.error_{scene}-->", README)[1])
    error = max(paper_errors(library, scene).values())
    within(abs(np.log2(error / figure)), 1, "error over the README's, in doublings")
    coarse = max(paper_errors(library, scene, 1e-6).values())
    beyond(abs(np.log2(coarse / figure)), 2, "error at a looser tolerance over the README's, in doublings")


def test_the_readmes_commands_for_a_downloaded_file_give_friction_on_any_system(root, references):
    """Those for PowerShell, translated word by word, give the same file."""
    (commands,), (windows,) = blocks("bash"), blocks("powershell")
    installed = {one.name for one in distributions()}
    bash(commands, root)
    file, found = root / "friction.csv", []
    for words in ("", windows.replace("py -m", "python -m").replace("\\", "/")):
        bash(words, root)
        found.append(file.read_bytes())
    assert found[0] == found[1] and len(windows.splitlines()) == len(commands.splitlines()) == 2
    assert {one.name for one in distributions()} == installed
    error = np.abs(table(file)["X_O"][::10] - references["friction"]["X_O"]).max()
    within(error, 3e-8, "X_O off the reference, m")
    beyond(np.abs(table(file)["X_O"][::10] - references["free"]["X_O"]).max(), 0.1, "X_O of the free wheel, m")


def test_the_commands_for_fmpy_do_what_their_comments_say(root):
    commands, varying = blocks("bash", TOOLS)
    view = "./scripts/view driven.csv\n"  # of a folder of the lab, which may be absent
    assert varying.endswith(view)
    log = bash(commands, root) + bash(varying if "view" in MODULES else varying.removesuffix(view), root)
    assert "No problems found" in log and (root / "driven.html").is_file() == ("view" in MODULES)
    for word in ("stick", "release", "reversal", "lies flat"):
        assert word in log, word
    energy = table(root / "energy.csv")
    assert energy.dtype.names == ("time", "theta", "E")
    within(np.ptp(energy["E"]) / energy["E"][0], 2e-12, "range of the energy, relative")  # friction takes a quarter
    fall = table(root / "fall.csv")
    assert round(fall["time"][-1], 2) == 0.59
    within(fall["theta"][-1], 1e-6, "least theta, rad")
    speeds_up_as_newton_says(table(root / "driven.csv"))


def speeds_up_as_newton_says(driven: np.ndarray) -> None:
    late = 0.01 / 2  # FMPy holds an input over its step of 0.01 s: on the ramp it lags by half a step
    m, R, J_z, impulse = 20, 0.35, 1.8, 2 * (0.5 - late) + 2 * 9
    speed = R * impulse / (J_z + m * R * R)  # m/s, O of an upright wheel under a torque about its axle
    velocity = np.hypot(driven["X_O_dot"][-1], driven["Y_O_dot"][-1])
    within(abs(velocity / speed - 1), 64 * EPSILON, "velocity, relative")
    beyond(abs(velocity / (speed * 19 / impulse) - 1), 4e-5, "velocity by a ramp without its lag, relative")


def test_the_recipe_for_a_speed_starts_at_that_speed(root):
    (command,) = blocks("bash", RECIPES)
    bash(command, root)
    start = table(root / "five.csv")[0]
    assert [start["X_O"], start["Y_O"], start["Y_O_dot"]] == [0, 0, 0]
    speed = np.hypot(start["X_O_dot"], start["Y_O_dot"])
    within(abs(speed - 5), 1e-6, "speed off 5, m/s")
    beyond(abs(0.3 / 0.35 * speed - 5), 0.5, "speed with the lever r_0 off 5, m/s")


def test_the_c_example_compiles_anywhere_and_prints_what_the_python_example_prints(root, tmp_path_factory):
    (commands,) = blocks("bash", HEADER_PAGE)
    assert "wheel=/path/to/this/project\n" in commands
    here = tmp_path_factory.mktemp("anywhere")
    printed = bash(commands.replace("/path/to/this/project", str(root)), here)
    assert printed == run("python", EXAMPLES / "accelerations.py", folder=here) and len(printed.splitlines()) == 4
    theta_ddot = [float(x) for x in re.findall(r"theta_ddot = *(-?[\d.]+)", printed)]
    fall = -PAPER.m * PAPER.g * PAPER.r_0 * np.cos(1.308997) / fall_inertia(PAPER, 1.308997)
    within(abs(theta_ddot[3] - fall), 1e-4, "theta_ddot of the release, rad/s2")
    beyond(abs(theta_ddot[3] - fall * 1.001), 3e-4, "theta_ddot off a fall 0.1 % faster, rad/s2")


def test_the_lines_of_python_and_c_for_the_header_are_those_that_run(root):
    (source,) = blocks("c", HEADER_PAGE)
    include = '#include <stdio.h>\n#include "wheel_equations.h"\n'
    show = 'printf("theta_ddot = %.4f rad/s2, N = %.4f N, tau = %.4f N m\\n", now.theta_ddot, now.lambda[2], now.tau);'
    (root / "lines.c").write_text(f"{include}int main(void) {{\n{source}{show}\n}}\n")
    flags = "-I fmu-src/equations -L build/release -lwheel_equations -Wl,-rpath,build/release"
    in_c = bash(f"cc lines.c {flags} -o lines && ./lines", root)
    lines, _ = blocks("python", HEADER_PAGE)
    assert len(lines.splitlines()) <= 10
    assert in_c == python(lines, root) and "tau = 5.6728" in in_c


def test_a_solver_of_ones_own_gives_the_papers_wheel(root, references):
    _, lines = blocks("python", HEADER_PAGE)
    assert len(lines.splitlines()) <= 10
    printed = python(lines, root)
    X_O, theta = map(float, re.search(r"X_O = (\S+) m, theta = (\S+) rad", printed).groups())
    free, friction = references["free"], references["friction"]
    within(max(abs(X_O - free["X_O"][-1]), abs(theta - free["theta"][-1])), 2e-8, "X_O, m, and theta, rad, by SciPy")
    beyond(abs(theta - friction["theta"][-1]), 0.05, "theta off that with friction, rad")


def test_the_master_in_python_stops_the_wheel_when_newton_says_and_again_from_its_snapshot(root):
    printed = run("python", EXAMPLES / "master.py", folder=root)
    found = dict(re.findall(r"A brake of (\d+) N m stops the wheel at t = ([\d.]+) s", printed))
    inertia, omega = 1.8 + 20 * 0.35**2, 10.0  # J_z + m R^2 of an upright wheel; rad/s
    assert len(found) == 2
    for brake, stopped in found.items():
        late = float(stopped) - (1.0 + inertia * omega / float(brake))  # seen at the next step of 1 ms
        assert 0 <= late <= 0.001
    assert found["30"] != found["60"]


SHOWN = dict.fromkeys(("vehicle_start", "car", "anti_lock", "carrier"), VEHICLE)
SHOWN |= {"hill": VEHICLE, "step_limit": VEHICLE, "quarter_car": RECIPES, "gradient": CONTROL}


def shown(name: str) -> str:
    """The text that a page shows next to an example."""
    page = SHOWN[name]
    return blocks("text", page[page.index(f"examples/python/{name}.py)") :])[0]


@pytest.mark.parametrize("name", SHOWN)
def test_an_example_prints_what_its_page_shows(root, name):
    assert run("python", EXAMPLES / f"{name}.py", folder=root) == shown(name)


def ways(name: str) -> list[float]:
    return [float(way) for way in re.findall(r"([\d.]+) m[;.]", shown(name))]


def test_the_shown_ways_are_those_of_friction_and_of_energy():
    printed = re.findall(r"([\d.]+) m\b", shown("anti_lock"))
    locked, anti_lock, limited, sliding, shortest = map(float, printed)
    for way, mu in ((sliding, 0.4), (shortest, 0.6)):
        within(abs(way - 20**2 / (2 * mu * 9.81)), 0.05, "v^2 / (2 mu g), m")  # as printed
    within(abs(locked - sliding), 0.2, "way of locked wheels, m")
    within(limited - shortest / 0.99, 0.5, "way of the limited brake, which comes on over 70 ms, m")
    assert shortest < limited < anti_lock < locked - 10
    way, height = ways("hill")
    within(abs(way - height), 0.005, "distance uphill, m")
    essential, _ = blocks("python", VEHICLE)
    lines = (EXAMPLES / "anti_lock.py").read_text(encoding="utf-8")
    assert all(line.split("  #")[0].strip() in lines for line in essential.splitlines())


def programs(page: str) -> list[tuple[str, str]]:
    """The programs in Python of a page, each with what the page shows as its output. A block that begins with an import
    begins a program, any other goes on with the one before."""
    found: list[list[str]] = []
    for language, text in re.findall(r"^```(\w*)\n(.*?)^```", page, re.MULTILINE | re.DOTALL):
        if language == "python" and re.match(r"(import|from) ", text):
            found.append([text, ""])
        elif language in ("python", "text") and found:
            found[-1][language == "text"] += text
    return [(lines, output) for lines, output in found]


LOG = re.compile(r"\[(OK|WARNING|DISCARD|ERROR|FATAL|INFO)\]")  # as FMPy prints a message
# Those of studies are run by the tests of lab/studies; the output of programs in files is that of SHOWN.
PROGRAMS = [(name, k) for name, page in PAGES.items() if name[:4] != "lab/" for k in range(len(programs(page)))]


@pytest.mark.parametrize(("name", "number"), PROGRAMS)
def test_a_program_on_a_page_runs_and_prints_what_the_page_shows(root, name, number):
    lines, expected = programs(PAGES[name])[number]
    if "casadi" in lines:
        pytest.importorskip("casadi")
    printed = [line for line in python(lines, root).splitlines() if not LOG.match(line)]
    for of_a_file in {shown(example) for example in SHOWN if SHOWN[example] == PAGES[name]}:
        expected = expected.replace(of_a_file, "")
    assert printed == expected.splitlines() or not expected


def test_every_program_is_found():
    counts = {name: len(programs(page)) for name, page in PAGES.items()}
    assert counts["docs/first_suspension.md"] == 1 and counts["docs/linearize_and_control.md"] == 2
    fragments = {name: page for name, page in PAGES.items() if blocks("python", page) and not programs(page)}
    assert {*fragments} == {"docs/teaching.md"}
