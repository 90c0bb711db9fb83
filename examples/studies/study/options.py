"""The arguments of ./scripts/study: read, and refused where wrong, by Python alone, before anything is installed.

Names are checked against the FMU's modelDescription.xml. Values are in SI units, or in degrees with `deg` behind them.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable
from math import radians
from pathlib import Path
from xml.etree import ElementTree
from zipfile import BadZipFile, ZipFile

EXAMPLES = Path(__file__).resolve().parent.parent
ROOT = EXAMPLES.parent.parent
if not __package__:  # run as a file, by scripts/help
    sys.path.insert(0, str(EXAMPLES))
from study.measures import READABLE, SETTABLE, StudyError, check_names, parse_measure  # noqa: E402

USAGE = """examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study my_study.py               a file that defines study = Study(...); see docs/studies.md
  ./scripts/study --vary theta_start=60deg:90deg:31 --vary s=0,0.01,0.03 --set phi_dot_start=-3 \\
      --measure lowest=lowest --out results/studies/lean.zarr --csv
  ./scripts/study --list starts.csv         one wheel per row; the first row has the names
"""


def number(text: str) -> float:
    """A number in SI units, or in degrees with `deg` behind it."""
    return radians(float(text[:-3])) if text.endswith("deg") else float(text)


def numbers(text: str) -> list[float]:
    """`1,2,3` or `first:last:count`; a range in degrees is even in degrees, to the last digit."""
    if ":" not in text:
        return [number(part) for part in text.split(",")]
    first, last, count = text.split(":")
    if first.endswith("deg") and last.endswith("deg"):
        return [radians(value) for value in numbers(f"{first[:-3]}:{last[:-3]}:{count}")]
    first, last, count = number(first), number(last), int(count)
    if count < 2:
        raise ValueError(count)
    step = (last - first) / (count - 1)
    return [*(first + k * step for k in range(count - 1)), last]


def named(texts: list[str], convert: Callable[[str], object], option: str, form: str) -> dict[str, object]:
    """NAME=VALUE options as a dictionary; StudyError with the form that is expected."""
    pairs = {}
    for name, _, value in (text.partition("=") for text in texts):
        try:
            pairs[name] = convert(value)
        except StudyError:
            raise
        except ValueError:
            raise StudyError(f"{option} {name}={value}: write {option} {form}.") from None
    return pairs


def read_list(path: Path) -> dict[str, list[float]]:
    """The columns of a CSV file of numbers."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        return {name: [number(row[name]) for row in rows] for name in rows[0]}
    except (OSError, ValueError, IndexError, TypeError, AttributeError) as fault:
        raise StudyError(f"--list {path}: a row of names, then rows of numbers, are expected ({fault}).") from None


def fields_of(arguments: argparse.Namespace) -> dict[str, object]:
    """The fields of a Study that the options give."""
    measures = named(arguments.measure, lambda text: parse_measure(text).text, "--measure", "'NAME=max(theta)'")
    return {
        "grid": named(arguments.vary, numbers, "--vary", "NAME=1,2,3 or NAME=first:last:count"),
        "list": read_list(arguments.list) if arguments.list else {},
        "values": named(arguments.set, number, "--set", "NAME=1.5 or NAME=85deg"),
        "history": arguments.history,
        **({"measures": measures} if measures else {}),
        **{name: getattr(arguments, name) for name in ("stop_time", "interval", "tolerance", "branch_at")},
    }


def variables(fmu: Path) -> dict[str, str]:
    """Name -> causality, of the FMU or, before it is built, of the project's modelDescription.xml."""
    try:
        text = ZipFile(fmu).read("modelDescription.xml")
    except (OSError, BadZipFile, KeyError):
        text = (ROOT / "modelDescription.xml").read_bytes()
    return {v.get("name"): v.get("causality", "local") for v in ElementTree.fromstring(text).iter("ScalarVariable")}


def check(arguments: argparse.Namespace) -> None:
    """StudyError if there is no study of that name, or an option cannot be parsed."""
    if arguments.study:
        file_of(arguments.study)
        return
    fields, known = fields_of(arguments), variables(arguments.fmu)
    if bool(fields["grid"]) == bool(fields["list"]):
        raise StudyError("Which wheels? Give an example, a file, --vary NAME=VALUES, or --list CSV; see --help.")
    check_names([*fields["grid"], *fields["list"], *fields["values"]], SETTABLE, known)
    measures = [parse_measure(text) for text in fields.get("measures", {}).values()]
    check_names([*(m.variable for m in measures), *fields["history"]], READABLE, known)


def file_of(name: str) -> Path:
    """The file of a study that is given by its path or as an example's name."""
    path = Path(name) if name.endswith(".py") else EXAMPLES / f"{name}.py"
    if not path.is_file():
        raise StudyError(f"There is no study {name}; the examples are {', '.join(example_names())}.")
    return path


def example_names() -> list[str]:
    """The studies that lie beside this package."""
    return sorted(path.stem for path in EXAMPLES.glob("*.py"))


def arguments_of(argv: list[str] | None = None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="./scripts/study",
        description="Runs many wheels on all cores or on a Dask cluster. Started again, it continues where it stopped.",
        epilog=USAGE.format(names=", ".join(example_names())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add, several = parser.add_argument, {"action": "append", "default": []}
    add("study", nargs="?", help="an example's name or a Python file")
    add("--vary", **several, metavar="NAME=VALUES", help="an axis of the grid: 1,2,3 or first:last:count")
    add("--list", type=Path, metavar="CSV", help="one wheel per row instead of a grid")
    add("--set", **several, metavar="NAME=VALUE", help="a value for all wheels")
    add("--measure", **several, metavar="NAME=MEASURE", help="for instance 'highest=max(theta)', or lowest=lowest")
    add("--history", nargs="+", default=[], metavar="NAME", help="variables to keep at every communication point")
    add("--stop-time", type=float, default=10.0, help="s (10)")
    add("--interval", type=float, default=0.01, help="s between communication points (0.01)")
    add("--tolerance", type=float, help="relative tolerance of the FMU")
    add("--branch-at", type=float, metavar="T", help="tunable parameters and inputs vary from T s on; one shared start")
    add("--workers", type=int, help="processes on this machine; all cores if not given")
    add("--scheduler", metavar="tcp://HOST:PORT", help="a running Dask scheduler instead")
    add("--fmu", type=Path, default=ROOT / "wheel.fmu")
    add("--out", metavar="PLACE", help="Zarr folder of the results, or its URL (results/studies/NAME.zarr)")
    add("--overwrite", action="store_true", help="discard the results that are there")
    add("--netcdf", action="store_true", help="a copy as NetCDF beside the Zarr folder")
    add("--csv", action="store_true", help="a copy as CSV, one row per wheel (and time)")
    add("--publish", action="store_true", help="write an example's data and figure into docs/")
    return parser.parse_args(argv)


if __name__ == "__main__":
    try:
        check(arguments_of())
    except StudyError as fault:
        print(f"study: {fault}", file=sys.stderr)
        sys.exit(2)
