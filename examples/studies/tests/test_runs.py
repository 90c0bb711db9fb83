"""The runs of a worker: one instance, fmi2Reset between runs, a shared start, a status for every fate."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from fmpy import simulate_fmu
from studies_support import equal, single
from study import Status, Study, StudyError
from study.instance import can_change
from study.measures import parse_measure
from study.runs import Runner, first_passage
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within


def test_each_fate_is_a_status_with_the_message_of_the_fmu(runner: Runner) -> None:
    wheels = [
        ("reached", {}, ""),
        ("flat", {"phi_dot_start": 0}, "flat"),
        ("lifted_off", {"theta_start": 0.26, "phi_dot_start": -40, "s": 0.03}, "lifted off"),
        ("grip", {"mu_max": 0.4}, "friction above mu_max"),
        ("refused", {"theta_start": 4}, "theta_start"),
        ("refused", {"s": -1}, "s"),
    ]
    usual = {"theta_start": 1.3, "phi_dot_start": -2, "s": 0, "mu_max": 0}
    columns = {name: [(usual | changed)[name] for _, changed, _ in wheels] for name in usual}
    result = single(runner, Study(list=columns, measures={"lowest": "min(theta)"}))
    for k, (fate, _, words) in enumerate(wheels):
        assert Status(result["status"][k]).name == fate
        assert words in result["message"][k]
        assert (result["n_steps"][k] > 0) == (result["end_time"][k] > 0) == (fate != "refused")
    assert result["end_time"][0] == 10


def test_a_wheel_of_a_study_moves_as_fmpy_simulates_it(runner: Runner, fmu_path) -> None:
    study = Study(grid={"s": [0.0, 0.03]}, measures={"theta_end": "theta"}, history=["theta", "X_O"], interval=0.1)
    result = single(runner, study)
    for k, s in enumerate((0.0, 0.03)):
        expected = simulate_fmu(str(fmu_path), start_values={"s": s}, output_interval=0.1, output=["theta", "X_O"])
        for name in ("theta", "X_O"):
            # the instants may differ by rounding
            within(absolute_error(result[name][k], expected[name]), 4096 * EPSILON, "beside fmpy, rad, m")
        assert result["theta_end"][k] == result["theta"][k, -1]
    beyond(absolute_error(*result["theta"]), 0.1, "the two wheels apart, rad")


def test_a_run_is_bit_identical_whatever_was_run_before_it(runner: Runner, fates: Study) -> None:
    alone = [single(runner, replace(fates, grid={**fates.grid, "s": [s]})) for s in (0.03, 0.0)]
    together = single(runner, fates)
    for s, one in zip((1, 0), alone, strict=True):
        rows = np.arange(24).reshape(3, 2, 4)[:, s].ravel()
        assert equal(one, {name: column[rows] for name, column in together.items()})
    assert not equal(*alone)


def test_wheels_that_continue_from_a_shared_snapshot_are_bit_identical_to_separate_runs(
    runner: Runner,
) -> None:
    """Against runs that have the same communication points but fetch no snapshot: each in a separate block."""
    study = Study(
        grid={"theta_start": [1.2, 1.3], "s": [0.0, 0.01, 0.03], "M_3": [0.0, -0.2]},
        measures={"theta_end": "theta", "mu": "max(mu_required)"},
        stop_time=4.0,
        branch_at=1.5,
    )
    assert all(can_change(runner.instance.description, name) for name in ("s", "M_3"))
    together = single(runner, study)
    for k, point in enumerate(product(*study.grid.values())):
        runner._shared = None
        alone = single(
            runner, replace(study, grid={name: [value] for name, value in zip(study.grid, point, strict=True)})
        )
        assert equal(alone, {name: column[k : k + 1] for name, column in together.items()})
    assert len(set(together["theta_end"])) == 12
    assert (together["fmu_time"] > 0).all()


def test_a_shared_start_that_ends_is_the_end_of_all_that_share_it(runner: Runner) -> None:
    study = Study(grid={"s": [0.0, 0.03]}, values={"phi_dot_start": 0.0}, branch_at=2.0)
    result = single(runner, study)
    assert (result["status"] == Status.flat).all()
    assert (result["end_time"] < 2).all()


def test_measures_agree_with_the_history(runner: Runner) -> None:
    measures = {"low": "min(theta)", "high": "max(theta)", "mean": "mean(theta)", "down": "first(theta < 0.8)"}
    result = single(runner, Study(grid={"s": [0.0]}, measures=measures, history=["theta"]))
    t, theta = np.linspace(0, 10, 1001), result["theta"][0]
    assert (result["low"][0], result["high"][0]) == (theta.min(), theta.max())
    # a sum of 1001 terms
    within(relative_error(result["mean"][0], np.trapezoid(theta, t) / 10), 1024 * EPSILON, "mean, relative")
    k = int(np.argmax(theta < 0.8))  # it passes 0.8 once here
    assert t[k - 1] < result["down"][0] <= t[k]
    within(abs(np.interp(result["down"][0], t, theta) - 0.8), 64 * EPSILON, "theta then, rad")


def test_a_passage_that_never_happens_is_not_a_number() -> None:
    t, x = np.array([0.0, 1.0, 2.0]), np.array([3.0, 2.0, 1.0])
    assert first_passage(t, x, 1.5, below=True) == 1.5
    assert first_passage(t, x, 4.0, below=True) == 0.0
    assert np.isnan(first_passage(t, x, 0.5, below=True))
    assert np.isnan(first_passage(t, x, 3.5, below=False))


def test_an_impossible_study_is_refused_with_a_message(runner: Runner) -> None:
    good = Study(grid={"s": [0.0, 0.01]})
    faults = {
        "not a parameter": replace(good, grid={"tetha_start": [1.0]}),
        "not an output": replace(good, measures={"low": "min(tetha)"}),
        "not a measure": replace(good, measures={"low": "least(theta)"}),
        "exactly one": replace(good, list={"s": [0.0]}),
        "one length": Study(list={"s": [0.0, 0.1], "theta_start": [1.0]}),
        "two things": replace(good, measures={"s": "theta"}),
        "an integer": replace(good, measures={"n": "max(n_steps)"}),
        "above zero": replace(good, interval=0.0),
        "at least one wheel": Study(sample={"s": (0.0, 0.1)}),
        "is in values": replace(good, values={"s": 0.0}),
    }
    for words, study in faults.items():
        with pytest.raises(StudyError, match=words):
            study.check(runner.instance.description)
    good.check(runner.instance.description)


def test_a_measure_is_parsed_as_it_is_written() -> None:
    assert parse_measure(" first( theta < -1.5e-1 ) ").limit == -0.15
    assert parse_measure("theta").kind == "last"
    for text in ("", "theta <", "first(theta)", "min(theta", "min(a, b)", "first(theta < x)"):
        with pytest.raises(ValueError, match="not a measure"):
            parse_measure(text)


def test_a_sample_is_drawn_by_its_seed_and_within_its_bounds() -> None:
    study = Study(sample={"theta_start": (1.0, 1.5), "s": (0.0, 0.1)}, count=50, seed=7)
    again, other = replace(study), replace(study, seed=8)
    assert study.spec() == again.spec()
    assert study.fingerprint("") != other.fingerprint("")
    theta = np.sort(study.axes["theta_start"])
    assert (np.floor((theta - 1.0) / 0.01) == np.arange(50)).all()  # a Latin hypercube: one wheel in each fiftieth


def test_a_wheel_that_leans_to_the_other_side_is_as_low_as_its_mirror_image(runner: Runner) -> None:
    measures = {"low": "lowest", "down": "first(plane_angle < 0.9)", "end": "plane_angle"}
    lean = Study(list={"theta_start": [1.3, np.pi - 1.3], "phi_dot_start": [-2.0, -2.0]}, measures=measures)
    result = single(runner, replace(lean, history=["theta"]))
    for k, theta in enumerate(result["theta"]):
        angle = np.minimum(theta, np.pi - theta)
        within(abs(result["low"][k] - angle.min()), 16 * EPSILON, "lowest angle, rad")
        within(abs(result["end"][k] - angle[-1]), 16 * EPSILON, "angle at the end, rad")
    within(abs(np.diff(result["low"]).item()), 512 * EPSILON, "lowest angles apart, rad")  # after 10 s
    within(abs(np.diff(result["down"]).item()), 256 * EPSILON, "first passages apart, s")
    within(absolute_error(result["theta"][:, 0], [1.3, np.pi - 1.3]), 64 * EPSILON, "starts, rad")
