"""A report: what it measures goes into CSV files, and out of these alone come its pictures and its page of Markdown.

requirements.csv lists every figure in its report's order: unit, what is asked of it (an upper bound, zero included, or
nothing), and words. docs/results/data/NAME.csv has the figures as measured, NAME_TABLE.csv the tables, made.csv the
machine, versions, commit and date of each report.
"""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from importlib.metadata import distributions
from io import StringIO
from pathlib import Path
from typing import Any

import pandas as pd
from support.motion import Library
from support.paths import build_folder

from publishing.markdown import number, page, said

Row = Mapping[str, object]
Tables = dict[str, pd.DataFrame]
Part = Callable[["Report"], None]
PACKAGES = ("FMPy", "numpy", "scipy", "matplotlib", "heyoka", "numba", "numbalsoda")
REQUIREMENTS = pd.read_csv(Path(__file__).with_name("requirements.csv")).set_index(["report", "figure"])


def part(seconds: float) -> Callable[[Part], Part]:
    """Makes a function a part of its module's report; the bar needs the time that it takes."""

    def marked(measure: Part) -> Part:
        measure.seconds = seconds
        return measure

    return marked


@dataclass
class Report:
    """What one report measures. quick: fewer cases and repetitions, to see that it works."""

    name: str
    library: Library
    folder: Path
    quick: bool = False
    options: Mapping[str, Any] = field(default_factory=dict)
    measured: dict[str, float] = field(default_factory=dict)
    kept: dict[str, Any] = field(default_factory=dict)  # what several parts of a report use

    def figures(self, **measured: float) -> None:
        """Numbers that requirements.csv lists."""
        unknown = [name for name in measured if (self.name, name) not in REQUIREMENTS.index]
        assert not unknown, f"requirements.csv does not list {unknown} of {self.name}"
        self.measured |= {name: float(value) for name, value in measured.items()}

    def table(self, name: str, rows: pd.DataFrame | Sequence[Row]) -> None:
        write_csv(self.folder, f"{self.name}_{name}", pd.DataFrame(rows))

    def write(self) -> None:
        """The figures, and what they were measured with."""
        found = REQUIREMENTS.loc[self.name].join(pd.Series(self.measured, name="measured", dtype=float), how="inner")
        columns = ["figure", "measured", "unit", "asked", "what"]
        write_csv(self.folder, self.name, found.rename_axis("figure").reset_index()[columns])
        path = self.folder / "data" / "made.csv"
        others = pd.read_csv(path, dtype=str) if path.exists() else pd.DataFrame({"report": []})
        rows = pd.concat([others[others["report"] != self.name], pd.DataFrame([made(self.name)])])
        write_csv(self.folder, "made", rows.sort_values("report"))


def write_csv(folder: Path, name: str, frame: pd.DataFrame) -> None:
    """Floats with seven digits."""
    (folder / "data").mkdir(parents=True, exist_ok=True)
    short = frame.map(lambda cell: float(f"{cell:.7g}") if isinstance(cell, float) else cell)
    short.to_csv(folder / "data" / f"{name}.csv", index=False, lineterminator="\n")


def read_tables(folder: Path, name: str) -> Tables:
    """The tables of a report by name; one without rows may lack its columns too."""
    texts = {file.stem: file.read_text(encoding="utf-8") for file in sorted((folder / "data").glob(f"{name}_*.csv"))}
    return {
        stem.removeprefix(f"{name}_"): pd.read_csv(StringIO(text)) if text.strip() else pd.DataFrame()
        for stem, text in texts.items()
    }


def render(name: str, folder: Path, views: Callable[[Tables], Tables] = dict) -> tuple[str, str]:
    """The page out of the data, and what was not met in words; views: adds the tables that follow from others."""
    figures = pd.read_csv(folder / "data" / f"{name}.csv").fillna({"unit": ""})
    figures["shown"] = [f"{number(float(f.measured))} {f.unit}".strip() for f in figures.itertuples()]
    asked = figures[figures["asked"].notna()]
    met = asked["measured"] <= asked["asked"]
    bounds = [f"{'≤' if f.asked else '='} {number(f.asked)} {f.unit}".strip() for f in asked.itertuples()]
    measured = asked["shown"].where(met, "**" + asked["shown"] + "**")
    table = {"figure": asked["what"], "required": bounds, "measured": measured}
    missed = [f"{f.what} ({f.shown})" for f in asked[~met].itertuples()]
    run = pd.read_csv(folder / "data" / "made.csv", index_col="report", dtype=str).loc[name]
    values = {f.figure: number(float(f.measured)) for f in figures.itertuples()}
    given = {"name": name, "f": values, "t": views(read_tables(folder, name)), "run": run}
    return page(f"{name}.md.j2", asked=pd.DataFrame(table), missed=missed, **given), "; ".join(missed)


def cached(name: str) -> str:
    """An entry of the build's CMakeCache.txt."""
    text = (build_folder() / "CMakeCache.txt").read_text()
    entry = re.search(rf"^{name}:[A-Z]+=(.*)$", text, re.MULTILINE)
    return entry[1] if entry else ""


def made(name: str) -> Row:
    """Machine, versions, commit, date; no names of users or folders. Files that reports write are no change."""
    info = Path("/proc/cpuinfo")
    model = re.search(r"^model name\s*:\s*(.+)$", info.read_text(), re.MULTILINE) if info.exists() else None
    processor = model[1] if model else platform.processor() or platform.machine()
    installed = {found.name.lower(): found.version for found in distributions()}
    versions = [f"{p} {installed[p.lower()]}" if p.lower() in installed else f"no {p}" for p in PACKAGES]
    changed = said("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs", ":!*.md", ":!*.html")
    return {
        "report": name,
        "date": f"{datetime.now(UTC):%Y-%m-%d}",
        "machine": f"{processor}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {platform.system()}",
        "compiler": f"{said(cached('CMAKE_CXX_COMPILER'), '--version')}, {cached('CMAKE_CXX_FLAGS_RELEASE')}",
        "versions": ", ".join([f"Python {platform.python_version()}", *versions]),
        "commit": said("git", "rev-parse", "--short=12", "HEAD") + (", with local changes" if changed else ""),
    }
