"""The chosen constants of fmu-src (support/constant.hpp), and the consequence of half and double, over random scenes.

An error is the distance of a run from one at a tolerance of 1e-12, over the tolerance and over the growth of a small
change of the start. Each run is of the build `constants`, in a new process for each constant and factor.
"""

import ast
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from typing import Any

import numpy as np
import pandas as pd

from wheelfmu.fmu.driver import Values
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.errors import KINDS, kind_errors
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.motion import run as attempt
from wheelfmu.truth.scenes import Scene
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import random_slide

FACTORS = (0.5, 2.0)
TOLERANCES = (1e-5, 1e-8)  # in turn
EXACT, MOVED, MOST_GROWTH = 1e-12, 1e-8, 1e4
# What half and double may do, in each kind of scenes: the largest error, over tolerance and growth, and the evaluations
# over those of the unchanged constants.
MOST_ERROR, MOST_WORK = 1.0, 2.0
SEEN = 1.01  # growth that is written
LEAST = 0.01  # smaller errors may grow to it unseen
SEEDS = 6
DEADLINE = 600.0  # s, for one changed constant
TIMES = np.linspace(0.0, 0.6, 7)
SHOWN = [kind for kind in KINDS if "lambda_1" not in kind]  # forces jump where the law changes
WORK = ("n_rhs", "n_roots")
TEXT = r"((?:\"[^\"]*\"\s*)+)"
DECLARED = re.compile(rf"\bCONSTANT\(([\w ]+),\s+(\w+),\s+([^\";]+?),\s+{TEXT},\s+{TEXT}\);")


@dataclass(frozen=True)
class Constant:
    name: str  # file.name
    value: str
    unit: str
    reason: str


def constants() -> list[Constant]:
    """In the order of the files."""
    found = []
    for path in sorted((ROOT / "fmu-src").glob("*/*.?pp")):
        if path.name == "constant.hpp":
            continue
        for _, name, value, unit, reason in DECLARED.findall(path.read_text(encoding="utf-8")):
            said = (ast.literal_eval(f"({text})") for text in (unit, reason))
            found.append(Constant(f"{path.stem}.{name}", " ".join(value.split()), *said))
    return found


# ---- scenes ----


def rolling(random: np.random.Generator, **changes: float) -> Values:
    """Any wheel on any road that grips."""
    start = dict(random_slide(random).start)
    for name in ("mu_max", "mu_slide", "slip_x_start", "slip_y_start"):
        start.pop(name, None)
    return start | {"keep_contact": True} | changes


def law(random: np.random.Generator, narrowest: float) -> Values:
    return {"friction_law": "regularized", "omega_s": float(10 ** random.uniform(narrowest, 0)), "s": 0.02}


def driven(random: np.random.Generator) -> Schedule:
    """Torque and brake that lead the spin through zero, and hold and release the wheel."""
    torque, brake = (tuple(random.uniform(-12, 12, 2)), tuple(random.uniform(0, 20, 2)))
    return Schedule(((0.0, {"M_3": torque}), (0.2, {"M_brake": brake}), (0.4, {"M_3": -torque[0]})))


