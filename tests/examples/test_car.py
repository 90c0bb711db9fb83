"""The car: coupled FMUs against one set of equations and against closed forms; orders, lift-off, the C master."""

from __future__ import annotations

import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from vehicles import build, car, car_judges, monolithic_car
from vehicles.master import EXCHANGES

Fmus = dict[str, Path]
GRID = 0.05  # s


def apart(table: dict[str, np.ndarray], truth: dict[str, np.ndarray]) -> float:
    """Largest difference of the chassis' motion over time, each relative to its range, at least 1 % of the unit."""
    ranges = {n: max(float(np.ptp(truth[n])), 0.01) for n in car.COMPARED}
    return max(float(np.abs(table[n] - truth[n]).max()) / ranges[n] for n in car.COMPARED)


def whole(manoeuvre: car.Manoeuvre, stop: float) -> tuple[car.Manoeuvre, dict[str, np.ndarray]]:
    """The manoeuvre up to `stop`, and the same as one set of equations."""
    cut = replace(manoeuvre, stop=stop)
    return cut, monolithic_car.solve(cut, np.arange(round(stop / GRID) + 1) * GRID, 1e-8)


@pytest.fixture(scope="module")
def step() -> tuple[car.Manoeuvre, dict[str, np.ndarray]]:
    return whole(car.STEP, 2.0)


@pytest.mark.parametrize(("name", "stop"), [("lane", 3.5), ("eight", 4.0), ("circle", 4.0)])
def test_the_coupled_car_moves_as_one_set_of_equations(fmus: Fmus, name: str, stop: float) -> None:
    manoeuvre, truth = whole(car.MANOEUVRES[name], stop)
    run = car.drive(fmus, manoeuvre, 0.002, "rollback", GRID)
    assert apart(run.table, truth) < 3e-5  # measured below 1e-5
    for w in car.WHEELS:
        assert np.abs(run.table[f"{w}.lambda_3"] - truth[f"{w}.lambda_3"]).max() < 0.1  # N; measured 3e-3


def test_launch_brake_and_stop_are_those_of_one_set_of_equations(fmus: Fmus) -> None:
    """Friction holds the wheels at first, the brakes stop them: events in four FMUs and in one solver."""
    short = {"t_off": 1.5, "t_brake": 1.8}
    manoeuvre, truth = whole(replace(car.STRAIGHT, driver={**car.STRAIGHT.driver, **short}), 4.0)
    run = car.drive(fmus, manoeuvre, 0.001, "derivatives", GRID)
    assert apart(run.table, truth) < 2e-3
    assert all(run.table[f"{w}.omega_z"][-1] == 0 for w in car.WHEELS)
    unbraked = replace(manoeuvre, driver={**manoeuvre.driver, "B_0": 0.0})
    free = car.drive(fmus, unbraked, 0.001, "derivatives", GRID)
    assert apart(free.table, truth) > 0.1  # partner: it is the brakes that stop it


def test_a_wrong_parameter_of_one_set_of_equations_shows(
    step: tuple[car.Manoeuvre, dict[str, np.ndarray]],
) -> None:
    """Partner of the check: one per cent of one spring is far beyond its bound."""
    manoeuvre, truth = step
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(car.WHEELS["fl"], "k", 1.01 * car.WHEELS["fl"]["k"])
        other = monolithic_car.solve(manoeuvre, truth["time"], 1e-8)
    assert apart(other, truth) > 1e-4


@pytest.mark.parametrize(("exchange", "order", "within"), [("held", 1, 0.15), ("derivatives", 2, 0.2)])
def test_the_orders_of_the_masters(
    fmus: Fmus, step: tuple[car.Manoeuvre, dict[str, np.ndarray]], exchange: str, order: int, within: float
) -> None:
    manoeuvre, truth = step
    coarse, fine = (apart(car.drive(fmus, manoeuvre, h, exchange, GRID).table, truth) for h in (0.002, 0.001))
    assert np.log2(coarse / fine) == pytest.approx(order, abs=within)


def test_rollback_beats_first_derivatives(fmus: Fmus, step: tuple[car.Manoeuvre, dict[str, np.ndarray]]) -> None:
    manoeuvre, truth = step
    lines, again = (
        apart(car.drive(fmus, manoeuvre, 0.002, exchange, GRID).table, truth)
        for exchange in ("derivatives", "rollback")
    )
    assert again < lines / 100


def stiffer(manoeuvre: car.Manoeuvre, factor: float) -> car.Manoeuvre:
    """All bushings stiffer and harder damped."""
    links = {n: factor * car.LAYOUT["chassis"][n] for n in ("k_h", "c_h", "k_a", "c_a")}
    return replace(manoeuvre, chassis={**manoeuvre.chassis, **links, "inner_step": 0.001 / factor})


