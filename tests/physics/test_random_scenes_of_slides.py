"""Random scenes of slides, under the exact law of friction, a soft and a stiff regularized one: the error at three
tolerances over the tolerance and the growth of small errors; and instants that the motion itself makes inside a step,
lift-off and jam. Against a finer run of the other formulation, which shares no equation of motion.

Bounds lie at least three times above the largest figure of these seeds.
"""

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.errors import KINDS, kind_errors
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.motion import run as attempt
from wheelfmu.truth.scenes import PAPER, Scene
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import random_slide

TOLERANCES = (1e-5, 1e-7, 1e-9)
EXACT, LAWS = 1e-12, ("exact", "soft", "stiff")
TIMES = np.linspace(0, 0.6, 13)
MOVED = 1e-8
SHOWN = [kind for kind in KINDS if "lambda_1" not in kind]  # forces jump where the law changes


def slide(seed: int, law: str) -> Scene:
    random = np.random.default_rng(seed)
    scene = random_slide(random)
    start: Values = {**scene.start, "s": scene.start["s"] or 0.02}
    if law != "exact":
        width = random.uniform(0.05, 0.5) if law == "soft" else 10 ** -random.uniform(4, 7)
        start |= {"friction_law": "regularized", "omega_s": float(width)}
    return Scene(start, 0.6, scene.inputs)


def run(library: Library, scene: Scene, tolerance: float, formulation: int, times=TIMES, **changes: float) -> Run:
    return attempt(library, {**scene.start, "formulation": formulation, **changes}, times, tolerance, scene.inputs)


def distance(found: Run, expected: Run) -> float:
    """Of outputs and energy, up to the first end, over the largest value of their kind or 1."""
    rows = min(len(each.t) - (each.end is not None) for each in (found, expected))
    before = ({name: column[:rows] for name, column in each.columns.items()} for each in (found, expected))
    errors = kind_errors(*before, 1.0)
    return max(errors[kind[0]] for kind in SHOWN)


STARTS = ("theta_start", "phi_dot_start", "psi_dot_start", "theta_dot_start")
SEEDS = range(1000, 1040)


@pytest.mark.parametrize("law", LAWS)
def test_the_error_of_a_random_slide_is_a_part_of_its_tolerance_times_the_growth_of_errors(library, law: str) -> None:
    off: dict[float, list[float]] = {tolerance: [] for tolerance in TOLERANCES}
    others, slid = [], 0
    for seed in SEEDS:
        scene, form = slide(seed, law), 2 + seed % 2
        exact = run(library, scene, EXACT, form)
        if not exact.columns:
            continue
        slid += bool((exact["contact_mode"] == 1).any())
        near = [run(library, scene, EXACT, form, **{name: scene.start[name] + MOVED}) for name in STARTS]
        grown = max(1.0, *(distance(each, exact) / MOVED for each in near))
        for tolerance in TOLERANCES:
            found = run(library, scene, tolerance, 5 - form)
            assert (found.end is None) == (exact.end is None), (seed, tolerance)
            off[tolerance].append(distance(found, exact) / tolerance / grown)
        other = run(
            library, scene, EXACT, form, mu_slide=scene.start["mu_slide"] * (1 - 1e-3), s=scene.start["s"] * 1.01
        )
        others.append(distance(other, exact) / 1e-7 / grown)
    assert len(others) > 30 and slid > 25
    for tolerance in TOLERANCES:
        within(max(off[tolerance]), 2.0, f"largest error over tolerance {tolerance:g} and growth")
        within(float(np.median(off[tolerance])), 0.015, f"middle error over tolerance {tolerance:g} and growth")
    beyond(float(np.median(others)), 2.0, "middle distance of a road 0.1 % more slippery over 1e-7 and growth")


# ---- instants ----

HUB: Values = {"r": 0.0, "J_x": 0.09, "J_z": 0.12, "psi_start": 0.3}


def jamming(random: np.random.Generator) -> Values:
    """A light disc that leans and slides sideways: about a third jams on the way, another at the start."""
    mu = float(random.uniform(0.6, 1.3))
    start = {**HUB, "J_y": 0.09 * random.choice([1, 1.2]), "theta_start": random.uniform(0.7, 1.0)}
    start |= {
        "theta_dot_start": random.uniform(1, 3),
        "phi_dot_start": random.normal(0, 2),
        "s": random.choice([0, 0.01]),
    }
    start |= {"psi_dot_start": random.normal(0, 0.5), "slip_x_start": random.normal(), "mu_max": mu}
    start |= {"slip_y_start": -random.uniform(2, 6), "mu_slide": mu * random.uniform(0.8, 1)}
    return {name: float(value) for name, value in start.items()}


def lifting(random: np.random.Generator) -> Values:
    """A wheel that falls fast under a load that lifts: about half leave the ground on the way."""
    mu = float(random.uniform(0.1, 0.5))
    start = {**random_slide(random).start, "slope": 0.0, "theta_start": random.uniform(0.7, 1.3), "mu_max": mu}
    start |= {"theta_dot_start": -random.uniform(2.5, 4.5), "slip_x_start": random.normal(0, 2), "mu_slide": 0.9 * mu}
    start |= {"slip_y_start": random.normal(0, 2), "F_Z": random.uniform(0.3, 0.6) * PAPER.m * PAPER.g}
    return {name: float(value) for name, value in start.items()}


MADE = {"jams": jamming, "lifted off": lifting}


def law_of(law: str, values: Values) -> Values:
    widths = {"exact": {}, "soft": {"omega_s": 0.2}, "stiff": {"omega_s": 1e-6}}
    return {**values, "s": 0.01, **({"friction_law": 2} if law != "exact" else {}), **widths[law]}


def ends(library: Library, end: str, law: str) -> list[tuple[Values, int, float]]:
    """Wheels whose motion leads to the end after a while, and the instant of the fine run by one of the forms."""
    found = []
    for seed in range(2000, 2060):
        values, form = law_of(law, MADE[end](np.random.default_rng(seed))), 2 + seed % 2
        fine = instant(library, values, EXACT, form, end)
        if fine is not None and fine > 1e-3:
            found.append((values, form, fine))
    return found


def instant(library: Library, values: Values, tolerance: float, form: int, end: str, **changes: float) -> float | None:
    """By one step over the whole time; none where the wheel does not come to this end."""
    done = attempt(library, {**values, "formulation": form, **changes}, [0.0, 0.6], tolerance, Schedule())
    return done.end if done.end is not None and end in done.messages[-1] else None


@pytest.mark.parametrize("end", MADE)
@pytest.mark.parametrize("law", LAWS)
def test_an_end_that_the_motion_makes_inside_a_step_is_met_at_its_instant(library: Library, end: str, law: str) -> None:
    cases, off = ends(library, end, law), []
    assert len(cases) > 12
    for tolerance in TOLERANCES:
        for values, form, fine in cases:
            found = instant(library, values, tolerance, 5 - form, end)
            assert found is not None
            within(abs(found - fine), 0.3 * tolerance, f"instant at tolerance {tolerance:g}, s")
    for values, form, fine in cases:
        moved = instant(library, values, EXACT, form, end, mu_slide=values["mu_slide"] * (1 - 1e-4))
        off.append(abs((moved or 0.0) - fine))
    beyond(float(np.median(off)), 3e-7, "middle distance of the instants with another coefficient, s")
