"""Builds the FMU, simulates the paper's wheel or a different one, and draws the diagrams.

  ./scripts/run                             the paper's two scenes, without and with rolling resistance (s = 0.03 m)
  ./scripts/run v=18km/h                    a vehicle's wheel that starts upright at the origin, along X
  ./scripts/run s=0.01 theta_start=60deg    other values in both scenes, where the first keeps s = 0
  ./scripts/run m=12kg J_x=0.56 J_y=0.56 J_z=1.1   a lighter wheel, with its moments of inertia in kg m2
  ./scripts/run slope=12% r_0=30cm          units: kg g, m mm cm, s ms, m/s km/h, rad deg, N kN, N.m; % for the slope
  ./scripts/run M_brake=20 stop_time=20     an input that is constant over the run, and a longer run
  ./scripts/run mu_max=0.45 mu_slide=0.4    a wet road, on which the wheel slides
  ./scripts/run guided=true v=30km/h M_brake=400 mu_max=0.5 mu_slide=0.4   on a carrier, locked and sliding
  ./scripts/run guided=true v=10m/s psi_dot_guide=0.5 mu_max=0.3 mu_slide=0.25   steered into a slide
  ./scripts/run coin                        a preset wheel
  ./scripts/run backspin                    a preset case, a hoop that slides, rolls and comes back
  ./scripts/run s=0.01 error=methods        a diagram of error against computing time for every method

The command installs what is missing, builds wheel.fmu and leaves it here. It simulates both scenes with the fmpy
command line and writes into results/ the diagrams, the tables free.csv and friction.csv, and wheel.html, a 3D page of
the motion. It estimates the error of both runs with another solver (docs/recipes.md).

Any parameter or input of docs/variables.md can be given, each once. An input keeps its value for the whole run, and
docs/in_your_tool.md shows one that varies. If no body within the wheel's outline has the given moments of inertia, a
warning says so.

The first run takes about a minute. It installs missing Debian packages (a C++ build, Python's venv), puts Python
packages into .venv, and compiles. cargo is among the packages because it downloads the pinned source of SUNDIALS, the
second solver.

With v the wheel starts at psi = 0, theta = 90 deg, X_O = Y_O = 0 and phi_dot = -v/(r_0 + r). All but the last can be
given too. With v=0 it stands. Without v or a preset it starts at the paper's X_O = -0.0776 m and Y_O = 0, whatever its
radii. Give X_O_start and Y_O_start to change that.

With a preset, other values scale with the radius R = r_0 + r: s is 0.03 m R / 0.35 m, phi_dot_start is
-2 rad/s sqrt(0.35 m / R), and stop_time is 10 s sqrt(R / 0.35 m). examples/wheels.json has its parameters and their
sources.

output_interval is the time between rows of the tables. Unless it is given, it is 10 ms, less for a small wheel, and at
most a fortieth of the fastest period of spin or nutation at the start. The diagrams do not depend on it.
"""

import csv
import sys
from itertools import islice
from pathlib import Path
from subprocess import PIPE, STDOUT

from wheelfmu.commands import build, processes
from wheelfmu.fmu import start_values
from wheelfmu.fmu.outputs import deliver, new_folder
from wheelfmu.fmu.paths import ROOT

SCENES = {"free": "No rolling resistance", "friction": "Rolling resistance"}
PAGE = ROOT / "lab" / "lesson"
# Of an earlier run, where this one has none; the paper's figures stay.
OLD = ("free.*", "friction.*", "wheel.html", "error_time.*", "diagrams.*", "diagram_*")


def usage(_words: list[str]) -> str:
    return f"{__doc__}\n{start_values.usage()}"


def reads(words: list[str]) -> list[str]:
    start_values.values(words)
    return words


def simulation(*options: str) -> list[str]:
    """Words that simulate wheel.fmu by FMPy's command line."""
    return [str(Path(sys.executable).with_name("fmpy")), "simulate", "wheel.fmu", *options]


def simulate(new: Path, words: list[str]) -> None:
    """Both scenes and the error of each, side by side; Failed with FMPy's message where a scene cannot be simulated."""
    given, running = start_values.command(start_values.values(words)), {}
    for name, last in {"free": ("s", "0"), "friction": ()}.items():  # the last value of s holds
        options = ["--output-file", str(new / f"{name}.csv"), *given, *last]
        with (new / f"{name}.log").open("w") as log:
            running[name] = processes.start(*simulation(*options), stdout=log, stderr=STDOUT)
    processes.status(*processes.python("wheelfmu.diagrams.races", new, *words))
    if failed := [name for name, one in running.items() if one.wait()]:
        text = (new / f"{failed[-1]}.log").read_text(errors="replace")
        (ROOT / "build" / "simulation.log").write_text(text)
        said = [line.removeprefix("[ERROR] ") for line in text.splitlines() if line.startswith("[ERROR] ")]
        sentence = f'The scene "{failed[-1]}" could not be simulated; build/simulation.log has what FMPy printed.'
        print(*(said or [sentence]), sep="\n", file=sys.stderr)
        raise processes.Failed(1)


def moves(table: Path) -> bool:
    """Whether a scene has rows of two instants, which is a motion."""
    with table.open(newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        times = [float(row[0]) for row in islice(rows, 1, 3)]
        return any(time > times[0] for time in [*times, *(float(row[0]) for row in rows)])


def draw(new: Path, words: list[str]) -> list[str]:
    """The page and the pictures, side by side; the lines that name them."""
    moving = {name: label for name, label in SCENES.items() if moves(new / f"{name}.csv")}
    drawing = [processes.python("wheelfmu.diagrams.paper", new, *words)]
    if PAGE.exists() and moving:
        tables = [new / f"{name}.csv" for name in moving]
        options = [*tables, "--output", new / "wheel.html", "--labels", *moving.values()]
        drawing.insert(0, processes.command("view", *options))
    running = [processes.start(*words, stdout=PIPE, text=True) for words in drawing]
    said = [one.communicate()[0] for one in running]
    if any(one.returncode for one in running):
        raise processes.Failed(1)
    return "".join(said).replace(f"{new}/", "").splitlines()


def main(words: list[str]) -> None:
    build.build("release")
    results = ROOT / "results"
    results.mkdir(exist_ok=True)
    with new_folder(results) as new:
        deliver(ROOT / "build" / "release" / "wheel.fmu", ROOT / "wheel.fmu")
        simulate(new, words)
        for name, label in SCENES.items():
            for line in (new / f"{name}.log").read_text(errors="replace").splitlines():
                print(f"{label}: {line}")
        lines = draw(new, words)
        for error in sorted(new.glob("*.error")):
            print(error.read_text(encoding="utf-8").splitlines()[0])
            error.unlink()
        for old in (path for name in OLD for path in results.glob(name)):
            old.unlink()
        for path in new.iterdir():
            path.replace(results / path.name)
    print(f"wheel.fmu is ready. In {results}:")
    print(*(f"  {line}" for line in lines), "  free.csv, friction.csv: the numbers.", sep="\n")
    if (results / "error_time.png").exists():
        print("  error_time.png, error_time.csv: error over time, by method.")
