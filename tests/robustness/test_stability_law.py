"""The regularized law tends to the exact one at first order; the choice of method; hours of weak releases; drift."""

from __future__ import annotations

import numpy as np
import pytest
from reference import Wheel as ReferenceWheel
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
    assert (np.abs(orders - 1) < 0.15).all()  # measured 0.913, 0.929, 0.940
    slow = np.log10(law_error(library, truth, 1e-1, 1e-9) / law_error(library, truth, 1e-2, 1e-9))
    assert abs(slow - 1) > 0.15  # too wide to be asymptotic: 0.67


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("omega_s", [1e-3, 1e-5, 1e-7, 1e-8])
def test_no_width_is_quietly_wrong(library: Library, truth: Run, omega_s: float, tolerance: float) -> None:
    bound = WIDTH_FACTOR * omega_s + TOLERANCE_FACTOR * tolerance
    assert law_error(library, truth, omega_s, tolerance, "bdf") < bound  # measured 0.76 of it and less
    lighter = run(library, {"s": 0.025}, regularized.TIMES, tolerance)
    assert regularized.error_against(truth, lighter) > bound  # another friction: 0.99


def test_adams_and_bdf_agree_where_both_are_affordable(library: Library, truth: Run) -> None:
    adams, bdf = (law_error(library, truth, 1e-4, 1e-8, method) for method in ("adams", "bdf"))
    assert abs(adams - bdf) < 1e-6  # measured 1.5e-8 of 3.3e-4
    assert abs(adams - law_error(library, truth, 1.1e-4, 1e-8)) > 1e-6  # a tenth wider: 3e-5


@pytest.mark.parametrize(("factor", "method"), [(0.5, "adams"), (2.0, "bdf")])
def test_the_automatic_method_follows_the_decay_number(library: Library, factor: float, method: str) -> None:
    at_one = regularized.decay_number({**FRICTION, "omega_s": 1.0})
    law = {**FRICTION, "friction_law": "regularized", "omega_s": at_one / (factor * 200.0)}
    assert regularized.chosen_method(library, law) == method


def test_ten_minutes_of_weak_releases_keep_energy_spin_and_cost(library: Library) -> None:
    done = long_runs.long_run(library, "friction", FRICTION, 600.0)
    energy = done.energy[0]
    assert done.status == 0
    assert done.held == 0
    assert done.rise < 1e-8 * energy  # measured 0: it never rises between two readings
    coarse = long_runs.long_run(library, "free", {"method": "adams"}, 600.0, tolerance=1e-4)
    assert coarse.rise > 1e-8 * energy  # nothing dissipates, a looser tolerance: 9e-6
    per_stretch = np.diff(done.events)
    assert per_stretch[-10:].sum() == pytest.approx(562, abs=6)  # 5.62 a second, as in the first hour
    rhs = done.column(8)
    assert np.diff(rhs)[-10:].mean() < 1.1 * np.diff(rhs)[5:15].mean()  # measured 0.97


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
    assert max(r.max() for r in drift.residuals(wheel, done)) < 3e-9  # measured 1.05e-9
    assert max(r.max() for r in drift.residuals(ReferenceWheel(r=0.05 + 1e-7), done)) > 3e-9  # 0.1 um: 3e-7


def test_a_free_wheel_drifts_in_energy_no_faster_than_its_tolerance(library: Library) -> None:
    done = run(library, {}, np.linspace(0, 600, 601), 1e-8)
    change = np.abs(done["E"] / done["E"][0] - 1).max()
    assert change < 60 * 1e-8  # one tolerance in ten seconds; measured 4.3e-8
    loose = run(library, {"method": "adams"}, np.linspace(0, 600, 601), 1e-5)
    assert np.abs(loose["E"] / loose["E"][0] - 1).max() > 60 * 1e-8  # 7.5e-6
