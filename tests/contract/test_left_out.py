"""What a scene does not need is not done: proved by the FMU's own counters, scene by scene.

What each omission saves is in docs/results/speed.md. Each statement has a partner in which the thing is asked
for and the same counter moves.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from fmpy import simulate_fmu
from support.bounds import within

COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
WITHOUT_FRICTION = {
    "free": {},
    "fast spin": {"phi_dot_start": -60.0},
    "near flat": {"theta_start": pi / 6, "psi_dot_start": 0.1, "phi_dot_start": 0.0, "keep_contact": True},
    "general inertia": {"J_x": 0.7, "J_y": 1.2},
}
REGULARIZED = {"s": 0.03, "friction_law": 2}
SMOOTH = {
    **WITHOUT_FRICTION,
    "regularized": REGULARIZED,
}
SCENES = {**SMOOTH, "regularized, stiff": {**REGULARIZED, "omega_s": 1e-6}, "friction": {"s": 0.03}}


@pytest.fixture(scope="session")
def counters(fmu: str, description):
    """counters(step, stop, output, input, **start values) -> the counters at the stop time."""

    def run(step: float = 0.1, stop: float = 2.0, output: tuple[str, ...] = (), input=None, **values) -> dict[str, int]:
        result = simulate_fmu(
            fmu,
            model_description=description,
            output_interval=step,
            stop_time=stop,
            start_values=values,
            output=[*output, *COUNTERS],
            input=input,
        )
        assert result["time"][-1] == pytest.approx(stop), "the run ended early"
        return {name: int(result[name][-1]) for name in COUNTERS}

    return run


def force(values: list[float], stop: float = 2.0) -> np.ndarray:
    """F_X, constant between equally spaced jumps: two rows at each jump."""
    times = np.linspace(0, stop, len(values) + 1)
    rows = [(t, f) for i, f in enumerate(values) for t in (times[i], times[i + 1])]
    return np.array(rows, dtype=[("time", float), ("F_X", float)])


@pytest.mark.parametrize("scene", SMOOTH)
def test_a_smooth_scene_evaluates_no_root_function_and_restarts_nothing(counters, scene):
    counted = counters(**SMOOTH[scene])
    assert counted["n_roots"] == counted["n_events"] == counted["n_restarts"] == 0


def test_the_least_friction_installs_the_root_function(counters):
    free, touched = counters(method=4), counters(s=1e-15)
    assert touched["n_roots"] >= touched["n_steps"]
    assert touched["n_rhs"] == free["n_rhs"]  # the motion is the same to the last step


def test_the_friction_wheel_restarts_at_its_37_events_and_nowhere_else(counters):
    counted = counters(stop=10.0, s=0.03)
    assert counted["n_events"] == 37
    assert counted["n_restarts"] == 37


@pytest.mark.parametrize("scene", SCENES)
def test_the_communication_grid_costs_no_evaluation(counters, scene):
    coarse, fine = counters(step=1.0, **SCENES[scene]), counters(step=1e-3, **SCENES[scene])
    assert fine == coarse


def test_friction_does_cost_evaluations(counters):
    assert counters(s=0.03)["n_rhs"] != counters()["n_rhs"]


@pytest.mark.parametrize("scene", SCENES)
def test_reading_every_output_costs_no_evaluation(counters, description, scene):
    outputs = tuple(v.name for v in description.modelVariables if v.causality == "output")
    assert {"theta", "lambda_3", "X_C", "tau"} <= set(outputs)
    assert counters(output=(*outputs, "E", "mu_required"), **SCENES[scene]) == counters(**SCENES[scene])


@pytest.mark.parametrize("scene", [name for name in SCENES if name != "regularized, stiff"])
def test_the_smooth_method_needs_no_jacobian(counters, scene):
    assert counters(**{**SCENES[scene], "method": 2})["n_jac"] == 0
    assert counters(**{**SCENES[scene], "method": 3})["n_jac"] > 0


def test_only_a_stiff_scene_gets_jacobians_by_itself(counters):
    with_jacobian = [name for name in SCENES if counters(**SCENES[name])["n_jac"] > 0]
    assert set(with_jacobian) <= {"regularized", "regularized, stiff"}
    assert "regularized, stiff" in with_jacobian


def test_an_input_set_to_the_value_it_has_costs_nothing(counters):
    assert counters(step=0.01, input=force([0.0])) == counters(step=0.01)


def test_a_constant_force_set_again_at_each_step_restarts_nothing(counters):
    assert counters(step=0.01, input=force([0.5]))["n_restarts"] == 0


def test_each_jump_of_an_input_is_one_restart(counters):
    steady, jumping = counters(input=force([0.5])), counters(input=force([0.5, 1.0, 0.5, 1.0]))
    assert jumping["n_restarts"] - steady["n_restarts"] == 3
    assert jumping["n_rhs"] > steady["n_rhs"]


@pytest.mark.parametrize("moments", [{"J_x": 0.7, "J_y": 1.2}, {"J_x": 0.9, "J_y": 0.9}], ids=["any J", "J_x = J_y"])
def test_the_large_system_is_left_out_whatever_the_moments_of_inertia_are(counters, moments):
    automatic, reduced, multibody = (counters(**moments, s=0.03, formulation=k) for k in (1, 2, 3))
    assert automatic == reduced
    assert automatic["n_rhs"] != multibody["n_rhs"]


def test_the_free_wheel_is_integrated_over_one_nutation_only(counters):
    unfolded, stepped = counters(stop=10.0), counters(stop=10.0, formulation=2)
    assert counters(stop=1000.0, step=100.0) == unfolded
    within(unfolded["n_rhs"] / stepped["n_rhs"], 0.2, "evaluations")
