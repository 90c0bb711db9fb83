"""./scripts/example: what it takes, what it leaves, and what it says where an example was deleted."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.bounds import beyond, within
from support.checkout import copy_checkout
from support.typed import asked

from lab.vehicles import example
from lab.vehicles.car import Fmus
from lab.vehicles.commands.example import NAMES
from lab.vehicles.manoeuvres import MANOEUVRES


def test_it_drives_the_car_prints_its_closed_forms_and_leaves_table_picture_and_package(
    fmus: Fmus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
):
    monkeypatch.setattr(example, "RESULTS", tmp_path)
    monkeypatch.setattr(example, "BUILT", fmus["chassis"].parent)
    monkeypatch.setattr(example, "build_all", lambda: fmus)
    assert example.main("car", "step") == 0
    printed = capsys.readouterr().out
    assert "lateral force of the front axle: 26" in printed
    left = {p.name for p in (tmp_path / "car").iterdir()}
    assert left == {"car.csv", "car.png", "car.ssp", "chassis.fmu", "driver.fmu"}
    monkeypatch.setitem(MANOEUVRES, "step", MANOEUVRES["step"].changed(v=22.0))
    assert example.main("car", "step") == 1 and re.match(r"\w\w ended the run .* lifted off", capsys.readouterr().err)


def test_the_quarter_car_is_launched_as_its_closed_form_says(
    fmus: Fmus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
):
    """Partner: a wheel whose rotation takes no moment."""
    monkeypatch.setattr(example, "RESULTS", tmp_path)
    monkeypatch.setattr(example, "BUILT", fmus["chassis"].parent)
    monkeypatch.setattr(example, "build_all", lambda: fmus)
    found = []
    for J_z in (example.J_Z, 0.0):
        monkeypatch.setattr(example, "J_Z", J_z)
        assert example.main("suspended") == 0
        found.append([float(x) for x in re.findall(r"(?:: |form: )([\d.]+)", capsys.readouterr().out)])
    within(abs(found[0][0] / found[0][1] - 1), 2e-3, "acceleration, relative")
    beyond(abs(found[1][0] / found[1][1] - 1), 2e-2, "acceleration without J_z, relative")
    left = {p.name for p in (tmp_path / "suspended").iterdir()}
    assert left == {"suspended.csv", "suspended.png", "quarter_car.ssp", "quarter_car.fmu"}


def test_of_what_was_deleted_the_help_has_nothing_and_the_command_one_sentence(tmp_path: Path):
    copy_checkout(tmp_path)

    def printed(*words: str) -> str:
        done = subprocess.run(
            [sys.executable, "-S", "-B", tmp_path / "tools", "example", *words], capture_output=True, text=True
        )
        assert done.returncode == (0 if "--help" in words else 2)
        return done.stdout + done.stderr

    assert all(f"\n  {name} " in printed("--help") for name in NAMES)
    (tmp_path / "lab" / "vehicles" / "control.py").unlink()
    assert "control" not in printed("--help").split("NAME is one of")[1]
    assert printed("control").startswith('example: argument NAME: there is no example "control"; there are car')
    (tmp_path / "examples" / "vehicles" / "package.py").unlink()
    assert "are not here" in printed("car")


@pytest.mark.parametrize(
    ("line", "words"),
    {
        "example cars": "Do you mean car?",
        "example car lanes": "Do you mean lane?",
        "example control lane": "no manoeuvres",
    }.items(),
)
def test_a_typing_error_is_refused_in_one_sentence(tmp_path: Path, line: str, words: str):
    done = asked(tmp_path, line)
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1
