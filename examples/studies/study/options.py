"""The arguments of ./scripts/study: read, and refused where wrong, by Python alone, before anything is installed.

Names are checked against the FMU's modelDescription.xml. Values are in SI units, or have a unit behind them.
"""

import argparse
import csv
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.etree import ElementTree
from zipfile import BadZipFile, ZipFile

EXAMPLES = Path(__file__).resolve().parent.parent
ROOT = EXAMPLES.parent.parent
sys.path.append(str(EXAMPLES.parent / "python"))
if not __package__:  # run as a file, by scripts/help
    sys.path.insert(0, str(EXAMPLES))
from values import Fault, Variable, number, parted, ready, scale, suggestion, variables, wheels  # noqa: E402

from study.plan import Study, StudyError  # noqa: E402

NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py"))  # the studies that lie beside this package
SETTABLE, READABLE = ("parameter", "input"), ("output", "local")  # causalities
USAGE = """examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study fates --wheel coin        with a ready wheel: {wheels}
  ./scripts/study my_study.py               a file that defines study = Study(...); see docs/studies.md
  ./scripts/study --vary theta_start=60deg:90deg:31 --vary s=0,0.01,0.03 --set phi_dot_start=-3 \\
      --measure lowest=lowest --out results/studies/lean.zarr --csv
  ./scripts/study --list starts.csv         one wheel per row; the first row has the names
"""


def numbers(name: str, text: str, unit: str) -> list[float]:
    """`1,2,3` or `first:last:count`; a range of angles in degrees is even in degrees, to the last digit."""
    if ":" not in text:
        return [number(name, part, unit) for part in text.split(",")]
    first, last, count = [*text.split(":"), "", ""][:3]
    if not count.isdigit() or int(count) < 2:
        raise StudyError(f"--vary {name}={text}: write --vary NAME=1,2,3 or NAME=first:last:count.")
    (begin, given), (end, other) = parted(name, first), parted(name, last)
    if given != other:
        begin, end, given = number(name, first, unit), number(name, last, unit), ""
    step = (end - begin) / (int(count) - 1)
    evenly = [*(begin + k * step for k in range(int(count) - 1)), end]
    return [number(name, f"{value!r}{given}", unit) for value in evenly]


def pairs(texts: list[str]) -> dict[str, str]:
    """NAME=VALUE options as a dictionary."""
    return dict(text.partition("=")[::2] for text in texts)


def study_of(arguments: argparse.Namespace) -> Study:
    """The study that the options describe, checked."""
    known = variables(description(arguments.fmu))

    def unit(name: str) -> str:
        check_names([name], SETTABLE, known)
        return known[name].unit or "1"

    def value(name: str, text: str) -> float:
        return number(name, text, unit(name))

    grid = {name: numbers(name, text, unit(name)) for name, text in pairs(arguments.vary).items()}
    rows = {name: [value(name, text) for text in column] for name, *column in columns(arguments.list)}
    if bool(grid) == bool(rows):
        raise StudyError("Which wheels? Give an example, a file, --vary NAME=VALUES, or --list CSV; see --help.")
    values = {name: x for name, x in arguments.body.items() if name not in grid | rows}
    values |= {name: value(name, text) for name, text in pairs(arguments.set).items()}
    fields = {name: getattr(arguments, name) for name in ("history", "stop_time", "interval", "tolerance", "branch_at")}
    fields |= {"measures": pairs(arguments.measure)} if arguments.measure else {}
    study = Study(grid=grid, list=rows, values=values, **fields)
    study.check(known)
    return study


def columns(path: Path | None) -> list[tuple[str, ...]]:
    """Of a CSV file: each begins with a name."""
    try:
        return [*zip(*filter(None, csv.reader(path.open(newline=""))), strict=True)] if path else []
    except (OSError, ValueError) as fault:
        raise StudyError(f"--list {path}: a row of names, then rows of numbers, are expected ({fault}).") from None


def description(fmu: Path) -> bytes:
    """modelDescription.xml of the FMU or, before it is built, of the project."""
    try:
        return ZipFile(fmu).read("modelDescription.xml")
    except (OSError, BadZipFile, KeyError):
        return (ROOT / "modelDescription.xml").read_bytes()


