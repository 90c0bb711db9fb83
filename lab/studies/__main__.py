"""The command ./scripts/study: runs what its arguments (options.py) describe."""

import argparse
import runpy
import signal
import sys
import time
from pathlib import Path
from typing import Any

from wheelfmu.fmu import files
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

from .options import INTERRUPTED, arguments_of
from .plan import Study

Content = dict[str, Any]  # `study`, `name`; of a file perhaps `draw`; of earlier results `out`


def study_file(path: Path) -> Content:
    """The names that a study's file defines."""
    sys.path.append(str(path.resolve().parent))  # for what it imports from there
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise Fault(f"{path} does not define study = Study(...).")
    return content | {"name": path.stem}


def content_of(given: Path | Study) -> Content:
    from .dataset import open_results, study_of

    if isinstance(given, Study):
        return {"study": given, "name": "study"}
    if given.suffix == ".zarr":  # a folder of results, which goes on
        return {"study": study_of(open_results(given)), "name": given.stem, "out": given}
    return study_file(given)


def conduct(arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and prints the outcome and where it is."""
    from wheelfmu.diagrams.style import save_png

    from .checking import checked  # before a run: Dask's scheduler reloads this package in its own process
    from .compute import run
    from .dataset import export, exported, summarize
    from .pictures import draw

    content = content_of(arguments.study)
    study, stem = content["study"], ROOT / "results" / "studies" / content["name"]
    arguments.out = out = str(content.get("out") or arguments.out or f"{stem}.zarr").removeprefix("file://")
    if "://" not in out:
        stem = Path(out.removesuffix(".zarr"))
    asked = {".nc": arguments.netcdf, ".csv": arguments.csv}
    exports = [Path(f"{stem}{end}") for end in asked if asked[end]]
    published = ROOT / "docs" / "figures" / f"study_{stem.name}.png"
    picture = published if arguments.publish and "draw" in content else Path(f"{stem}.png")
    written = [*exports, *[picture] * (picture != published)]
    read = [arguments.fmu, arguments.list, arguments.study if "out" not in content else None]
    before = exported(out)
    files.check(
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
    if figure := content.get("draw", draw)(results):
        paths.append(save_png(figure, picture))
    print("\n".join(f"Wrote {path}" for path in paths))


def main(argv: list[str] | None = None) -> int:
    try:
        return carried_out(arguments_of(argv))
    except Fault as fault:
        code, text = 2, str(fault)
    except KeyboardInterrupt:
        code, text = 128 + signal.SIGINT, INTERRUPTED
    print(f"study: {text}", file=sys.stderr)
    return code


def carried_out(arguments: argparse.Namespace) -> int:
    """Runs a study. Fault where it cannot be run as it is written."""
    try:
        conduct(arguments)
        return 0
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        text = f"{arguments.out}: {fault}; results so far are kept; the same command continues from here."
    print(f"study: {text}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
