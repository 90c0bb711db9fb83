"""The coupled vehicles against closed forms and one system of equations; the orders of the master."""

from math import exp

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from lab.vehicles import judges, planar
from lab.vehicles.master import Component, Master, loaded
from lab.vehicles.options import Manoeuvre, manoeuvres
from lab.vehicles.vehicle import Fmus, Table, drive, error

STRAIGHT, CIRCLE, STEP, LANE, HILL = manoeuvres("car").values()
LAUNCH, BRAKE = manoeuvres("suspended").values()
STEPS = (0.0025, 0.00125, 0.000625)  # s


def off(finding: judges.Finding) -> float:
    return relative_error(finding.measured, finding.exact)


def stiffer(run: Manoeuvre, factor: float) -> Manoeuvre:
    """All bushings stiffer and harder damped."""
    return run.changed(k_h=factor * run["k_h"], c_h=factor * run["c_h"])


@pytest.mark.parametrize(
    ("run", "judge", "rest"),
    [(CIRCLE, "bend", 4e-4), (STRAIGHT.changed(stop=3.5), "launch", 4e-4), (STEP, "bend", 1e-3)],
    ids=["circle", "launch", "step"],
)
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(fmus: Fmus, run: Manoeuvre, judge: str, rest: float):
    """rest: roll squared, as after a step, does not fall as 1 / k. Nor do the lateral forces of the axles, whose wheels
    do not slip: stiffer bushings hold more of the strain that entering the bend has left."""
    soft, stiff = (list(judges.JUDGES[judge](drive(fmus, r, 0.0005).whole, r)) for r in (run, stiffer(run, 3.0)))
    for finding, nearer in zip(soft, stiff, strict=True):
        within(off(finding), 0.04, f"{finding.what}, relative")
        if finding.what.startswith("lateral force"):
            within(off(nearer), 0.02, f"{finding.what}, stiff links, relative")
            continue
        within(off(nearer) / max(0.45 * off(finding), rest), 1, "error of stiff links over what 1/k allows")
    other = run.changed(m_B=1.1 * run["m_B"])  # partner: of a heavier car
    beyond(max(off(finding) for finding in judges.JUDGES[judge](drive(fmus, run).whole, other)), 0.05, "relative")


def test_the_stopping_distance_is_that_of_the_closed_form(fmus: Fmus):
    for run in (STRAIGHT, BRAKE):
        table = drive(fmus, run, 0.001).whole
        for finding in judges.judge(table, run):
            within(off(finding), 0.05 if finding.what.startswith("load") else 0.02, f"{finding.what}, relative")
        weaker = run.changed(**{name: 0.9 * run[name] for name in ("B_0", "M_pedal") if name in run.given})
        assert not all(finding.holds for finding in judges.judge(table, weaker))


def test_the_car_stands_starts_and_parks_on_the_hill_without_rolling_back(fmus: Fmus):
    def back(table: Table) -> float:
        """How far a wheel's centre goes back at most, m."""
        return max(float((np.maximum.accumulate(x) - x).max()) for x in (table[f"{w}.X_O"] for w in judges.WHEELS))

    table = drive(fmus, HILL, 0.001).whole
    held = (table["time"] < HILL["t_on"]) | (table["time"] > 8)
    assert not any(table[f"{w}.omega_z"][held].any() for w in judges.WHEELS)
    start = table["time"] < HILL["t_brake"]
    assert back({name: values[start] for name, values in table.items()}) == 0
    within(back(table), 1e-3, "way that it rolls back, m")
    weak = HILL.changed(B_hold=400.0)  # partner: below m g R sin(slope), 652 N m
    beyond(back(drive(fmus, weak).table), 0.1, "way that it rolls back with weak brakes, m")


def test_in_the_plane_the_coupled_car_moves_as_one_system_of_equations(fmus: Fmus):
    """Braking in a turn, all but the stop; partner: bushings 1 % softer."""
    run = STEP.changed(k_v=0.0, k_i=0.0, B_0=1500.0, t_brake=2.0, **planar.LEVEL)
    truth = planar.solved(run, np.arange(0, 4.1, 0.25))
    within(error(fmus, run, truth, 0.005, "rollback"), 1e-5, "error / range")
    beyond(error(fmus, run.changed(k_h=0.99 * run["k_h"]), truth, 0.005, "rollback"), 3e-5, "with softer bushings")


def test_the_orders_of_the_masters(fmus: Fmus):
    """Reference: rollback at a quarter of the smaller step."""
    lane = LANE.changed(stop=3.0)
    truth = drive(fmus, lane, 0.00125, "rollback", 0.25).whole
    for exchange, order in (("held", 1), ("derivatives", 2), ("rollback", 4)):
        coarse, fine = (error(fmus, lane, truth, h, exchange) for h in (0.01, 0.005))
        within(abs(np.log2(coarse / fine) - order), 0.3, f"{exchange}: order of convergence off {order}")
    softer = lane.changed(**{f"k_{w}": 0.99 * lane[f"k_{w}"] for w in judges.WHEELS})
    beyond(error(fmus, softer, truth, 0.01, "rollback") / coarse, 100, "error of springs 1 % softer")


def test_the_error_of_held_positions_is_the_drag_of_their_lag(fmus: Fmus):
    """The share of the speed that the drag k v h / 2 takes over 2.5 s of the launch."""
    truth = drive(fmus, LAUNCH, STEPS[-1] / 4, "derivatives", 0.05).whole
    held = [error(fmus, LAUNCH, truth, h, "held") for h in STEPS]
    lagging = [error(fmus, LAUNCH.changed(follow=0.0), truth, h, "held") for h in STEPS]
    within(np.divide(held, lagging).max(), 0.25, "error of those that follow over that of held positions")
    for factor, check in ((1, within), (2, beyond)):  # of the step, and so of the drag
        x = [factor * LAUNCH["k_h"] * h / 2 * 2.5 / 334.7 for h in STEPS]
        predicted = [1 - (1 - exp(-share)) / share for share in x]
        check(relative_error(lagging, predicted), 0.05, "error of held positions off the drag, relative")


@pytest.mark.parametrize("exchange", ["held", "derivatives", "rollback"])
@pytest.mark.parametrize(("h", "grid"), [(0.0002, 0.0017), (0.007, 0.01)])
def test_a_run_ends_at_its_stop_whether_or_not_the_step_divides_it(fmus: Fmus, exchange: str, h: float, grid: float):
    table = drive(fmus, LAUNCH.changed(stop=0.7), h, exchange, grid).whole
    assert table["time"][-1] == 0.7 and np.all(np.diff(table["time"]) > 0)


def test_the_master_refuses_an_algebraic_loop(fmus: Fmus):
    """The order of exchange rests on declared dependencies; F_X -> lambda_1 -> X_O would be a loop."""
    loop = [(("quarter_car", "F_X"), ("wheel", "F_X")), (("wheel", "lambda_1"), ("quarter_car", "X_O"))]
    parts = [Component(name, fmus[name]) for name in ("wheel", "quarter_car")]
    with pytest.raises(ValueError, match="cycle"), loaded(*parts):
        Master(parts, loop)
