"""A report: its parts measure tables and figures; out of these data alone come its pictures and its page of Markdown.

requirements.csv lists every figure in its report's order: the cell of a table (its row by the first column) or the
reduction of a column that it is, unless a part measures it; unit, what is asked of it (an upper bound, zero included,
or nothing), and words. In docs/results/data, figures.csv has the figures of all reports as measured, made.csv machine,
versions, commit and date, NAME_TABLE.csv each long table, NAME.txt the short ones, one below the other.
"""

from __future__ import annotations

import os
import platform
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property
from importlib.metadata import distributions
from io import StringIO
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from wheelfmu.fmu.paths import ROOT, build_folder
from wheelfmu.fmu.values import Fault
from wheelfmu.publishing.markdown import number, page, said
from wheelfmu.truth import requirements
from wheelfmu.truth.motion import Library

RESULTS = ROOT / "docs" / "results"
TEMPLATES = Path(__file__).parent / "templates"
Row = dict[str, Any]
Tables = dict[str, pd.DataFrame]
Axis = Mapping[str, Any] | Sequence[Any] | Callable  # of the report
PACKAGES = ("FMPy", "numpy", "scipy", "matplotlib")
SHORT = 15  # rows
REDUCTIONS = ("max", "min", "median", "sum")
REQUIREMENTS = pd.read_csv(requirements.FILE).set_index(["report", "figure"])


@dataclass
class Part:
    """A function of a report, which measures in so many seconds.

    It returns numbers and tables by name, or one table, which gets the function's name. With axes it is called for each
    combination of their values, and returns the rest of a row, or of several, that begin with these values, or with
    their names.
    """

    measure: Callable
    seconds: float
    axes: Mapping[str, Axis]

    @property
    def words(self) -> str:
        return (self.measure.__doc__ or "").splitlines()[0]

    def __call__(self, report: Report) -> dict[str, Any]:
        found = self.rows(report) if self.axes else self.measure(report)
        return found if isinstance(found, dict) else {self.measure.__name__: found}

    def rows(self, report: Report) -> list[Row]:
        axes = [axis(report) if callable(axis) else axis for axis in self.axes.values()]
        named = (axis.items() if isinstance(axis, Mapping) else [(value, value) for value in axis] for axis in axes)
        rows = []
        for names, values in (zip(*case, strict=True) for case in product(*named)):
            found, head = self.measure(report, *values), dict(zip(self.axes, names, strict=True))
            rows += [head | row for row in (found if isinstance(found, list) else [found])]
        return rows


def part(seconds: float, axes: Mapping[str, Axis] | None = None) -> Callable[[Callable], Part]:
    return lambda measure: Part(measure, seconds, axes or {})


@dataclass
class Report:
    """What one report measures. quick: fewer cases and repetitions, to see that it works."""

    name: str
    library: Library
    folder: Path
    quick: bool = False
    figures: dict[str, float] = field(default_factory=dict)
    tables: Tables = field(default_factory=dict)

    @cached_property
    def master(self) -> Any:
        from .native import Master

        return Master(self.library)

    @cached_property
    def fmus(self) -> dict[str, Path]:
        """Every FMU of the examples, built."""
        from lab.vehicles.vehicle import build_all

        return build_all()

    def measure(self, part: Part) -> None:
        for name, found in part(self).items():
            if isinstance(found, pd.DataFrame | list):
                self.tables[name] = pd.DataFrame(found)
            else:
                if (self.name, name) not in REQUIREMENTS.index:
                    raise Fault(f"{requirements.FILE.relative_to(ROOT)} does not list {name} of {self.name}.")
                self.figures[name] = float(found)

    def value(self, figure: Any) -> float:
        """What a part has returned, or a cell or reduction of a table; NaN: not yet."""
        if figure.Index in self.figures or figure.table not in self.tables:
            return self.figures.get(figure.Index, np.nan)
        table = self.tables[figure.table]
        values = table.max(numeric_only=True) if figure.column == "*" else table[figure.column]
        if figure.row in REDUCTIONS:
            return float(values.agg(figure.row))
        found = values[[number(name) == figure.row for name in table.iloc[:, 0]]]
        return float(found.iloc[0]) if len(found) else np.nan

    def write(self) -> None:
        """Figures and tables, and what they were measured with."""
        found = {figure.Index: self.value(figure) for figure in REQUIREMENTS.loc[self.name].itertuples()}
        known = [(self.name, figure, f"{value:.7g}") for figure, value in found.items() if not np.isnan(value)]
        update(self.folder, "figures", pd.DataFrame(known, columns=["report", "figure", "measured"]))
        short = {name: frame for name, frame in self.tables.items() if len(frame) <= SHORT}
        for name in self.tables.keys() - short.keys():
            write_csv(self.folder, f"{self.name}_{name}", self.tables[name])
        if texts := [f"# {name}\n{csv_of(frame)}" for name, frame in short.items()]:
            (self.folder / "data" / f"{self.name}.txt").write_text("\n".join(texts), encoding="utf-8")
        update(self.folder, "made", pd.DataFrame([made(self.name)]))


