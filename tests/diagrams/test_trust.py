"""The error that a run states of itself: it is the true one, and where it means nothing the line says so."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from fmpy import extract, simulate_fmu
from support.bounds import beyond, relative_error, within

from wheelfmu.diagrams import races, style
from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.fmu.paths import build_folder
from wheelfmu.truth import sliding
from wheelfmu.truth.errors import by_instant
from wheelfmu.truth.measure import transitions
from wheelfmu.truth.scenes import SCENES, Scene
from wheelfmu.truth.trust import DEFAULT, ROUNDING, TIGHTEST, Motion, Wheel, trust

WORDS = {"regularized": "2", "True": "true", "False": "false", "multibody": "3", "adams": "2", "bdf": "3"}
NAMES = (
    "free",
    "friction",
    "general inertia",
    "fast rolling",
    "near flat",
    "past upright",
    "thin disc",
    "light friction",
)
JUDGED = {name: SCENES[name] for name in NAMES}
JUDGED["multibody"] = Scene({"formulation": "multibody", "s": 0.03}, 5.0)
JUDGED["by CVODE"] = Scene({"method": "adams", "s": 0.03}, 5.0)
JUDGED["stiff"] = Scene({"s": 0.03, "friction_law": "regularized", "omega_s": 1e-3}, 2.0)
JUDGED["sliding"] = Scene(sliding.ROAD, 3.0)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Wheel]:
    yield Wheel(extract(str(build_folder() / "wheel.fmu"), str(tmp_path_factory.mktemp("wheel"))))


def values_of(scene: Scene) -> dict[str, str]:
    """As ./scripts/run gives them."""
    return {name: WORDS.get(str(value), str(value)) for name, value in scene.start.items()}


@pytest.mark.parametrize("scene", JUDGED.values(), ids=JUDGED)
def test_the_estimated_error_is_the_true_one(wheel: Wheel, scene: Scene) -> None:
    """Beside the reference; partner: of a looser run the error is another."""
    given, times = values_of(scene), np.linspace(0, scene.duration, 51)
    solved = scene.solved(times, rtol=1e-13)
    exact = np.column_stack([solved[name] for name in HEADLINE])
    run, other = (wheel.motion(given, times, tolerance) for tolerance in (DEFAULT, 1e-5))
    truth = wheel.judge(given, times)
    estimated, true = (by_instant(run.rows, rows).max() for rows in (truth.rows, exact))
    beyond(true, ROUNDING, "true error / range")
    within(relative_error(estimated, true), 0.3, "estimated error, relative")
    beyond(by_instant(other.rows, truth.rows).max() / true, 2, "error of a looser run over the true one")


def test_the_estimated_error_of_a_long_free_run_is_of_the_size_of_the_true_one(wheel: Wheel) -> None:
    """Over 100 s what CVODE's own steps add is not small any more."""
    times = np.linspace(0, 100, 51)
    solved = Scene({}, 100.0).solved(times, rtol=1e-13)
    exact = np.column_stack([solved[name] for name in HEADLINE])
    run, truth = wheel.motion({}, times, DEFAULT), wheel.judge({}, times)
    estimated, true = (by_instant(run.rows, rows).max() for rows in (truth.rows, exact))
    within(max(estimated / true, true / estimated), 2, "estimated over true error, or its inverse")


@pytest.mark.parametrize(
    ("start", "solver", "shared"),
    [
        ({}, "CVODE's Adams", False),
        ({"method": "3", "s": "0.03"}, "DOP853", False),
        ({"mu_max": "0.45", "mu_slide": "0.4"}, "CVODE's Adams", True),
        ({"s": "0.03", "friction_law": "2", "omega_s": "1e-6"}, "CVODE's Adams", True),
    ],
)
def test_another_solver_judges_and_where_it_is_the_same_solver_the_line_says_so(
    wheel: Wheel, start, solver, shared
) -> None:
    times = np.linspace(0, 2, 21)
    said = trust(wheel.motion(start, times, DEFAULT), wheel.judge(start, times)).said("A")
    assert f" of the range, estimated with {solver}" in said
    assert ("; slides and rests in a boundary layer are solved by the same solver" in said) == shared


