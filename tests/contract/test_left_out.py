"""What a scene does not need is not done: proved by the FMU's own counters, scene by scene.

What each omission saves is in docs/results/speed.md. Each statement has a partner in which the thing is asked for and
the same counter moves. That neither the grid nor a reading costs an evaluation is told where their bits are compared,
counters among them: test_stepping.py, test_properties.py.
"""

from math import pi

import numpy as np
import pytest
from support.bounds import within
from support.driver import COUNTERS

WITHOUT_FRICTION = {
    "free": {},
    "fast spin": {"phi_dot_start": -60.0},
    "near flat": {"theta_start": pi / 6, "psi_dot_start": 0.1, "phi_dot_start": 0.0, "keep_contact": True},
    "general inertia": {"J_x": 0.7, "J_y": 1.2},
}
REGULARIZED = {"s": 0.03, "friction_law": 2}
SMOOTH = {**WITHOUT_FRICTION, "regularized": REGULARIZED}
SCENES = {**SMOOTH, "regularized, stiff": {**REGULARIZED, "omega_s": 1e-6}, "friction": {"s": 0.03}}


@pytest.fixture
def counters(wheel):
    """counters(step, stop, **start values) -> the counters at the stop time."""

    def run(step: float = 0.1, stop: float = 2.0, **values) -> dict[str, float]:
        w = wheel().start(**values)
        for t in np.arange(1, round(stop / step) + 1) * step:
            w.to(t)
        return dict(zip(COUNTERS, w.get(*COUNTERS), strict=True))

    return run


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


@pytest.mark.parametrize("scene", [name for name in SCENES if name != "regularized, stiff"])
def test_the_smooth_method_needs_no_jacobian(counters, scene):
    assert counters(**{**SCENES[scene], "method": 2})["n_jac"] == 0
    assert counters(**{**SCENES[scene], "method": 3})["n_jac"] > 0


def test_only_a_stiff_scene_gets_jacobians_by_itself(counters):
    with_jacobian = [name for name in SCENES if counters(**SCENES[name])["n_jac"] > 0]
    assert set(with_jacobian) <= {"regularized", "regularized, stiff"}
    assert "regularized, stiff" in with_jacobian


@pytest.mark.parametrize("moments", [{"J_x": 0.7, "J_y": 1.2}, {"J_x": 0.9, "J_y": 0.9}], ids=["any J", "J_x = J_y"])
def test_the_large_system_is_left_out_whatever_the_moments_of_inertia_are(counters, moments):
    automatic, reduced, multibody = (counters(**moments, s=0.03, formulation=k) for k in (1, 2, 3))
    assert automatic == reduced
    assert automatic["n_rhs"] != multibody["n_rhs"]


def test_the_free_wheel_is_integrated_over_one_nutation_only(counters):
    unfolded, stepped = counters(stop=10.0), counters(stop=10.0, formulation=2)
    assert counters(stop=1000.0, step=100.0) == unfolded
    within(unfolded["n_rhs"] / stepped["n_rhs"], 0.2, "evaluations")
