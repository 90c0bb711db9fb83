"""The values that ./scripts/run takes: parameters, inputs, units, ready wheels; a fault is one sentence."""

import json
import re
import subprocess
import sys
from math import atan, pi
from pathlib import Path

import pytest
from fmpy import simulate_fmu
from support.bounds import EPSILON, within
from support.paths import ROOT, build_folder


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "wheel.fmu").symlink_to(build_folder() / "wheel.fmu")
    return tmp_path


def ask(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools" / "diagrams" / "start_values.py"), *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def given(done: subprocess.CompletedProcess[str]) -> dict[str, str]:
    """Times and start values among the arguments of FMPy."""
    options, _, start = done.stdout.partition("--start-values\n")
    times = {name.replace("-", "_"): value for name, value in re.findall(r"--(\S+)=(\S+)", options)}
    return times | dict(re.findall(r"(\S+)\n(\S+)", start))


def test_values_become_start_values_in_si(root):
    values = given(ask(root, "s=0.01", "theta_start=60deg", "formulation=2", "keep_contact=true", "stop_time=20"))
    within(abs(float(values.pop("theta_start")) - pi / 3), 16 * EPSILON, "theta_start")
    assert values == {
        "s": "0.01",
        "formulation": "2",
        "keep_contact": "true",
        "stop_time": "20",
        "output_interval": "0.01",
    }


UNITS = {"m=12kg": 12, "m=500g": 0.5, "r_0=30cm": 0.3, "slope=8deg": 8 * pi / 180, "slope=12%": atan(0.12)}
UNITS |= {"M_brake=20": 20, "M_3=-2Nm": -2, "F_X=0.3kN": 300, "phi_dot_start=-30rpm": -pi, "output_interval=5ms": 0.005}


@pytest.mark.parametrize(("argument", "value"), UNITS.items())
def test_parameters_and_inputs_take_units(root, argument, value):
    values = given(ask(root, argument))
    within(abs(float(values[argument.partition("=")[0]]) / value - 1), 4 * EPSILON, "the value in SI")


REFUSED = {"theta=1": "theta_start", "speed=3": "phi_dot_start = -v/(r_0 + r)", "slope=-8deg": "slope_direction"}
REFUSED |= {"s": "neither name=value nor a ready wheel", "s=0": "above 0", "m=heavy": "not a number", "m=3m": "kg or g"}
REFUSED |= {"output_interval=20": "too long", "wheel=tank": "There is no wheel", "slope_direction=10%": "rad or deg"}


@pytest.mark.parametrize(("argument", "words"), REFUSED.items())
def test_what_cannot_be_meant_is_refused_with_one_sentence(root, argument, words):
    done = ask(root, argument)
    assert done.returncode == 1 and done.stdout == ""
    assert words in done.stderr and done.stderr.count("\n") == 1


WHEELS = json.loads((ROOT / "examples" / "wheels.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", WHEELS)
def test_a_ready_wheel_has_a_source_is_a_body_that_can_exist_and_rolls(root, name):
    wheel = WHEELS[name]
    assert wheel["title"] and wheel["source"].endswith(".")
    p = {key: float(value) for key, value in given(ask(root, name)).items()}
    assert p == {key: float(value) for key, value in given(ask(root, f"wheel={name}")).items()}
    assert {"m", "r_0", "r", "J_x", "J_y", "J_z"} == {*wheel["parameters"]} < {*p}
    assert max(p["J_x"], p["J_y"], p["J_z"]) <= (p["J_x"] + p["J_y"] + p["J_z"]) / 2 * (1 + 4 * EPSILON)
    assert 0.3 < p["J_z"] / (p["m"] * (p["r_0"] + p["r"]) ** 2) < 1  # all of its mass lies within its radius
    start = {key: value for key, value in p.items() if key not in ("stop_time", "output_interval")}
    end = simulate_fmu(str(root / "wheel.fmu"), start_values=start, stop_time=0.1, output=["E"])
    assert end["time"][-1] == 0.1 and end["E"][-1] < end["E"][0]


def test_a_name_given_beside_a_ready_wheel_prevails(root):
    assert given(ask(root, "coin", "m=1g", "s=2mm"))["m"] == "0.001"


def test_help_lists_every_parameter_input_and_ready_wheel(root, description):
    done = ask(root, "--help")
    names = [v.name for v in description.modelVariables if v.causality in ("parameter", "input")]
    assert done.returncode == 0 and all(f"  {name} " in done.stdout for name in [*names, *WHEELS])
