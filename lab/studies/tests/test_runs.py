"""The runs of a worker: one instance, fmi2Reset between runs, a status for every fate."""

from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from fmpy import simulate_fmu
from support.bounds import EPSILON, absolute_error, beyond, relative_error, within

from lab.studies import Status, Study, StudyError
from lab.studies.measures import parse_measure
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import variables
from wheelfmu.truth.sliding import SLIDES, UPRIGHT

from .studies_support import FATES, same

DESCRIPTION = (ROOT / "modelDescription.xml").read_bytes()
JAMS = SLIDES["jams"].start


@pytest.fixture(scope="module")
def rolled(alone) -> xr.Dataset:
    measures = {"low": "min(theta)", "high": "max(theta)", "mean": "mean(theta)", "down": " first( theta < +8e-1 ) "}
    measures |= {"at_once": "first(theta > -1.)", "never": "first(theta > 3.5)", "end": "theta"}
    return alone(Study(grid={"s": [0.0, 0.03]}, measures=measures, history=["theta", "X_O"]))


def test_each_fate_is_a_status_with_the_message_of_the_fmu(alone) -> None:
    wheels = [
        ("reached", {}, ""),
        ("flat", {"phi_dot_start": 0}, "flat"),
        ("lifted_off", {"theta_start": 0.26, "phi_dot_start": -40, "s": 0.03}, "lifted off"),
        ("grip", {"mu_max": 0.4}, "friction coefficient above mu_max"),
        ("jammed", JAMS, "jams"),
        ("refused", {"theta_start": 4}, "theta_start"),
        ("refused", {"s": -1}, "s"),
    ]
    usual = {name: float(v.start) for name, v in variables().items() if name in JAMS}
    usual |= {"theta_start": 1.3, "s": 0}
    columns = {name: [(usual | changed)[name] for _, changed, _ in wheels] for name in usual}
    results = alone(Study(list=columns, measures={"lowest": "min(theta)"}))
    for k, (fate, _, words) in enumerate(wheels):
        one = results.isel(wheel=k)
        assert Status(one["status"]).name == fate and words in one["message"].item()
        assert (one["n_steps"] > 0) == (one["end_time"] > 0) == (fate != "refused")
    assert results["end_time"][0] == 10


def test_the_slip_and_the_time_of_sliding_of_a_locked_wheel_are_the_closed_forms(alone) -> None:
    """From v it slides for v / (mu g)."""
    measures = {"slip": "slip", "slid": "slid", "mean": "mean(slip)", "slow": "first(slip < 7.2km/h)"}
    locked = UPRIGHT | {"mu_max": 0.45, "M_brake": 1000.0}
    grid = {"slip_x_start": [0.0, 4.0, 7.0], "mu_slide": [0.3, 0.4]}
    results = alone(Study(grid=grid, values=locked, measures=measures, stop_time=3.0))
    v, mu = results["slip_x_start"], results["mu_slide"]
    within(absolute_error(results["slip"], v + 0 * mu), 16 * 7 * EPSILON, "largest slip, m/s")
    within(absolute_error(results["slid"], v / (mu * 9.81)), 0.01, "time of sliding, s")  # one interval
    within(absolute_error(results["mean"], v**2 / (2 * mu * 9.81) / 3), 2e-5, "mean slip, m/s")  # its last interval
    slow = ((v - 2) / (mu * 9.81)).where(v > 2, 0)
    within(absolute_error(results["slow"], slow), 16384 * EPSILON, "first passage of 2 m/s, s")
    beyond(absolute_error(results["slid"].sel(mu_slide=0.3), v / (0.31 * 9.81)), 0.05, "time by another friction, s")


def test_a_wheel_of_a_study_moves_as_fmpy_simulates_it(rolled: xr.Dataset, fmu_path: Path) -> None:
    for s in (0.0, 0.03):
        expected = simulate_fmu(str(fmu_path), start_values={"s": s}, output_interval=0.01, output=["theta", "X_O"])
        for name in ("theta", "X_O"):
            # the instants may differ by rounding
            within(absolute_error(rolled[name].sel(s=s), expected[name]), 4096 * EPSILON, f"{name} off FMPy's, SI")
    beyond(absolute_error(*rolled["theta"].values), 0.1, "the two wheels apart, rad")


