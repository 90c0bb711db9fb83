"""The regularized law tends to the exact one at first order; the choice of method; hours of weak releases; drift."""

from __future__ import annotations

import numpy as np
import pytest
from reference import Wheel as ReferenceWheel
from support.bounds import absolute_error, beyond, within
from support.driver import Values
from support.motion import Library, Run, run

from robustness import drift, long_runs, regularized
from robustness.regularized import TOLERANCE_FACTOR, WIDTH_FACTOR

FRICTION: Values = {"s": 0.03}


@pytest.fixture(scope="module")
def truth(library: Library) -> Run:
    return run(library, FRICTION, regularized.TIMES, 1e-12)


def law_error(library: Library, truth: Run, omega_s: float, tolerance: float, method: str = "automatic") -> float:
    values = {**FRICTION, "friction_law": "regularized", "omega_s": omega_s, "method": method}
    return regularized.error_against(truth, run(library, values, regularized.TIMES, tolerance))


def test_the_regularized_law_converges_at_first_order(library: Library, truth: Run) -> None:
    errors = [law_error(library, truth, omega_s, 1e-9) for omega_s in (1e-3, 1e-4, 1e-5, 1e-6)]
    orders = np.log10(np.array(errors[:-1]) / errors[1:])
    within(np.abs(orders - 1).max(), 0.15, "orders")
    slow = np.log10(law_error(library, truth, 1e-1, 1e-9) / law_error(library, truth, 1e-2, 1e-9))
    beyond(abs(slow - 1), 0.15, "slow")  # too wide to be asymptotic


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("omega_s", [1e-3, 1e-5, 1e-7, 1e-8])
def test_no_width_is_quietly_wrong(library: Library, truth: Run, omega_s: float, tolerance: float) -> None:
    bound = WIDTH_FACTOR * omega_s + TOLERANCE_FACTOR * tolerance
    within(law_error(library, truth, omega_s, tolerance, "bdf"), bound, "law error")
    lighter = run(library, {"s": 0.025}, regularized.TIMES, tolerance)
    beyond(regularized.error_against(truth, lighter), bound, "error against")  # another friction


def test_adams_and_bdf_agree_where_both_are_affordable(library: Library, truth: Run) -> None:
    adams, bdf = (law_error(library, truth, 1e-4, 1e-8, method) for method in ("adams", "bdf"))
    within(abs(adams - bdf), 6e-9, "adams")
    beyond(abs(adams - law_error(library, truth, 1.1e-4, 1e-8)), 2e-6, "law error")  # a tenth wider


@pytest.mark.parametrize(("factor", "layered"), [(0.5, False), (2.0, True)])
def test_the_automatic_method_follows_the_decay_number(library: Library, factor: float, layered: bool) -> None:
    at_one = regularized.decay_number({**FRICTION, "omega_s": 1.0})
    law = {**FRICTION, "friction_law": "regularized", "omega_s": at_one / (factor * regularized.THRESHOLD)}
    assert regularized.is_layered(library, law) == layered


def random_law(seed: int) -> tuple[Values, float]:
    """A stiff regularized law on a random wheel: start values and width."""
    random = np.random.default_rng(seed)
    start = {"theta_start": random.uniform(0.8, np.pi - 0.8), "s": random.uniform(0.005, 0.05)}
    start |= dict(zip(("psi_dot_start", "theta_dot_start"), random.normal(0, (1, 0.5)), strict=True))
    start["phi_dot_start"] = random.normal(0, 4)
    return start, 10 ** random.uniform(-6, -5)


def test_a_stiff_law_is_solved_within_its_tolerance(library: Library) -> None:
    """Against the same law at a much tighter tolerance by BDF alone, which knows no layer."""
    times, tolerance, errors = np.linspace(0, 3, 31), 1e-8, []
    for seed in range(60):
        start, omega_s = random_law(seed)
        law = {**start, "keep_contact": True, "friction_law": "regularized", "omega_s": omega_s}
        exact = run(library, {**law, "method": "bdf"}, times, 1e-12)
        errors.append(regularized.error_against(exact, run(library, law, times, tolerance)) / tolerance)
    within(float(np.nanmedian(errors)), 5, "median error over tolerance")
    within(float(np.nanmax(errors)), 5000, "largest error over tolerance")


def test_ten_minutes_of_weak_releases_keep_energy_spin_and_cost(library: Library) -> None:
    done = long_runs.long_run(library, "friction", FRICTION, 600.0)
    energy = done.energy[0]
    assert done.status == 0
    assert done.held == 0
    within(done.rise / energy, 1e-8, "done")  # it never rises between two readings
    coarse = long_runs.long_run(library, "free", {"method": "adams"}, 600.0, tolerance=1e-4)
    beyond(coarse.rise / energy, 9e-8, "coarse")  # nothing dissipates, a looser tolerance
    per_stretch = np.diff(done.events)
    within(absolute_error(per_stretch[-10:].sum(), 562), 6, "per stretch")
    rhs = done.column(8)
    within(np.diff(rhs)[-10:].mean() / np.diff(rhs)[5:15].mean(), 1.1, "rhs")


def test_the_releases_of_ten_minutes_do_not_depend_on_the_tolerance(library: Library) -> None:
    counts = []
    for tolerance in (1e-6, 1e-9):
        with library.wheel() as wheel:
            wheel.set(**FRICTION)
            wheel.initialise(tolerance)
            wheel.step_to(600.0)
            counts.append(wheel.get("n_events")[0])
    assert counts[0] == counts[1] == 3353


def test_the_multibody_form_stays_on_its_constraints(library: Library) -> None:
    values: Values = {**FRICTION, "J_x": 1.8, "formulation": "multibody"}
    done = run(library, values, np.linspace(0, 120, 1201))
    wheel = ReferenceWheel(J_x=1.8, s=0.03)
    within(max(r.max() for r in drift.residuals(wheel, done)), 3e-9, "residuals")
    beyond(max(r.max() for r in drift.residuals(ReferenceWheel(r=0.05 + 1e-7), done)), 3e-9, "residuals")


def test_a_free_wheel_drifts_in_energy_no_faster_than_its_tolerance(library: Library) -> None:
    done = run(library, {}, np.linspace(0, 600, 601), 1e-8)
    change = np.abs(done["E"] / done["E"][0] - 1).max()
    within(change, 1e-10, "change")  # one tolerance in ten seconds
    loose = run(library, {"method": "adams"}, np.linspace(0, 600, 601), 1e-5)
    beyond(np.abs(loose["E"] / loose["E"][0] - 1).max(), 4e-6, "E")
