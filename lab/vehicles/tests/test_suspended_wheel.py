"""Suspended wheel: co-simulation against a closed form; orders, standing start."""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from lab.vehicles import suspended
from lab.vehicles.master import Component, Master, loaded
from lab.vehicles.suspended import ABS, IDEAL, LAUNCH, LOCKED, SUSPENDED
from lab.vehicles.vehicle import Errors, Fmus, Table, upright

STEPS = (0.0025, 0.00125, 0.000625)  # s


@pytest.fixture(scope="module")
def found(fmus: Fmus, truth: Table) -> Errors:
    return suspended.convergence(fmus, truth, STEPS)


@pytest.mark.parametrize(("torque", "check"), [(150.0, within), (151.5, beyond)])
def test_wheel_and_mass_accelerate_together_as_newton_and_euler_say(truth: Table, torque: float, check) -> None:
    late = truth["time"] > 2.5  # s, two seconds after the motor begins to pull
    for body in ("X_O_dot", "X_B_dot"):
        found = np.polyfit(truth["time"][late], truth[body][late], 1)[0]
        check(abs(found / suspended.acceleration(torque) - 1), 1e-4, f"slope of {body}, relative")


def test_the_error_of_held_positions_is_the_drag_of_their_lag(found: Errors) -> None:
    held, lagging = ([*found[kind].values()] for kind in ("held", "positions held"))
    within(np.divide(held, lagging).max(), 0.25, "error of those that follow over that of held positions")
    for factor, check in ((1, within), (2, beyond)):  # of the step, and so of the drag
        predicted = [suspended.drag_share(factor * h) for h in STEPS]
        check(relative_error(lagging, predicted), 0.05, "error of held positions off the drag, relative")


def test_the_coupled_wheel_stands_until_the_drive_pulls(fmus: Fmus) -> None:
    table = SUSPENDED.drive(fmus, LAUNCH.changed(stop=0.6), 0.005, grid=0.05).whole
    standing = table["time"] <= 0.5
    assert np.all(table["omega_z"][standing] == 0)
    beyond(-table["omega_z"][~standing].max(), 0.01, "spin after the drive pulls, rad/s")


@pytest.mark.parametrize("exchange", ["held", "derivatives", "rollback"])
@pytest.mark.parametrize(("h", "grid"), [(0.0002, 0.0017), (0.007, 0.01)])
def test_a_run_ends_at_its_stop_whether_or_not_the_step_divides_it(
    fmus: Fmus, truth: Table, exchange: str, h: float, grid: float
) -> None:
    stop = 0.7
    table = SUSPENDED.drive(fmus, LAUNCH.changed(stop=stop), h, exchange, grid).whole
    assert table["time"][-1] == stop and np.all(np.diff(table["time"]) > 0)
    speed = np.interp(stop, truth["time"], truth["X_O_dot"])
    within(abs(table["X_O_dot"][-1] / speed - 1), 0.05, "speed at the end, relative")


ROLLS = {"wheel": upright(0.0, 0.0, 0.0, 1.0, 0.0, 0.35)}
SKIDS = {**upright(0.0, 0.0, 0.0, 0.0, 0.0, 0.35), "guided": True, "slip_x_start": 20.0, "M_brake": 1e4}
SLIDES = {"wheel": {**SKIDS, "mu_max": 0.1, "mu_slide": 0.1}}
LIMITS = [(ROLLS, 0.031, within), (ROLLS, 0.033, beyond), (SLIDES, 0.0185, within), (SLIDES, 0.0195, beyond)]


@pytest.mark.parametrize(("start", "h", "check"), LIMITS)
def test_a_damper_bounds_the_step_by_the_reduced_mass_of_both_partners(fmus: Fmus, start, h: float, check) -> None:
    """2 m / c = 31.1 ms for 34.7 kg of wheel and 300 kg of body; the wheel's inertia alone would allow 34.7 ms. Of a
    wheel that slides with its spin held, 20 kg count: 18.75 ms."""
    free = {"k_h": 0.0, "k_v": 0.0, "c_v": 0.0, "t_couple": 0.0, "M_drive": 0.0}
    damper = replace(SUSPENDED, starts=lambda _run: start)
    # The damper along X alone is left of what manoeuvres.toml connects.
    vars(damper)["connections"] = [c for c in SUSPENDED.connections if c[0][1] in ("X_O", "X_O_dot", "F_X")]
    table = damper.drive(fmus, LAUNCH.changed(stop=300 * h, **free), h, "held", h).table
    apart = np.abs(table["X_O_dot"] - table["X_B_dot"])[-10:].max()
    check(apart, 1, "relative speed, 1 or 20 m/s at the start")


@pytest.fixture(scope="module")
def stops(fmus: Fmus) -> dict[str, Table]:
    return {run.name: SUSPENDED.drive(fmus, run).whole for run in (ABS, IDEAL, LOCKED)}


@pytest.mark.parametrize(("run", "closed_form"), [(LOCKED, suspended.sliding_way), (IDEAL, suspended.gripping_way)])
def test_a_locked_and_an_ideal_brake_stop_after_the_closed_forms_way(stops, run, closed_form) -> None:
    off = suspended.way(stops[run.name], run) / closed_form(stops[run.name], run) - 1
    within(abs(off), 1e-3, "way off the closed form, relative")
    beyond(abs(1.005 * (off + 1) - 1), 3e-3, "way 0.5 % longer off the closed form, relative")
    assert np.any(stops[run.name]["slip_x"]) == (run is LOCKED)


def test_the_anti_lock_controller_stops_between_both_and_keeps_the_wheel_turning(stops, fmus: Fmus) -> None:
    locked, found = suspended.way(stops["locked"], LOCKED), suspended.way(stops["abs"], ABS)
    within(abs(suspended.sliding_way(stops["abs"], ABS) / locked - 1), 1e-2, "way as if locked off the locked one's")
    assert suspended.shortest(stops["abs"], ABS) < found
    within(found / locked, 0.95, "way over that of the locked wheel")

    def least_turn(table: Table) -> float:
        fast = (table["time"] > 0.5) & (table["X_B_dot"] > 2)
        return float((-0.35 * table["omega_z"][fast] / table["X_B_dot"][fast]).min())

    beyond(least_turn(stops["abs"]), 0.4, "speed of the tread over that of the vehicle")
    assert least_turn(stops["locked"]) == 0
    never = ABS.changed(slip_build=2.0, slip_dump=2.0)  # the controller never acts
    lame = SUSPENDED.drive(fmus, never).whole
    assert suspended.way(lame, never) == locked


def test_the_master_refuses_an_algebraic_loop(fmus: Fmus) -> None:
    """Partner: the order of exchange rests on declared dependencies; F_X -> lambda_1 -> X_O would be a loop."""
    loop = [(("quarter_car", "F_X"), ("wheel", "F_X")), (("wheel", "lambda_1"), ("quarter_car", "X_O"))]
    parts = [Component(name, fmus[name]) for name in ("wheel", "quarter_car")]
    with pytest.raises(ValueError, match="cycle"), loaded(*parts):
        Master(parts, loop)
