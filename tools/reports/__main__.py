"""./scripts/report NAME…|all: measures, and writes the page NAME.md, its pictures and data into build/report/latest.

With --publish they go to docs/results, which is kept under version control, and the figures in all pages are filled in
from them.
"""

from __future__ import annotations

import sys
from argparse import Namespace
from importlib import import_module
from pathlib import Path
from types import ModuleType

from support.motion import Library
from support.paths import ROOT, build_folder
from tqdm import tqdm

from diagrams import style
from publishing import documents

from . import plots
from .options import NAMES, arguments
from .page import Report, read_tables, render


def measure(names: list[str], folder: Path, options: Namespace) -> None:
    """Each part of each report says how many seconds it takes, so that the bar can tell the time left."""
    parts = [(name, part, seconds) for name in names for part, seconds in module(name).PARTS.items()]
    library = Library.unpacked(build_folder() / "wheel.fmu")
    reports = {name: Report(name, library, folder, options.quick, vars(options)) for name in names}
    layout = "{percentage:3.0f} % |{bar:20}| {elapsed}, {remaining} left; {desc}"
    with tqdm(total=sum(seconds for *_, seconds in parts), bar_format=layout) as bar:
        for name, part, seconds in parts:
            bar.set_description_str(f"{name}: {(part.__doc__ or part.__name__).splitlines()[0]}")
            part(reports[name])
            reports[name].write()
            bar.update(seconds)
    library.remove()


def module(name: str) -> ModuleType:
    return import_module(f".{name}", __package__)


def draw(name: str, folder: Path) -> bool:
    """The pictures that are drawn from tables, and the page; whether all requirements are met."""
    of, missed = module(name), ""
    for picture, sheet in getattr(of, "PICTURES", {}).items():
        style.save_png(sheet(read_tables(folder, name)), folder / f"{name}_{picture}.png", plots.DPI)
    if hasattr(of, "page"):
        of.page(folder)
    else:
        text, missed = render(name, folder, getattr(of, "views", dict))
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
    print(f"{name}: {f'not met: {missed}' if missed else 'all requirements are met'}.")
    return not missed


def fresh(name: str, folder: Path) -> bool:
    """Whether the page that is there is the one of the data; a report that was not published yet has none."""
    if hasattr(module(name), "page") or not (folder / "data" / f"{name}.csv").exists():
        return True
    text, _ = render(name, folder, getattr(module(name), "views", dict))
    same = text == (folder / f"{name}.md").read_text(encoding="utf-8")
    if not same:
        print(f"{name}.md is not the page of the data: run ./scripts/report {name} --render.")
    return same


def main() -> int:
    options = arguments()
    names = list(NAMES) if "all" in options.names else list(dict.fromkeys(options.names))
    published = options.publish or options.render or options.check
    folder = ROOT / "docs" / "results"
    if not published:
        folder = ROOT / "build" / "report" / ("quick" if options.quick else "latest")
    folder.mkdir(parents=True, exist_ok=True)
    if options.check:
        stale = [name for name in names if not fresh(name, folder)]
        return int(bool(stale))
    if not options.render:
        measure(names, folder, options)
    met = [draw(name, folder) for name in names]
    if not published:
        print(f"Written into {folder.relative_to(ROOT)}.")
    else:
        sys.argv = sys.argv[:1]
        documents.main()
    return int(not all(met))


if __name__ == "__main__":
    sys.exit(main())
