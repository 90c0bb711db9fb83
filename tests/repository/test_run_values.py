"""The values that ./scripts/run takes: names are checked, degrees become radians, a fault is one sentence."""

import subprocess
import sys
from math import pi
from pathlib import Path

import pytest
from support.bounds import EPSILON, within
from support.paths import ROOT, build_folder


@pytest.fixture
def root(tmp_path: Path) -> Path:
    (tmp_path / "wheel.fmu").symlink_to(build_folder() / "wheel.fmu")
    return tmp_path


def ask(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools" / "diagrams" / "start_values.py"), *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_values_become_start_values_in_si(root):
    done = ask(root, "s=0.01", "theta_start=60deg", "formulation=2", "keep_contact=true", "stop_time=20")
    values = dict(line.split() for line in done.stdout.splitlines())
    within(abs(float(values.pop("theta_start")) - pi / 3), 16 * EPSILON, "theta_start")
    assert values == {"s": "0.01", "formulation": "2", "keep_contact": "true", "stop_time": "20"}


REFUSED = {"theta=1": 'no parameter "theta"', "M_brake=1": 'no parameter "M_brake"'}
REFUSED |= {"s": "not of the form name=value", "s=0": "above 0", "m=heavy": "not a number"}


@pytest.mark.parametrize(("argument", "words"), REFUSED.items())
def test_what_cannot_be_meant_is_refused_with_one_sentence(root, argument, words):
    done = ask(root, argument)
    assert done.returncode == 1 and done.stdout == ""
    assert words in done.stderr and done.stderr.count("\n") == 1


def test_help_lists_every_parameter(root, description):
    done = ask(root, "--help")
    parameters = [v for v in description.modelVariables if v.causality == "parameter"]
    assert done.returncode == 0 and all(f"  {v.name} " in done.stdout for v in parameters)
    assert "M_brake" not in done.stdout
