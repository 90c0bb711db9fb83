"""./scripts/example: parameters with units, sentences for what does not exist, output only under results/examples."""

from __future__ import annotations

import csv
import subprocess
from math import pi
from pathlib import Path

import pytest
from support.paths import ROOT
from vehicles import example, options


@pytest.mark.parametrize(
    ("text", "value"),
    [("1ms", 1e-3), ("60e3", 60e3), ("60kN/m", 60e3), ("-4deg", -4 * pi / 180), ("36km/h", 10.0), ("0.5", 0.5)],
)
def test_a_number_may_carry_a_unit(text: str, value: float) -> None:
    assert options.number("x", text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("argument", "said"),
    [
        ("k", "k is not name=value."),
        ("h=1furlong", "h=1furlong is not a number with one of the units"),
        ("stifness=2", "There is no parameter stifness here; there are, for example, stiffness"),
        ("scene=moon", "scene is one of straight, trailing, not moon."),
    ],
)
def test_what_does_not_exist_gets_one_sentence(argument: str, said: str) -> None:
    with pytest.raises(options.Refused) as refusal:
        options.read([argument], {"scene": ("straight", "trailing")}, {"h", "k", "stiffness"})
    assert str(refusal.value).startswith(said)


def test_an_example_writes_table_figure_fmus_and_package(
    fmus: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout
    said = example.run_axle(fmus, ["scene=straight", "M_left=40", "M_right=40", "stop=0.5", "h=1ms"], tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {"axle.csv", "axle.png", "axle.ssp"}
    with (tmp_path / "axle.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert float(rows[-1]["time"]) == pytest.approx(0.5)
    assert float(rows[-1]["v"]) == pytest.approx(80 / (0.35 * example.axle.Scene().m_t) * 0.5, rel=0.02)
    assert said[0].startswith("Largest departure from the rigid axle")
    after = subprocess.run(["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, text=True).stdout
    assert after == before
