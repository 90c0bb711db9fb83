"""The reference solution judged: its search for events, integral laws, the benchmark, rolling resistance.

Every bound has a partner that breaks an equation, a parameter or a law, and must exceed it. Closed forms judge the
FMU, which is compared with this reference.
"""

from dataclasses import replace
from datetime import date
from itertools import pairwise
from math import cos, sin

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth import scenes
from wheelfmu.truth.cases import CASES
from wheelfmu.truth.errors import instants_error as error_of_instants
from wheelfmu.truth.errors import kind_errors
from wheelfmu.truth.problems import PROBLEMS, by_reference, errors, transitions
from wheelfmu.truth.reference import Inputs, Road, Solution, Start, Wheel, newton_euler, solve
from wheelfmu.truth.reference.crossing import NODES, first_fall
from wheelfmu.truth.reference.judge import contact_gap, energy_gap, impulse_gap
from wheelfmu.truth.scenes import GENERAL
from wheelfmu.truth.scenes import SCENES as ROLLING
from wheelfmu.truth.sliding import SLIDES

SCENES = {name: CASES.get(name, scene) for name, scene in ROLLING.items() if "friction_law" not in scene.start}
SCENES |= {f"slides: {name}": scene for name, scene in SLIDES.items()}
PUSHED = Inputs(
    force=lambda t: (3 * sin(2 * t), 2 * cos(3 * t), -5 * sin(t)),
    moment=lambda t: (0.3 * cos(t), 0.2 * sin(2 * t), 0.5 * sin(3 * t)),
)
all_scenes = pytest.mark.parametrize("scene", SCENES)


def run(scene: str) -> Solution:
    return SCENES[scene].solved()


@pytest.fixture
def arm_kept_fixed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The constraint differentiated as if the arm p did not turn with the wheel."""
    monkeypatch.setattr(newton_euler, "arm_rate", lambda wheel, n, w: (0.0, 0.0, 0.0))


@pytest.fixture
def wrong_gyroscopic_sign(monkeypatch: pytest.MonkeyPatch) -> None:
    """w x J w with the sign turned, as (16) prints it."""
    right = newton_euler.gyroscopic
    monkeypatch.setattr(newton_euler, "gyroscopic", lambda *of: tuple(-c for c in right(*of)))


def test_a_solution_that_was_kept_is_the_one_that_is_computed_now(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of one scene, on each day another."""
    name = [*SCENES][date.today().toordinal() % len(SCENES)]
    before, heavier = run(name), replace(SCENES[name], start={**SCENES[name].start, "g": 9.81 * (1 + 1e-5)})
    monkeypatch.setattr(scenes, "kept", lambda _question, answer: answer())
    within(kind_errors(run(name).columns, before.columns), 1e-9, f"{name}: solutions apart, relative")
    beyond(abs(heavier.solved()["lambda_3"][0] / before["lambda_3"][0] - 1), 1e-9, f"{name}: under another weight")


# ---- the search for events ----


def test_a_brief_dip_between_two_samples_is_found_and_a_near_miss_is_not() -> None:
    dip = (NODES - 0.5) ** 2
    x, _ = first_fall(dip - 1e-8, from_zero=False)
    within(abs(x - (0.5 - 1e-4)), 16 * 0.25 * EPSILON / 2e-4, "place of the fall")  # values of 0.25, a slope of 2e-4
    assert first_fall(dip + 1e-8, from_zero=False) is None


def test_a_release_found_a_little_early_is_not_taken_for_a_return_to_zero() -> None:
    """omega_z with slope -1e-5 and rounding 1e-13 at the start: that root is known, no event."""
    omega_z = NODES * (NODES - 1e-5) + 1e-13
    assert first_fall(omega_z, from_zero=True) is None
    assert first_fall(omega_z, from_zero=False) is not None  # the false return, at 1e-8


# ---- contact, energy, momentum ----


@all_scenes
def test_the_wheel_stays_on_its_contact_and_its_slip_is_that_of_its_velocities(scene: str) -> None:
    within(contact_gap(run(scene)), 2e-11, "velocity, m/s, and height off the contact, m")


@all_scenes
def test_energy_changes_by_the_work_of_inputs_and_friction(scene: str) -> None:
    within(energy_gap(run(scene), "inputs", "friction", "sliding"), 5e-11, "energy off the work, relative")


