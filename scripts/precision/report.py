"""docs/results/work_precision.md: every sentence with a figure is computed from the run's data."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .cells import microseconds, number, table
from .compare import ratio, time_at
from .goals import OURS, YARDSTICKS, goals
from .runner import Entry, Sheet
from .scenes import POINTS, TARGETS
from .tables import cost_parts

INTRODUCTION = """# Error against run time

Written by `scripts/work_precision`; do not edit. Error: largest difference over {points} grid times of X_O, theta,
phi_dot and psi_dot, each relative to its range, against the reference of the scene (tests/reference at two tolerances;
their difference is the reference's own error). Time: one solution with the four outputs at all grid times, best of all
repetitions unless said otherwise; set-ups take turns in {rounds} rounds. The FMU is called by a C master
(scripts/bench/master.c) in steps of a hundredth of the run; start and end are listed apart. DOP853 C++: hand-inlined,
the compiler and level of the product (native: for this very processor). heyoka: time inside `propagate_grid`, compiled
beforehand; what Python does between two events is left out. SciPy: the C right-hand side through ctypes. Peers with one
tolerance use it as relative and as absolute tolerance.
"""


def goals_part(sheets: list[Sheet], extra: dict[str, Any]) -> str:
    rows = [
        (g.what, f"≤ {g.bound:g} {g.unit}".strip(), f"{number(g.measured)} {g.unit}".strip(), g.verdict)
        for g in goals(sheets, extra)
    ]
    return "## Goals\n\n" + table(("goal", "bound", "measured", ""), rows)


def ratios_part(sheets: list[Sheet]) -> str:
    """Time of the FMU over that of each peer at equal errors."""
    text = "## The FMU against its peers\n\nTime of the FMU (all automatic) over that of the set-up at the same error;"
    text += " below 1 the FMU is faster. —: one of the two does not reach that error.\n\n"
    for sheet in sheets:
        peers = [n for n in sheet.names() if n != OURS]
        rows = [(p, *(number(ratio(sheet, OURS, p, e), ".2f") for e in TARGETS)) for p in peers]
        text += f"**{sheet.scene.title}**\n\n"
        text += table(("set-up", *(f"at {e:.0e}" for e in TARGETS)), rows) + "\n"
    return text


def sentence(sheet: Sheet) -> str:
    """Which set-up is fastest at each error, and how far the FMU is from it."""
    parts = []
    for error in TARGETS:
        times = {n: t for n in sheet.names() if (t := time_at(sheet.of(n), error))}
        if not times:
            parts.append(f"at {error:.0e} none")
            continue
        first = min(times, key=lambda n: times[n])
        ours = f", the FMU {microseconds(times[OURS])} µs" if OURS in times and first != OURS else ""
        parts.append(f"at {error:.0e} {first} ({microseconds(times[first])} µs{ours})")
    return "Fastest: " + "; ".join(parts) + ".\n"


def entry_row(sheet: Sheet, e: Entry) -> tuple[str, ...]:
    counts = [str(e.counts.get(key, "—")) for key in ("steps", "evaluations", "events")]
    if e.error is None:
        return (e.setup.name, f"{e.tolerance:.0e}", f"failed: {e.note}", "—", "—", *counts)
    bound = "≤ " if e.error < 3 * sheet.reference.error else ""
    return (
        e.setup.name,
        f"{e.tolerance:.0e}",
        f"{bound}{e.error:.1e}",
        microseconds(e.best),
        microseconds(e.median),
        *counts,
    )


def entry_rows(sheet: Sheet) -> list[tuple[str, ...]]:
    """One row per measurement; a set-up that could not run at all is one row."""
    rows = []
    for name in sheet.names():
        entries = sheet.of(name)
        hopeless = all(e.error is None and e.note == entries[0].note for e in entries)
        rows += [entry_row(sheet, e) for e in (entries[:1] if hopeless else entries)]
    return rows


def scene_part(sheet: Sheet) -> str:
    name = f"work_precision_{sheet.scene.name}.png"
    text = f"## {sheet.scene.title}\n\n![{sheet.scene.title}]({name})\n\n{sentence(sheet)}"
    text += f"The reference's own error: {sheet.reference.error:.1e}. {sheet.scene.stop:g} s of motion.\n\n"
    head = ("set-up", "tolerance", "error", "best µs", "median µs", "steps", "right-hand sides", "events")
    rows = table(head, entry_rows(sheet))
    return text + f"<details><summary>All measurements</summary>\n\n{rows}\n</details>\n"


def write(sheets: list[Sheet], extra: dict[str, Any], rounds: int, path: Path) -> None:
    limits = Path(__file__).with_name("limits.md")
    parts = [INTRODUCTION.format(points=POINTS, rounds=rounds), goals_part(sheets, extra)]
    parts += [limits.read_text()] if limits.exists() else []
    parts += [ratios_part(sheets), *(scene_part(s) for s in sheets), *cost_parts(extra)]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(parts))


def summary(sheets: list[Sheet]) -> str:
    """The ratios that matter, for the terminal."""
    lines = []
    for sheet in sheets:
        for peer in YARDSTICKS:
            ratios = ", ".join(f"{e:.0e}: {number(ratio(sheet, OURS, peer, e), '.2f')}" for e in TARGETS)
            lines.append(f"{sheet.scene.name:16} FMU / {peer:10}  {ratios}")
    return "\n".join(lines)