def factors(body: Mapping[str, float]) -> dict[str, float]:
    """By variable: its value in a motion of this wheel over that in the similar motion of the paper's."""
    text = description(ROOT / "wheel.fmu")
    bases = {unit.get("name"): unit.find("BaseUnit").attrib for unit in ElementTree.fromstring(text).iter("Unit")}
    powers = {unit: {n: int(base[n]) for n in ("kg", "m", "s") if n in base} for unit, base in bases.items()}
    return {name: scale(body, **powers.get(v.unit, {})) for name, v in variables(text).items()}


def check_names(names: Iterable[str], causalities: tuple[str, str], known: Mapping[str, Variable]) -> None:
    """StudyError about the first name that is not a variable of these causalities."""
    there = {name: v.description or "" for name, v in known.items() if v.causality in causalities}
    for name in names:
        if name not in there:
            hint = suggestion(name, there) or f" There are {', '.join(there)}."
            kind = "a parameter or input" if causalities == SETTABLE else "an output or local variable"
            raise StudyError(f"'{name}' is not {kind} of this FMU.{hint}")


def seconds(text: str) -> float:
    """A time, such as 2min."""
    return number("time", text, "s")


def file_of(name: str) -> Path:
    """The file of a study that is given by its path or as an example's name."""
    path = Path(name) if name.endswith(".py") else EXAMPLES / f"{name}.py"
    if not path.is_file():
        meant = suggestion(name, dict.fromkeys(NAMES, ""))
        raise StudyError(f"There is no study {name}; the examples are {', '.join(NAMES)}.{meant}")
    return path


def arguments_of(argv: list[str] | None = None) -> argparse.Namespace:
    """The arguments, `study` as the path of a file or as the Study that the others describe.

    What cannot be meant is one line on stderr and exit status 2.
    """
    parser = argparse.ArgumentParser(
        prog="./scripts/study",
        description="Runs many wheels on all cores or on a Dask cluster. Started again, it continues where it stopped.",
        epilog=USAGE.format(names=", ".join(NAMES), wheels=", ".join(wheels())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add, several = parser.add_argument, {"action": "append", "default": []}
    add("study", nargs="?", help="an example's name or a Python file")
    add("--wheel", metavar="NAME", help="a ready wheel, to which lengths, times and rates of a study's file are scaled")
    add("--vary", **several, metavar="NAME=VALUES", help="an axis of the grid: 1,2,3 or first:last:count")
    add("--list", type=Path, metavar="CSV", help="one wheel per row instead of a grid")
    add("--set", **several, metavar="NAME=VALUE", help="a value for all wheels, such as slope=12%%")
    add("--measure", **several, metavar="NAME=MEASURE", help="for instance 'highest=max(theta)', or lowest=lowest")
    add("--history", nargs="+", default=[], metavar="NAME", help="variables to keep at every communication point")
    add("--stop-time", type=seconds, default=10.0, help="s (10)")
    add("--interval", type=seconds, default=0.01, help="s between communication points (0.01)")
    add("--tolerance", type=float, help="relative tolerance of the FMU")
    add("--branch-at", type=seconds, metavar="T", help="a shared start: tunable parameters and inputs vary from T s on")
    add("--workers", type=int, help="processes on this machine; all cores if not given")
    add("--scheduler", metavar="tcp://HOST:PORT", help="a running Dask scheduler instead")
    add("--fmu", type=Path, default=ROOT / "wheel.fmu")
    add("--out", metavar="PLACE", help="Zarr folder of the results, or its URL (results/studies/NAME.zarr)")
    add("--overwrite", action="store_true", help="discard the results that are there")
    add("--netcdf", action="store_true", help="a copy as NetCDF beside the Zarr folder")
    add("--csv", action="store_true", help="a copy as CSV, one row per wheel (and time)")
    add("--publish", action="store_true", help="write an example's data and figure into docs/")
    arguments = parser.parse_args(argv)
    try:
        arguments.body = ready(arguments.wheel) if arguments.wheel else {}
        arguments.study = file_of(arguments.study) if arguments.study else study_of(arguments)
    except (StudyError, Fault) as fault:
        parser.exit(2, f"study: {fault}\n")
    return arguments


if __name__ == "__main__":
    arguments_of()
