"""The arguments of ./scripts/study: a study from a file, one of the examples by name, or one written as options.

They are read, and refused where wrong, by Python alone, before anything is installed. Names are checked against
the FMU's modelDescription.xml. Values are in SI units, or have a unit behind them.
"""

import argparse
import re
from pathlib import Path
from typing import Any

from lab.studies.names import SETTABLE, check_names, variables_of
from lab.studies.plan import Study
from wheelfmu.fmu.csv_file import read_table
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, Parser, Variable, limited, number, parted, single, suggestion

INTERRUPTED = "stopped; the same command continues from here."
EXAMPLES = Path(__file__).parent / "examples"
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py"))
SHOWN = """examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study my_study.py               a file that defines study = Study(...); see lab/studies/README.md
  ./scripts/study --vary theta_start=60deg:90deg:31 --vary s=0,0.01,0.03 --set phi_dot_start=-3 \\
      --measure lowest=lowest --out results/studies/lean.zarr --csv
  ./scripts/study --list starts.csv         one wheel per row; the first row has the names
  ./scripts/study lean                      continues results/studies/lean.zarr, or another folder of results
"""


def numbers(variable: Variable, text: str) -> list[float]:
    """`1,2,3` or `first:last:count`; a range of angles in degrees is even in degrees, to the last digit."""
    name, unit = variable.name, variable.unit or "1"
    if ":" not in text:
        parts = text.split(",")
        if any(re.match(r"\s*0[0-9]", part) for part in parts[1:]):
            raise Fault(f"--vary {name}={text}: commas part the values; the decimal mark is a point.")
        return [variable.number_of(part) for part in parts]
    first, last, count = [*text.split(":"), "", ""][:3]
    if not re.fullmatch(r"[0-9]{1,9}", count) or int(count) < 2 or text.count(":") > 2:
        raise Fault(f"--vary {name}={text}: write --vary NAME=1,2,3 or NAME=first:last:count.")
    (begin, given), (end, other) = parted(name, first), parted(name, last)
    if given != other:
        begin, end, given = number(name, first, unit), number(name, last, unit), ""
    step = (end - begin) / (int(count) - 1)
    evenly = [*(begin + k * step for k in range(int(count) - 1)), end]
    return [variable.number_of(f"{value!r}{given}") for value in evenly]


def pairs(option: str, texts: list[str]) -> dict[str, str]:
    """NAME=VALUE options as a dictionary."""
    parts = [text.partition("=") for text in texts]
    if bare := [name for name, equals, text in parts if not (name and equals and text)]:
        raise Fault(f'{option} "{bare[0]}" is not of the form NAME=VALUE.')
    return single((name, text) for name, _, text in parts)


def study_of(arguments: argparse.Namespace) -> Study:
    """The study that the options describe, checked."""
    known, table = variables_of(arguments.fmu), read_table(arguments.list) if arguments.list else None
    axes, given = pairs("--vary", arguments.vary), pairs("--set", arguments.set)
    varied = [*axes, *(table.columns if table else ())]
    check_names([*varied, *given], SETTABLE, known)
    if bool(axes) == bool(table):
        raise Fault("Which wheels? Give an example, a file, --vary NAME=VALUES, or --list CSV; see --help.")
    names = ("history", "stop_time", "interval", "tolerance")
    fields = {name: getattr(arguments, name) for name in names}
    fields |= {"measures": pairs("--measure", arguments.measure)} if arguments.measure else {}
    study = Study(
        grid={name: numbers(known[name], text) for name, text in axes.items()},
        list={name: table.read(name, known[name].number_of) for name in table.columns} if table else {},
        values={name: known[name].number_of(text) for name, text in given.items()},
        **fields,
    )
    study.check(known)
    return study


def count(text: str) -> int:
    """A whole number of wheels or processes."""
    return int(Variable("count", "", "Integer", "", "", "1", "", "").number_of(text))


def tolerance(text: str) -> float:
    """A number above 0."""
    return limited("tolerance", number("tolerance", text), "", 0.0, above=True)


def seconds(text: str) -> float:
    """A time, such as 2min."""
    return number("time", text, "s")


def file_of(name: str) -> Path:
    """The file of a study that is given by its path or as an example's name; or the folder of results to go on with."""
    path = Path(name) if name.endswith((".py", ".zarr")) else EXAMPLES / f"{name}.py"
    if not path.exists() and (kept := ROOT / "results" / "studies" / f"{name}.zarr").is_dir():
        return kept
    if not path.exists():
        meant = suggestion(name, dict.fromkeys(NAMES, ""))
        raise Fault(f"There is no study {name}; the examples are {', '.join(NAMES)}.{meant}")
    return path


def arguments_of(argv: list[str] | None = None) -> argparse.Namespace:
    """The arguments, `study` as the path of a file or as the Study that the others describe; Fault."""
    parser = Parser(
        prog="./scripts/study",
        description="Runs many wheels on all cores or on a Dask cluster. Started again, it continues where it stopped.",
        epilog=SHOWN.format(names=", ".join(NAMES)),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    several: dict[str, Any] = {"action": "append", "default": []}
    add = parser.add_argument
    add("study", nargs="?", help="an example's name, a Python file, or earlier results to continue")
    add("--vary", **several, metavar="NAME=VALUES", help="an axis of the grid: 1,2,3 or first:last:count")
    add("--list", type=Path, metavar="CSV", help="one wheel per row instead of a grid")
    add("--set", **several, metavar="NAME=VALUE", help="a value for all wheels, such as slope=12%%")
    add(
        "--measure",
        **several,
        metavar="NAME=MEASURE",
        help="for instance 'highest=max(theta)', lowest=lowest, "
        "'down=first(theta<30deg)' (theta_end=theta, at the end of the run)",
    )
    add("--history", nargs="+", default=[], metavar="NAME", help="variables to keep at every communication point")
    add("--stop-time", type=seconds, default=10.0, help="duration, s (10)")
    add("--interval", type=seconds, default=0.01, help="communication step, s (0.01)")
    add("--tolerance", type=tolerance, help="relative tolerance of the FMU (1e-8)")
    add("--workers", type=count, help="processes on this machine (one per core)")
    add("--scheduler", metavar="tcp://HOST:PORT", help="a running Dask scheduler instead")
    add("--fmu", type=Path, default=ROOT / "wheel.fmu", help="the FMU (wheel.fmu, as ./scripts/run leaves it)")
    add("--out", metavar="PLACE", help="Zarr folder of the results, or its URL (results/studies/NAME.zarr)")
    add("--overwrite", action="store_true", help="discard existing results and files")
    add("--netcdf", action="store_true", help="a copy as NetCDF beside the Zarr folder")
    add("--csv", action="store_true", help="a copy as CSV, one row per wheel (and time)")
    add("--check", type=count, metavar="N", help="repeat N random wheels with another solver to estimate their error")
    add("--publish", action="store_true", help="write an example's figure into docs/figures")
    arguments = parser.parse_args(argv)
    arguments.study = file_of(arguments.study) if arguments.study else study_of(arguments)
    return arguments
