"""Numbers and tables as they stand in every document, and pages made from templates."""

from __future__ import annotations

import csv
import re
import subprocess
from contextlib import suppress
from math import isfinite
from pathlib import Path
from typing import Any

import tabulate
from jinja2 import Environment, FileSystemLoader, StrictUndefined

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

TEMPLATES = Path(__file__).parent / "templates"

tabulate.WIDE_CHARS_MODE = False  # widths must not depend on the packages that are installed


def said(*command: str) -> str:
    """The first line that a program prints; nothing where it fails or is missing."""
    with suppress(OSError):
        found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        return (found.stdout.strip().splitlines() or [""])[0] if not found.returncode else ""
    return ""


def pages() -> list[Path]:
    """Every document under version control, and new ones; without git, as in a ZIP, all outside ignored folders."""
    if not (ROOT / ".git").exists():
        ignored = {line.strip("/") for line in (ROOT / ".gitignore").read_text(encoding="utf-8").splitlines()}
        found = (page for kind in ("*.md", "*.html") for page in ROOT.rglob(kind))
        return sorted(page for page in found if page.relative_to(ROOT).parts[0] not in ignored)
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", "*.md", "*.html"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [ROOT / name for name in sorted(listed.stdout.split("\0")) if name and (ROOT / name).is_file()]


def number(value: object) -> str:
    """Short text of a value: 3 digits of a float, or 2 and a plain exponent; integers and text as they are."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return "" if value is None else str(value)
    if not isfinite(value):
        return str(value)
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def table(frame: Any) -> str:
    """Of a pandas table, the first column to the left, the others to the right; unknown values stay empty."""
    if frame.empty:
        return "None."
    cells = frame.convert_dtypes().astype(object)
    texts = [[number(cell).replace("|", "\\|") for cell in row] for row in cells.where(cells.notna(), None).to_numpy()]
    sides = ("left", *["right"] * (frame.shape[1] - 1))
    return tabulate.tabulate(texts, list(frame.columns), "pipe", disable_numparse=True, colalign=sides)


# A figure in prose: a number, and behind it its report and name as a comment.
FIGURE = re.compile(r"([-−]?\d[\d.]*(?:e-?\d+)?)?<!--(\w+\.\w+)-->")


def with_figures(text: str) -> str:
    """The text with every figure in its prose as docs/results/data has it; Fault where it has none, or no number."""
    rows = csv.DictReader((ROOT / "docs" / "results" / "data" / "figures.csv").open(encoding="utf-8"))
    known = {f"{row['report']}.{row['figure']}": number(float(row["measured"])) for row in rows}

    def filled(found: re.Match[str]) -> str:
        given, name = found.groups()
        if name not in known:
            raise Fault(f"docs/results/data/figures.csv has no figure {name}.")
        if not given:
            raise Fault(f"<!--{name}--> must stand right behind a number, without a space.")
        return f"{re.sub('^-', '−', known[name])}<!--{name}-->"

    return FIGURE.sub(filled, text)


def page(template: str, folder: Path = TEMPLATES, **values: object) -> str:
    """A page out of a template in a folder; an unknown name is an error."""
    loader = FileSystemLoader(folder)
    pages = Environment(loader=loader, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    pages.filters |= {"table": table, "number": number}
    return re.sub(r"\n{3,}", "\n\n", pages.get_template(template).render(**values)).strip() + "\n"
