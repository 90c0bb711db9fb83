"""./scripts/report NAME…|all: measures, and writes the page NAME.md, its pictures and data into build/report/latest.

With --publish they go to docs/results, which is kept under version control, and the figures in the prose of every
document, `3.1e-9<!--accuracy.error_free-->`, follow; with --part one part is measured, and its pictures are drawn, on
top of the data that are there. A report is a module NAME: its parts measure, in their order, and own pictures that are
drawn from tables; its `figures` follow from tables, as the tables do that its `views` add; templates/NAME.md.j2 is its
page; one without is written by hand.
"""

from __future__ import annotations

import shutil
import sys
from argparse import Namespace
from importlib import import_module
from pathlib import Path
from types import ModuleType

from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT, build_folder
from wheelfmu.fmu.progress import bar
from wheelfmu.fmu.values import Fault
from wheelfmu.publishing.markdown import pages, with_figures
from wheelfmu.truth.motion import Library

from . import plots
from .options import FURTHER, arguments
from .page import RESULTS, WHOLE, Part, Report, misses, read_tables, render

BAR = "{percentage:3.0f} % |{bar:20}| {elapsed}, {remaining} left; {desc}"
TEMPLATES = Path(__file__).parent / "templates"
CREDIBILITY = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "credibility.srmd"


def module(name: str) -> ModuleType:
    return import_module(f".{name}", __package__)


def parts_of(name: str) -> list[Part]:
    """The parts of a report's module, in their order, and those of the modules that belong to it."""
    modules = [module(of) for of in (name, *FURTHER.get(name, ()))]
    return [part for of in modules for part in vars(of).values() if isinstance(part, Part)]


def begin(folder: Path) -> None:
    """What is measured elsewhere than in docs/results starts from a copy of the data there."""
    if not (folder / "data").exists():
        shutil.copytree(RESULTS / "data", folder / "data")


def measure(parts: dict[str, list[Part]], folder: Path, options: Namespace) -> None:
    library = Library.unpacked(build_folder() / "wheel.fmu")
    with bar(total=sum(part.seconds for of in parts.values() for part in of), bar_format=BAR) as done:
        for name, of in parts.items():
            report = Report(name, library, folder, options.quick, getattr(module(name), "figures", lambda _: {}))
            for part in of:
                done.set_description_str(f"{name}: {part.words}")
                report.measure(part)
                done.update(part.seconds)
            report.write(options.part or WHOLE)
    library.remove()


def rendered(name: str, folder: Path) -> str:
    """The page; none where it is written by hand."""
    has_page = (TEMPLATES / f"{name}.md.j2").exists()
    return render(name, folder, getattr(module(name), "views", dict)) if has_page else ""


def draw(name: str, parts: list[Part], folder: Path) -> None:
    """The parts' pictures that are drawn from tables, and the page."""
    for part in parts:
        for picture, sheet in part.pictures.items():
            style.save_png(sheet(read_tables(name, folder)), folder / f"{name}_{picture}.png", plots.DPI)
    if text := rendered(name, folder):
        (folder / f"{name}.md").write_text(text, encoding="utf-8")


def missed(names: list[str], folder: Path) -> bool:
    """Whether a figure is beyond its bound; a sentence for each."""
    sentences = [sentence for name in names for sentence in misses(name, folder)]
    for sentence in sentences:
        print(sentence, file=sys.stderr)
    return bool(sentences)


def filled(page: Path, text: str) -> str:
    """A document with the figures of the data; Fault names it."""
    try:
        return with_figures(text)
    except Fault as fault:
        raise Fault(f"{page.relative_to(ROOT)}: {fault}") from fault


def outdated() -> dict[Path, str]:
    """The documents whose figures in prose are not those of the data, as they have to be."""
    texts = {page: page.read_text(encoding="utf-8") for page in (*pages(), CREDIBILITY)}
    return {page: new for page, text in texts.items() if (new := filled(page, text)) != text}


def stale(name: str, folder: Path) -> bool:
    """Whether the page that is there is not the one of the data; a report that was not published yet has none."""
    page = folder / f"{name}.md"
    differs = page.exists() and rendered(name, folder) != page.read_text(encoding="utf-8")
    if differs:
        print(f"{name}.md is not the page of the data: run ./scripts/report {name} --render.")
    return differs


def main(options: Namespace) -> int:
    names = options.names
    published = options.publish or options.render or options.check
    folder = RESULTS if published else ROOT / "build" / "report" / ("quick" if options.quick else "latest")
    if options.check:
        for page in (others := outdated()):
            print(f"{page.relative_to(ROOT)} has other figures than the data: run ./scripts/report all --render.")
        return int(sum([*(stale(name, folder) for name in names), missed(names, folder)]) + len(others) > 0)
    parts = {name: [part for part in parts_of(name) if options.part in (None, part.name)] for name in names}
    if not options.render:
        begin(folder)
        measure(parts, folder, options)
    for name, of in parts.items():
        draw(name, of, folder)
    for page, text in outdated().items() if published else ():
        page.write_text(text, encoding="utf-8")
    if not published:
        print(f"Written into {folder.relative_to(ROOT)}.")
    return int(missed(names, folder))


if __name__ == "__main__":
    sys.exit(main(arguments()))