def test_measures_are_those_of_the_history(rolled: xr.Dataset) -> None:
    one = rolled.sel(s=0.0)
    t, theta = one["time"].values, one["theta"].values
    assert (one["high"], one["end"]) == (theta.max(), theta[-1])  # the start is the highest
    assert theta.min() - 1e-3 < one["low"] < theta.min()
    within(relative_error(one["mean"], np.trapezoid(theta, t) / 10), 1024 * EPSILON, "mean of 1001 terms, relative")
    k = int(np.argmax(theta < 0.8))  # it passes 0.8 once here
    assert t[k - 1] < one["down"] <= t[k]
    within(abs(np.interp(one["down"], t, theta) - 0.8), 64 * EPSILON, "theta at the first passage off 0.8, rad")
    assert one["at_once"] == 0 and np.isnan(one["never"])


def test_an_extreme_lies_between_the_samples_of_a_smooth_turn_and_on_the_sample_of_a_kink() -> None:
    t = np.arange(0, 3, 0.01)
    swing, tent = np.cos(9 * (t - 1.2345)), 1 - abs(t - 1.2)
    for kind, sign in (("max", 1), ("min", -1)):
        measure = parse_measure(f"{kind}(theta)")
        within(abs(measure.value(t, sign * swing) - sign), 2e-6, "extreme of a swing")
        assert measure.value(t, sign * tent) == sign * tent.max() and measure.value(t, sign * t) == sign * t[-1]
    beyond(1 - swing.max(), 1e-5, "largest sample below the swing's")


def test_a_run_is_bit_identical_whatever_was_run_before_it(alone) -> None:
    together = alone(FATES)
    for point in product(*FATES.grid.values()):
        where = {name: [value] for name, value in zip(FATES.grid, point, strict=True)}
        assert same(alone(replace(FATES, grid=where)), together.sel(where))
    assert {Status.reached, Status.flat} <= {*together["status"].values.flat}
    assert not same(together.isel(s=[0]), together.isel(s=[1]).assign_coords(s=[0.0]))


FAULTS = {
    "either grid or list": {"list": {"s": [0.0]}},
    "one length": {"grid": {}, "list": {"s": [0.0, 0.1], "theta_start": [1.0]}},
    "a list of numbers": {"grid": {"s": []}},
    "two things": {"measures": {"s": "theta"}},
    "an integer": {"measures": {"n": "max(n_steps)"}},
    "above zero": {"interval": 0.0},
    "is in values": {"values": {"s": 0.0}},
}
NO_MEASURES = ("", "theta <", "first(theta)", "min(theta", "min(a, b)", "first(theta < x)")


def test_an_impossible_study_is_refused_with_a_message() -> None:
    known, good = variables(), {"grid": {"s": [0.0, 0.01]}}
    for words, fields in [*FAULTS.items(), *(("not a measure", {"measures": {"low": text}}) for text in NO_MEASURES)]:
        with pytest.raises(StudyError, match=words):
            Study(**(good | fields)).check(known)
    with pytest.raises(ValueError, match="takes no unit but"):
        parse_measure("first(theta < 30kg)")
    Study(**good).check(known)


def test_a_wheel_that_leans_to_the_other_side_is_as_low_as_its_mirror_image(alone) -> None:
    measures = {"low": "lowest", "down": "first(plane_angle < 0.9)", "end": "plane_angle"}
    starts = {"theta_start": [1.3, np.pi - 1.3], "phi_dot_start": [-2.0, -2.0]}
    results = alone(Study(list=starts, measures=measures, history=["theta"]))
    angle = np.minimum(results["theta"], np.pi - results["theta"])
    fine = alone(Study(list=starts, measures=measures, interval=0.001))
    within(absolute_error(results["low"], fine["low"]), 3e-7, "lowest angle, rad")
    beyond(absolute_error(angle.min("time"), fine["low"]), 1e-6, "lowest sample, rad")
    within(absolute_error(results["end"], angle[:, -1]), 16 * EPSILON, "angle at the end, rad")
    within(abs(np.diff(results["low"]).item()), 512 * EPSILON, "lowest angles apart, rad")  # after 10 s
    within(abs(np.diff(results["down"]).item()), 64 * EPSILON, "first passages apart, s")
    beyond(absolute_error(*results["theta"]), 0.1, "thetas apart, rad")
