"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options."""

from __future__ import annotations

import argparse
import runpy
import sys
import time
from pathlib import Path

from .measures import StudyError
from .options import ROOT, arguments_of, check, fields_of, file_of
from .plan import Study


def study_file(name: str) -> dict[str, object]:
    """What a study's file defines: `study`, perhaps `table` and `draw`."""
    path = file_of(name)
    sys.path.insert(0, str(path.resolve().parent))
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise StudyError(f"{path} does not say study = Study(...).")
    return content | {"name": path.stem}


def main(argv: list[str] | None = None) -> int:
    """Runs a study; a fault of the study is one sentence on stderr and exit status 2."""
    arguments = arguments_of(argv)
    try:
        check(arguments)
        content = (
            study_file(arguments.study)
            if arguments.study
            else {"study": Study(**fields_of(arguments)), "name": "study"}
        )
        conduct(content, arguments)
    except StudyError as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 2
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        print(f"study: {fault}; what is written stays, and the same command goes on from here.", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("study: stopped; the same command goes on from here.", file=sys.stderr)
        return 130
    return 0


def conduct(content: dict[str, object], arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and says what came out and where it is."""
    from .compute import run
    from .results import export, summarize

    stem = ROOT / "results" / "studies" / content["name"]
    out = arguments.out or str(stem.with_suffix(".zarr"))
    if "://" not in out:
        stem = Path(out).with_suffix("")
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
        written.append(export(results, stem.with_suffix(".nc")))
    if arguments.csv:
        written.append(export(results, stem.with_suffix(".csv")))
    if "draw" in content:
        written += picture(content, results, stem, arguments.publish)
    print("\n".join(f"Wrote {path}" for path in written))


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
    from .results import export

    if hasattr(table, "to_csv"):
        path = stem.with_suffix(".csv")
        table.to_csv(path, index=False, float_format="%.6g", lineterminator="\n")
        return path
    return export(table, stem.with_suffix(".nc"))


if __name__ == "__main__":
    sys.exit(main())
