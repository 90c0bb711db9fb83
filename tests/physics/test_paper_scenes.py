"""The paper's two scenes, (27)-(33) without and with friction, against the trusted tables; energy; convergence.

s = 0 and s = 0.03 m, 10 s, J_x = J_y. Fixed axes.
"""

from __future__ import annotations

import numpy as np
import pytest
from reference.tables import read_table
from support.motion import Library

from .measure import FRICTION, energy_error, table_errors

BOUND = 1e-6  # of the output's range
both = pytest.mark.parametrize("scene", FRICTION)


def worst(library: Library, scene: str, tolerance: float | None = None, **start: float) -> float:
    return max(table_errors(library, scene, tolerance, **start).values())


@both
def test_each_headline_output_is_right_to_a_millionth_of_its_range_at_the_default_tolerance(
    library: Library, scene: str
) -> None:
    assert worst(library, scene) < BOUND  # measured 6.7e-8 free, 1.6e-8 friction
    assert worst(library, scene, J_z=1.8 * (1 - 1e-5)) > BOUND  # measured 4.6e-5, 2.9e-5


@both
def test_every_column_of_the_tables_is_met(library: Library, scene: str) -> None:
    want = read_table(f"paper_{scene}")

    def error(tolerance: float) -> float:
        got = library.simulate(want["t"], tolerance, s=FRICTION[scene])
        changing = [name for name in want if name != "t" and np.ptp(want[name]) > 1e-3]  # not E of the free wheel
        return max(float(np.abs(got[name] - want[name]).max() / np.ptp(want[name])) for name in changing)

    assert error(1e-11) < 1e-8  # measured 1.1e-10, 5.0e-11
    assert error(1e-6) > 1e-8  # measured at least 4.3e-6


def test_rolling_without_slip_needs_a_friction_coefficient_of_up_to_0_49(library: Library) -> None:
    want = read_table("paper_free")
    run = library.simulate(np.linspace(0, 10, 1001))
    tangential = np.hypot(want["lambda_1"], want["lambda_2"])
    assert abs(run["mu_required"].max() - 0.4869) < 1e-4  # at 0.63 s
    assert np.abs(run["mu_required"][::10] - tangential / want["lambda_3"]).max() < 1e-5  # measured 1.1e-8
    assert np.abs(run["mu_required"][::10] - tangential / 196.2).max() > 0.01  # over the weight instead of N


@both
def test_the_error_falls_in_proportion_to_the_tolerance(library: Library, scene: str) -> None:
    """Of a motion that is stepped through: Runge-Kutta for both."""

    def order(**start: float) -> float:
        coarse, fine = (worst(library, scene, tolerance, method=4, **start) for tolerance in (1e-5, 1e-10))
        return float(np.log10(coarse / fine) / 5)

    assert 0.8 < order() < 1.25  # measured 0.98, 0.98
    assert order(J_z=1.799) < 0.1  # another wheel does not converge to the table: measured 0.001 at most


@both
def test_at_the_tightest_tolerance_only_the_tables_rounding_is_left(library: Library, scene: str) -> None:
    assert worst(library, scene, 1e-13) < 2e-10  # measured 6.3e-11 free, 4.5e-11 friction
    assert worst(library, scene, 1e-8) > 2e-10  # measured 6.7e-8, 1.6e-8


@both
@pytest.mark.parametrize("choice", [{"formulation": 3}, {"method": 3}], ids=["multibody", "bdf"])
def test_the_other_formulation_and_the_other_method_reach_the_same_motion(
    library: Library, scene: str, choice: dict[str, int]
) -> None:
    assert worst(library, scene, 1e-11, **choice) < 2e-8  # measured at most 1.8e-9 (bdf, free)
    assert worst(library, scene, 1e-4, **choice) > 1e-6  # measured at least MEASURE


def test_the_free_wheel_keeps_its_energy_to_the_tolerance(library: Library) -> None:
    assert energy_error(library) < 1e-8  # measured 1.2e-9
    assert energy_error(library, 1e-12) < 1e-12  # measured 1.4e-13
    assert energy_error(library, s=1e-8) > 1e-8  # a hundred-millionth of a metre of friction: measured 5.9e-7


def test_the_energy_error_falls_with_the_tolerance(library: Library) -> None:
    tolerances = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12]
    errors = np.array([energy_error(library, tolerance, method=4) for tolerance in tolerances])
    assert (errors[1:] < 0.2 * errors[:-1]).all()  # measured factors at most 0.014
    assert (errors < tolerances).all()  # measured: at most 0.50 of the tolerance
    broken = np.array([energy_error(library, tolerance, method=4, s=1e-8) for tolerance in tolerances[-2:]])
    assert broken[1] > 0.2 * broken[0]  # a loss that no tolerance mends: measured 1.0