def scene(kind: str, random: np.random.Generator) -> Scene:
    free = {"s": 0.0, "slope": 0.0, "J_x": 0.9, "J_y": 0.9, "J_z": 1.7}
    match kind:
        case "free":
            return Scene(rolling(random, **free), 0.6)
        case "rolls":
            return Scene(rolling(random, s=random.uniform(0.01, 0.05)), 0.6, driven(random))
        case "passes zero":
            spin = {"phi_dot_start": random.normal(0, 1), "psi_dot_start": 0.0, "s": random.uniform(0.01, 0.3)}
            return Scene(rolling(random, **spin), 0.6, driven(random))
        case "passes a law":
            start = rolling(random, phi_dot_start=random.normal(0, 1), psi_dot_start=0.0) | law(random, -7)
            return Scene(start, 0.6, driven(random))
        case "slides":
            return random_slide(random)
        case "slides under a law":
            slide = random_slide(random)
            return Scene(slide.start | law(random, -7), 0.6, slide.inputs)
        case "carried":
            turns = Schedule(((0.0, {"psi_dot_guide": (0.0, *random.uniform(-2, 2, 2))}), (0.4, {"M_3": 5.0})))
            start = rolling(random, psi_dot_start=0.0, theta_dot_start=0.0) | {"guided": True}
            return Scene(start, 0.6, turns)
        case "jumps":  # the rates of a carrier on a slip, with and without a law
            slide = random_slide(random)
            start = dict(slide.start) | {"guided": True, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
            start |= law(random, -7) if random.random() < 0.5 else {}
            rates = [{f"{angle}_dot_guide": random.uniform(-1, 1) for angle in ("psi", "theta")} for _ in range(2)]
            return Scene(start, 0.6, Schedule(((0.0, rates[0]), (0.02, rates[1]), (0.4, {"M_3": 5.0}))))
        case "lifts off":
            fast = {"psi_dot_start": random.normal(0, 6), "theta_dot_start": random.normal(0, 5)}
            return Scene(rolling(random, **fast) | {"keep_contact": False}, 0.6)
        case _:  # a method of CVODE
            return Scene(rolling(random, s=random.uniform(0.01, 0.05)) | {"method": kind}, 0.6, driven(random))


ROLLS = ("free", "rolls", "passes zero", "passes a law", "carried", "lifts off", "adams", "bdf")
SCENES = (*ROLLS, "slides", "slides under a law", "jumps")


def scenes() -> Iterator[tuple[str, int, Scene]]:
    for kind in SCENES:
        for seed in range(SEEDS):
            yield kind, seed, scene(kind, np.random.default_rng([SCENES.index(kind), seed]))


# ---- runs ----


def run(library: Library, of: Scene, tolerance: float, **changes: float) -> Run:
    return attempt(library, {**of.start, **changes}, TIMES, tolerance, of.inputs)


def distance(found: Run, expected: Run) -> float:
    """Of outputs, up to the first end, over the largest value of their kind or 1; and of the ends, s."""
    if not found.columns or (found.end is None) != (expected.end is None):
        return np.inf
    rows = len(expected.t) - (expected.end is not None)
    if rows > len(found.t):
        return np.inf
    ends = abs(found.end - expected.end) if expected.end is not None and found.end is not None else 0.0
    before = ({name: column[:rows] for name, column in each.columns.items()} for each in (found, expected))
    found_before, expected_before = before
    errors = kind_errors(found_before, expected_before, 1.0) if rows else {}
    return max(ends, *(errors.get(kind[0], 0.0) for kind in SHOWN))


Judge = dict[tuple[str, int], tuple[Run, float]]


def judges(folder: str) -> Judge:
    """Of each scene the exact run and the growth of a small change; scenes that a change of 1e-8 leads elsewhere, to
    another end or through a corner, judge no error."""
    library, found = Library(folder), {}
    for kind, seed, each in scenes():
        exact = run(library, each, EXACT)
        theta = float(each.start["theta_start"])
        growth = max(1.0, distance(run(library, each, EXACT, theta_start=theta + MOVED), exact) / MOVED)
        if growth < MOST_GROWTH:
            found[kind, seed] = exact, growth
    return found


def judged(folder: str, known: Judge, changed: tuple[str, float]) -> pd.DataFrame:
    """By kind of scene, one constant changed: the largest error over tolerance and growth, and the evaluations."""
    os.environ["WHEEL_CONSTANT"], os.environ["WHEEL_FACTOR"] = changed[0], str(changed[1])
    library, rows = Library(folder), []
    for kind, seed, each in scenes():
        tolerance, error = TOLERANCES[seed % 2], 0.0
        done = run(library, each, tolerance)
        if (kind, seed) in known:
            exact, growth = known[kind, seed]
            error = distance(done, exact) / (tolerance * growth)
        rows.append((kind, error, sum(done.counters.get(name, 0) for name in WORK)))
    table = pd.DataFrame(rows, columns=["kind", "error", "work"])
    return table.groupby("kind", sort=False).agg(error=("error", "max"), work=("work", "sum"))


def measured(folder: str, chosen: Sequence[Constant]) -> pd.DataFrame:
    """A row for each constant and factor: the kinds of scenes whose error and whose evaluations grow most.

    Each runs in a new process: a library reads the environment where it is loaded.
    """
    asked = [("", 1.0), *((each.name, factor) for each in chosen for factor in FACTORS)]
    context, rows = get_context("fork"), []
    with context.Pool(1) as pool:
        known = pool.apply(judges, (folder,))
    with context.Pool(os.cpu_count(), maxtasksperchild=1) as pool:
        results = pool.imap(partial(judged, folder, known), asked)
        base = results.next(DEADLINE)
        for name, factor in asked[1:]:
            now = results.next(DEADLINE)
            growth, work = now["error"] / np.maximum(base["error"], LEAST), now["work"] / base["work"]
            of, by = growth.idxmax(), work.idxmax()
            rows.append((name, factor, now["error"].max(), now["error"][of], growth[of], of, work[by], by))
        pool.close()
        pool.join()
    return pd.DataFrame(rows, columns=["name", "factor", "largest", "error", "growth", "of", "work", "by"])


# Where a factor leads beyond the limits, as far as that may go, error and work, and why it is left so.
ORDER = "cvode_engine.highest_adams_order"
EDGES: dict[tuple[str, float], tuple[float, float, str]] = {
    (ORDER, 0.5): (MOST_ERROR, 4.0, "an order of 4 makes more steps; the order is no size that drifts, and 9 is kept"),
    (ORDER, 2.0): (np.inf, MOST_WORK, "CVODE has no order above 12 and refuses 18: the run fails with a message"),
}


def beyond(table: pd.DataFrame) -> list[tuple[str, float, str]]:
    """Constant, factor and figures beyond what is stated."""
    found = []
    for row in table.itertuples():
        error, work, _ = EDGES.get((row.name, row.factor), (MOST_ERROR, MOST_WORK, ""))
        if not (row.largest <= error and row.work <= work):
            found.append((row.name, row.factor, said(row)))
    return found


def said(row: Any) -> str:
    """The figures of one factor, with the kinds of scenes that they are of."""
    error = f"error {row.error:.2g} ({row.of})" if not row.growth < SEEN else ""
    work = f"work {row.work:.2f} ({row.by})" if not row.work < SEEN else ""
    return ", ".join(filter(None, (error, work))) or "–"


def described(chosen: Sequence[Constant], table: pd.DataFrame) -> dict[str, Any]:
    """Rows, edges and limits, for their page."""
    figures = {(row.name, row.factor): said(row) for row in table.itertuples()}
    rows = [
        [f"`{each.name}`", f"`{each.value}`", each.unit, each.reason, *(figures[each.name, f] for f in FACTORS)]
        for each in chosen
    ]
    edges = [f"`{name}`, times {factor:g}: {why}" for (name, factor), (_, _, why) in EDGES.items()]
    count, kinds = len(SCENES) * SEEDS, ", ".join(SCENES)
    return {"rows": rows, "edges": edges, "error": MOST_ERROR, "work": MOST_WORK, "count": count, "kinds": kinds}
