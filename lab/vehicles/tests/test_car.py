"""The coupled car against closed forms and one system of equations; the orders of the master."""

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from lab.vehicles import judges, planar
from lab.vehicles.car import Fmus, drive, error
from lab.vehicles.manoeuvres import MANOEUVRES, WHEELS, Manoeuvre
from lab.vehicles.master import Component, Ended, Master, loaded

LANE, STRAIGHT, CIRCLE, STEP = MANOEUVRES.values()
IN_PLANE = STEP.changed(k_v=0.0, k_i=0.0, B_0=1500.0, t_brake=2.0, **planar.LEVEL)


def off(finding: judges.Finding) -> float:
    return relative_error(finding.measured, finding.exact)


def stiffer(run: Manoeuvre, factor: float) -> Manoeuvre:
    """All bushings stiffer and harder damped."""
    return run.changed(k_h=factor * run["k_h"], c_h=factor * run["c_h"])


@pytest.mark.parametrize("name", judges.JUDGES)
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(fmus: Fmus, name: str):
    """That of the loads falls as 1 / k. Partner: the closed forms of a heavier car with weaker brakes."""
    run = MANOEUVRES[name]
    tables = [drive(fmus, r, 0.002) for r in (run, stiffer(run, 3.0))]
    soft, stiff = (judges.judge(name, table, run) for table in tables)
    for finding, nearer in zip(soft, stiff, strict=True):
        load = finding.what.startswith("load")
        within(off(finding), 0.03 if load else 0.01, f"{finding.what}, relative")
        if load:
            within(off(nearer) / off(finding), 0.5, f"{finding.what}, with stiff links over soft ones")
    other = judges.judge(name, tables[0], run.changed(m_B=1.1 * run["m_B"], B_0=0.9 * run["B_0"]))
    beyond(max(map(off, other)), 0.05, "of a heavier car, relative")


def test_in_the_plane_the_coupled_car_moves_as_one_system_of_equations_with_the_orders_of_the_masters(fmus: Fmus):
    """Braking in a turn, all but the stop; partner: bushings 1 % softer."""
    truth = planar.solved(IN_PLANE, np.arange(0, 4.1, 0.25))

    def found(h: float, exchange: str, run: Manoeuvre = IN_PLANE) -> float:
        return error(drive(fmus, run, h, exchange, 0.25), truth)

    for exchange, order in (("held", 1), ("derivatives", 2), ("rollback", 4)):
        coarse, fine = (found(h, exchange) for h in (0.01, 0.005))
        within(abs(np.log2(coarse / fine) - order), 0.3, f"{exchange}: order of convergence off {order}")
    within(fine, 1e-5, "rollback: error / range")
    beyond(found(0.005, "rollback", IN_PLANE.changed(k_h=0.99 * STEP["k_h"])), 3e-5, "with softer bushings")


@pytest.mark.parametrize("exchange", ["held", "derivatives", "rollback"])
def test_a_run_ends_at_its_stop_whether_or_not_the_step_divides_it(fmus: Fmus, exchange: str):
    times = drive(fmus, STRAIGHT.changed(stop=0.1), 0.007, exchange, 0.014)["time"]
    assert times[-1] == 0.1 and np.all(np.diff(times) > 0)


def test_a_wheel_that_lifts_off_ends_the_run_with_its_own_message(fmus: Fmus):
    with pytest.raises(Ended) as ended:
        drive(fmus, STEP.changed(v=22.0))
    assert ended.value.component in WHEELS and "lifted off" in ended.value.message and 0.5 < ended.value.time < 1.5


def test_the_master_refuses_an_algebraic_loop(fmus: Fmus):
    """The order of exchange rests on declared dependencies: a contact force that follows a force at once."""
    left, right = parts = [Component(name, fmus["wheel"]) for name in ("left", "right")]
    loop = [((one.name, "lambda_1"), (other.name, "F_X")) for one, other in ((left, right), (right, left))]
    with pytest.raises(ValueError, match="cycle"), loaded(*parts):
        Master(parts, loop)
