"""The car: coupled FMUs against closed forms; orders of the masters."""

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from lab.vehicles import car, car_judges, planar
from lab.vehicles.car_judges import (
    CIRCLE,
    CURVE,
    EIGHT,
    HILL,
    LANE,
    LAYOUT,
    SPLIT,
    STEP,
    STRAIGHT,
    WHEELS,
    constants,
)
from lab.vehicles.options import Manoeuvre
from lab.vehicles.vehicle import Fmus, Table


def drive(fmus: Fmus, *how: object) -> Table:
    """The coupled car: manoeuvre, step, exchange, grid."""
    return car.CAR.drive(fmus, *how).table


def error(finding: car_judges.Finding) -> float:
    return relative_error(finding.measured, finding.exact)


def test_the_car_stands_starts_and_parks_on_the_hill_without_rolling_back(fmus: Fmus) -> None:
    table = drive(fmus, HILL, 0.001)
    held = (table["time"] < HILL["t_on"]) | (table["time"] > 8)
    assert not any(table[f"{w}.omega_z"][held].any() for w in WHEELS)
    start = table["time"] < HILL["t_brake"]
    assert car.rolled_back({name: values[start] for name, values in table.items()}) == 0
    within(car.rolled_back(table), car.LIMITS["roll_back"], "way that it rolls back, m")
    for finding in car_judges.standing(table, HILL, constants(HILL)):
        within(error(finding), 0.01 if finding.what.startswith("load") else 1e-3, f"{finding.what}, relative")
    weak = HILL.changed(B_hold=400.0)  # partner: below m g R sin(slope), 652 N m
    beyond(car.rolled_back(drive(fmus, weak)), 0.1, "way that it rolls back with weak brakes, m")


def test_the_orders_of_the_masters(fmus: Fmus) -> None:
    """Reference: rollback at a quarter of the smaller step."""
    lane = LANE.changed(stop=3.0)
    truth = drive(fmus, lane, 0.00125, "rollback", 0.25)
    for exchange, order in (("held", 1), ("derivatives", 2), ("rollback", 4)):
        coarse, fine = (car.CAR.error(fmus, lane, truth, h, exchange) for h in (0.01, 0.005))
        within(abs(np.log2(coarse / fine) - order), 0.3, f"{exchange}: order of convergence off {order}")
    softer = lane.changed(**{f"k_{w}": 0.99 * float(wheel["k"]) for w, wheel in WHEELS.items()})
    beyond(car.CAR.error(fmus, softer, truth, 0.01, "rollback") / coarse, 100, "error of springs 1 % softer")


def test_in_the_plane_the_coupled_car_moves_as_one_system_of_equations(fmus: Fmus) -> None:
    """Braking in a turn, all but the stop; partner: bushings 1 % softer."""
    run = CURVE.changed(stop=7.0, **planar.LEVEL)
    truth = planar.solved(run, np.arange(0, 7.1, 0.25))
    within(car.CAR.error(fmus, run, truth, 0.005, "rollback"), 3e-6, "error / range")
    softer = run.changed(k_h=0.99 * run["k_h"])
    beyond(car.CAR.error(fmus, softer, truth, 0.005, "rollback"), 3e-5, "error with softer bushings")


def stiffer(manoeuvre: Manoeuvre, factor: float) -> Manoeuvre:
    """All bushings stiffer and harder damped."""
    links = {n: factor * LAYOUT["chassis"][n] for n in ("k_h", "c_h")}
    return manoeuvre.changed(**links, inner_step=0.001 / factor)


QUICK_CIRCLE = CIRCLE.changed(stop=9.0, ramp_v=3.0)
LAUNCH = STRAIGHT.changed(stop=3.5)


@pytest.mark.parametrize(
    ("manoeuvre", "judge", "count", "rest"),
    [(QUICK_CIRCLE, "bend", 5, 4e-4), (LAUNCH, "launch", 2, 4e-4), (STEP, "step", 3, 1e-3)],
)
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(
    fmus: Fmus, manoeuvre: Manoeuvre, judge: str, count: int, rest: float
) -> None:
    """rest: roll squared, as after a step, does not fall as 1 / k. Nor do the lateral forces of the axles, whose wheels
    do not slip: stiffer bushings hold more of the strain that entering the bend has left."""
    tables = (drive(fmus, stiffer(manoeuvre, k), 0.0005) for k in (1.0, 3.0))
    found, c = car_judges.JUDGES[judge], constants(manoeuvre)
    soft, stiff = ([f for f in found(table, manoeuvre, c) if f.exact] for table in tables)
    assert len(soft) == count
    for finding, nearer in zip(soft, stiff, strict=True):
        within(error(finding), 0.04, f"{finding.what}, relative")
        if finding.what.startswith("lateral force"):
            within(error(nearer), 0.02, f"{finding.what}, stiff links, relative")
            continue
        within(error(nearer) / max(0.45 * error(finding), rest), 1, "error of stiff links over what 1/k allows")


