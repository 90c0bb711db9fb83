"""The car: coupled FMUs against one set of equations and against closed forms; orders, lift-off, the C master."""

import os
import shutil
import subprocess
import sys
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, relative_error, within
from support.paths import ROOT
from vehicles import car, car_judges, errors, layout, monolithic_car
from vehicles.layout import CIRCLE, HILL, LANE, LAYOUT, MANOEUVRES, STEP, STRAIGHT, TOO_FAST, WHEELS
from vehicles.options import EXCHANGES, Manoeuvre
from vehicles.vehicle import Fmus, Table

from reports.page import read_tables


def drive(fmus: Fmus, *how: object) -> Table:
    """The coupled car: manoeuvre, step, exchange, grid."""
    return car.CAR.drive(fmus, *how).table


def worst(table: Table, name: str) -> float:
    """Largest difference from one set of equations over the whole manoeuvre, over all that is compared."""
    return car.CAR.distance(table, monolithic_car.read(name))


def error(finding: car_judges.Finding) -> float:
    return relative_error(finding.measured, finding.exact)


def test_the_report_has_every_manoeuvre_with_every_master() -> None:
    table = read_tables("vehicles")["car_errors"]
    found = set(table[["manoeuvre", "inputs over the step", "step [ms]"]].itertuples(index=False, name=None))
    assert found == set(product(monolithic_car.NAMES, EXCHANGES, [1000 * h for h in errors.STEPS]))


SOFTER = {f"k_{w}": 0.99 * float(wheel["k"]) for w, wheel in WHEELS.items()}  # springs, by 1 %


@pytest.mark.parametrize(
    ("name", "exchange", "bound", "changed", "broken"),
    [
        *((name, "rollback", 1e-5, SOFTER, 1e-3) for name in ("circle", "step", "eight", "lane")),
        ("straight", "rollback", 1e-4, {"B_0": 0.0}, 0.1),
        *(("hill", e, bound, {"slope": 0.0}, 0.1) for e, bound in zip(EXCHANGES, (0.01, 3e-4, 1e-4), strict=True)),
    ],
)
def test_the_coupled_car_moves_as_one_set_of_equations(
    fmus: Fmus, name: str, exchange: str, bound: float, changed: dict, broken: float
) -> None:
    """Over the full length: up to 25 s, 125 m. Friction and brakes hold wheels, let go and stop them inside steps:
    events in four FMUs and in one solver."""
    step, truth = 0.001 if changed is not SOFTER else 0.002, monolithic_car.read(name)
    table = drive(fmus, MANOEUVRES[name], step, exchange, 0.25)
    assert len(table["time"]) == len(truth["time"])
    within(worst(table, name), bound, f"{exchange}: motion apart / range")
    for w in WHEELS if changed is SOFTER else ():
        within(np.abs(table[f"{w}.lambda_3"] - truth[f"{w}.lambda_3"]).max(), 0.02, "normal force apart, N")
    off = worst(drive(fmus, MANOEUVRES[name].changed(**changed), step, exchange, 0.25), name)
    beyond(off, broken, "motion apart / range, of another car")


def test_the_car_stands_starts_and_parks_on_the_hill_without_rolling_back(fmus: Fmus) -> None:
    table = drive(fmus, HILL)
    held = (table["time"] < HILL["t_on"]) | (table["time"] > 8)
    assert not any(table[f"{w}.omega_z"][held].any() for w in WHEELS)
    start = table["time"] < HILL["t_brake"]
    assert car.rolled_back({name: values[start] for name, values in table.items()}) == 0
    within(car.rolled_back(table), car.LIMITS["roll_back"], "rolls back, m")
    for finding in car_judges.standing(table, HILL):
        within(error(finding), 0.01 if finding.what.startswith("load") else 1e-3, f"{finding.what}, relative")
    weak = HILL.changed(B_hold=400.0)  # partner: below m g R sin(slope), 652 N m
    beyond(car.rolled_back(drive(fmus, weak)), 0.1, "rolls back with weak brakes, m")


@pytest.mark.parametrize(("name", "stop"), [(name, 2.5 if name == "lane" else 1.5) for name in monolithic_car.NAMES])
def test_the_tables_of_one_set_of_equations_are_what_it_gives(name: str, stop: float) -> None:
    """Their begin, integrated again with a looser tolerance, which makes the difference."""
    again = monolithic_car.solve(MANOEUVRES[name], monolithic_car.GRID, 1e-7, stop)
    for column, values in monolithic_car.read(name).items():
        part, span = values[: len(again["time"])], max(float(np.ptp(values)), 0.01)
        within(np.abs(again[column] - part).max() / span, 1e-5, "apart / range")


@pytest.mark.parametrize(("exchange", "order"), [("held", 1), ("derivatives", 2), ("rollback", 4)])
def test_the_orders_of_the_masters(fmus: Fmus, exchange: str, order: int) -> None:
    coarse, fine = (worst(drive(fmus, LANE, h, exchange, 0.25), "lane") for h in (0.002, 0.001))
    within(abs(np.log2(coarse / fine) - order), 0.3, "off the order")


def test_one_set_of_equations_lifts_off_where_the_coupled_car_does(fmus: Fmus) -> None:
    wheel, time = monolithic_car.lift_off(TOO_FAST)
    ending = car.CAR.drive(fmus, TOO_FAST, 0.001, "rollback").ending
    assert (ending.component, f"{ending.time:.6f}") == (wheel, f"{time:.6f}")


