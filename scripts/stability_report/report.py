"""Writes docs/results/stability.md: tables and conclusions, all computed from the results."""

from __future__ import annotations

import platform
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from robustness.case import Case
from robustness.checks import Check
from robustness.drift import Drift
from robustness.long_runs import LongRun
from robustness.regularized import TOLERANCE_FACTOR, WIDTH_FACTOR, Crossing, Point, observed_order
from robustness.verdicts import TOLERANCES, Verdict

from .isolated import Broken

LARGEST_DRIFT = 1e-9

ROOT = Path(__file__).resolve().parent.parent.parent


@dataclass
class Results:
    """All that the script found."""

    sweep: dict[str, tuple[Case, list[Verdict] | Broken]] = field(default_factory=dict)
    contract: dict[str, list[Check] | Broken] = field(default_factory=dict)
    regularized: list[Point] = field(default_factory=list)
    crossings: list[Crossing] = field(default_factory=list)
    long_runs: list[LongRun] = field(default_factory=list)
    resolved: list[tuple[float, float, float]] = field(default_factory=list)
    drifts: list[Drift] = field(default_factory=list)
    seconds: float = 0.0

    def verdicts(self) -> dict[str, list[Verdict]]:
        return {name: v for name, (_, v) in self.sweep.items() if not isinstance(v, Broken)}

    def faults(self) -> list[str]:
        """One sentence per thing that is not as stated."""
        found = [f"{name}: {v}" for name, (_, v) in self.sweep.items() if isinstance(v, Broken)]
        for name, verdicts in self.verdicts().items():
            found += [f"{name}, tolerance {v.tolerance:g}: {'; '.join(v.faults)}" for v in verdicts if not v.holds]
        for group, checks in self.contract.items():
            if isinstance(checks, Broken):
                found.append(f"{group}: {checks}")
            else:
                found += [f"{group}, {what}: {got} instead of {want}" for what, want, got, holds in checks if not holds]
        return found + self.study_faults()

    def study_faults(self) -> list[str]:
        """The same for the studies. The bounds are those of the page's text."""
        found = [
            f"regularized law, {p.method}, tolerance {p.tolerance:g}, omega_s {p.omega_s:g}: error {p.error:.1e}"
            for p in self.regularized
            if not p.error <= WIDTH_FACTOR * p.omega_s + TOLERANCE_FACTOR * p.tolerance
        ]
        found += [f"drift of {d.name}: {d.worst:.1e}" for d in self.drifts if not d.worst <= LARGEST_DRIFT]
        for r in self.long_runs:
            flat = np.median(r.cost[-10:]) <= 1.5 * np.median(r.cost[1:11])
            sound = (r.status == 0, r.held == 0, r.memory <= 4 << 20, r.rise <= 10 * r.tolerance * r.energy[0], flat)
            names = ("status", "omega_z held", "memory", "rise of the energy", "cost per simulated second")
            found += [f"{r.name}: {name}" for name, good in zip(names, sound, strict=True) if not good]
        return found


