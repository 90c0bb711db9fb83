"""Runs every set-up of every scene in interleaved rounds, so that noise of the machine meets all alike."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field

from .builds import Build
from .measure import Record, Worker, error_of, measure
from .reference import Reference, reference_of
from .scenes import TOLERANCES, Scene, Setup, fmu_setups, peer_setups

# What a note says if a tighter tolerance need not be tried: not installed, not built, not for this scene, too slow.
HOPELESS = ("No module", "only for", "no answer", "does not compile", "right-hand sides, only", "steps, only")
SLOW = 0.02  # s: what takes longer is measured in the first round only


@dataclass
class Entry:
    """One set-up at one tolerance. best, median in s; error None: not solved, and note says why."""

    setup: Setup
    tolerance: float
    error: float | None = None
    note: str = ""
    counts: dict[str, int] = field(default_factory=dict)
    bests: list[float] = field(default_factory=list)
    medians: list[float] = field(default_factory=list)

    @property
    def best(self) -> float:
        return min(self.bests)

    @property
    def median(self) -> float:
        return sorted(self.medians)[len(self.medians) // 2]

    def take(self, record: Record) -> None:
        if "solve_best" in record:
            self.bests.append(record["solve_best"])
            self.medians.append(record["solve_median"])


@dataclass
class Sheet:
    """All entries of one scene."""

    scene: Scene
    reference: Reference
    entries: list[Entry]

    def of(self, name: str) -> list[Entry]:
        return [e for e in self.entries if e.setup.name == name]

    def names(self) -> list[str]:
        return list(dict.fromkeys(e.setup.name for e in self.entries))


@dataclass(frozen=True)
class Plan:
    """How much to do."""

    rounds: int = 3
    seconds: float = 0.04  # for the repetitions of one measurement
    quick: bool = False

    def tolerances(self, setup: Setup) -> tuple[float, ...]:
        """All decades for what is fast; every second one for the slow peers."""
        slow = setup.family == "python" and setup.name.startswith("SciPy")
        if self.quick:
            return TOLERANCES[::6] if slow else TOLERANCES[1:9]
        return TOLERANCES[::2] if slow else TOLERANCES


class Progress:
    """One line on the terminal that says what is being done."""

    def __init__(self) -> None:
        self.begin = time.monotonic()
        self.live = sys.stderr.isatty()

    def say(self, text: str, line: bool = False) -> None:
        stamp = f"[{time.monotonic() - self.begin:5.0f} s] {text}"
        if self.live:
            print(f"\r\033[K{stamp}", end="\n" if line else "", file=sys.stderr, flush=True)
        elif line:
            print(stamp, file=sys.stderr, flush=True)


def first_round(build: Build, worker: Worker, sheet: Sheet, plan: Plan, say: Progress) -> None:
    """Errors, counts and a first time. A set-up that is missing or hopeless is not asked again."""
    given_up: dict[str, str] = {}
    for entry in sheet.entries:
        name = entry.setup.name
        say.say(f"{sheet.scene.name}: {name} at {entry.tolerance:.0e}")
        if name in given_up:
            entry.note = given_up[name]
            continue
        record = measure(build, worker, sheet.scene, entry.setup, entry.tolerance, plan.seconds)
        entry.error = error_of(record, sheet.reference.rows)
        entry.counts = {key: record[key] for key in ("steps", "evaluations", "events") if key in record}
        if entry.error is None:
            entry.note = record.get("note", "no finite result")
            if any(sign in entry.note for sign in HOPELESS):
                given_up[name] = entry.note
        else:
            entry.take(record)


def further_rounds(build: Build, worker: Worker, sheet: Sheet, plan: Plan, say: Progress) -> None:
    for count in range(1, plan.rounds):
        say.say(f"{sheet.scene.name}: round {count + 1} of {plan.rounds}")
        for entry in sheet.entries:
            if entry.bests and entry.best < SLOW:
                entry.take(measure(build, worker, sheet.scene, entry.setup, entry.tolerance, plan.seconds))


def run_scene(build: Build, worker: Worker, scene: Scene, plan: Plan, say: Progress) -> Sheet:
    say.say(f"{scene.name}: the reference")
    reference = reference_of(scene, build.work)
    setups = [*fmu_setups(scene, build.methods), *peer_setups(scene)]
    entries = [Entry(setup, tolerance) for setup in setups for tolerance in plan.tolerances(setup)]
    sheet = Sheet(scene, reference, entries)
    first_round(build, worker, sheet, plan, say)
    further_rounds(build, worker, sheet, plan, say)
    solved = sum(e.error is not None for e in entries)
    say.say(f"{scene.name}: {solved} of {len(entries)} solved; reference error {reference.error:.1e}", line=True)
    return sheet
