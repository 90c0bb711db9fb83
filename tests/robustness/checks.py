"""Checks of the contract at its edges: refusals, communication steps, tolerance limits, endings as a master sees them,
contact kept through N < 0, the cost of watching for endings. Each check gives (what, expected, found, holds)."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, pi
from time import perf_counter

import numpy as np
from support.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK, TERMINATED, WARNING, Values
from support.motion import Library, run

from .regularized import best_time
from .sweep import LIGHT, PI, inertia

Check = tuple[str, str, str, bool]
FRICTION: Values = {"s": 0.03}
FINAL = ("X_O", "theta", "phi_dot", "psi_dot", "psi", "phi", "E")

REFUSED: dict[str, tuple[Values, int]] = {
    "m = NaN": ({"m": nan}, 1),
    "g = infinity": ({"g": inf}, 1),
    "m = 0": ({"m": 0.0}, 1),
    "r_0 = -0.3 m": ({"r_0": -0.3}, 1),
    "r = -0.05 m": ({"r": -0.05}, 1),
    "s = -0.03 m": ({"s": -0.03}, 1),
    "g = -9.81": ({"g": -9.81}, 1),
    "omega_s = 0": ({"omega_s": 0.0}, 1),
    "J_z above J_x + J_y": ({"J_z": 1.9}, 1),
    "J_x = 0": ({"J_x": 0.0, "J_z": 0.9}, 1),
    "theta_start = 0 (flat)": ({"theta_start": 0.0}, 1),
    "theta_start = pi (flat)": ({"theta_start": pi}, 1),
    "theta_start = -0.2 (in the ground)": ({"theta_start": -0.2}, 1),
    "theta_start = NaN": ({"theta_start": nan}, 1),
    "phi_dot_start = infinity": ({"phi_dot_start": inf}, 1),
    "three faults at once": ({"m": -1.0, "s": nan, "theta_start": 4.0}, 3),
}


def refusals(library: Library) -> list[Check]:
    """One sentence per fault, at initialization or when the value is set; corrected after fmi2Reset."""
    checks = []
    for name, (values, faults) in REFUSED.items():
        with library.wheel() as wheel:
            refused = wheel.set(**values) > WARNING
            refused = wheel.initialise() > WARNING or refused
            sentences = len(wheel.sentences)
            again = wheel.reset() == OK and wheel.initialise() == OK and wheel.step_to(0.1) == OK
        words = ("refused" if refused else "accepted", f"{sentences} sentence{'s' * (sentences > 1)}")
        found = ", ".join((*words, f"{'usable' if again else 'dead'} after reset"))
        expected = f"refused, {faults} sentence{'s' * (faults > 1)}, usable after reset"
        checks.append((name, expected, found, refused and sentences >= faults and again))
    return checks


def final_state(library: Library, values: Values, times: np.ndarray, tolerance: float = 1e-8) -> list[float]:
    with library.wheel() as wheel:
        wheel.set(**values)
        wheel.initialise(tolerance, float(times[0]))
        status = max([wheel.step_to(float(t)) for t in times[1:]], default=OK)
        return [float(status), *wheel.reader(FINAL)()]


def communication(library: Library) -> list[Check]:
    """The communication grid does not change a bit of the solution."""
    once = final_state(library, FRICTION, np.array([0.0, 10.0]))
    fine = 1e-6 * np.arange(1001)
    tiny = 5.0 + 1e-9 * np.arange(20001)
    grids = {
        "1 ms instead of one step of 10 s": (np.linspace(0, 10, 10001), once),
        "uneven steps, some of length zero": (
            np.sort(np.concatenate([10 * np.linspace(0, 1, 77) ** 2, [5.0, 5.0]])),
            once,
        ),
        "1 us steps at the start": (np.concatenate([fine, [10.0]]), once),
        "1 ns steps, 20,000 of them at t = 5 s": (np.concatenate([[0.0], tiny, [10.0]]), once),
    }
    checks = []
    for name, (times, want) in grids.items():
        same = final_state(library, FRICTION, times) == want
        checks.append((name, "the same bits", "the same bits" if same else "other bits", same))
    hour = final_state(library, FRICTION, np.array([0.0, 3600.0]))
    split = final_state(library, FRICTION, np.linspace(0, 3600, 3601))
    checks.append(
        ("one step of 3600 s", "the same bits", "the same bits" if hour == split else "other bits", hour == split)
    )
    return checks


def tolerances(library: Library) -> list[Check]:
    checks = []
    for wish in (1e-15, 1e-1):
        with library.wheel() as wheel:
            status = wheel.initialise(wish)
            said = wheel.sentences[0] if wheel.sentences else "nothing said"
            reached = wheel.step_to(10.0) == OK
        holds = status <= WARNING and reached and "tolerance" in said
        checks.append((f"tolerance {wish:g}", "clamped, said once, runs", said, holds))
    return checks


def endings(library: Library) -> list[Check]:
    """What a master sees of the plain drop: status, last time, terminated, outputs, one sentence, no further step."""
    with library.wheel() as wheel:
        wheel.set(**{"phi_dot_start": 0.0})
        wheel.initialise()
        status = wheel.step_to(10.0)
        theta = wheel.reader(("theta",))()[0]
        seen = (
            status == DISCARD,
            wheel.status(TERMINATED),
            abs(wheel.status(LAST_SUCCESSFUL_TIME) - 0.59275) < 1e-4,
            np.sin(theta) < 1e-6,
        )
        once, again = len(wheel.sentences) == 1, wheel.step_to(11.0) == ERROR
    names = ("fmi2Discard", "fmi2Terminated", "last time", "theta there", "one sentence", "a further step is refused")
    results = (*seen, once, again)
    return [
        (f"plain drop: {name}", "yes", "yes" if r else "no", bool(r)) for name, r in zip(names, results, strict=True)
    ]


def kept_contact(library: Library) -> list[Check]:
    """The light wheel's fall passes N < 0 once; with contact kept it goes on and says so once."""
    with library.wheel(logging=True) as wheel:
        wheel.set(**{**inertia(LIGHT), "phi_dot_start": 0.0, "keep_contact": True})
        wheel.initialise()
        wheel.step_to(0.45)
        force = wheel.reader(("lambda_3",))()[0]
        said = [m for m in wheel.sentences if "pull" in m or "contact" in m]
    found = f"N = {force:.1f} N at 0.45 s, {len(said)} sentences"
    return [("contact kept through N < 0", "goes on, one sentence", found, force < 0 and len(said) == 1)]


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
    for name, values in (("free wheel", {}), ("friction", FRICTION), ("upright, fast", {"theta_start": PI / 2 - 0.1})):
        ratio = watching_ratio(library, values)
        checks.append((f"watching for endings, {name}", "within 3 % of not watching", f"{ratio:.3f} x", ratio < 1.03))
    return checks


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


GROUPS: dict[str, Callable[[Library], list[Check]]] = {
    "Bad input": refusals,
    "Communication steps": communication,
    "Tolerance limits": tolerances,
    "Endings as a master sees them": endings,
    "Contact kept": kept_contact,
    "J_x and J_y nearly equal": cliffs,
    "A step too dear": unaffordable,
    "Cost of watching": watching,
}