def table(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def escaped(text: str) -> str:
    return text.replace("|", "\\|")


def cell(verdict: Verdict) -> str:
    """Errors in the order of the judges; bold where the expectation fails, in brackets where it is not claimed."""
    text = ", ".join(f"{f.error:.0e}" for f in verdict.errors) or "-"
    if not verdict.faults:
        return text
    return f"**{text}**" if verdict.claimed else f"({verdict.outcome}: {text})"


def sweep_table(results: Results) -> str:
    rows = []
    for name, (case, verdicts) in results.sweep.items():
        head = (escaped(name), str(case.expect))
        if isinstance(verdicts, Broken):
            rows.append((*head, "", *[f"**{verdicts}**"] * len(TOLERANCES)))
            continue
        judges = next((", ".join(f.judge for f in v.errors) for v in verdicts if v.errors), "")
        rows.append((*head, judges, *[cell(v) for v in verdicts]))
    return table(("case", "expected", "judged by", *[f"{t:g}" for t in TOLERANCES]), rows)


def remarks(results: Results) -> str:
    return "\n".join(f"- {escaped(name)}: {case.remark}." for name, (case, _) in results.sweep.items() if case.remark)


def amplification(results: Results, judge: str) -> str:
    """Which cases keep the error within the tolerance, and which exceed it by how much."""
    worst = {}
    for name, verdicts in results.verdicts().items():
        seen = [(f, v.tolerance) for v in verdicts for f in v.errors if f.judge == judge and v.claimed]
        ratios = [max(f.error - f.floor, 0.0) / tolerance for f, tolerance in seen]
        if ratios:
            worst[name] = max(ratios)
    within = sum(r <= 1 for r in worst.values())
    ten = sum(r <= 10 for r in worst.values())
    top = sorted(worst.items(), key=lambda item: -item[1])[:3]
    listed = "; ".join(f"{escaped(n)} ({r:.0f} x)" for n, r in top)
    return (
        f"{within} of {len(worst)} cases within the tolerance at every tolerance, {ten} within 10 x; largest: {listed}"
    )


def contract_tables(results: Results) -> str:
    parts = []
    for group, checks in results.contract.items():
        rows = [("-", "-", str(checks))] if isinstance(checks, Broken) else [
            (escaped(what), want, escaped(got) if holds else f"**{escaped(got)}**") for what, want, got, holds in checks
        ]  # fmt: skip
        parts.append(f"### {group}\n\n{table(('what', 'expected', 'found'), rows)}")
    return "\n\n".join(parts)


def point_cells(points: list[Point], tolerance: float, omega_s: float, method: str) -> str:
    for p in points:
        if (p.tolerance, p.method) == (tolerance, method) and np.isclose(p.omega_s, omega_s, rtol=1e-9, atol=0):
            return f"{p.error:.1e}, {p.milliseconds:.2f} ms"
    return "-"


def regularized_table(points: list[Point]) -> str:
    tolerances = sorted({p.tolerance for p in points}, reverse=True)
    heads = ["omega_s [rad/s]", *[f"{m}, {t:g}" for t in tolerances for m in ("Adams", "BDF")]]
    rows = [
        (
            "exact law",
            *[
                point_cells(points, t, 0.0, "adams") if m == "adams" else ""
                for t in tolerances
                for m in ("adams", "bdf")
            ],
        )
    ]
    for omega_s in sorted({p.omega_s for p in points if p.omega_s}, reverse=True):
        cells = [point_cells(points, t, omega_s, m) for t in tolerances for m in ("adams", "bdf")]
        rows.append((f"{omega_s:g}", *cells))
    return table(tuple(heads), rows)


def order_sentence(points: list[Point]) -> str:
    tolerance = min(p.tolerance for p in points)
    exact = next(p.error for p in points if p.tolerance == tolerance and p.law == "exact")
    errors = {p.omega_s: p.error for p in points if p.tolerance == tolerance and p.method == "bdf"}
    orders = [(w, o) for w, o in observed_order(points, tolerance) if w < 5e-2 and errors[w] > 30 * exact]
    listed = ", ".join(f"{o:.2f}" for _, o in orders)
    span = f"tolerance {tolerance:g}, omega_s {orders[0][0]:g} down to {orders[-1][0]:g} rad/s"
    return f"Observed order of convergence to the exact law ({span}): {listed}."


def long_table(runs: list[LongRun]) -> str:
    rows = []
    for r in runs:
        early, late = np.median(r.cost[1:11]), np.median(r.cost[-10:])
        change = (r.energy[-1] - r.energy[0]) / r.energy[0]
        rows.append((r.name, f"{early:.0f}", f"{late:.0f}", f"{change:.1e}", f"{max(r.rise, 0):.1e}",
                     f"{r.events[-1]:.0f}", f"{r.held:g}", f"{r.memory / 1024:.0f}"))  # fmt: skip
    heads = ("run", "us/s, first sixth", "us/s, last sixth", "energy change / E", "largest rise [J]", "transitions",
             "max abs omega_z held [rad/s]", "memory growth [KiB]")  # fmt: skip
    return table(heads, rows)


def footer(results: Results) -> str:
    git = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    commit = subprocess.run(git, capture_output=True, text=True, check=False).stdout.strip()
    models = [line for line in Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    cpu = models[0].split(":")[1].strip() if models else platform.processor()
    return f"Commit {commit}; {cpu}; Python {platform.python_version()}; {results.seconds:.0f} s in all."
