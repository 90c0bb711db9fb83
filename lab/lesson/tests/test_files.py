"""What ./scripts/view makes of result files."""

import re
from dataclasses import replace

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, within

from lab.lesson.bodies import read_bodies

from .pages import POSE, opened, view, write_csv

T = np.linspace(0, 1, 11)
UPRIGHT = {"X_O": T, "Y_O": 0 * T, "Z_O": 0 * T + 0.7, "psi": 0 * T, "theta": 0 * T + np.pi / 2, "phi": -T / 0.7}


def columns_of(rows: np.ndarray, names=("time", *POSE)) -> dict[str, np.ndarray]:
    return {name: np.asarray(rows[name], dtype=float) for name in names}


def shape(path, columns: dict[str, np.ndarray]) -> tuple[float, float]:
    """r_0 and r in m as read from a file with these columns, which keeps none of them."""
    (body,) = read_bodies(write_csv(path / "wheel.csv", columns))
    assert not {"r_0", "r"} & body.columns.keys()
    return body.parameters["r_0"], body.parameters["r"]


@pytest.fixture
def one(scenes, tmp_path):
    return write_csv(tmp_path / "one.csv", columns_of(scenes["free"]))


@pytest.mark.parametrize(("r_0", "r"), [(0.3, 0.05), (0.2, 0.0)])
def test_the_wheels_radii_follow_from_its_motion(simulate, tmp_path, r_0, r):
    values = {"r_0": r_0, "r": r, "J_x": 0.4, "J_y": 0.4, "J_z": 0.8}
    rows = simulate(output_interval=0.1, stop_time=2, output=POSE, start_values=values)
    within(absolute_error(shape(tmp_path, columns_of(rows)), (r_0, r)), 64 * EPSILON, "r_0, r, m")


def test_a_wheel_that_stays_upright_gets_the_papers_proportions_or_those_of_its_file(tmp_path):
    assert shape(tmp_path, {"time": T} | UPRIGHT) == pytest.approx((0.6, 0.1))
    assert shape(tmp_path, {"time": T} | UPRIGHT | {"r_0": 0 * T + 0.4, "r": 0 * T + 0.3}) == (0.4, 0.3)


def test_prefixes_make_several_wheels_and_other_columns_stay_unread(tmp_path):
    table = {"time": T} | {f"chassis.{column}": 0 * T for column in ("X", "Y", "Z", "psi")} | {"driver.speed": T}
    for name, x, y in (("wheel_fl", 2.6, 1.5), ("wheel_rr", 0.0, 0.0)):
        moved = UPRIGHT | {"X_O": T + x, "Y_O": 0 * T + y}
        table |= {f"{name}.{column}": moved[column] for column in POSE}
    assert [body.name for body in read_bodies(write_csv(tmp_path / "car.csv", table))] == ["wheel_fl", "wheel_rr"]


def refusal(capsys, *words) -> str:
    """What the command prints when it takes these words for wrong."""
    with pytest.raises(SystemExit) as end:
        view(*words)
    assert end.value.code == 2
    return capsys.readouterr().err


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ({"psi": None}, "lacks the column psi"),
        ({"phi": np.where(T > 0.5, np.nan, T)}, "is not finite"),
        ({"time": -T}, "time does not rise"),
        ({"time": 0 * T}, "no motion to show: all rows are of one instant"),
    ],
)
def test_a_file_that_cannot_be_shown_is_refused_with_one_sentence(tmp_path, capsys, fault, sentence):
    columns = {"time": T} | UPRIGHT | fault
    path = write_csv(tmp_path / "bad.csv", {name: column for name, column in columns.items() if column is not None})
    assert re.fullmatch(rf"view: .*{sentence}.*\.\n", refusal(capsys, path))
    assert not path.with_suffix(".html").exists()


def test_a_missing_file_and_more_labels_than_bodies_are_refused_with_one_sentence(one, tmp_path, capsys):
    assert re.match("view: .* cannot be read: there is no such file.", refusal(capsys, tmp_path / "none.csv"))
    said = refusal(capsys, one, "--labels", "a", "b", "c")
    assert said == "view: --labels names 3 wheels, but the files hold 1 wheel.\n"
    view(one, "--labels", "a")


def test_the_page_is_one_file_that_asks_for_nothing_else_and_names_the_licence_of_three_js(recorded_file):
    text = recorded_file.read_text()
    addresses = re.findall(r"""(?:src|href|url|@import)\s*[=(]\s*["']?([^"')\s>]+)""", text)
    assert all(address.startswith("data:") for address in addresses)
    assert len(text.encode()) < 3_000_000
    assert "three.js authors" in text and "Permission is hereby granted" in text


def test_a_long_run_is_thinned_to_a_page_below_ten_megabytes(one, capsys, monkeypatch):
    (body,) = read_bodies(one)
    columns = {name: np.tile(column, 250) for name, column in body.columns.items()}
    columns["time"] = np.arange(len(columns["time"])) * 0.01
    monkeypatch.setattr("lab.lesson.writing.read_bodies", lambda *_: [replace(body, columns=columns)])
    view(one)
    assert "One row in 3 is kept" in capsys.readouterr().out
    assert 6_000_000 < one.with_suffix(".html").stat().st_size < 10_000_000


def test_without_a_name_the_page_stands_beside_the_first_file_and_the_command_says_where(one, capsys):
    for path, options in (("one.html", ()), ("other.html", ("--output", one.with_name("other.html")))):
        view(one, *options)
        assert capsys.readouterr().out.startswith(f"{one.with_name(path)} (")  # and no row is left out
        assert one.with_name(path).stat().st_size > 1e5


def test_wheels_of_one_file_open_together_and_those_of_several_side_by_side(window, one, tmp_path):
    both = {f"{name}.{column}": UPRIGHT[column] for name in ("fl", "wheel_rr") for column in POSE}
    path = write_csv(tmp_path / "axle.csv", {"time": T} | both)
    view(path)
    view(path, one, "--output", tmp_path / "two.html")
    with opened(window, tmp_path / "axle.html") as page:
        assert page.evaluate("page.choices[page.choice].label") == "Together"
        assert page.evaluate("page.views.map((view) => view.map(({name}) => name))") == [["fl", "wheel_rr"]]
        assert page.locator(".label b").all_inner_texts() == ["front left", "rear right"]
    with opened(window, tmp_path / "two.html") as page:
        assert page.locator("#choice label:has(:checked)").inner_text() == "Side by side"