def test_the_estimated_error_of_a_guided_wheel_is_that_of_the_closed_form(wheel: Wheel) -> None:
    """Upright under the regularized law: sinh(omega_z / omega_s) decays as exp(-s m g t / ((J_z + m R^2) omega_s))."""
    start = {"s": 0.03, "friction_law": "regularized", "omega_s": 0.1, "theta_start": np.pi / 2, "guided": True}
    times, decay = np.linspace(0, 4, 51), 0.03 * 20 * 9.81 / (1.8 + 20 * 0.35**2) / 0.1  # 1/s
    exact = 0.1 * np.arcsinh(np.sinh(-2 / 0.1) * np.exp(-decay * times))
    given = values_of(Scene(start, 4.0))
    run, truth = wheel.motion(given, times, 1e-5), wheel.judge(given, times)
    estimated, true = (np.abs(run.rows[:, 2] - spin).max() for spin in (truth.rows[:, 2], exact))
    beyond(true, ROUNDING * np.ptp(exact), "true error, rad/s")
    off = abs(estimated - true) / np.ptp(exact)
    within(off / TIGHTEST, 10, "estimated error off the true one, in tolerances of the judge")
    beyond(true / np.ptp(exact) / TIGHTEST, 10, "true error, in these tolerances")


def test_the_shift_of_transitions_is_the_true_one(wheel: Wheel) -> None:
    want = transitions()[1:, 0]
    times = np.linspace(0, 10, 1001)
    run, truth = wheel.motion({"s": "0.03"}, times, 1e-6), wheel.judge({"s": "0.03"}, times)
    found = trust(run, truth)
    true = np.abs(np.array([t for t, _ in run.events]) - want).max()
    assert found.counts == (37, 37)
    within(relative_error(found.shift, true), 3e-3, "estimated shift, relative")
    assert "37 transitions, shifted by up to" in found.said("A") and "computing time" in found.said("A")
    for seconds, words in ((-6e-6, "below 0.01 ms."), (4e-5, "0.04 ms.")):  # the difference of two times
        assert found._replace(seconds=seconds).said("A").endswith(f"; computing time {words}")
    few = run._replace(events=run.events[:-1])
    assert "36 transitions, 37 by the other solver" in trust(few, truth).said("A")


WET = {"mu_max": "0.5", "mu_slide": "0.4"}
LOCKED = {"guided": "true", "theta_start": "1.5707963", "phi_dot_start": "-10", "M_brake": "400"}
COUNTED = {
    "friction": ({"s": "0.03"}, 37, "37 transitions, "),
    "slides at once, locks, stands": (LOCKED | WET, 3, "3 transitions, "),
    "lies flat": ({"phi_dot_start": "0"}, 0, "; the end, "),
    "slides, lies flat": (WET | {"phi_dot_start": "0"}, 1, "; 1 transition and the end, "),
}


@pytest.mark.parametrize(("start", "count", "words"), COUNTED.values(), ids=COUNTED)
def test_the_transitions_of_the_line_are_those_that_the_wheel_counts(wheel: Wheel, start, count, words) -> None:
    """n_events, which the captions have; the end is none."""
    times = np.linspace(0, 10, 1001)
    found = trust(wheel.motion(start, times, DEFAULT), wheel.judge(start, times))
    table = simulate_fmu(str(build_folder() / "wheel.fmu"), stop_time=10, output=["n_events"], start_values=start)
    assert found.counts[0] == table["n_events"][-1] == count and words in found.said("A")


def test_a_warning_is_no_event(wheel: Wheel) -> None:
    """Partner: the wheel gives one, with the instant of a look at it, which depends on the step."""
    given = {"m": "12", "J_x": "0.559", "J_y": "0.559", "J_z": "1.1", "slope": "0.12", "M_brake": "20"}
    warned, _ = wheel.begun(given, DEFAULT, logging=True)
    for t in np.arange(100) / 100:
        warned.doStep(t, 0.01)
    assert any("mu_required" in text for text in warned.texts())
    warned.close()
    run = wheel.motion(given, np.linspace(0, 1, 101), DEFAULT)
    assert run.events and not any("mu_required" in words for _, words in run.events)


