"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options."""

import argparse
import runpy
import sys
import time
from pathlib import Path

from .options import ROOT, arguments_of
from .plan import Study, StudyError


def study_file(path: Path, wheel: str | None = None) -> dict[str, object]:
    """The names that a study's file defines: `study`, of a ready wheel if one is given, perhaps `table` and `draw`."""
    sys.path.insert(0, str(path.resolve().parent))
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise StudyError(f"{path} does not define study = Study(...).")
    if wheel:
        content |= {"study": content["study"].scaled(wheel)}
    return content | {"name": f"{path.stem}_{wheel}" if wheel else path.stem}


def main() -> int:
    """Runs a study; a fault of the study is one line on stderr and exit status 2."""
    try:
        conduct(arguments_of())
        return 0
    except StudyError as fault:
        code, text = 2, f"{fault}"
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        code, text = 2, f"{fault}; results so far are kept; the same command continues from here."
    except KeyboardInterrupt:
        code, text = 130, "stopped; the same command continues from here."
    print(f"study: {text}", file=sys.stderr)
    return code


def conduct(arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and prints the outcome and where it is."""
    content = {"study": arguments.study, "name": "study"}
    if isinstance(arguments.study, Path):
        content = study_file(arguments.study, arguments.wheel)
    from .compute import run
    from .dataset import export, summarize

    stem = ROOT / "results" / "studies" / content["name"]
    out = arguments.out or str(stem.with_suffix(".zarr"))
    if "://" not in out:
        stem = Path(out).with_suffix("")
    begin = time.perf_counter()
    how = {name: getattr(arguments, name) for name in ("fmu", "workers", "scheduler", "overwrite")}
    results = run(content["study"], out, **how)
    print(summarize(results, time.perf_counter() - begin))
    asked = {".nc": arguments.netcdf, ".csv": arguments.csv}
    written = [out, *(export(results, stem.with_suffix(end)) for end in asked if asked[end])]
    if "table" in content:  # an example's own table and figure, beside the results or in docs/
        published = ROOT / "docs" / "results" / "data", ROOT / "docs" / "figures"
        data, figure = (folder / f"study_{stem.name}" if arguments.publish else stem for folder in published)
        table = content["table"](results)
        written.append(export(table, data.with_suffix(".csv" if hasattr(table, "to_csv") else ".nc")))
        written += [content["draw"](table, figure)] if "draw" in content else []
    print("\n".join(f"Wrote {path}" for path in written))


if __name__ == "__main__":
    sys.exit(main())
