"""The packages of the C++ examples, built by the recipe of their page, run by FMPy from their own start at their own
step. SI units.
"""

import runpy
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp import simulation
from fmpy.ssp.ssd import read_ssd, read_ssv
from support.bounds import beyond, within

from wheelfmu.fmu.paths import ROOT

VEHICLES = ROOT / "examples" / "vehicles"
SYSTEMS = {"car": "car/car.toml", "quarter_car": "quarter_car/quarter_car.toml"}
OUT_AND_BACK = (47.5, 3 * np.tanh(1.75)), (104.0, 0.0)  # X and Y of the path


def run(package: Path, halves: int = 1, **how: object) -> np.ndarray:
    """The rows of FMPy's run, whose times are those before each step."""
    system = tomllib.loads((VEHICLES / SYSTEMS[package.stem]).read_text(encoding="utf-8"))
    h, start = system["step"] / halves, read_ssv(str(package), "resources/start.ssv")
    rows = simulation.simulate_ssp(
        str(package), **{"step_size": h, "stop_time": system["stop"] - h / 2, "parameter_set": start} | how
    )
    return rows[halves - 1 :: halves]


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_package_is_valid_and_binds_the_start_values_of_its_system_at_the_components(vehicles: Path, name: str):
    package, system = (
        vehicles / f"{name}.ssp",
        runpy.run_path(str(VEHICLES / "package.py"))["read"](VEHICLES / SYSTEMS[name]),
    )
    structure = read_ssd(str(package), validate=True)
    assert len(structure.system.connections) == len(system["connections"]) and not structure.system.parameterBindings
    every = {}
    for component in structure.system.elements:
        (binding,) = component.parameterBindings
        values = {p.name: p.value for p in read_ssv(str(package), binding.source, validate=True).parameters}
        assert values.keys() == system["start"][component.name].keys()
        every |= {f"{component.name}.{of}": value for of, value in values.items()}
    assert {p.name: p.value for p in read_ssv(str(package), "resources/start.ssv").parameters} == every


def test_the_cars_package_changes_lanes_in_fmpy_from_its_own_start_at_its_own_step(vehicles: Path):
    """All wheels on the road, loaded after the first step, the rear point on its path, and an error of order 1;
    partner: a driver without a path."""
    runs = [run(vehicles / "car.ssp", halves) for halves in (1, 2, 4)]
    assert all(min(rows[f"{wheel}.lambda_3"][1:].min() for wheel in ("fl", "fr", "rl", "rr")) > 2000 for rows in runs)
    for X, Y in OUT_AND_BACK:
        within(abs(np.interp(X, runs[0]["chassis.X_R"], runs[0]["chassis.Y_R"]) - Y), 0.02, "off the lane, m")
    coarse, fine = (np.abs(rows["chassis.Y"] - runs[2]["chassis.Y"]).max() for rows in runs[:2])
    within(coarse, 0.05, "off a run with a quarter of the step, m")
    within(fine / coarse, 0.6, "error at half the step, over that at the step")
    start = read_ssv(str(vehicles / "car.ssp"), "resources/start.ssv")
    start.parameters = [p for p in start.parameters if p.name != "driver.path"]
    straight = run(vehicles / "car.ssp", parameter_set=start)
    beyond(abs(np.interp(47.5, straight["chassis.X_R"], straight["chassis.Y_R"]) - 3), 2, "the same on no path, m")


def test_the_quarter_cars_package_accelerates_in_fmpy_as_newton_and_euler_say(vehicles: Path):
    m, m_t = 320.0, 320.0 + 1.8 / 0.35**2
    rows = run(vehicles / "quarter_car.ssp")
    late = rows["time"] > 2.5
    found = np.polyfit(rows["time"][late], rows["quarter_car.X_B_dot"][late], 1)[0]
    for torque, check in ((150.0, within), (151.5, beyond)):
        check(abs(found / ((torque - 0.01 * m * 9.81) / 0.35 / m_t) - 1), 5e-3, "acceleration, relative")
    within(abs(rows["quarter_car.Z_B"] - 0.70285).max(), 1e-9, "height of the mass, which starts at rest, m")


def test_a_package_without_its_start_values_is_another_system(vehicles: Path):
    rows = run(vehicles / "quarter_car.ssp", parameter_set=None, stop_time=0.3)
    beyond(abs(rows["wheel.theta"] - np.pi / 2).max(), 0.1, "off upright, rad")


@pytest.fixture(autouse=True)
def in_its_own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """FMPy unpacks where it runs."""
    monkeypatch.chdir(tmp_path)
    yield
