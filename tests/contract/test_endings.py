"""How a run ends: flat on the ground or lifted off. Discard, the instant, and outputs there."""

import subprocess
import sys

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.closed_forms import fall_time
from support.driver import DISCARD, DO_STEP_STATUS, LAST_SUCCESSFUL_TIME, OK, TERMINATED, FMU2Wheel
from support.scenes import PAPER, THETA_0

DROP = {"theta_start": THETA_0, "phi_dot_start": 0.0}  # let go at rest


def ended(w: FMU2Wheel) -> float:
    """The instant at which the run ended, after a check of all that a master can ask for."""
    assert w.status(DO_STEP_STATUS) == DISCARD
    assert w.status(TERMINATED) == 1
    finite = np.isfinite(w.get(*w.reals))
    assert all(finite[k] for k, name in enumerate(w.reals) if name != "mu_required")  # infinite where N vanishes
    return w.status(LAST_SUCCESSFUL_TIME)


def test_the_end_does_not_depend_on_the_communication_grid(wheel):
    at_once, in_steps = wheel().start(**DROP), wheel().start(**DROP)
    assert at_once.step(10.0) == DISCARD
    status = OK
    while status == OK:
        status = in_steps.step(0.01)
    assert (status, in_steps.time) == (DISCARD, pytest.approx(0.59))
    assert ended(at_once) == ended(in_steps)
    assert at_once.bits() == in_steps.bits()
    assert at_once.bits() != wheel().start(**DROP).run([0.59])[0]


def test_a_wheel_pulled_up_lifts_off_where_the_normal_force_vanishes(wheel):
    """F_Z grows by 30 N/s against the weight of 196.2 N; the wheel's own motion shifts the instant."""
    w = wheel().start().give({"F_Z": (0.0, 30.0)})
    assert w.step(10.0) == DISCARD
    t = ended(w)
    (normal,) = w.get("lambda_3")
    within(abs(normal), 3e-6, "normal force")  # N
    assert "lifted off" in w.take_messages()[-1].text
    before = wheel().start().give({"F_Z": (0.0, 30.0)}).by(t - 0.01)
    beyond(before.get("lambda_3")[0], 0.1, "lambda_3")
    kept = wheel().start(keep_contact=1).give({"F_Z": (0.0, 30.0)}).by(t + 0.2)
    assert kept.get("lambda_3")[0] < 0  # the partner: the ground pulls


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-10])
def test_a_wheel_that_is_off_the_ground_at_the_start_ends_there_however_soon_it_would_be_pressed_again(
    wheel, tolerance
):
    """The force is back long before the solver's first step ends: both its ends, or its end alone, tell nothing."""
    motion = {"theta_start": 1.0, "psi_dot_start": 6.0, "theta_dot_start": 4.0, "phi_dot_start": 2.0}
    w, kept = (wheel().start(tolerance=tolerance, keep_contact=k, **motion).put(F_Z=-10.5) for k in (0, 1))
    within(abs(w.get("lambda_3")[0] + 2.5), 0.5, "lambda_3")  # N
    beyond(kept.by(0.005).get("lambda_3")[0], 5, "lambda_3")  # how soon
    assert w.step(0.1) == DISCARD
    assert ended(w) == 0
    wheel().start(tolerance=tolerance, **motion).put(F_Z=-15.0).by(0.1)  # the partner: N = 0.7 N at the start


def fmpy_simulate(fmu_path, output, *start_values: str) -> tuple[str, np.ndarray]:
    command = [sys.executable, "-m", "fmpy", "simulate", str(fmu_path), "--output-file", str(output)]
    values = ["--start-values", *start_values] if start_values else []
    finished = subprocess.run([*command, *values], capture_output=True, text=True, check=True)
    assert finished.stderr == ""
    return finished.stdout, np.genfromtxt(output, delimiter=",", names=True)


@pytest.mark.local
def test_fmpy_simulate_ends_where_the_wheel_falls_and_keeps_the_data(fmu_path, tmp_path):
    start = ("theta_start", "1.3089969389957472", "phi_dot_start", "0")
    said, rows = fmpy_simulate(fmu_path, tmp_path / "drop.csv", *start)
    assert said.startswith("[WARNING] The wheel fell flat at t = 0.5927504")
    assert len(rows) == 61
    within(abs(rows["time"][-1] - fall_time(PAPER, THETA_0, 1e-7)), 2e-10, "time")
    within(abs(rows["theta"][-1] - 1e-7), 512 * EPSILON, "theta")  # rounding of the instant, times theta_dot
    said, rows = fmpy_simulate(fmu_path, tmp_path / "paper.csv")  # the partner: the paper's wheel rolls on
    assert (said, len(rows), rows["time"][-1]) == ("", 1001, 10.0)
