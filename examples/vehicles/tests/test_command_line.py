"""./scripts/example: parameters with units, sentences for what does not exist or is not allowed, before anything is
built; output only under results/examples."""

from __future__ import annotations

import csv
import signal
import subprocess
import sys
import time
from math import pi
from pathlib import Path

import pytest
from support.bounds import relative_error, within
from support.paths import ROOT
from vehicles import axle, driven, example, options
from vehicles.component import Component
from vehicles.master import Master

READS = [sys.executable, "-S", "-B", str(ROOT / "examples" / "vehicles" / "vehicles" / "options.py")]


@pytest.mark.parametrize(
    ("text", "value"),
    [("1ms", 1e-3), ("60e3", 60e3), ("60kN/m", 60e3), ("-4deg", -4 * pi / 180), ("36km/h", 10.0), ("0.5", 0.5)],
)
def test_a_number_may_carry_a_unit(text: str, value: float) -> None:
    assert options.number("x", text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("cra", '"cra" is no example; there are axle, car, suspended, balance, control; did you mean car?'),
        ("axle k", '"k" is not of the form name=value; --help lists the names.'),
        ("axle h=1furlong", "h=1furlong is not a number with one of the units"),
        ("axle h=1e", "h=1e is not a number"),
        ("axle stifness=2", "There is no parameter stifness here; there are, for example, stiffness"),
        ("axle scene=moon", "scene is one of straight, clothoid, trailing, rolling_out, not moon."),
        ("car m_B=-1", "m_B = -1: it must be above 0 kg."),
        ("car v=-5", "v = -5: it must be at least 0 m/s."),
        ("car k_fl=-1", "k_fl = -1: it must be at least 0 N/m."),
        ("suspended h=0", "h = 0: it must be above 0 s."),
        ("suspended stop=1ms h=5ms", "stop = 0.001: it must be at least the step h, 0.005 s."),
    ],
)
def test_what_does_not_exist_or_is_not_allowed_gets_one_sentence_before_anything_is_built(line: str, said: str) -> None:
    """By the standard library alone: nothing need be installed."""
    done = subprocess.run([*READS, *line.split()], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(said) and done.stderr.count("\n") == 1


@pytest.mark.parametrize("name", options.LIST)
def test_help_lists_every_parameter_and_all_of_them_are_taken(name: str) -> None:
    listed = subprocess.run([*READS, name, "--help"], capture_output=True, text=True, check=True).stdout
    for variable in options.known(options.LIST[name]).values():
        assert f"\n  {variable.name} " in listed
        assert options.values(options.LIST[name], [f"{variable.name}=1"]) == {variable.name: 1.0}


@pytest.mark.parametrize(
    ("model", "given", "said"),
    [
        ("axle", {"m_B": -1.0}, "axle: m_B = -1: it must be above 0 kg."),
        ("chassis", {"x_fl": -9.0}, "chassis: The centre of mass must lie between the wheels."),
        ("wheel", {"m": -1.0}, "wheel: m = -1"),
    ],
)
def test_what_only_the_unit_can_refuse_is_said_in_its_own_words(
    fmus: dict[str, Path], model: str, given: dict[str, float], said: str
) -> None:
    with (
        pytest.raises(ValueError) as refusal,
        Master([Component(model, fmus[model], given)], [], fmus["chassis"].parent) as master,
    ):
        master.run(0.01, 0.001, [])
    assert str(refusal.value).startswith(said)


def test_an_example_writes_table_figure_fmus_and_package(fmus: dict[str, Path], tmp_path: Path) -> None:
    before = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout
    given = {"scene": "straight", "M_left": 40.0, "M_right": 40.0, "stop": 0.5, "h": 0.001}
    said = example.run_axle(fmus, given, tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"axle.csv", "axle.png", "axle.ssp"}
    with (tmp_path / "axle.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[-1]["time"]) == pytest.approx(0.5)
    within(relative_error(float(rows[-1]["v"]), 80 / (0.35 * axle.Scene().m_t) * 0.5), 0.01, "speed, relative")
    assert said[0].startswith("Largest departure from the rigid axle")
    after = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout
    assert after == before


@pytest.mark.parametrize("changed", [{"scene": "trailing", "M_left": 5.0}, {"scene": "rolling_out", "v": 0.1}])
def test_an_axle_without_a_closed_form_is_not_compared_with_one(
    fmus: dict[str, Path], tmp_path: Path, changed: dict[str, float | str]
) -> None:
    (said,) = example.run_axle(fmus, {**changed, "stop": 0.2}, tmp_path)
    assert said.startswith("No closed form to compare with: with ")


def test_ctrl_c_ends_a_run_with_one_word(fmus: dict[str, Path]) -> None:
    start = "runpy.run_module('vehicles.example', run_name='__main__')"
    # What it needs is imported before it is interrupted: some packages tell an interrupt of their import otherwise.
    code = f"import runpy, sys, vehicles.example; sys.argv = ['example', 'balance']; print('ready'); {start}"
    folders = [str(ROOT / name) for name in ("tools", "examples/vehicles", "tests")]
    run = subprocess.Popen(
        [sys.executable, "-u", "-c", f"import sys; sys.path[:0] = {folders}; {code}"],
        **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True},
    )
    assert run.stdout.readline() == "ready\n"
    time.sleep(0.2)
    run.send_signal(signal.SIGINT)
    _, said = run.communicate(timeout=60)
    assert (run.returncode, said.strip().splitlines()[-1]) == (130, "Interrupted.")
    assert "Traceback" not in said


def test_a_verdict_on_the_balanced_wheel_looks_at_both_runs(fmus: dict[str, Path]) -> None:
    held, tall = (driven.verdict(driven.run(fmus, given), 1.5)[1] for given in ({}, {"k_theta": 0.0}))
    assert held.startswith("Controlled it stays up") and "drives a circle of 1.50" in held
    assert "its last turn is not the circle of 1.5 m" in tall
