"""The start of a vehicle's wheel: the function to copy, and the parameter set that is in every build."""

import runpy
from math import cos, pi, sin
from pathlib import Path

from fmpy.ssp.ssd import read_ssv
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.paths import ROOT

vehicle_start = runpy.run_path(str(ROOT / "examples" / "python" / "vehicle_start.py"))["vehicle_start"]


def test_the_wheel_starts_upright_at_its_place_with_its_speed_along_its_heading(wheel):
    given, there = {"v": 5.0, "heading": 2.0, "x": 3.0, "y": -1.0}, ("X_O", "Y_O", "X_O_dot", "Y_O_dot", "Z_O")
    rolls, wrong = (wheel().start(**vehicle_start(**given, R=R)).get(*there) for R in (0.35, 0.3))
    for found, wanted in zip(rolls, (3.0, -1.0, 5 * cos(2.0), 5 * sin(2.0), 0.35), strict=True):
        within(abs(found - wanted), 16 * EPSILON, "place, m, or velocity, m/s")
    beyond(abs(wrong[2] - 5 * cos(2.0)), 0.1, "velocity with the radius r_0, m/s")


def test_the_parameter_set_of_every_build_is_the_start_at_5_m_per_s(fmu: str):
    file = Path(fmu) / "extra" / "org.fmi-standard.fmi-ls-ref" / "vehicle.ssv"
    values = {parameter.name: float(parameter.value) for parameter in read_ssv(str(file), validate=True).parameters}
    assert values == vehicle_start(5.0) != vehicle_start(5.0, heading=pi / 2)