def stiffer(manoeuvre: Manoeuvre, factor: float) -> Manoeuvre:
    """All bushings stiffer and harder damped."""
    links = {n: factor * LAYOUT["chassis"][n] for n in ("k_h", "c_h", "k_a", "c_a")}
    return manoeuvre.changed(**links, inner_step=0.001 / factor)


QUICK_CIRCLE = CIRCLE.changed(stop=9.0, ramp_v=3.0)
LAUNCH = STRAIGHT.changed(stop=3.5, B_0=0.0)


@pytest.mark.parametrize(
    ("manoeuvre", "judge", "count", "rest"),
    [(QUICK_CIRCLE, "bend", 3, 4e-4), (LAUNCH, "launch", 2, 4e-4), (STEP, "step", 3, 1e-3)],
)
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(
    fmus: Fmus, manoeuvre: Manoeuvre, judge: str, count: int, rest: float
) -> None:
    """rest: roll squared, as after a step, does not fall as 1 / k."""
    tables = (drive(fmus, stiffer(manoeuvre, k), 0.0005) for k in (1.0, 3.0))
    soft, stiff = ([f for f in car_judges.JUDGES[judge](table, manoeuvre) if f.exact] for table in tables)
    assert len(soft) == count
    for finding, nearer in zip(soft, stiff, strict=True):
        within(error(finding), 0.04, "error, relative")
        within(error(nearer) / max(0.45 * error(finding), rest), 1, "error of stiff links over what 1/k allows")


def test_the_stopping_distance_is_that_of_the_closed_form(fmus: Fmus) -> None:
    for finding in car_judges.braking(drive(fmus, STRAIGHT), STRAIGHT):
        within(error(finding), 0.05 if finding.what.startswith("load") else 0.02, f"{finding.what}, relative")


def test_wheels_that_never_slip_do_not_understeer(fmus: Fmus) -> None:
    found = {f.what: f for f in car_judges.circle(drive(fmus, CIRCLE.changed(stop=12.0, ramp_v=7.0), 0.002), CIRCLE)}
    within(abs(found["understeer gradient"].measured), 3e-5, "rad s2/m")  # a road car: 2e-3 to 5e-3


def test_the_figure_of_eight_closes(fmus: Fmus) -> None:
    for eight, check in ((layout.EIGHT, within), (layout.EIGHT.changed(k_y=0.0, k_psi=0.0), beyond)):  # after 105 m
        (gap,) = car_judges.closure(drive(fmus, eight, 0.002), eight)
        check(gap.measured, 0.02, "gap, m")


def test_the_double_lane_change_ends_in_its_lane(fmus: Fmus) -> None:
    table = drive(fmus, LANE, 0.002)
    beyond(table["Y_R"].max(), 2.5, "to the left, m")
    within(abs(table["Y_R"][-1]), 0.01, "off the lane at the end, m")
    within(np.abs(table["off"]).max(), 0.05, "off the path, m")


def test_a_step_of_the_steering_overshoots_and_needs_the_friction_of_an_axle_not_of_a_wheel(fmus: Fmus) -> None:
    """A lateral acceleration a needs about a / g; partner: the wheel inside the bend."""
    table = drive(fmus, STEP.changed(v=60 / 3.6, delta_0=np.radians(3)), 0.002)
    found = {finding.what: finding.measured for finding in car_judges.step(table, STEP)}
    beyond(found["overshoot of the lateral acceleration"], 0.01, "overshoot")
    least = float(np.abs(table["a_y"]).max()) / layout.G
    within(abs(max(car_judges.demand(table).values()) / least - 1), 0.1, "friction over a / g, off 1")
    beyond(max(np.nanmax(table[f"{w}.mu_required"]) for w in WHEELS) / least, 2, "of one wheel over a / g")


OF_FIVE_WHEELS = """
import sys
from vehicles import build, car, layout
fmus = build.build_c(build.Path(sys.argv[1])) | {"wheel": build.Path(sys.argv[2])}
table = car.CAR.drive(fmus, layout.LANE.changed(stop=1.0)).table
print(*(table[f"{w}.lambda_3"][0] / (layout.MASS * layout.G) for w in layout.WHEELS))
"""


def test_a_fifth_wheel_is_a_change_of_one_file(fmus: Fmus, tmp_path: Path) -> None:
    without = shutil.ignore_patterns("__pycache__", "axle.csv", "quarter_car.csv")  # FMUs that are not built again
    for folder in ("examples/vehicles", "examples/python", "cmake"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=without)
    fifth = WHEELS["rr"] | {"name": "fifth", "y": 0.0}
    with (tmp_path / "examples" / "vehicles" / "car" / "car.toml").open("a") as file:
        file.write("\n".join(["[wheel.spare]", *(f"{n} = {x!r}" for n, x in fifth.items())]))
    command = [sys.executable, "-c", OF_FIVE_WHEELS, tmp_path / "build", fmus["wheel"].resolve()]
    how = {"cwd": tmp_path / "examples" / "vehicles", "env": os.environ | {"PYTHONPATH": str(ROOT / "tests")}}
    done = subprocess.run(command, **how, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    shares = [float(share) for share in done.stdout.split()]
    assert len(shares) == 5
    within(abs(sum(shares) - 1), 32 * EPSILON, "shares of the weight off 1")
