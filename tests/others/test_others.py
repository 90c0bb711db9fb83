"""wheel.fmu and its equations against derivations, reference results and closed forms that other people made."""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.exact_motions import measured_critical_spin
from wheelfmu.truth.motion import Library
from wheelfmu.truth.others import kane, wheels
from wheelfmu.truth.others.wheels import read
from wheelfmu.truth.requirements import asked


@pytest.mark.parametrize("symmetric", [True, False], ids=["J_x = J_y", "any J"])
def test_kanes_method_gives_the_same_accelerations_and_normal_force(symmetric: bool) -> None:
    within(kane.distance(symmetric=symmetric), asked("others", "kane"), "symbrim: relative")  # two solutions
    beyond(kane.distance(10, symmetric, stretched=1 + 1e-9), 2e-11, "symbrim, a tube 1e-9 thicker: relative")


def test_modelicas_wheel_is_as_far_from_ours_as_from_an_independent_integration(library: Library) -> None:
    within(wheels.modelica_own(library), asked("others", "modelica_own"), "reference and FMU apart, m")
    for other in (wheels.modelica_reference(), wheels.modelica(library)):
        assert wheels.apart(read("modelica_wheel"), other) == pytest.approx(5.84e-4, abs=1e-6)  # m


def test_the_drift_of_modelicas_wheel_is_seen_in_its_energy(library: Library) -> None:
    ours = wheels.modelica(library)["E"]
    assert wheels.modelica_energy()[0] == pytest.approx(ours[0], rel=64 * EPSILON)
    within(np.ptp(ours) / ours[0], 4e-10, "our energy: drift, relative")
    beyond(wheels.modelica_drift(), 5e-6, "the table's energy: drift, relative")


def test_exudyns_coin_converges_to_ours(library: Library) -> None:
    table, ours = read("exudyn_coin"), wheels.coin(library, 1e-12)
    within(np.abs(wheels.coin_limit(table) - ours).max(), asked("others", "coin"), "contact points apart, m")
    off = np.abs(table["x"] - ours[0])
    assert off[:-1] / off[1:] == pytest.approx(4, rel=1e-3)  # a method of second order
    beyond(off[-1], 1e-10, "the smallest step without extrapolation, m")


def test_exudyns_thrown_disc_converges_to_ours_as_its_regularization_narrows(library: Library) -> None:
    table, ours = read("exudyn_slide"), wheels.thrown(library, 1e-12)
    off = np.abs(wheels.thrown_limit(table) - ours)
    within(off[:2].max(), 5e-10, "centre apart while it slides, m")
    within(off[2:].max(), asked("others", "thrown"), "centre apart after it grips, m")
    by_zone = np.abs(wheels.thrown_in_steps(table) - ours)
    assert by_zone[:-1] / by_zone[1:] == pytest.approx(2, rel=0.05)  # of first order in the zone
    beyond(by_zone[-1, 2:].max(), 1e-6, "centre apart at the narrowest zone, m")


@pytest.mark.parametrize("scene", ["rolls", "slides", "backspin"])
def test_siconos_converges_to_ours_at_first_order_in_its_step(library: Library, scene: str) -> None:
    steps, ours = wheels.siconos(read("siconos"), scene), wheels.siconos_ours(library, scene, 1e-11)
    within(np.abs(steps.limit - ours).max(), asked("others", f"siconos_{scene}"), "centre, from five steps, m")
    within(abs(steps.order - 1), 0.01, "order of convergence less 1")
    beyond(np.abs(steps.places[-1] - ours).max(), 1e-4, "centre at the smallest step, without extrapolation, m")
    other = {"mu_max": 0.3003, "mu_slide": 0.3003} if scene != "rolls" else {"m": 20.02}
    beyond(np.abs(steps.limit - wheels.siconos_ours(library, scene, 1e-11, **other)).max(), 4e-6, "another wheel, m")


def test_siconos_rolling_friction_is_ours(library: Library) -> None:
    steps, ours = wheels.siconos(read("siconos"), "resists"), wheels.siconos_ours(library, "resists", 1e-11)
    within(np.abs(steps.places - ours).max(), asked("others", "siconos_resists"), "centre at any step, m")
    beyond(np.abs(steps.places - wheels.siconos_ours(library, "resists", 1e-11, s=0.01001)).max(), 1e-5, "other s, m")


def test_the_critical_spin_is_that_of_sympys_disc(library: Library) -> None:
    off = measured_critical_spin(library, wheels.SYMPY_DISC) - wheels.SYMPY_CRITICAL_SPIN
    within(abs(off), asked("others", "critical"), "critical spin, rad/s")
    tube = measured_critical_spin(library, replace(wheels.SYMPY_DISC, r=0.01)) - wheels.SYMPY_CRITICAL_SPIN
    beyond(abs(tube), 3e-4, "critical spin with a tube of 1 cm, rad/s")


@pytest.mark.parametrize("disc", wheels.DISCS, ids=lambda disc: f"m = {disc.m:g}, r_0 = {disc.r_0:g}")
def test_the_rolling_disc_follows_legendre_functions(library: Library, disc: wheels.Wheel) -> None:
    within(wheels.legendre_error(library, disc), asked("others", "legendre"), "omega_2, omega_3: relative")
    judged = replace(disc, J_x=disc.J_x * (1 + 1e-9))
    beyond(wheels.legendre_error(library, disc, judged), 2e-11, "judged by J_x 1e-9 larger: relative")
