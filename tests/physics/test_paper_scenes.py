"""The paper's two scenes, (27)-(33) without and with friction, against the reference; energy; convergence.

s = 0 and s = 0.03 m, 10 s, J_x = J_y. Fixed axes.
"""

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.truth.measure import FRICTION, energy_error, paper, paper_errors
from wheelfmu.truth.motion import Library

BOUND = 1e-6  # of the output's range
both = pytest.mark.parametrize("scene", FRICTION)


def worst(library: Library, scene: str, tolerance: float | None = None, **start: float) -> float:
    return max(paper_errors(library, scene, tolerance, **start).values())


WAYS = {"default": ({}, BOUND, {"J_z": 1.8 * (1 - 1e-5)})}
WAYS |= {"tightest": ({"tolerance": 1e-13}, 2e-10, {"tolerance": 1e-8})}
WAYS |= {"multibody": ({"tolerance": 1e-11, "formulation": 3}, 2e-8, {"tolerance": 1e-4})}
WAYS |= {"bdf": ({"tolerance": 1e-11, "method": 3}, 2e-8, {"tolerance": 1e-4})}


@both
@pytest.mark.parametrize(("how", "bound", "broken"), WAYS.values(), ids=WAYS)
def test_each_headline_output_is_that_of_the_reference(
    library: Library, scene: str, how: dict, bound: float, broken: dict
):
    """At the default tolerance it is right to a millionth of its range."""
    within(paper_errors(library, scene, **how), bound, "error / range")
    beyond(worst(library, scene, **how | broken), bound, "error of another run / range")


def test_rolling_without_slip_needs_a_friction_coefficient_of_up_to_0_49(library: Library) -> None:
    want = paper("free")
    run = library.simulate(np.linspace(0, 10, 1001))
    tangential = np.hypot(want["lambda_1"], want["lambda_2"])
    within(abs(run["mu_required"].max() - 0.4869), 1e-4, "largest mu_required off 0.4869")  # at 0.63 s
    within(
        np.abs(run["mu_required"][::10] - tangential / want["lambda_3"]).max(), 7e-9, "mu_required off the reference's"
    )
    beyond(np.abs(run["mu_required"][::10] - tangential / 196.2).max(), 0.03, "mu_required by the weight")


@both
def test_the_error_falls_in_proportion_to_the_tolerance(library: Library, scene: str) -> None:
    """Of a motion that is stepped through: Runge-Kutta for both."""

    def order(**start: float) -> float:
        coarse, fine = (worst(library, scene, tolerance, method=4, **start) for tolerance in (1e-5, 1e-10))
        return float(np.log10(coarse / fine) / 5)

    within(abs(order() - 1.025), 0.225, "order of convergence off 1.025")
    within(abs(order(J_z=1.799)), 1e-3, "order of convergence of another wheel")


def test_the_free_wheel_keeps_its_energy_to_the_tolerance(library: Library) -> None:
    within(energy_error(library), 5e-10, "change of the energy, relative")
    within(energy_error(library, 1e-12), 2.2e-13, "change of the energy at 1e-12, relative")
    beyond(energy_error(library, s=1e-8), 1e-8, "change by a hundred-millionth of a metre of friction, relative")
