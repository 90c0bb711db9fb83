"""The command ./scripts/study: a study from a file, one of the examples by name, or one written as options."""

from __future__ import annotations

import argparse
import runpy
import sys
import time
from pathlib import Path

from .options import ROOT, Fault, arguments_of, file_of, study_of
from .plan import Study, StudyError


def study_file(name: str, wheel: str | None = None) -> dict[str, object]:
    """The names that a study's file defines: `study`, of a ready wheel if one is given, perhaps `table` and `draw`."""
    path = file_of(name)
    sys.path.insert(0, str(path.resolve().parent))
    content = runpy.run_path(str(path))
    if not isinstance(content.get("study"), Study):
        raise StudyError(f"{path} does not define study = Study(...).")
    if wheel:
        content |= {"study": content["study"].scaled(wheel)}
    return content | {"name": f"{path.stem}_{wheel}" if wheel else path.stem}


def main(argv: list[str] | None = None) -> int:
    """Runs a study; a fault of the study is one line on stderr and exit status 2."""
    arguments = arguments_of(argv)
    try:
        if arguments.study:
            content = study_file(arguments.study, arguments.wheel)
        else:
            content = {"study": study_of(arguments), "name": "study"}
        conduct(content, arguments)
    except (StudyError, Fault) as fault:
        print(f"study: {fault}", file=sys.stderr)
        return 2
    except OSError as fault:  # a full disk, or one that cannot be reached any more
        print(f"study: {fault}; results so far are kept; the same command continues from here.", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("study: stopped; the same command continues from here.", file=sys.stderr)
        return 130
    return 0


def conduct(content: dict[str, object], arguments: argparse.Namespace) -> None:
    """Runs, exports, draws, and prints the outcome and where it is."""
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
    written = [out, *(export(results, stem.with_suffix(end)) for end in (".nc", ".csv") if asked[end])]
    if "table" in content:  # an example's own table and figure, beside the results or in docs/
        data, figure = stem, stem
        if arguments.publish:
            data = ROOT / "docs" / "results" / "data" / f"study_{stem.name}"
            figure = ROOT / "docs" / "figures" / f"study_{stem.name}"
        table = content["table"](results)
        written.append(export(table, data.with_suffix(".csv" if hasattr(table, "to_csv") else ".nc")))
        written += [content["draw"](table, figure)] if "draw" in content else []
    print("\n".join(f"Wrote {path}" for path in written))


if __name__ == "__main__":
    sys.exit(main())
