"""A report: its parts measure tables and figures; out of these data alone come its pictures and its page of Markdown.

requirements.csv lists every figure in its report's order: the cell of a table (its row by the first column) or the
reduction of a column that it is, unless a part or the report's function `figures` returns it; unit, upper bound, where
no test has one, and words. In docs/results/data, figures.csv has the figures of all reports as measured, made.csv
machine, versions, commit and date of a report and of the parts that were measured again since, NAME_TABLE.csv each long
table, NAME.txt the short ones, one below the other.
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
from matplotlib.figure import Figure

from wheelfmu.fmu.paths import ROOT, build_folder
from wheelfmu.fmu.values import Fault
from wheelfmu.publishing.markdown import number, page, said
from wheelfmu.truth.motion import Library

RESULTS = ROOT / "docs" / "results"
TEMPLATES = Path(__file__).parent / "templates"
Row = dict[str, Any]
Tables = dict[str, pd.DataFrame]
Axis = Mapping[str, Any] | Sequence[Any] | Callable  # of the report
PACKAGES = ("FMPy", "numpy", "scipy", "matplotlib")
SHORT = 15  # rows
REDUCTIONS = ("max", "min", "median", "sum")
FILE = Path(__file__).with_name("requirements.csv")
REQUIREMENTS = pd.read_csv(FILE).set_index(["report", "figure"])
WHOLE = "all"  # in made.csv: every part


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
    pictures: dict[str, Callable[[Tables], Figure]] = field(default_factory=dict)

    def picture(self, name: str) -> Callable[[Callable], Callable]:
        """Names the picture that a function draws from tables, of which this part measures one."""

        def keep(draw: Callable[[Tables], Figure]) -> Callable[[Tables], Figure]:
            self.pictures[name] = draw
            return draw

        return keep

    @property
    def name(self) -> str:
        return self.measure.__name__

    @property
    def words(self) -> str:
        return (self.measure.__doc__ or "").splitlines()[0]

    def __call__(self, report: Report) -> dict[str, Any]:
        found = self.rows(report) if self.axes else self.measure(report)
        return found if isinstance(found, dict) else {self.name: found}

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
    """What one report measures, on top of the data that are in its folder. quick: fewer cases and repetitions, to see
    that it works; follow: the figures that follow from its tables."""

    name: str
    library: Library
    folder: Path
    quick: bool = False
    follow: Callable[[Tables], Row] = lambda _: {}

    def __post_init__(self) -> None:
        self.figures: Row = read_figures(self.name, self.folder)
        self.tables = read_tables(self.name, self.folder)

    @cached_property
    def master(self) -> Any:
        from .native import Master

        return Master(self.library)

    @cached_property
    def fmus(self) -> dict[str, Path]:
        """Every FMU of the examples, built."""
        from lab.vehicles.car import build_all

        return build_all()

    def measure(self, part: Part) -> None:
        for name, found in part(self).items():
            if isinstance(found, pd.DataFrame | list):
                self.tables[name] = pd.DataFrame(found)
            else:
                self.figures[name] = float(found)

    def value(self, figure: Any) -> float:
        """A cell or reduction of a table, or what a part has returned; NaN: not yet."""
        if pd.isna(figure.table) or figure.table not in self.tables:
            return self.figures.get(figure.Index, np.nan)
        table = self.tables[figure.table]
        values = table[figure.column]
        if figure.row in REDUCTIONS:
            return float(values.agg(figure.row))
        found = values[[number(name) == figure.row for name in table.iloc[:, 0]]]
        return float(found.iloc[0]) if len(found) else np.nan

    def write(self, part: str = WHOLE) -> None:
        """Figures and tables, and what the part was measured with."""
        self.figures |= self.follow(self.tables)
        listed = REQUIREMENTS.loc[self.name]
        for name in self.figures.keys() - set(listed.index):
            raise Fault(f"{FILE.relative_to(ROOT)} does not list {name} of {self.name}.")
        found = {figure.Index: self.value(figure) for figure in listed.itertuples()}
        known = [(self.name, figure, f"{value:.7g}") for figure, value in found.items() if not np.isnan(value)]
        update(self.folder, "figures", pd.DataFrame(known, columns=["report", "figure", "measured"]))
        short = {name: frame for name, frame in self.tables.items() if len(frame) <= SHORT}
        for name in short:  # one that was long has a file of its own
            (self.folder / "data" / f"{self.name}_{name}.csv").unlink(missing_ok=True)
        for name in self.tables.keys() - short.keys():
            write_csv(self.folder, f"{self.name}_{name}", self.tables[name])
        if texts := [f"# {name}\n{csv_of(frame)}" for name, frame in short.items()]:
            (self.folder / "data" / f"{self.name}.txt").write_text("\n".join(texts), encoding="utf-8")
        before = read_made(self.name, self.folder)
        kept = before[before["part"] != part] if part != WHOLE else before.iloc[:0]
        update(self.folder, "made", pd.concat([kept, pd.DataFrame([made(self.name, part)])]))


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


def read_figures(name: str, folder: Path = RESULTS) -> Row:
    """The figures of a report as measured, those that are listed."""
    path = folder / "data" / "figures.csv"
    known = (
        pd.read_csv(path).query("report == @name") if path.exists() else pd.DataFrame({"figure": [], "measured": []})
    )
    measured = dict(zip(known["figure"], known["measured"], strict=True))
    return {figure: measured[figure] for figure in REQUIREMENTS.loc[name].index if figure in measured}


def read_made(name: str, folder: Path = RESULTS) -> pd.DataFrame:
    """What the report and its parts were measured with."""
    path = folder / "data" / "made.csv"
    return pd.read_csv(path, dtype=str).query("report == @name") if path.exists() else pd.DataFrame({"part": []})


def misses(name: str, folder: Path) -> list[str]:
    """A sentence for each figure that is beyond its bound, or missing."""
    measured, sentences = read_figures(name, folder), []
    for figure in REQUIREMENTS.loc[name].dropna(subset="asked").fillna({"unit": ""}).itertuples():
        value = measured.get(figure.Index, np.nan)
        if not value <= figure.asked:
            found, most = (f"{number(float(x))} {figure.unit}".strip() for x in (value, figure.asked))
            said = "is not measured" if np.isnan(value) else f"is {found}"
            sentences.append(f"{name}.{figure.Index}, {figure.what}, {said}; at most {most} is allowed.")
    return sentences


def render(name: str, folder: Path, views: Callable[[Tables], Tables] = dict) -> str:
    """The page out of the data; views: adds the tables that follow from others."""
    values = {figure: number(float(measured)) for figure, measured in read_figures(name, folder).items()}
    runs = [run._asdict() for run in read_made(name, folder).itertuples(index=False)]
    short = (folder / "data" / f"{name}.txt").exists()
    given = {"name": name, "short": short, "f": values, "t": views(read_tables(name, folder)), "runs": runs}
    return page(f"{name}.md.j2", TEMPLATES, **given)


def made(name: str, part: str) -> Row:
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
        "part": part,
        "date": f"{datetime.now(UTC):%Y-%m-%d}",
        "machine": f"{processor}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}, {platform.system()}",
        "compiler": f"{said(build['CMAKE_CXX_COMPILER'], '--version')}, {build['CMAKE_CXX_FLAGS_RELEASE']}",
        "versions": ", ".join([f"Python {platform.python_version()}", *versions]),
        "commit": said("git", "rev-parse", "--short=12", "HEAD") + (", with local changes" if changed else ""),
    }
