"""What the edges of the contract cost, for `stability`: nearly equal inertias, a choice too dear, watching for endings.

Each check gives (what, expected, found, holds).
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, pi
from time import perf_counter

import numpy as np
from support.driver import ERROR, Values
from support.motion import Library, run

from .law import FRICTION, best_time

Check = tuple[str, str, str, bool]


def cliffs(library: Library) -> list[Check]:
    """J_x and J_y that differ by 1e-12: the same motion, at a price that is no cliff. Both are stepped, because only a
    wheel with J_x = J_y is unfolded."""
    equal, grid = {"method": "adams"}, np.linspace(0, 10, 101)
    split = equal | {"J_y": 0.9 * (1 - 1e-12)}
    whole, parted = (run(library, values, grid, 1e-8) for values in (equal, split))
    apart = max(float(np.abs(whole[n] - parted[n]).max() / np.ptp(whole[n])) for n in ("X_O", "theta", "psi_dot"))
    calls = parted.counters["n_rhs"] / whole.counters["n_rhs"]
    price = best_time(library, split, 1e-8, 10.0, 30) / best_time(library, equal, 1e-8, 10.0, 30)
    found = f"{calls:.1f}; in time {price:.1f}"
    return [
        ("outputs apart, tolerance 1e-8", "below 1e-6", f"{apart:.1e}", apart < 1e-6),
        ("right-hand sides over those for J_x = J_y", "below 3", found, calls < 3),
    ]


def unaffordable(library: Library) -> list[Check]:
    """A choice that cannot be afforded, Adams on a width of 1e-8 rad/s, stops in the step with its reason."""
    with library.wheel() as wheel:
        wheel.set(**{**FRICTION, "friction_law": "regularized", "omega_s": 1e-8, "method": "adams"})
        wheel.initialise(1e-8)
        status = wheel.step_to(10.0)
        said = wheel.sentences[-1] if wheel.sentences else "nothing said"
    return [("10 s in one step, Adams, omega_s = 1e-8 rad/s", "an error with its reason", said, status == ERROR)]


def watching_ratio(library: Library, values: Values, repeats: int = 60) -> float:
    """Time with endings watched over time without lift-off watched (contact kept), best of interleaved runs."""
    best = {False: inf, True: inf}
    for i in range(2 * repeats):
        keep = bool(i % 2)
        with library.wheel() as wheel:
            wheel.set(**{**values, "keep_contact": keep})
            wheel.initialise()
            before = perf_counter()
            wheel.step_to(10.0)
            best[keep] = min(best[keep], perf_counter() - before)
    return best[False] / best[True]


def watching(library: Library) -> list[Check]:
    checks = []
    for name, values in (("free wheel", {}), ("friction", FRICTION), ("upright, fast", {"theta_start": pi / 2 - 0.1})):
        ratio = watching_ratio(library, values)
        checks.append((f"watching for endings, {name}", "within 3 % of not watching", f"{ratio:.3f} x", ratio < 1.03))
    return checks


GROUPS: dict[str, Callable[[Library], list[Check]]] = {
    "J_x and J_y nearly equal": cliffs,
    "A step too dear": unaffordable,
    "Cost of watching": watching,
}