QUICK_CIRCLE = replace(car.CIRCLE, stop=9.0, driver={**car.CIRCLE.driver, "ramp_v": 3.0})
LAUNCH = replace(car.STRAIGHT, stop=3.5, driver={**car.STRAIGHT.driver, "B_0": 0.0})


@pytest.mark.parametrize(("manoeuvre", "judge"), [(QUICK_CIRCLE, car_judges.bend), (LAUNCH, car_judges.launch)])
def test_closed_forms_hold_up_to_the_compliance_of_the_bushings(
    fmus: Fmus, manoeuvre: car.Manoeuvre, judge: object
) -> None:
    soft, stiff = (judge(car.drive(fmus, stiffer(manoeuvre, f), 0.0005).table, manoeuvre) for f in (1.0, 3.0))
    for finding, nearer in zip(soft, stiff, strict=True):
        assert finding.error < 0.04, finding  # measured at most 0.032
        assert nearer.error < max(0.45 * finding.error, 4e-4), nearer  # as 1 / k, but for roll squared


def test_the_stopping_distance_is_that_of_the_closed_form(fmus: Fmus) -> None:
    for finding in car_judges.braking(car.drive(fmus, car.STRAIGHT).table, car.STRAIGHT):
        assert finding.error < 0.05, finding


def test_wheels_that_never_slip_do_not_understeer(fmus: Fmus) -> None:
    table = car.drive(fmus, replace(car.CIRCLE, stop=12.0, driver={**car.CIRCLE.driver, "ramp_v": 7.0}), 0.002).table
    assert abs(car_judges.understeer(table)) < 3e-5  # rad s2/m; a road car has 2e-3 to 5e-3; measured 1e-5


def test_the_figure_of_eight_closes(fmus: Fmus) -> None:
    gap = car_judges.closure(car.drive(fmus, car.EIGHT, 0.002).table)
    assert gap.measured < 0.02  # m, after 105 m; measured 0.010
    open_loop = replace(car.EIGHT, driver={**car.EIGHT.driver, "k_y": 0.0, "k_psi": 0.0})
    assert car_judges.closure(car.drive(fmus, open_loop, 0.002).table).measured > 0.02  # partner


def test_the_double_lane_change_ends_in_its_lane(fmus: Fmus) -> None:
    table = car.drive(fmus, car.LANE, 0.002).table
    assert table["Y_R"].max() > 2.5  # m
    assert abs(table["Y_R"][-1]) < 0.01
    assert np.abs(table["off"]).max() < 0.05


def test_too_fast_a_step_ends_with_the_wheel_that_lifts_off_and_when(fmus: Fmus) -> None:
    run = car.drive(fmus, car.TOO_FAST, 0.001)
    assert "wheel ended the run at t = 0." in run.ending
    assert "lifted off the ground" in run.ending
    assert run.ending.split(" wheel")[0] in [f"The {w['name']}" for w in car.WHEELS.values()]
    assert car.drive(fmus, replace(car.TOO_FAST, v=10.0, stop=1.2), 0.001).ending == ""  # partner


@pytest.mark.parametrize("exchange", EXCHANGES)
def test_the_c_master_gets_the_same_bits(fmus: Fmus, exchange: str) -> None:
    manoeuvre = replace(car.LANE, stop=0.3)
    run, answer = car.drive_in_c(fmus, manoeuvre, 0.001, exchange, GRID)
    slow = car.drive(fmus, manoeuvre, 0.001, exchange, GRID)
    assert {name: values.tobytes() for name, values in run.table.items()} == {
        name: values.tobytes() for name, values in slow.table.items()
    }
    assert answer.total > sum(answer.steps.values()) / 2 > 0


def test_a_fifth_wheel_is_a_change_of_one_file(tmp_path: Path) -> None:
    copy = tmp_path / "examples"
    shutil.copytree(build.EXAMPLES, copy, ignore=shutil.ignore_patterns("__pycache__"))
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
        "import sys; from dataclasses import replace; from pathlib import Path\n"
        "from vehicles import build, car\n"
        f"fmus = build.build_c(Path({str(tmp_path / 'build')!r}))\n"
        f"fmus['wheel'] = Path({str(build.wheel_fmu().resolve())!r})\n"
        "table = car.drive(fmus, replace(car.LANE, stop=1.0)).table\n"
        "N = [table[f'{w}.lambda_3'][0] for w in car.WHEELS]\n"
        "print(len(N), sum(N) / (car.MASS * car.G))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=copy, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    wheels, share = done.stdout.split()
    assert int(wheels) == 5
    assert float(share) == pytest.approx(1, abs=1e-9)