def update(folder: Path, name: str, rows: pd.DataFrame) -> None:
    """Replaces the rows of the same reports in a table of all reports."""
    path = folder / "data" / f"{name}.csv"
    others = pd.read_csv(path, dtype=str) if path.exists() else rows.iloc[:0]
    rows = pd.concat([others[~others["report"].isin(rows["report"])], rows])
    write_csv(folder, name, rows.sort_values("report", kind="stable"))


def csv_of(frame: pd.DataFrame) -> str:
    return frame.to_csv(index=False, float_format="%.7g", lineterminator="\n")


def write_csv(folder: Path, name: str, frame: pd.DataFrame) -> None:
    (folder / "data").mkdir(parents=True, exist_ok=True)
    (folder / "data" / f"{name}.csv").write_text(csv_of(frame), encoding="utf-8")


def read_tables(name: str, folder: Path = RESULTS) -> Tables:
    """The tables of a report by name; one without rows may lack its columns too."""
    path = folder / "data" / f"{name}.txt"
    _, *texts = re.split(r"^# (\w+)\n", path.read_text(encoding="utf-8") if path.exists() else "", flags=re.M)
    read = (pd.read_csv(StringIO(text)) if text.strip() else pd.DataFrame() for text in texts[1::2])
    long = {file.stem.removeprefix(f"{name}_"): pd.read_csv(file) for file in path.parent.glob(f"{name}_*.csv")}
    return dict(zip(texts[::2], read, strict=True)) | long


def render(name: str, folder: Path, views: Callable[[Tables], Tables] = dict) -> tuple[str, str]:
    """The page out of the data, and what was not met in words; views: adds the tables that follow from others."""
    known = pd.read_csv(folder / "data" / "figures.csv").query("report == @name").set_index("figure")["measured"]
    figures = REQUIREMENTS.loc[name].assign(measured=known).dropna(subset="measured").fillna({"unit": ""})
    figures["shown"] = [f"{number(float(f.measured))} {f.unit}".strip() for f in figures.itertuples()]
    asked = figures[figures["asked"].notna()]
    met = asked["measured"] <= asked["asked"]
    bounds = [f"{'≤' if f.asked else '='} {number(f.asked)}" for f in asked.itertuples()]
    measured = asked["shown"].where(met, "**" + asked["shown"] + "**")
    table = {"figure": asked["what"], "required": bounds, "measured": measured}
    missed = [f"{f.what} ({f.shown})" for f in asked[~met].itertuples()]
    run = pd.read_csv(folder / "data" / "made.csv", index_col="report", dtype=str).loc[name]
    values = {f.Index: number(float(f.measured)) for f in figures.itertuples()}
    short = (folder / "data" / f"{name}.txt").exists()
    given = {"name": name, "short": short, "f": values, "t": views(read_tables(name, folder)), "run": run}
    return page(f"{name}.md.j2", TEMPLATES, asked=pd.DataFrame(table), missed=missed, **given), "; ".join(missed)


def made(name: str) -> Row:
    """Machine, versions, commit, date; no names of users or folders. Files that reports write are no change."""
    info = Path("/proc/cpuinfo")
    models = re.findall(r"^model name\s*:\s*(.+)$", info.read_text() if info.exists() else "", re.MULTILINE)
    (processor, *_) = [*models, platform.processor() or platform.machine()]
    build = dict(re.findall(r"^(\w+):[A-Z]+=(.*)$", (build_folder() / "CMakeCache.txt").read_text(), re.MULTILINE))
    installed = {found.name.lower(): found.version for found in distributions()}
    versions = [f"{p} {installed[p.lower()]}" for p in PACKAGES]
    changed = said("git", "status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs", ":!*.md", ":!*.html")
    return {
        "report": name,
        "date": f"{datetime.now(UTC):%Y-%m-%d}",
        "machine": f"{processor}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {platform.system()}",
        "compiler": f"{said(build['CMAKE_CXX_COMPILER'], '--version')}, {build['CMAKE_CXX_FLAGS_RELEASE']}",
        "versions": ", ".join([f"Python {platform.python_version()}", *versions]),
        "commit": said("git", "rev-parse", "--short=12", "HEAD") + (", with local changes" if changed else ""),
    }
