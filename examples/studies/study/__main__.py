"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options."""

from __future__ import annotations

import argparse
import runpy
import sys
import time
from pathlib import Path

from .options import EXAMPLES, ROOT, arguments_of, example_names, named, number, numbers, read_list
from .plan import Study, StudyError


def study_of_options(arguments: argparse.Namespace) -> Study:
    """The study that the options describe."""
    options = {"stop_time": arguments.stop_time, "interval": arguments.interval, "tolerance": arguments.tolerance}
    if arguments.measure:
        options["measures"] = named(arguments.measure, str, "measure")
    return Study(
        grid=named(arguments.vary, numbers, "vary"),
        list=read_list(arguments.list) if arguments.list else {},
        values=named(arguments.set, number, "set"),
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
