"""A report: figures with what was asked of them, tables, pictures; CSV files out of them, and a page of Markdown."""

from __future__ import annotations

import csv
import os
import platform
import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from figures_in_pages import number
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.figure import Figure as Sheet
from support.motion import Library
from support.paths import ROOT, build_folder
from tabulate import tabulate

Row = Mapping[str, object]
PACKAGES = ("FMPy", "numpy", "scipy", "matplotlib", "heyoka", "numba", "numbalsoda")


@dataclass(frozen=True)
class Figure:
    """A measured number. asked: its bound, None where nothing was asked; relation: "at most" or "exactly"."""

    figure: str
    what: str
    measured: float
    unit: str = ""
    asked: float | None = None
    relation: str = "at most"

    @property
    def met(self) -> bool:
        if self.asked is None:
            return True
        return self.measured == self.asked if self.relation == "exactly" else self.measured <= self.asked


@dataclass
class Report:
    """What one report has measured. quick: fewer cases and repetitions, to see that it works."""

    name: str
    library: Library
    folder: Path
    quick: bool = False
    options: dict[str, str] = field(default_factory=dict)
    figures: dict[str, Figure] = field(default_factory=dict)
    tables: dict[str, list[Row]] = field(default_factory=dict)
    words: dict[str, str] = field(default_factory=dict)
    kept: dict[str, Any] = field(default_factory=dict)  # what several parts of a report use

    def figure(self, figure: str, what: str, measured: float, unit: str = "", asked: float | None = None, **more: str):
        self.figures[figure] = Figure(figure, what, float(measured), unit, asked, **more)

    def table(self, name: str, rows: Sequence[Row]) -> None:
        """Rows of a table of the page; also docs/results/data/<report>_<name>.csv."""
        self.tables[name] = list(rows)
        write_csv(self.folder / "data" / f"{self.name}_{name}.csv", self.tables[name])

    def picture(self, name: str, sheet: Sheet) -> None:
        """docs/results/<report>_<name>.png; the file holds no date."""
        sheet.savefig(self.folder / f"{self.name}_{name}.png", dpi=150, metadata={"Software": None})

    @property
    def missed(self) -> list[Figure]:
        return [f for f in self.figures.values() if not f.met]

    def asked(self) -> list[Row]:
        """What was asked beside what was measured."""
        return [
            {
                "figure": f.what,
                "asked": f"{'≤' if f.relation == 'at most' else '='} {number(float(f.asked))} {f.unit}".strip(),
                "measured": f"{number(f.measured)} {f.unit}".strip(),
                "met": "yes" if f.met else "**no**",
            }
            for f in self.figures.values()
            if f.asked is not None
        ]

    def write(self) -> Path:
        rows = [
            {
                "figure": f.figure,
                "measured": f.measured,
                "unit": f.unit,
                "asked": f.asked,
                "met": f.met,
                "what": f.what,
            }
            for f in self.figures.values()
        ]
        write_csv(self.folder / "data" / f"{self.name}.csv", rows)
        loader = FileSystemLoader(Path(__file__).with_name("templates"))
        pages = Environment(loader=loader, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
        pages.filters |= {"table": markdown_table, "number": number}
        figures = {name: number(f.measured) for name, f in self.figures.items()}
        page = pages.get_template(f"{self.name}.md").render(
            report=self, f=figures, t=self.tables, words=self.words, asked=self.asked(), missed=self.missed
        )
        path = self.folder / f"{self.name}.md"
        path.write_text(re.sub(r"\n{3,}", "\n\n", page).strip() + f"\n\n{footer(self.name)}\n", encoding="utf-8")
        return path


def plain(value: object) -> object:
    """As it is kept in a CSV file: seven digits."""
    return f"{value:.7g}" if isinstance(value, float) else value


def write_csv(path: Path, rows: Sequence[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(rows[0]) if rows else [], lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: plain(value) for key, value in row.items()} for row in rows)


def markdown_table(rows: Sequence[Row]) -> str:
    """The first column to the left, the others to the right."""
    if not rows:
        return "None."
    cells = [[number(cell).replace("|", "\\|") for cell in row.values()] for row in rows]
    sides = ("left", *["right"] * (len(rows[0]) - 1))
    return tabulate(cells, list(rows[0]), tablefmt="pipe", disable_numparse=True, colalign=sides)


def said(*command: str) -> str:
    """First line of what a program prints."""
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return (found.stdout.strip().splitlines() or [""])[0]


def cached(name: str) -> str:
    """An entry of the build's CMakeCache.txt."""
    text = (build_folder() / "CMakeCache.txt").read_text()
    entry = re.search(rf"^{name}:[A-Z]+=(.*)$", text, re.MULTILINE)
    return entry[1] if entry else ""


def processor() -> str:
    info = Path("/proc/cpuinfo")
    model = re.search(r"^model name\s*:\s*(.+)$", info.read_text(), re.MULTILINE) if info.exists() else None
    return model[1] if model else platform.processor() or platform.machine()


def versions() -> str:
    found = [f"Python {platform.python_version()}"]
    for name in PACKAGES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"no {name}")
    return ", ".join(found)


def footer(name: str) -> str:
    """Machine, versions, commit, date; no names of users or folders. Files that reports write are no change."""
    changed = said("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs", ":!*.md", ":!*.html")
    lines = [
        f"Made by `./scripts/report {name}` on {datetime.now(UTC):%Y-%m-%d}.",
        f"Machine: {processor()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {platform.system()}.",
        f"Compiler: {said(cached('CMAKE_CXX_COMPILER'), '--version')}, {cached('CMAKE_CXX_FLAGS_RELEASE')}.",
        f"Versions: {versions()}.",
        f"Commit: {said('git', 'rev-parse', '--short=12', 'HEAD')}{', with local changes' if changed else ''}.",
    ]
    return "---\n\n" + "  \n".join(lines)
