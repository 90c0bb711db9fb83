"""The command ./scripts/study: runs what its arguments (options.py) describe."""

import argparse
import runpy
import sys
import time
from dataclasses import replace
from pathlib import Path

from wheelfmu.fmu import outputs
from wheelfmu.fmu.values import Fault

from .options import arguments_of
from .plan import ROOT, Study, StudyError


def study_file(path: Path, wheel: str | None = None, body: str | None = None) -> dict[str, object]:
    """The names that a study's file defines: `study`, of a preset or body if given, perhaps `table` and `draw`."""
    sys.path.append(str(path.resolve().parent))  # for what it imports from there
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
    kept = isinstance(arguments.study, Path) and arguments.study.suffix == ".zarr"
    if isinstance(arguments.study, Path) and not kept:
        content = study_file(arguments.study, arguments.wheel, arguments.body)
    from .checking import checked  # before a run: Dask's scheduler reloads this package in its own process
    from .compute import run
    from .dataset import export, exported, open_results, study_of, summarize

    if kept:  # a folder of results, which goes on
        arguments.out = str(arguments.study)
        content = {"study": study_of(open_results(arguments.out)), "name": arguments.study.stem}
    if "table" not in content:
        from .pictures import draw

        content["draw"] = draw
    stem = ROOT / "results" / "studies" / content["name"]
    arguments.out = out = arguments.out or f"{stem}.zarr"
    if "://" not in out:
        stem = Path(out.removesuffix(".zarr"))
    if "table" in content and arguments.netcdf:
        raise StudyError("--netcdf: this study writes its own table as NetCDF.")
    asked = {".nc": arguments.netcdf, ".csv": arguments.csv}
    exports = {Path(f"{stem}{end}"): end for end in asked if asked[end]}
    written = [*exports, *[Path(f"{stem}.nc")] * ("table" in content)]
    if "draw" in content and not arguments.publish:
        written.append(Path(f"{stem}.png"))
    folder = [Path(out)] * ("://" not in out)
    read = [arguments.study] * (isinstance(arguments.study, Path) and not kept)
    inputs = [arguments.fmu, *filter(None, [arguments.list]), *read]
    before = exported(out)
    outputs.check([*folder, *written], inputs, lambda path: path.name in before, overwrite=arguments.overwrite)
    begin = time.perf_counter()
    workers = arguments.scheduler or arguments.workers
    results = run(content["study"], out, fmu=arguments.fmu, workers=workers, overwrite=arguments.overwrite)
    exported(out, {path.name for path in written})
    print(summarize(results, time.perf_counter() - begin))
    if arguments.check:
        results, said = checked(content["study"], results, arguments.fmu, out, arguments.check)
        print(said)
    paths = [out, *(export(results, path) for path in exports)]
    if "table" in content:  # an example's own table and figure
        table = content["table"](results)
        paths.append(export(table, Path(f"{stem}.nc")))
        results = table
    if "draw" in content:
        figure = ROOT / "docs" / "figures" / f"study_{stem.name}" if arguments.publish and "table" in content else stem
        paths += filter(None, [content["draw"](results, figure)])
    print("\n".join(f"Wrote {path}" for path in paths))


def main(argv: list[str] | None = None) -> int:
    try:
        return carried_out(arguments_of(argv))
    except (StudyError, Fault) as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 2


def carried_out(arguments: argparse.Namespace) -> int:
    """Runs a study; a fault of the study is one line on stderr and exit status 2."""
    try:
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
