"""The command ./scripts/study: runs what its arguments (options.py) describe."""

import argparse
import runpy
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

from wheelfmu.fmu import outputs
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

from .options import arguments_of
from .plan import Study

Content = dict[str, Any]  # `study`, `name`; of a file perhaps `table` and `draw`; of earlier results `out`


def study_file(path: Path, wheel: str | None = None, body: str | None = None) -> Content:
    """The names that a study's file defines, of a preset or body if given."""
    sys.path.append(str(path.resolve().parent))  # for what it imports from there
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise Fault(f"{path} does not define study = Study(...).")
    if body:
        content["study"] = replace(content["study"], body=body)
    if wheel:
        content["study"] = content["study"].scaled(wheel)
    return content | {"name": "_".join(filter(None, [path.stem, wheel, body]))}


def content_of(arguments: argparse.Namespace) -> Content:
    from .dataset import open_results, study_of

    given = arguments.study
    if isinstance(given, Study):
        return {"study": given, "name": "study"}
    if given.suffix == ".zarr":  # a folder of results, which goes on
        return {"study": study_of(open_results(given)), "name": given.stem, "out": given}
    return study_file(given, arguments.wheel, arguments.body)


def conduct(arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and prints the outcome and where it is."""
    from .checking import checked  # before a run: Dask's scheduler reloads this package in its own process
    from .compute import run
    from .dataset import export, exported, summarize
    from .pictures import draw as usual

    content = content_of(arguments)
    study, stem, table = content["study"], ROOT / "results" / "studies" / content["name"], content.get("table")
    draw = content.get("draw", None if table else usual)
    arguments.out = out = str(content.get("out") or arguments.out or f"{stem}.zarr")
    if "://" not in out:
        stem = Path(out.removesuffix(".zarr"))
    if table and arguments.netcdf:
        raise Fault("--netcdf: this study writes its own table as NetCDF.")
    asked = {".nc": arguments.netcdf, ".csv": arguments.csv}
    exports = [Path(f"{stem}{end}") for end in asked if asked[end]]
    figure = ROOT / "docs" / "figures" / f"study_{stem.name}" if arguments.publish and table else stem
    written = [*exports, *[Path(f"{stem}.nc")] * bool(table), *[Path(f"{stem}.png")] * bool(draw and figure == stem)]
    read = [arguments.fmu, arguments.list, arguments.study if "out" not in content else None]
    before = exported(out)
    outputs.check(
        [*[Path(out)] * ("://" not in out), *written],
        [path for path in read if isinstance(path, Path)],
        lambda path: path.name in before,
        overwrite=arguments.overwrite,
    )
    begin = time.perf_counter()
    workers = arguments.scheduler or arguments.workers
    results = run(study, out, fmu=arguments.fmu, workers=workers, overwrite=arguments.overwrite)
    exported(out, {path.name for path in written})
    print(summarize(results, time.perf_counter() - begin))
    if arguments.check:
        results, said = checked(study, results, arguments.fmu, out, arguments.check)
        print(said)
    paths = [out, *(export(results, path) for path in exports)]
    if table:  # an example's own table
        results = table(results)
        paths.append(export(results, Path(f"{stem}.nc")))
    if draw:
        paths += filter(None, [draw(results, figure)])
    print("\n".join(f"Wrote {path}" for path in paths))


def main(argv: list[str] | None = None) -> int:
    try:
        return carried_out(arguments_of(argv))
    except Fault as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 2


def carried_out(arguments: argparse.Namespace) -> int:
    """Runs a study; what stops it is one line on stderr. Fault where it cannot be run as it is written."""
    try:
        conduct(arguments)
        return 0
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        code, text = 2, f"{arguments.out}: {fault}; results so far are kept; the same command continues from here."
    except KeyboardInterrupt:
        code, text = 130, "stopped; the same command continues from here."
    print(f"study: {text}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
