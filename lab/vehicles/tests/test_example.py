"""./scripts/example: what it takes, what it leaves, and what it says where an example was deleted."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
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
    assert example.main("step") == 0
    printed = capsys.readouterr().out
    assert "lateral force of the front axle: 26" in printed
    assert {p.name for p in tmp_path.iterdir()} == {"step.csv", "step.png", "car.ssp"}
    monkeypatch.setitem(MANOEUVRES, "step", MANOEUVRES["step"].changed(v=22.0))
    assert example.main("step") == 1 and re.match(r"\w\w ended the run .* lifted off", capsys.readouterr().err)


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
    assert printed("control").startswith('example: argument NAME: there is no example "control"; there are lane')
    (tmp_path / "examples" / "vehicles" / "package.py").unlink()
    assert "are not here" in printed("lane")


@pytest.mark.parametrize(("line", "words"), {"example lanes": "Do you mean lane?", "example lane h=1": "h=1"}.items())
def test_a_typing_error_is_refused_in_one_sentence(tmp_path: Path, line: str, words: str):
    done = asked(tmp_path, line)
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1
