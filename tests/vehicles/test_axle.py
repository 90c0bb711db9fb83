"""The axle against the rigid axle on wheels that never slip: closed forms, order in 1/k, energy;
Modelica's wheel sets, which two wheels on axle.fmu become as the links are made stiffer."""

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, relative_error, within

from wheelfmu.truth.others.wheels import read
from wheelfmu.vehicles import axle
from wheelfmu.vehicles import wheel_sets as sets
from wheelfmu.vehicles.axle import AXLE, ROLLING_OUT, SCENES, STRAIGHT, TRAILING
from wheelfmu.vehicles.options import Manoeuvre
from wheelfmu.vehicles.vehicle import Fmus

SHORT = TRAILING.changed(stop=1.0)


@pytest.mark.parametrize("scene", [*SCENES.values(), STRAIGHT.changed(slope=0.1)], ids=[*SCENES, "uphill"])
def test_the_error_of_the_closed_form_falls_as_one_over_the_stiffness(fmus: Fmus, scene: Manoeuvre) -> None:
    soft, stiff = axle.stiffness_errors(fmus, scene.changed(stop=2.0), (2.0, 4.0), 0.0005).values()
    within(stiff, 0.008, "error of links four times as stiff / range")
    within(abs(np.log2(soft / stiff) - 1), 0.25, "order in 1/k off 1")


@pytest.mark.parametrize("changed", [{"J_z": 1.7}, {"J_x": 0.5}, {"J_3": 15.0}, {"m_B": 117.0}, {"a": 0.19}])
def test_a_wrong_constant_of_the_closed_form_shows(changed: dict[str, float]) -> None:
    """Partner: each mass and inertia enters m_t, I_t or S as derived; the bound of the test above separates them."""
    scene, times = TRAILING.changed(stop=2.0), np.arange(101) * 0.02
    off = AXLE.distance(axle.rigid(scene.changed(**changed), times), axle.rigid(scene, times))
    beyond(off, 0.0062, "error of a wrong constant / range")  # more than that of links four times as stiff


def test_on_a_slope_the_energy_stays(fmus: Fmus) -> None:
    scene = STRAIGHT.changed(stop=2.0, slope=0.1, M_left=0.0, M_right=0.0)
    drift = axle.energy_gain(AXLE.drive(fmus, scene, 0.0005).whole)
    within(abs(drift), 0.1, "drift of the energy, J")  # the height along the slope is worth 150 J
    level = AXLE.drive(fmus, scene.changed(slope=0.0, v=1.0), 0.0005).whole
    within(np.abs(level["v"] - 1.0).max(), 1e-9, "change of speed on the level, m/s")
    within(np.abs(level["Y"]).max(), 64 * EPSILON, "off the line, m")


@pytest.mark.parametrize("v", [-1.0, 0.0, 0.5])
def test_whatever_the_start_it_ends_with_the_mass_in_front(fmus: Fmus, v: float) -> None:
    scene = TRAILING.changed(v=v, omega=2.0, a=0.3, stop=8.0)
    table, c = AXLE.drive(fmus, scene, 0.002).whole, axle.constants(scene)
    V = np.sqrt(c.v**2 + c.I_t / c.m_t * c.omega**2)
    within(relative_error(table["v"][-1], V), 0.01, "speed at the end, relative")
    within(abs(table["omega"][-1] / c.omega), 0.02, "yaw rate at the end / at the start")
    behind = AXLE.drive(fmus, scene.changed(a=-0.3, v=abs(v) + 0.1, stop=8.0), 0.002).whole
    assert behind["v"][-1] < 0  # partner: with the mass behind it turns round


def test_each_wheel_of_a_turning_axle_stops_at_its_own_instant(fmus: Fmus) -> None:
    inner, outer = axle.velocities(ROLLING_OUT)[1]
    table = AXLE.drive(fmus, ROLLING_OUT.changed(stiffness=4.0), 0.0005, grid=0.005).whole
    for wheel, stop in (("left", inner), ("right", outer)):
        spin = table[f"{wheel}.omega_z"]
        within(abs(table["time"][np.argmax(spin == 0)] - stop), 0.02, f"stop of the {wheel} wheel, s")  # grid: 5 ms
        assert spin[-1] == 0
    assert outer - inner > 1  # partner: the instants are far apart


def test_held_positions_take_energy_and_straight_lines_hardly_any(fmus: Fmus) -> None:
    runs = (AXLE.drive(fmus, SHORT.changed(follow=0), 0.0005, exchange).whole for exchange in ("held", "derivatives"))
    held, lines = (axle.energy_gain(run) for run in runs)
    beyond(-held, 10, "energy taken, J")  # of some 90 J
    within(abs(lines / held), 5e-4, "energy gained with straight lines over that with held positions")


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_rigid_wheel_set_has_modelicas_numbers(scene: str) -> None:
    within(sets.distance(sets.table(scene), sets.rigid(scene)), 1e-5, "distance from Modelica's table, m, rad")
    at = read("multibody_jl_driving")
    exact = sets.rigid_at("driving", at["time"])
    within(np.hypot(at["x"] - exact["x"], at["y"] - exact["y"]).max(), 1e-3, "distance from Multibody.jl's test, m")


@pytest.mark.parametrize("scene", sets.SCENES)
def test_the_error_falls_as_one_over_the_stiffness_to_modelicas_numbers(fmus: Fmus, scene: str) -> None:
    stop, factors = 1.5, (5, 10, 20)
    runs = [sets.coupled(fmus, scene, factor, 0.002 / factor, stop) for factor in factors]
    errors = [sets.distance(run, sets.rigid(scene)) for run in runs]
    within(relative_error(np.array(errors[:-1]) / errors[1:], [2, 2]), 0.05, "ratio of errors off 2, relative")
    limit = sets.distance(sets.limit(runs), sets.rigid(scene))
    within(limit / errors[-1], 0.02, "error of the limit over that of the stiffest links")
    beyond(errors[0] / errors[-1], 3.5, "error of the softest links over that of the stiffest")
