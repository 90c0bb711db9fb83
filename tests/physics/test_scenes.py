"""Scenes that roll and that slide, by every formulation and method, against the independent reference.

The paper's two scenes, fast rolling, near flat, thin disc, J_x != J_y, heavy and light friction, past upright, spin
either way, and the six inputs: scenes.py, cases.py; thrown, driven, locked, on a slope, on a slippery road: sliding.py.
"""

import numpy as np
import pytest
from support.bounds import absolute_error, beyond, within

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.cases import CASES, error, transitions_gap
from wheelfmu.truth.errors import kind_errors
from wheelfmu.truth.measure import energy_error, paper
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import SCENES, THETA_0, Scene
from wheelfmu.truth.sliding import SLIDES

ROLLING = {"the paper's, free": SCENES["free"], "the paper's, friction": SCENES["friction"], **CASES}
FAST: Values = {"s": 0.03, "theta_start": 1.4, "phi_dot_start": -100.0}
VIOLENT: Values = {"s": 0.03, "keep_contact": True, "theta_start": 1.2, "psi_dot_start": 5.0, "theta_dot_start": 4.0}
ROLLING |= {"fast spin, friction": Scene(FAST, 1.0), "pulled": Scene({**VIOLENT, "phi_dot_start": 8.0}, 2.0)}
# With the errors allowed, in tolerances.
ALL = {name: (scene, 10) for name, scene in ROLLING.items()}
ALL |= {f"slides: {name}": (scene, 4) for name, scene in SLIDES.items() if name != "jams"}
TOLERANCES = (1e-4, 1e-7, 1e-10, 1e-13)
ROUNDING = 4e-12  # of the values, the reference's included
# Formulation, method, and so many times the error: CVODE controls the error of a step, not that of the motion.
KINDS = {"automatic": (1, 1, 1), "Adams": (2, 2, 5), "BDF": (2, 3, 100), "Runge-Kutta": (2, 4, 1)}
KINDS |= {"multibody": (3, 1, 1)}


def growth(library: Library, scene: Scene) -> float:
    """Of errors of the start: the largest change of an output over that of theta, spin or slip."""
    off, times = 1e-8, np.linspace(0, scene.duration, 51)
    start = {"theta_start": THETA_0, "phi_dot_start": -2.0, "slip_x_start": 0.0} | scene.start
    moved = [name for name in ("theta_start", "phi_dot_start", "slip_x_start") if name in scene.start or start[name]]
    exact, *ends = (
        library.simulate(times, 1e-12, scene.inputs, **{**scene.start, **change})
        for change in ({}, *({name: start[name] + off} for name in moved))
    )
    return max(error / off for end in ends for error in kind_errors(end, exact, 1.0).values())


@pytest.mark.parametrize(("scene", "most"), ALL.values(), ids=ALL)
def test_the_error_of_every_output_is_that_of_the_tolerance(library: Library, scene: Scene, most: float) -> None:
    """Where an error of the start grows more than a hundredfold, by so much more."""
    grown = max(1.0, growth(library, scene) / 100)
    for kind, (formulation, method, times) in KINDS.items():
        for tolerance in TOLERANCES:
            off = error(library, scene, tolerance, 1.0, formulation=formulation, method=method)
            bound = most * times * grown
            within(off / (tolerance + ROUNDING), bound, f"error of {kind}, in tolerances of {tolerance:g}")
    name, value = ("mu_slide", scene.road.mu_slide) if scene.road.mu_slide else ("J_z", scene.wheel.J_z)
    other = error(library, scene, 1e-10, 1.0, **{name: value * (1 - 1e-6)})
    beyond(other / 1e-10, 100, f"error with another {name}, in tolerances")


@pytest.mark.parametrize("scene", [n for n, case in ROLLING.items() if case.wheel.s > 0])
def test_no_transition_of_friction_is_lost_or_late_at_any_tolerance(library: Library, scene: str) -> None:
    case, s = ROLLING[scene], ROLLING[scene].wheel.s
    for tolerance in TOLERANCES:
        late = transitions_gap(library, case, s, tolerance)
        within(late / (10 * tolerance + 1e-9), 1, f"instants at {tolerance:g}, over ten tolerances")  # logged to 1 ns
    if case.solved().events[1:]:
        beyond(transitions_gap(library, case, s * (1 + 1e-4), 1e-8), 3e-6, "instants with another s, s")


def test_friction_holds_the_paper_s_wheel_for_a_sixth_of_the_time_without_any_spin(library: Library) -> None:
    run = library.simulate(np.linspace(0, 10, 5001), s=0.03)
    assert (np.sign(run["omega_z"]) == run["friction_mode"]).all()
    within(abs((run["friction_mode"] == 0).mean() - 0.16), 1e-3, "share of the time in which friction holds, off 0.16")
    lighter = library.simulate(np.linspace(0, 10, 5001), s=0.02)
    within((lighter["friction_mode"] == 0).mean(), 0.02, "share of the time in which a lighter friction holds")


def test_a_ground_that_pulls_has_no_rolling_resistance(library: Library) -> None:
    scene = ROLLING["pulled"]
    run = library.simulate(scene.solved().t, 1e-10, **scene.start)
    assert (run["lambda_3"] < 0).sum() > 10
    within(kind_errors(run, scene.solved(), 1.0), 1e-9, "outputs off the reference's, relative")
    other = kind_errors(run, scene.solved(pulled=1.0), 1.0)
    beyond(max(other.values()), 0.1, "outputs off a reference with s |N| there, relative")


def test_rolling_without_slip_needs_a_friction_coefficient_of_up_to_0_49(library: Library) -> None:
    """In the paper's free scene, at 0.63 s; by the weight in the place of N it would be another."""
    want = paper("free", 1001)
    found, tangential = library.simulate(want.t)["mu_required"], np.hypot(want["lambda_1"], want["lambda_2"])
    within(abs(found.max() - 0.4869), 1e-4, "largest mu_required off 0.4869")
    within(absolute_error(found, tangential / want["lambda_3"]), 7e-9, "mu_required off the reference's")
    beyond(absolute_error(found, tangential / 196.2), 0.03, "mu_required by the weight")


def test_the_free_wheel_keeps_its_energy_to_the_tolerance(library: Library) -> None:
    within(energy_error(library), 5e-10, "change of the energy, relative")
    within(energy_error(library, 1e-12), 2.2e-13, "change of the energy at 1e-12, relative")
    beyond(energy_error(library, s=1e-8), 1e-8, "change by a hundred-millionth of a metre of friction, relative")
