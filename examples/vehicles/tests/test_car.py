"""The car: coupled FMUs against one set of equations and against closed forms; orders, lift-off, the C master."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from vehicles import build, car, car_iso, car_judges, car_table
from vehicles.options import Manoeuvre

Fmus = dict[str, Path]


def worst(table: dict[str, np.ndarray], name: str) -> float:
    """Largest difference from one set of equations over the whole manoeuvre, over all that is compared."""
    return max(car_table.apart(table, car_table.read(name)).values())


@pytest.mark.parametrize("name", ["circle", "step", "eight", "lane"])
def test_the_coupled_car_moves_as_one_set_of_equations(fmus: Fmus, name: str) -> None:
    """Over the full length: up to 25 s, 125 m."""
    table, truth = car.drive(fmus, car.MANOEUVRES[name], 0.002, "rollback", 0.25).table, car_table.read(name)
    assert len(table["time"]) == len(truth["time"])
    within(worst(table, name), 1e-5, "motion apart / range")
    for w in car.WHEELS:
        within(np.abs(table[f"{w}.lambda_3"] - truth[f"{w}.lambda_3"]).max(), 0.02, "normal force apart, N")
    softer = {f"k_{w}": 0.99 * float(wheel["k"]) for w, wheel in car.WHEELS.items()}
    off = worst(car.drive(fmus, car.MANOEUVRES[name].changed(**softer), 0.002, "rollback", 0.25).table, name)
    beyond(off, 1e-3, "motion apart / range, springs 1 % softer")


def test_launch_brake_and_stop_are_those_of_one_set_of_equations(fmus: Fmus) -> None:
    """Friction holds the wheels at first, the brakes stop them: events in four FMUs and in one solver."""
    table = car.drive(fmus, car.STRAIGHT, 0.001, "rollback", 0.25).table
    within(worst(table, "straight"), 1e-4, "motion apart / range")  # the stop is inside a step
    assert all(table[f"{w}.omega_z"][-1] == 0 for w in car.WHEELS)
    beyond(
        worst(car.drive(fmus, car.STRAIGHT.changed(B_0=0.0), grid=0.25).table, "straight"),
        0.1,
        "motion apart / range, without brakes",
    )


def test_hill_start_stop_and_parking_are_those_of_one_set_of_equations(fmus: Fmus) -> None:
    """Over its full length, by three masters: brakes that hold, let go, stop and hold again inside steps."""
    for exchange, bound in {"held": 0.01, "derivatives": 3e-4, "rollback": 1e-4}.items():
        table = car.drive(fmus, car.HILL, 0.001, exchange, 0.25).table
        within(worst(table, "hill"), bound, f"{exchange}: motion apart / range")
    level = car.drive(fmus, car.HILL.changed(slope=0.0), 0.001, "rollback", 0.25).table
    beyond(worst(level, "hill"), 0.1, "motion apart / range, on the level")


def test_the_car_stands_starts_and_parks_on_the_hill_without_rolling_back(fmus: Fmus) -> None:
    table = car.drive(fmus, car.HILL).table
    before = table["time"] < car.HILL["t_on"]
    assert all((table[f"{w}.omega_z"][before] == 0).all() for w in car.WHEELS)
    start = table["time"] < car.HILL["t_brake"]
    assert car.rolled_back({name: values[start] for name, values in table.items()}) == 0
    within(car.rolled_back(table), car.ROLL_BACK, "rolls back, m")
    assert all((table[f"{w}.omega_z"][table["time"] > 8] == 0).all() for w in car.WHEELS)
    for finding in car_judges.standing(table, car.HILL):
        within(finding.error, 0.01 if finding.what.startswith("load") else 1e-3, f"{finding.what}, relative")
    weak = car.HILL.changed(B_hold=400.0)  # partner: below m g R sin(slope), 652 N m
    back = car.drive(fmus, weak).table
    beyond(car.rolled_back(back), 0.1, "rolls back with weak brakes, m")
    assert "rolls back" in car.verdict(back, weak)[1][0]


@pytest.mark.parametrize(
    ("name", "stop"), [("hill", 1.5), ("straight", 1.5), ("circle", 1.5), ("step", 1.5), ("eight", 1.5), ("lane", 2.5)]
)
def test_the_tables_of_one_set_of_equations_are_what_it_gives(name: str, stop: float) -> None:
    """Their begin, integrated again with a looser tolerance, which makes the difference."""
    again = car_table.integrate(car.MANOEUVRES[name], stop, 1e-7)
    for column, values in car_table.read(name).items():
        part, span = values[: len(again["time"])], max(float(np.ptp(values)), 0.01)
        within(np.abs(again[column] - part).max() / span, 1e-5, "apart / range")


@pytest.mark.parametrize(("exchange", "order"), [("held", 1), ("derivatives", 2), ("rollback", 4)])
def test_the_orders_of_the_masters(fmus: Fmus, exchange: str, order: int) -> None:
    coarse, fine = (worst(car.drive(fmus, car.LANE, h, exchange, 0.25).table, "lane") for h in (0.002, 0.001))
    within(abs(np.log2(coarse / fine) - order), 0.3, "off the order")


def test_one_set_of_equations_lifts_off_where_the_coupled_car_does(fmus: Fmus) -> None:
    wheel, time = car_table.lift_off(car.TOO_FAST)
    ending = car.drive(fmus, car.TOO_FAST, 0.001, "rollback").ending
    assert (ending.component, f"{ending.time:.6f}") == (wheel, f"{time:.6f}")


def stiffer(manoeuvre: Manoeuvre, factor: float) -> Manoeuvre:
    """All bushings stiffer and harder damped."""
    links = {n: factor * car.LAYOUT["chassis"][n] for n in ("k_h", "c_h", "k_a", "c_a")}
    return manoeuvre.changed(**links, inner_step=0.001 / factor)


QUICK_CIRCLE = car.CIRCLE.changed(stop=9.0, ramp_v=3.0)
LAUNCH = car.STRAIGHT.changed(stop=3.5, B_0=0.0)


@pytest.mark.parametrize(("manoeuvre", "judge"), [(QUICK_CIRCLE, car_judges.bend), (LAUNCH, car_judges.launch)])
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(
    fmus: Fmus, manoeuvre: Manoeuvre, judge: object
) -> None:
    soft, stiff = (judge(car.drive(fmus, stiffer(manoeuvre, f), 0.0005).table, manoeuvre) for f in (1.0, 3.0))
    for finding, nearer in zip(soft, stiff, strict=True):
        within(finding.error, 0.04, "error, relative")
        within(nearer.error / max(0.45 * finding.error, 4e-4), 1, "error of stiff links over what 1/k allows")


def test_the_gains_of_a_step_are_those_of_rigid_links_up_to_the_compliance(fmus: Fmus) -> None:
    def gains(factor: float) -> list[car_judges.Finding]:
        table = car.drive(fmus, stiffer(car.STEP, factor), 0.0005).table
        return [finding for finding in car_iso.step(table) if finding.exact]

    off, nearer = ([finding.error for finding in gains(factor)] for factor in (1.0, 3.0))
    assert len(off) == 3
    within(max(off), 0.04, "error, relative")
    for a, b in zip(off, nearer, strict=True):  # as 1 / k; roll squared does not
        within(b / max(0.45 * a, 1e-3), 1, "error of stiff links over what 1/k allows")


def test_the_stopping_distance_is_that_of_the_closed_form(fmus: Fmus) -> None:
    for finding in car_judges.braking(car.drive(fmus, car.STRAIGHT).table, car.STRAIGHT):
        within(finding.error, 0.05 if finding.what.startswith("load") else 0.02, f"{finding.what}, relative")


def test_wheels_that_never_slip_do_not_understeer(fmus: Fmus) -> None:
    table = car.drive(fmus, car.CIRCLE.changed(stop=12.0, ramp_v=7.0), 0.002).table
    within(abs(car_judges.understeer(table)), 3e-5, "understeer gradient, rad s2/m")  # a road car: 2e-3 to 5e-3


def test_the_figure_of_eight_closes(fmus: Fmus) -> None:
    for eight, check in ((car.EIGHT, within), (car.EIGHT.changed(k_y=0.0, k_psi=0.0), beyond)):  # after 105 m
        (gap,) = car_judges.closure(car.drive(fmus, eight, 0.002).table, eight)
        check(gap.measured, 0.02, "gap, m")


def test_the_double_lane_change_ends_in_its_lane(fmus: Fmus) -> None:
    table = car.drive(fmus, car.LANE, 0.002).table
    beyond(table["Y_R"].max(), 2.5, "to the left, m")
    within(abs(table["Y_R"][-1]), 0.01, "off the lane at the end, m")
    within(np.abs(table["off"]).max(), 0.05, "off the path, m")


def test_too_fast_a_step_ends_with_the_wheel_that_lifts_off_and_when(fmus: Fmus) -> None:
    said = car.sentence(car.drive(fmus, car.TOO_FAST).ending)
    assert "wheel ended the run at t = 0." in said
    assert "lifted off the ground" in said
    assert said.split(" wheel")[0] in [f"The {w['name']}" for w in car.WHEELS.values()]
    assert not car.drive(fmus, car.TOO_FAST.changed(v=10.0, stop=1.2), 0.001).ending  # partner


@pytest.mark.parametrize(
    ("name", "changed", "said"),
    [
        ("lane", {"stop": 3.0}, "the run ends after"),
        ("lane", {"k_y": 0.0, "k_psi": 0.0, "T_delta": 0.6}, "leaves its path"),
        ("straight", {"stop": 5.0}, "the car does not stand at the end"),
        ("straight", {"M_0": 10.0}, "the car does not set off"),
        ("hill", {"stop": 1.0}, "the run ends at 1 s, before t_on + ramp_M"),
        ("hill", {"slope": 0.3}, "rolls back"),
        ("too_fast", {"v": 10.0}, "no wheel lifts off"),
        ("step", {"v": 16.0, "delta_0": 0.08}, "friction coefficient of 1."),
        ("lane", {}, ""),
        ("hill", {"slope": np.arctan(0.2)}, ""),
    ],
)
def test_a_verdict_looks_at_the_run_that_it_judges(fmus: Fmus, name: str, changed: dict, said: str) -> None:
    manoeuvre = car.MANOEUVRES[name].changed(**changed)
    passed, (first, *_) = car.verdict(car.drive(fmus, manoeuvre, 0.002).table, manoeuvre)
    assert passed == (not said) == first.startswith("Possible: it needs a road with a friction coefficient of 0.")
    assert said in first


def test_the_friction_required_is_that_of_an_axle_not_of_its_unloaded_wheel(fmus: Fmus) -> None:
    """A lateral acceleration a needs about a / g; partner: the wheel inside the bend."""
    table = car.drive(fmus, car.STEP.changed(v=60 / 3.6, delta_0=np.radians(3)), 0.002).table
    least = float(np.abs(table["a_y"]).max()) / car.G
    within(abs(max(car.demand(table).values()) / least - 1), 0.1, "friction over a / g, off 1")
    beyond(max(np.nanmax(table[f"{w}.mu_required"]) for w in car.WHEELS) / least, 2, "of one wheel over a / g")


def test_a_fifth_wheel_is_a_change_of_one_file(tmp_path: Path) -> None:
    copy = tmp_path / "examples" / "vehicles"
    for folder in ("examples/vehicles", "examples/python", "cmake"):
        shutil.copytree(build.ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    fifth = """
[wheel.spare]
name = "fifth"
x = -1.4
y = 0.0
k = 26e3
c = 2800.0
steer = 0
drive = 0.2
brake = 0.1
k_bar = 0.0
"""
    with (copy / "car" / "car.toml").open("a") as layout:
        layout.write(fifth)
    code = (
        "from pathlib import Path\n"
        "from vehicles import build, car\n"
        f"fmus = build.build_c(Path({str(tmp_path / 'build')!r}))\n"
        f"fmus['wheel'] = Path({str(build.wheel_fmu().resolve())!r})\n"
        "table = car.drive(fmus, car.LANE.changed(stop=1.0)).table\n"
        "N = [table[f'{w}.lambda_3'][0] for w in car.WHEELS]\n"
        "print(len(N), sum(N) / (car.MASS * car.G))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    wheels, share = done.stdout.split()
    assert int(wheels) == 5
    within(abs(float(share) - 1), 32 * EPSILON, "share of the weight off 1")