@pytest.mark.parametrize("scene", ["free", "friction", "pushed", "general inertia, friction"])
@pytest.mark.usefixtures("arm_kept_fixed")
def test_an_arm_that_does_not_turn_breaks_contact_and_energy(scene: str) -> None:
    s = SCENES[scene]
    wrong = solve(s.wheel, s.motion, np.linspace(0, 1, 11), s.inputs.for_reference(), rtol=1e-9)
    beyond(contact_gap(wrong), 1, "velocity, m/s, and height off the contact, m")
    beyond(energy_gap(wrong, "inputs", "friction"), 1, "energy off the work, relative")


def test_energy_does_not_balance_without_the_work_of_sliding() -> None:
    beyond(energy_gap(run("slides: thrown"), "inputs", "friction"), 0.05, "energy off that work, relative")


def test_the_scenes_reach_what_they_are_named_after() -> None:
    assert all((run(scene).ended is None) == (scene != "slides: jams") for scene in SCENES)
    within(run("near flat")["theta"].min(), np.radians(1), "least tilt, rad")
    beyond(run("past upright")["theta"].max(), np.radians(150), "largest tilt, rad")
    assert 0 in run("heavy friction")["friction_mode"]


ROADS = {"rolls": (0.0, 1.0, None), "slides": (0.02, 0.2, Road(0.4, 0.35, (1.0, -1.5)))}


@pytest.mark.parametrize(("s", "duration", "road"), ROADS.values(), ids=ROADS)
def test_all_loads_account_for_momentum_and_angular_momentum_at_general_inertia(s, duration, road) -> None:
    wheel = Wheel(**GENERAL, s=s)
    swapped = replace(wheel, J_x=wheel.J_y, J_y=wheel.J_x)
    within(impulse_gap(wheel, PUSHED, wheel, duration, road), 4e-10, "momenta off the impulses, N s, N m s")
    beyond(impulse_gap(wheel, PUSHED, swapped, duration, road), 0.1, "momenta with swapped inertia, N s, N m s")


# ---- the values of docs/benchmark.md, by Taylor's method in quadruple precision, all transitions included ----


FRICTION = Wheel(s=0.03)
both_scenes = pytest.mark.parametrize("name", ["free", "friction"])


def benchmark_error(name: str, rtol: float) -> float:
    return errors(name, by_reference(PROBLEMS[name], rtol))[0]


def order(name: str) -> float:
    """Decades of error per decade of rtol, from 1e-6 to 1e-10."""
    return np.log10(benchmark_error(name, 1e-6) / benchmark_error(name, 1e-10)) / 4


@both_scenes
def test_the_error_falls_in_proportion_to_the_tolerance(name: str) -> None:
    within(abs(order(name) - 1), 0.15, "order of convergence less 1")


@both_scenes
@pytest.mark.usefixtures("wrong_gyroscopic_sign")
def test_a_wrong_gyroscopic_sign_neither_meets_nor_approaches_the_benchmark(name: str) -> None:
    beyond(benchmark_error(name, 1e-9), 0.2, "error / range")
    within(abs(order(name)), 5e-5, "order of convergence")


def test_all_transitions_of_the_friction_scene_are_at_their_instants() -> None:
    def late(s: float) -> float:
        return error_of_instants(solve(Wheel(s=s), Start(), [0.0, 10.0]).events[1:], transitions("friction"))

    within(late(0.03), 2e-11, "instants of the transitions, s")
    beyond(late(0.03 * (1 + 1e-6)), 1e-6, "instants with another s, s")


@pytest.mark.parametrize("rtol", [1e-4, 1e-6])
def test_no_transition_is_lost_at_a_coarse_tolerance(rtol: float) -> None:
    events = solve(FRICTION, Start(), [0.0, 10.0], rtol=rtol).events[1:]
    assert [mode for _, mode in events] == [mode for _, mode in transitions("friction")]


@pytest.mark.parametrize("scene", ["friction", "heavy friction"])
def test_the_wheel_is_held_exactly_until_the_holding_moment_reaches_s_N(scene: str) -> None:
    s = SCENES[scene]
    events = run(scene).events
    releases = [t for (_, before), (t, _) in pairwise(events) if before == 0]
    at = solve(s.wheel, s.motion, [0.0, *(t - 1e-9 for t in releases)])
    ratio = np.abs(at["tau"][1:]) / (s.wheel.s * at["lambda_3"][1:])
    assert len(releases) == {"friction": 12, "heavy friction": 9}[scene]
    assert set(at["omega_z"][1:]) == {0.0}
    within(np.abs(ratio - 1).max(), 2e-7, "holding moment over s N, off 1")
    beyond(np.abs(ratio / 1.001 - 1).max(), 5e-4, "holding moment over a friction 0.1 % too large, off 1")
