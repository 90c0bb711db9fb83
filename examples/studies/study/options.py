"""The options of ./scripts/study, read and checked before anything is built or installed."""

from __future__ import annotations

import argparse
import csv
import sys
from difflib import get_close_matches
from math import radians
from pathlib import Path
from xml.etree import ElementTree

EXAMPLES = Path(__file__).resolve().parent.parent
ROOT = EXAMPLES.parent.parent
FORMS = {  # how an option is written
    "vary": "NAME=1,2,3 or NAME=first:last:count",
    "set": "NAME=1.5 or NAME=85deg",
    "measure": "'NAME=max(theta)'",
}
USAGE = """examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study my_study.py               a file that says study = Study(...); docs/studies.md shows how
  ./scripts/study --vary theta_start=60deg:90deg:31 --vary s=0,0.01,0.03 --set phi_dot_start=-3 \\
      --measure lowest=lowest --out results/studies/lean.zarr --csv
  ./scripts/study --list starts.csv         one wheel per row; the first row has the names
"""


class StudyError(ValueError):
    """The study cannot be run as it is written; the text is one sentence."""


def number(text: str) -> float:
    """A number in SI units, or in degrees with `deg` behind it."""
    return radians(float(text[:-3])) if text.endswith("deg") else float(text)


def numbers(text: str) -> list[float]:
    """`1,2,3` or `first:last:count`; a range in degrees is even in degrees, to the last digit."""
    if ":" not in text:
        return [number(part) for part in text.split(",")]
    first, last, count = text.split(":")
    if first.endswith("deg") and last.endswith("deg"):
        return [radians(degree) for degree in numbers(f"{first[:-3]}:{last[:-3]}:{count}")]
    begin, end, steps = number(first), number(last), int(count) - 1
    return [begin + k * ((end - begin) / steps) for k in range(steps)] + [end] if steps > 0 else [begin]


def named(texts: list[str], convert: object, option: str) -> dict[str, object]:
    """NAME=VALUE options as a dictionary; StudyError with the form that is expected."""
    pairs = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            pairs[name] = convert(value)
        except ValueError:
            raise StudyError(f"--{option} {text}: write --{option} {FORMS[option]}.") from None
    return pairs


def read_list(path: Path) -> dict[str, list[float]]:
    """The columns of a CSV file of numbers."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        return {name: [number(row[name]) for row in rows] for name in rows[0]}
    except (OSError, ValueError, IndexError, TypeError, AttributeError) as fault:
        raise StudyError(f"--list {path}: a row of names, then rows of numbers, are expected ({fault}).") from None


def example_names() -> list[str]:
    """The studies that lie beside this package."""
    return sorted(path.stem for path in EXAMPLES.glob("*.py"))


def arguments_of(argv: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="./scripts/study",
        description="Runs many wheels on all cores or on a Dask cluster. Started again, it goes on where it was.",
        epilog=USAGE.format(names=", ".join(example_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("study", nargs="?", help="an example's name or a Python file")
    add(
        "--vary",
        action="append",
        default=[],
        metavar="NAME=VALUES",
        help="an axis of the grid: 1,2,3 or first:last:count",
    )
    add("--list", type=Path, metavar="CSV", help="one wheel per row instead of a grid")
    add("--set", action="append", default=[], metavar="NAME=VALUE", help="a value for all wheels")
    add("--measure", action="append", default=[], metavar="NAME=MEASURE", help="for instance 'highest=max(theta)'")
    add("--history", nargs="+", default=[], metavar="NAME", help="variables to keep at every communication point")
    add("--stop-time", type=float, default=10.0, help="s (10)")
    add("--interval", type=float, default=0.01, help="s between communication points (0.01)")
    add("--tolerance", type=float, help="relative tolerance of the FMU")
    add("--branch-at", type=float, metavar="T", help="tunable parameters and inputs vary from T s on; one shared start")
    add("--workers", type=int, help="processes on this machine; all cores if not given")
    add("--scheduler", metavar="tcp://HOST:PORT", help="a running Dask scheduler instead")
    add("--fmu", type=Path, default=ROOT / "wheel.fmu")
    add("--out", type=Path, help="Zarr folder of the results (results/studies/NAME.zarr)")
    add("--overwrite", action="store_true", help="throw away what is there and begin again")
    add("--netcdf", action="store_true", help="a copy as NetCDF beside the Zarr folder")
    add("--csv", action="store_true", help="a copy as CSV, one row per wheel (and time)")
    add("--publish", action="store_true", help="write an example's data and figure into docs/")
    return parser.parse_args(argv)


def check(arguments: argparse.Namespace) -> None:
    """StudyError for an option that cannot be read, and for a name that the description does not have."""
    for option, convert in (("vary", numbers), ("set", number), ("measure", str)):
        named(getattr(arguments, option), convert, option)
    if arguments.list:
        read_list(arguments.list)
    name = arguments.study
    if name and not name.endswith(".py") and name not in example_names():
        raise StudyError(f"There is no study {name}; the examples are {', '.join(example_names())}.")
    if name and name.endswith(".py") and not Path(name).is_file():
        raise StudyError(f"There is no file {name}.")
    if arguments.fmu == ROOT / "wheel.fmu":
        rows = list(ElementTree.parse(ROOT / "modelDescription.xml").getroot().iter("ScalarVariable"))
        known = [str(row.get("name")) for row in rows]
        asked = [text.partition("=")[0] for text in (*arguments.vary, *arguments.set)] + arguments.history
        for unknown in [name for name in asked if name not in known]:
            near = ", ".join(get_close_matches(unknown, known, 3, 0.5))
            raise StudyError(f"wheel.fmu has no variable {unknown}{f'; do you mean {near}' if near else ''}.")


if __name__ == "__main__":
    try:
        check(arguments_of(None))
    except StudyError as fault:
        print(f"study: {fault}", file=sys.stderr)
        sys.exit(2)
