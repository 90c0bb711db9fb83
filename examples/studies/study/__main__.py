"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options.

Arguments are read, and refused where wrong, by Python alone, before anything is installed. Names are checked against
the FMU's modelDescription.xml. Values are in SI units, or have a unit behind them. --help ends with these

examples:
  ./scripts/study fates                     one of the examples: {names}
  ./scripts/study fates --wheel coin        with a ready wheel: {wheels}
  ./scripts/study fates --body disc         with a homogeneous body of the same m, r_0 and r
  ./scripts/study my_study.py               a file that defines study = Study(...); see docs/studies.md
  ./scripts/study --vary theta_start=60deg:90deg:31 --vary s=0,0.01,0.03 --set phi_dot_start=-3 \\
      --measure lowest=lowest --out results/studies/lean.zarr --csv
  ./scripts/study --list starts.csv         one wheel per row; the first row has the names
"""

import argparse
import csv
import runpy
import sys
import time
from dataclasses import replace
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parent.parent
if not __package__:  # run as a file, by scripts/help
    sys.path[:0] = [str(EXAMPLES), str(EXAMPLES.parent / "python")]
from values import MOMENTS, Fault, bodies, number, parted, ready, suggestion, variables, wheels  # noqa: E402

from study.plan import ROOT, SETTABLE, Study, StudyError, check_names, description  # noqa: E402

NAMES = sorted(path.stem for path in EXAMPLES.glob("*.py"))  # the studies that lie beside this package


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

    grid = {name: numbers(name, text, unit(name)) for name, text in pairs(arguments.vary).items()}
    rows = {name: numbers(name, ",".join(column), unit(name)) for name, *column in columns(arguments.list)}
    if bool(grid) == bool(rows):
        raise StudyError("Which wheels? Give an example, a file, --vary NAME=VALUES, or --list CSV; see --help.")
    derived = MOMENTS if arguments.body else ()
    values = {name: x for name, x in arguments.ready.items() if name not in {*grid, *rows, *derived}}
    values |= {name: number(name, text, unit(name)) for name, text in pairs(arguments.set).items()}
    names = ("history", "stop_time", "interval", "tolerance", "branch_at", "body")
    fields = {name: getattr(arguments, name) for name in names}
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
    """The arguments, `study` as the path of a file or as the Study that the others describe; Fault, StudyError."""
    parser = argparse.ArgumentParser(
        prog="./scripts/study",
        description="Runs many wheels on all cores or on a Dask cluster. Started again, it continues where it stopped.",
        epilog=__doc__[__doc__.index("examples:") :].format(names=", ".join(NAMES), wheels=", ".join(wheels())),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add, several = parser.add_argument, {"action": "append", "default": []}
    add("study", nargs="?", help="an example's name or a Python file")
    add("--wheel", metavar="NAME", help="a ready wheel, to which lengths, times and rates of a study's file are scaled")
    add("--body", metavar="NAME", help=f"{', '.join(bodies())}: J_x, J_y, J_z follow from m, r_0, r of each wheel")
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
    add("--publish", action="store_true", help="write an example's figure into docs/figures")
    arguments = parser.parse_args(argv)
    arguments.ready = ready(arguments.wheel) if arguments.wheel else {}
    arguments.study = file_of(arguments.study) if arguments.study else study_of(arguments)
    return arguments


def study_file(path: Path, wheel: str | None = None, body: str | None = None) -> dict[str, object]:
    """The names that a study's file defines: `study`, of a ready wheel or body if given, perhaps `table` and `draw`."""
    sys.path.insert(0, str(path.resolve().parent))
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise StudyError(f"{path} does not define study = Study(...).")
    if body:
        content["study"] = replace(content["study"], body=body)
    if wheel:
        content["study"] = content["study"].scaled(wheel)
    return content | {"name": "_".join(filter(None, [path.stem, wheel, body]))}


def conduct(arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and prints the outcome and where it is."""
    content = {"study": arguments.study, "name": "study"}
    if isinstance(arguments.study, Path):
        content = study_file(arguments.study, arguments.wheel, arguments.body)
    from .compute import run
    from .dataset import export, summarize

    stem = ROOT / "results" / "studies" / content["name"]
    arguments.out = out = arguments.out or str(stem.with_suffix(".zarr"))
    if "://" not in out:
        stem = Path(out).with_suffix("")
    begin = time.perf_counter()
    workers = arguments.scheduler or arguments.workers
    results = run(content["study"], out, fmu=arguments.fmu, workers=workers, overwrite=arguments.overwrite)
    print(summarize(results, time.perf_counter() - begin))
    asked = {".nc": arguments.netcdf, ".csv": arguments.csv}
    written = [out, *(export(results, stem.with_suffix(end)) for end in asked if asked[end])]
    if "table" in content:  # an example's own table and figure
        table = content["table"](results)
        written.append(export(table, stem.with_suffix(".nc")))
        figure = ROOT / "docs" / "figures" / f"study_{stem.name}" if arguments.publish else stem
        written += [content["draw"](table, figure)] if "draw" in content else []
    print("\n".join(f"Wrote {path}" for path in written))


def main(argv: list[str] | None = None) -> int:
    """Runs a study; a fault of the study is one line on stderr and exit status 2."""
    try:
        arguments = arguments_of(argv)
        if __package__:  # else the arguments alone are checked
            conduct(arguments)
        return 0
    except (StudyError, Fault) as fault:
        code, text = 2, f"{fault}"
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        code, text = 2, f"{arguments.out}: {fault}; results so far are kept; the same command continues from here."
    except KeyboardInterrupt:
        code, text = 130, "stopped; the same command continues from here."
    print(f"study: {text}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