def test_an_upright_start_and_runs_that_part_are_named_with_the_instant_up_to_which_digits_hold(wheel: Wheel) -> None:
    times = np.linspace(0, 20, 2001)
    given = {"theta_start": str(np.pi / 2), "phi_dot_start": "0"}
    found = trust(wheel.motion(given, times, DEFAULT), wheel.judge(given, times))
    assert found.until is not None and "unstable or chaotic: three digits hold up to" in found.said("A")
    beyond(found.until, 5, "instant up to which digits hold in the fall from 6e-17 rad, s")
    grown = 1e-9 * np.exp(np.minimum(2 * times, 20.5))  # of two runs that part
    swing = np.column_stack([np.sin(times + 0.1 * k) for k in range(4)])
    truth, other = (Motion(times, rows) for rows in (swing, swing + grown[:, None]))
    found = trust(other, truth)
    within(abs(found.until - np.log(2e6) / 2), 0.02, "instant of a thousandth part of the range, s")
    assert trust(Motion(times, swing + 1e-5), truth).until is None


def test_errors_of_rounding_are_named_as_such_and_a_column_without_range_has_its_scale() -> None:
    times, flat = np.linspace(0, 1, 11), np.column_stack([np.linspace(0, 5, 11), np.full((11, 3), 1.5)])
    found = trust(Motion(times, flat + 1e-15), Motion(times, flat))
    within(found.error, 2e-15, "error of rounding / range")
    assert found.short == "error below 1e-11 of the range"
    beyond(trust(Motion(times, flat + 1e-3), Motion(times, flat)).error, 0.9e-3, "error without range / scale")


def test_the_race_of_all_methods_is_a_picture_and_a_table(wheel: Wheel, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(races, "TOLERANCES", (1e-4, 1e-8))
    times, given = np.linspace(0, 2, 201), {"s": "0.03"}
    found = races.measured(wheel, given, times, np.ones(4))
    pictures, save = [], style.save_png
    monkeypatch.setattr(style, "save_png", lambda figure, path: pictures.append(figure) or save(figure, path))
    races.write({"Rolling resistance": found}, tmp_path)
    header, *rows = (tmp_path / "error_time.csv").read_text().splitlines()
    assert header == "scene,method,tolerance,error,median_us,note" and len(rows) == 2 * len(races.METHODS)
    errors = {tuple(row.split(",")[1:3]): float(row.split(",")[3]) for row in rows}
    assert all(errors[method, "1e-08"] < 0.1 * errors[method, "0.0001"] for method in races.METHODS)
    assert (tmp_path / "error_time.png").read_bytes().startswith(b"\x89PNG")
    (ax,) = pictures[0].axes
    marks = [text.get_text() for text in ax.texts]
    assert {*marks} == {"$10^{-4}$", "$10^{-8}$"} and len(marks) >= 2 * len(races.METHODS) - 2  # two may coincide
    legend = [text.get_text() for text in pictures[0].legends[0].get_texts()]
    assert sorted(legend) == sorted([*races.METHODS, "default tolerance, $10^{-8}$"])
    rings = [line for line in ax.lines if line.get_label().startswith("default")]
    assert len(rings) == len(races.METHODS)
    pictures[0].canvas.draw()
    texts = [text.get_window_extent() for text in ax.get_xticklabels(which="both") if text.get_text()]
    assert all(left.x1 < right.x0 for left, right in pairwise(sorted(texts, key=lambda box: box.x0)))


def test_formulation_3_is_compared_once_also_where_it_is_the_one_that_is_asked_for() -> None:
    assert "formulation 3" in races.methods_of({"s": "0.03"}) and "formulation 3" not in races.methods_of(
        {"formulation": "3"}
    )
