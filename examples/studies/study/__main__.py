"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options."""

from __future__ import annotations

import argparse
import csv
import runpy
import sys
import time
from math import radians
from pathlib import Path

import numpy as np

from .plan import Study, StudyError

EXAMPLES = Path(__file__).resolve().parent.parent
ROOT = EXAMPLES.parent.parent
USAGE = """examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study my_study.py               a file that says study = Study(...); docs/studies.md shows how
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
        return np.radians(numbers(f"{first[:-3]}:{last[:-3]}:{count}")).tolist()
    return np.linspace(number(first), number(last), int(count)).tolist()


def named(texts: list[str], convert: object, option: str, form: str) -> dict[str, object]:
    """NAME=VALUE options as a dictionary; StudyError with the form that is expected."""
    pairs = {}
    for text in texts:
        name, _, value = text.partition("=")
        try:
            pairs[name] = convert(value)
        except ValueError:
            raise StudyError(f"{option} {text}: write {option} {form}.") from None
    return pairs


def read_list(path: Path) -> dict[str, list[float]]:
    """The columns of a CSV file of numbers."""
    try:
        with path.open(newline="") as file:
            rows = list(csv.DictReader(file))
        return {name: [number(row[name]) for row in rows] for name in rows[0]}
    except (OSError, ValueError, IndexError, TypeError, AttributeError) as fault:
        raise StudyError(f"--list {path}: a row of names, then rows of numbers, are expected ({fault}).") from None


def study_of_options(arguments: argparse.Namespace) -> Study:
    """The study that the options describe."""
    options = {"stop_time": arguments.stop_time, "interval": arguments.interval, "tolerance": arguments.tolerance}
    if arguments.measure:
        options["measures"] = named(arguments.measure, str, "--measure", "'NAME=max(theta)'")
    return Study(
        grid=named(arguments.vary, numbers, "--vary", "NAME=1,2,3 or NAME=first:last:count"),
        list=read_list(arguments.list) if arguments.list else {},
        values=named(arguments.set, number, "--set", "NAME=1.5 or NAME=85deg"),
        history=arguments.history,
        branch_at=arguments.branch_at,
        **options,
    )


def study_file(name: str) -> dict[str, object]:
    """What a study's file defines: `study`, perhaps `table` and `draw`; or `measure`."""
    path = Path(name) if name.endswith(".py") else EXAMPLES / f"{name}.py"
    if not path.is_file():
        raise StudyError(f"There is no study {name}; the examples are {', '.join(example_names())}.")
    sys.path.insert(0, str(path.resolve().parent))
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study) and "measure" not in content:
        raise StudyError(f"{path} does not say study = Study(...).")
    return content | {"name": path.stem}


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


def main(argv: list[str] | None = None) -> int:
    """Runs a study; a fault of the study is one sentence on stderr and exit status 2."""
    arguments = arguments_of(argv)
    try:
        content = (
            study_file(arguments.study) if arguments.study else {"study": study_of_options(arguments), "name": "study"}
        )
        measure(content, arguments) if "measure" in content else conduct(content, arguments)
    except StudyError as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("study: stopped; the same command goes on from here.", file=sys.stderr)
        return 130
    return 0


def conduct(content: dict[str, object], arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and says what came out and where it is."""
    from .compute import run
    from .store import export
    from .summary import summarize

    out = arguments.out or ROOT / "results" / "studies" / f"{content['name']}.zarr"
    begin = time.perf_counter()
    results = run(
        content["study"],
        out,
        fmu=arguments.fmu,
        workers=arguments.workers,
        scheduler=arguments.scheduler,
        overwrite=arguments.overwrite,
    )
    print(summarize(results, time.perf_counter() - begin))
    written = [out]
    if arguments.netcdf:
        written.append(export(results, out.with_suffix(".nc")))
    if arguments.csv:
        written.append(export(results, out.with_suffix(".csv")))
    if "draw" in content:
        written += picture(content, results, out.with_suffix(""), arguments.publish)
    print("\n".join(f"Wrote {path}" for path in written))


def measure(content: dict[str, object], arguments: argparse.Namespace) -> None:
    """A file that measures something instead of saying what is to be run."""
    folder = ROOT / "docs" / "results" if arguments.publish else ROOT / "results" / "studies"
    print("\n".join(f"Wrote {path}" for path in content["measure"](arguments.fmu, folder)))


def picture(content: dict[str, object], results: object, stem: Path, publish: bool) -> list[Path]:
    """The example's small table and its figure, beside the results or in docs/."""
    data, figure = stem, stem
    if publish:
        data = ROOT / "docs" / "results" / "data" / f"study_{stem.name}"
        figure = ROOT / "docs" / "figures" / f"study_{stem.name}"
    data.parent.mkdir(parents=True, exist_ok=True)
    table = content["table"](results)
    return [keep(table, data), *content["draw"](table, figure)]


def keep(table: object, stem: Path) -> Path:
    """A pandas table as CSV, an xarray dataset as NetCDF."""
    from .store import export

    if hasattr(table, "to_csv"):
        path = stem.with_suffix(".csv")
        table.to_csv(path, index=False, float_format="%.6g", lineterminator="\n")
        return path
    return export(table, stem.with_suffix(".nc"))


if __name__ == "__main__":
    sys.exit(main())
