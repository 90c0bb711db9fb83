"""./scripts/report NAME…|all: measures, and writes the page NAME.md, its pictures and data into build/report/latest.

With --publish they go to docs/results, which is kept under version control, and the figures in the prose of every
document, `3.1e-9<!--accuracy.error_free-->`, follow. A report is a module NAME: its parts measure, in their order, its
PICTURES are drawn from tables, its `views` add tables that follow from others, and templates/NAME.md.j2 is its page;
one without is written by hand.
"""

from __future__ import annotations

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
from .options import NAMES, arguments
from .page import RESULTS, Part, Report, read_tables, render

BAR = "{percentage:3.0f} % |{bar:20}| {elapsed}, {remaining} left; {desc}"
TEMPLATES = Path(__file__).parent / "templates"
CREDIBILITY = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "credibility.srmd"


def module(name: str) -> ModuleType:
    return import_module(f".{name}", __package__)


def parts_of(module: ModuleType) -> list[Part]:
    """The module's parts, in their order, and those of the modules that it names."""
    modules = (module, *(import_module(f".{name}", __package__) for name in getattr(module, "FURTHER", ())))
    return [part for module in modules for part in vars(module).values() if isinstance(part, Part)]


def measure(names: list[str], folder: Path, options: Namespace) -> None:
    library = Library.unpacked(build_folder() / "wheel.fmu")
    parts = {name: parts_of(module(name)) for name in names}
    with bar(total=sum(part.seconds for of in parts.values() for part in of), bar_format=BAR) as done:
        for name in names:
            report = Report(name, library, folder, options.quick)
            for part in parts[name]:
                done.set_description_str(f"{name}: {part.words}")
                report.measure(part)
                report.write()
                done.update(part.seconds)
    library.remove()


def rendered(name: str, folder: Path) -> tuple[str, str]:
    """The page, none where it is written by hand, and the requirements that are not met."""
    has_page = (TEMPLATES / f"{name}.md.j2").exists()
    return render(name, folder, getattr(module(name), "views", dict)) if has_page else ("", "")


def draw(name: str, folder: Path) -> bool:
    """The pictures that are drawn from tables, and the page; whether all requirements are met."""
    for picture, sheet in getattr(module(name), "PICTURES", {}).items():
        style.save_png(sheet(read_tables(name, folder)), folder / f"{name}_{picture}.png", plots.DPI)
    text, missed = rendered(name, folder)
    if text:
        (folder / f"{name}.md").write_text(text, encoding="utf-8")
    print(f"{name}: {f'not met: {missed}' if missed else 'all requirements are met'}.")
    return not missed


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
    differs = page.exists() and rendered(name, folder)[0] != page.read_text(encoding="utf-8")
    if differs:
        print(f"{name}.md is not the page of the data: run ./scripts/report {name} --render.")
    return differs


def main(options: Namespace) -> int:
    names = list(NAMES) if "all" in options.names else list(dict.fromkeys(options.names))
    published = options.publish or options.render or options.check
    folder = RESULTS if published else ROOT / "build" / "report" / ("quick" if options.quick else "latest")
    folder.mkdir(parents=True, exist_ok=True)
    if options.check:
        for page in (others := outdated()):
            print(f"{page.relative_to(ROOT)} has other figures than the data: run ./scripts/report all --render.")
        return int(sum(stale(name, folder) for name in names) + len(others) > 0)
    if not options.render:
        measure(names, folder, options)
    met = [draw(name, folder) for name in names]
    for page, text in outdated().items() if published else ():
        page.write_text(text, encoding="utf-8")
    if not published:
        print(f"Written into {folder.relative_to(ROOT)}.")
    return int(not all(met))


if __name__ == "__main__":
    sys.exit(main(arguments()))