def test_the_stopping_distance_is_that_of_the_closed_form(fmus: Fmus) -> None:
    for finding in car_judges.braking(drive(fmus, STRAIGHT, 0.001), STRAIGHT, constants(STRAIGHT)):
        within(error(finding), 0.05 if finding.what.startswith("load") else 0.02, f"{finding.what}, relative")


def test_on_a_split_road_the_car_keeps_its_course_at_the_closed_forms_deceleration_and_moment(fmus: Fmus) -> None:
    table = drive(fmus, SPLIT, 0.001)
    assert {*car_judges.slid(table)} == {"fr", "rr"} and car.verdict(table, SPLIT)[0]
    other = SPLIT.changed(mu_slide_right=0.16)
    for found, wrong in zip(*(car_judges.split(table, run, constants(run)) for run in (SPLIT, other)), strict=True):
        if found.exact:
            within(error(found), 1e-3, f"{found.what}, relative")
            beyond(error(wrong), 5e-3, f"{found.what}, by another friction on the right, relative")


def test_wheels_that_never_slip_do_not_understeer(fmus: Fmus) -> None:
    table = drive(fmus, CIRCLE.changed(stop=12.0, ramp_v=7.0), 0.002)
    found = {f.what: f for f in car_judges.circle(table, CIRCLE, constants(CIRCLE))}
    within(abs(found["understeer gradient"].measured), 3e-5, "understeer gradient, rad s2/m")  # road cars: 2e-3 to 5e-3


def test_the_figure_of_eight_closes(fmus: Fmus) -> None:
    for eight, check in ((EIGHT, within), (EIGHT.changed(k_y=0.0, k_psi=0.0, T_delta=0.3), beyond)):  # after 105 m
        gap, _ = car_judges.closure(drive(fmus, eight, 0.002), eight, constants(eight))
        check(gap.measured, 0.02, "gap, m")


def test_a_step_of_the_steering_overshoots_and_needs_the_friction_of_an_axle_not_of_a_wheel(fmus: Fmus) -> None:
    """A lateral acceleration a needs about a / g; partner: the wheel inside the bend."""
    table = drive(fmus, STEP.changed(v=60 / 3.6, delta_0=np.radians(3)), 0.002)
    found = {finding.what: finding.measured for finding in car_judges.step(table, STEP, constants(STEP))}
    beyond(found["overshoot of the lateral acceleration"], 0.01, "overshoot")
    least = float(np.abs(table["a_y"]).max()) / car_judges.G
    within(abs(max(car_judges.demand(table).values()) / least - 1), 0.1, "friction over a / g, off 1")
    beyond(max(np.nanmax(table[f"{w}.mu_required"]) for w in WHEELS) / least, 2, "friction of one wheel over a / g")


def test_a_closed_form_is_printed_where_what_it_assumes_holds_and_a_run_beyond_its_bound_has_failed(fmus: Fmus) -> None:
    table = drive(fmus, LAUNCH, 0.002)
    found, why = car_judges.judged("launch", table, LAUNCH)
    assert not why and [f.fault for f in found] == ["", ""] and all("closed form" in str(f) for f in found)
    slides = table | {"fl.slip_x": np.ones_like(table["time"])}
    stops = table | {"d_fl": np.full_like(table["time"], LAUNCH["travel"])}
    others = {"k_h is changed": (table, LAUNCH.changed(k_h=100e3)), "a wheel slides": (slides, LAUNCH)}
    for words, (run, asked) in (others | {"a strut reaches its stop": (stops, LAUNCH)}).items():
        found, why = car_judges.judged("launch", run, asked)
        assert why == words and not any("closed form" in str(f) or f.fault for f in found)
    turning = drive(fmus, STEP.changed(stop=0.8), 0.002)
    assert car_judges.judged("bend", turning, STEP)[1] == "it is not steady at the end"
    heavier = LAUNCH.changed(m_B=1300.0)  # of which the run is not
    lines, faults = car_judges.findings(table, heavier)
    assert "acceleration of the launch deviates from its closed form by more than 2 %" in faults[0]
    assert any("closed form" in line for line in lines)
