"""The wheel slides where grip ends, and grips again: balances, the independent reference, cost, endings.

Coulomb's law: grip up to mu_max N, then mu_slide N against the slip; R = r_0 + r. Straight: test_straight.py. SI.
"""

from math import cos, hypot, pi, sin

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import DISCARD, ERROR, OK
from wheelfmu.truth.closed_forms import circle
from wheelfmu.truth.errors import kind_errors
from wheelfmu.truth.motion import Library, Run, start_values
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.scenes import Scene
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import ROAD, SLIDES, UPRIGHT, random_slide

PAPER = Wheel()
R = PAPER.r_0 + PAPER.r
all_slides = pytest.mark.parametrize("name", [name for name in SLIDES if name != "jams"])
GRIPS, SLIDING = 0, 1


def simulate(library: Library, scene: Scene, times, tolerance: float | None = 1e-10, **changes: float) -> Run:
    return library.simulate(times, tolerance, scene.inputs, **{**scene.start, **changes})


def straight(library: Library, times, inputs: Schedule | None = None, **start: float) -> Run:
    """Upright, heading along X, at 1e-11."""
    return library.simulate(times, 1e-11, inputs, **{**UPRIGHT, **ROAD, **start})


# ---- a steady circle ----


def test_a_steady_circle_slides_outwards_where_the_road_gives_less_than_psi_dot_v_over_g(library: Library) -> None:
    theta, psi_dot = 1.2, 1.5
    start = start_values(PAPER, circle(PAPER, theta, psi_dot))
    free = library.simulate([0.0], **start)
    needed = psi_dot * float(np.hypot(free["X_O_dot"], free["Y_O_dot"])[0]) / PAPER.g

    def after(share: float) -> Run:
        mu = needed * share
        return library.simulate([0.0, 0.05, 3.0], 1e-10, mu_max=mu, mu_slide=0.99 * mu, **start)

    slides, grips = after(1 - 1e-6), after(1 + 1e-6)
    assert slides["contact_mode"][:2].tolist() == [SLIDING] * 2 and not grips["contact_mode"].any()
    assert slides["slip_y"][1] * slides["lambda_y"][0] < 0  # off the force that pulls inwards
    within(absolute_error(grips["theta"], theta), 64 * EPSILON, "lean of the wheel that grips, rad")
    beyond(absolute_error(slides["theta"], theta), 1e-3, "lean of the wheel that slides, rad")


# ---- balances ----


@all_slides
def test_the_road_pushes_against_the_slip_with_mu_slide_N_or_holds_with_at_most_mu_max_N(library, name: str) -> None:
    scene = SLIDES[name]
    run = simulate(library, scene, np.linspace(0, scene.duration, 401))
    slides, N = run["contact_mode"] == SLIDING, run["lambda_3"]
    slip, force = (np.array([run[f"{what}_x"], run[f"{what}_y"]]) for what in ("slip", "lambda"))
    speed = np.hypot(*slip)
    assert slides.any() and set(run["contact_mode"]) <= {0, 1}
    assert (speed[~slides] == 0).all() and (speed[slides] > 0).sum() >= slides.sum() - 1  # the instant of the loss
    off = force[:, slides] * speed[slides] + scene.road.mu_slide * np.maximum(N, 0)[slides] * slip[:, slides]
    within(np.abs(off / N[slides]).max(), 128 * EPSILON, "force off friction, times slip over N, m/s")
    within((run["mu_required"][~slides] / scene.road.mu_max).max(initial=0.0), 1 + 1e-8, "mu_required over mu_max")


# ---- the independent reference ----


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8, 1e-10])
def test_a_slip_begins_with_less_than_a_fiftieth_of_the_tolerance(library: Library, tolerance: float) -> None:
    """In m/s: what it is taken to be before the first step, to have a direction."""
    with library.wheel() as wheel:
        slip = wheel.start(tolerance=tolerance, mu_max=0.1, mu_slide=0.1).get("slip_x", "slip_y")
    beyond(hypot(*slip), 0.0, "first slip, m/s")
    within(hypot(*slip), 0.02 * tolerance, "first slip, m/s")


def moments(scene: Scene) -> list[tuple[float, int]]:
    """Loss and return of grip by the reference, after the start."""
    return scene.solved().contacts[1:]


def modes_missed(library: Library, scene: Scene, width: float, shift: float = 0.0, **changes: float) -> int:
    """How many readings just before and after a transition (shifted) show another mode than the reference."""
    events = moments(scene)
    before = [scene.solved([0.0]).contacts[0][1], *(mode for _, mode in events[:-1])]
    times = [0.0, *(t + shift + side * width for t, _ in events for side in (-1, 1)), scene.duration]
    found = simulate(library, scene, times, 1e-11, **changes)["contact_mode"][1:-1]
    return int(sum(found[::2] != before) + sum(found[1::2] != [mode for _, mode in events]))


@pytest.mark.parametrize("name", [n for n in SLIDES if n not in ("jams", "turns at once", "locked, leaning")])
def test_grip_is_lost_and_regained_at_the_references_instants(library: Library, name: str) -> None:
    scene = SLIDES[name]
    assert len(moments(scene)) > 0
    assert modes_missed(library, scene, 1e-7) == 0
    assert modes_missed(library, scene, 1e-7, shift=1e-5) == len(moments(scene))
    assert modes_missed(library, scene, 1e-7, mu_slide=scene.road.mu_slide * 0.999) > 0 or name == "locked"


def test_random_wheels_on_random_roads_follow_the_reference(library: Library) -> None:
    """Every output of 0.6 s, over the growth of a relative change of 1e-9 of the spin at the start."""
    random, worst, judged, transitions = np.random.default_rng(46), 0.0, 0, 0
    times = np.linspace(0, 0.6, 21)
    for _ in range(12):
        scene = random_slide(random)
        want, got = scene.solved(times), simulate(library, scene, times, 1e-11)
        assert bool(want.ended) == (got.end is not None), (scene, got.ended)
        moved = {"phi_dot_start": scene.start["phi_dot_start"] * (1 + 1e-9)}
        exact, near = simulate(library, scene, times, 1e-13), simulate(library, scene, times, 1e-13, **moved)
        if want.ended or near.end is not None or near.counters["n_events"] != exact.counters["n_events"]:
            continue
        grown = kind_errors(near.columns, exact.columns)
        off = kind_errors(got.columns, want.columns)
        worst = max(worst, *(off[kind] / max(1.0, grown[kind] / 1e-9) for kind in off))
        judged, transitions = judged + 1, transitions + len(want.contacts) - 1
    assert judged >= 6 and transitions >= 7, (judged, transitions)
    within(worst, 1e-10, "error over growth, relative")


# ---- cost ----


@pytest.mark.parametrize("mu_slide", [0.45, 0.44, 0.4])
def test_a_slide_costs_some_tens_of_steps_and_the_rest_what_it_costs_without(library: Library, mu_slide: float) -> None:
    stepped = library.simulate([0.0, 10.0], method=4).counters
    run = library.simulate(np.linspace(0, 10, 2001), mu_max=0.45, mu_slide=mu_slide)
    slides = int((np.diff(run["contact_mode"]) == 1).sum())
    assert slides > 0
    within((run.counters["n_steps"] - stepped["n_steps"]) / slides, 80, "steps more than without, per slide")
    within(run.counters["n_rhs"] / stepped["n_rhs"], 2, "evaluations over those without")


# ---- endings ----


def test_friction_jams_a_wheel_that_it_rights_and_the_run_ends_there(library: Library) -> None:
    scene = SLIDES["jams"]
    ended = scene.solved([0.0, scene.duration]).ended
    assert ended and ended.kind == "jams"
    run = simulate(library, scene, [0.0, scene.duration])
    assert run.end is not None and "jam" in str(run.ended)
    within(abs(run.end - ended.time), 1e-6, "instant of the jam, s")  # N grows without bound there
    light = simulate(library, scene, [0.0, scene.duration], mu_slide=0.4, mu_max=0.4)  # below 2 sqrt(0.05 * 1.05)
    assert light.end is None


@pytest.mark.parametrize(("kind", "start"), [
    ("lift", {"theta_start": 0.4, "theta_dot_start": 7.0, "phi_dot_start": 0.0, "slip_y_start": 3.0, "mu_max": 0.3}),
    ("flat", {"theta_start": 1.2, "phi_dot_start": 0.0, "mu_max": 0.3}),
])  # fmt: skip
def test_a_sliding_wheel_lifts_off_and_lies_flat_at_the_references_instants(library, kind, start) -> None:
    scene = Scene({**start, "mu_slide": 0.3}, 3.0)
    ended = scene.solved([0.0, 3.0], flat=float(np.sin(1e-7))).ended
    assert ended and ended.kind.startswith(kind)
    run = simulate(library, scene, [0.0, 3.0])
    assert run.end is not None and kind in str(run.ended).replace("-", " ").lower()
    assert run["contact_mode"][-1] == SLIDING
    within(abs(run.end - ended.time), 1e-8, "instant of the ending, s")
    rolling = library.simulate([0.0, 3.0], 1e-10, **{k: v for k, v in start.items() if k[:2] not in ("mu", "sl")})
    beyond(abs((rolling.end or 3.0) - ended.time), 1e-4, "instant of the wheel that rolls, s")


def test_inputs_that_change_at_every_step_of_a_slide_cost_a_short_step_each(library: Library) -> None:
    def evaluations_per_change(every: float) -> float:
        changes = 50
        with library.wheel() as wheel:
            wheel.start(**{**ROAD, "theta_start": 1.4, "phi_dot_start": -20.0, "slip_x_start": 9.0})
            for k in range(changes):
                assert wheel.set(M_brake=5.0 + k % 2) == OK and wheel.step_to(every * (k + 1)) == OK
            count, mode = wheel.get("n_rhs", "contact_mode")
        assert mode == SLIDING
        return count / changes

    within(evaluations_per_change(1e-3), 40, "evaluations at each step of 1 ms")
    beyond(evaluations_per_change(2e-2), 40, "evaluations at each step of 20 ms")


# ---- hard scenes ----


def test_a_start_in_which_the_wheel_jams_is_rejected_and_has_no_forces(library: Library, formulation: int) -> None:
    """With the slip that is set, and with that which the loads begin; without a jam the ground presses."""
    jams = {"J_x": 0.1, "J_y": 0.1, "J_z": 0.1, "theta_start": 1.0, "slip_y_start": -0.5, "formulation": formulation}

    def begin(mu: float) -> tuple[int, float, str]:
        with library.wheel() as wheel:
            wheel.initializing(**jams, mu_max=mu, mu_slide=mu)
            status, N = wheel.get_one("lambda_3")
            assert wheel.exitInitializationMode() == (OK if status == OK else ERROR)
            return status, N, "".join({*wheel.texts()})

    for mu in (5.0, 2.0):
        status, _, said = begin(mu)
        assert status == DISCARD
        assert said == f"At the start the wheel jams (Painleve's paradox) with mu_slide = {mu:.0f}: the run ends there."
    status, N, said = begin(0.5)
    assert (status, said) == (OK, "") and N > 0


@pytest.mark.parametrize("theta", [1.2, 2.0])
def test_a_wheel_that_full_grip_alone_would_hold_down_slides_off_a_road_that_has_less(library: Library, theta) -> None:
    """Without friction N < 0; the force that would keep it needs mu_max = 0.58 or 0.65."""
    light = {"J_x": 0.06, "J_y": 0.06, "J_z": 0.06, "psi_dot_start": 0.0, "phi_dot_start": 0.0, "theta_start": theta}
    for mu, mode in ((0.3, SLIDING), (0.7, GRIPS)):
        with library.wheel() as wheel:
            wheel.start(**light, F_Z=60.0, M_1=10.0 * np.sign(theta - pi / 2), mu_max=mu, mu_slide=mu)
            N, *found = wheel.get("lambda_3", "contact_mode")
            assert found == [mode] and (N > 0) == (mode == GRIPS)
            assert wheel.step(1e-3) == (OK if mode == GRIPS else DISCARD)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-8, 1e-12])
def test_a_jam_is_the_same_at_every_tolerance(library: Library, tolerance: float, formulation: int) -> None:
    """Friction of 4 against a fast slip across: the normal force grows as the inverse root of the time left."""
    scene = Scene({"mu_max": 5.0, "mu_slide": 4.0, "theta_start": 2.0, "slip_y_start": -10.0}, 0.4)
    ended = scene.solved([0.0, 0.4]).ended
    run = simulate(library, scene, [0.0, 0.4], tolerance, formulation=formulation)
    assert ended and ended.kind == "jams" and run.end is not None and "jam" in str(run.ended)
    within(abs(run.end - ended.time), 3e-3 * tolerance + 4096 * EPSILON, "instant of the jam, s")
    other = simulate(library, scene, [0.0, 0.4], mu_slide=4.04).end or 0
    beyond(abs(other - ended.time), 1e-4, "instant with 1 % more friction, s")


JAMMED = {"m": 36.2086, "r_0": 0.51346, "r": 0.06985, "J_x": 0.55723, "J_y": 0.1178, "J_z": 0.5408, "s": 0.02171}
JAMMED |= {"mu_max": 0.65776, "mu_slide": 0.60235, "psi_start": 1.18405, "theta_start": 1.36486, "phi_start": -1.24074}
JAMMED |= {"psi_dot_start": 1.6849, "theta_dot_start": 0.78322, "phi_dot_start": -63.15283}


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8, 1e-10])
def test_a_slide_that_cannot_but_begin_in_a_jam_ends_there(
    library: Library, tolerance: float, formulation: int
) -> None:
    """Without friction the ground would pull: N > 0 alone does not show the jam."""
    scene = Scene(JAMMED, 0.05, Schedule(((0.0, {"M_1": 10.2}),)))
    run = simulate(library, scene, [0.0, 0.05], tolerance, formulation=formulation)
    assert run.end is not None and "jams" in str(run.ended)
    within(abs(run.end - 0.0212237586), 1e-3 * tolerance + 1e-10, "instant of the jam, s")


STOPPING = {"m": 11.17, "r_0": 0.4524, "r": 0.0, "J_x": 0.447, "J_y": 0.7382, "J_z": 0.5485, "s": 0.009347}
STOPPING |= {"mu_max": 3.085, "mu_slide": 2.537, "psi_start": -2.477, "theta_start": 1.297, "phi_start": -0.5887}
STOPPING |= {"psi_dot_start": 3.205, "theta_dot_start": -0.7487, "phi_dot_start": 11.91}
STOPPING |= {"slip_x_start": -3.618, "slip_y_start": 3.002}


@pytest.mark.parametrize("tolerance", [1e-10, 1e-12])
def test_a_jam_where_a_slip_is_about_to_end_is_a_jam(library: Library, tolerance: float, formulation: int) -> None:
    """The slip falls below a millionth of its first size while the normal force grows without bound."""
    scene = Scene(STOPPING, 0.2, Schedule(((0.0, {"M_1": 0.582, "F_X": 2.48}),)))
    ended = scene.solved([0.0, 0.2]).ended
    run = simulate(library, scene, [0.0, 0.2], tolerance, formulation=formulation)
    assert ended and ended.kind == "jams" and run.end is not None and "jams" in str(run.ended)
    within(abs(run.end - ended.time), 1e-9, "instant of the jam, s")
    other = simulate(library, scene, [0.0, 0.2], tolerance, formulation=formulation, mu_slide=2.4)
    beyond(abs((other.end or 0.2) - ended.time), 1e-6, "instant with less friction, s")


def test_a_slip_that_falls_at_forty_times_g_ends_at_the_references_instants(library: Library) -> None:
    rod = {"J_x": 0.02, "J_y": 0.01, "J_z": 0.01, "s": 0.02, "mu_max": 0.33, "mu_slide": 0.3}
    turn = {"theta_start": 1.6, "phi_start": -2.0, "theta_dot_start": 1.0, "phi_dot_start": 2.0}
    scene = Scene({**rod, **turn}, 0.493)
    assert len(moments(scene)) > 10
    assert modes_missed(library, scene, 1e-7) == 0
    assert modes_missed(library, scene, 1e-7, shift=1e-5) > 0


ROADS = [{"mu_max": 0.1}, {"mu_max": 0.45}, {"mu_max": 0.2, "mu_slide": 0.15}, {"slope": 0.3}, {"slope_direction": pi}]


def test_a_locked_wheel_slides_over_roads_that_change_with_the_deceleration_of_each(library: Library) -> None:
    """g (mu cos a + sin a): mu_max set below mu_slide counts for both."""
    with library.wheel() as wheel:
        wheel.start(**{**UPRIGHT, **ROAD, "slip_x_start": 7.0, "M_brake": 1e3})
        speeds = [7.0]
        for k, road in enumerate([*ROADS, {}]):
            wheel.to(0.2 * (k + 1))
            speeds += wheel.get("X_O_dot")
            wheel.put(**road)
        assert wheel.get("contact_mode") == [SLIDING]
    slowing = -np.diff(speeds) / 0.2 / PAPER.g
    hill = [0.15 * cos(0.3) + sin(0.3), 0.15 * cos(0.3) - sin(0.3)]
    within(absolute_error(slowing, [0.4, 0.1, 0.4, 0.15, *hill]), 4096 * EPSILON, "deceleration over g")


def test_a_slip_that_begins_where_the_ground_pulls_keeps_its_direction(library: Library, formulation: int) -> None:
    """Without a force of the road it begins along the acceleration of the contact."""
    fast = {"theta_start": 2.0, "psi_dot_start": -3.0, "theta_dot_start": 14.0, "phi_dot_start": 15.5}
    with library.wheel(logging=True) as wheel:
        wheel.start(keep_contact=True, formulation=formulation, mu_max=1.0, mu_slide=0.36, **fast).to(0.01)
        assert [text.split(": ")[1].split(", and")[0] for text in wheel.texts()] == [
            "the wheel starts to slide.",
            "the road pulls",
        ]


@pytest.mark.parametrize("when", ["initializing", "at the start", "by parameters"])
def test_a_loss_of_grip_at_the_start_is_logged_and_counted_once(library: Library, when: str) -> None:
    with library.wheel(logging=True) as wheel:
        if when == "by parameters":  # a swing that needs more than a tenth
            wheel.start(mu_max=0.1, mu_slide=0.1)
        else:
            wheel.initializing(**{**UPRIGHT, **ROAD})
            assert when == "initializing" or wheel.exitInitializationMode() == OK
            wheel.put(M_3=-80.0).get("lambda_3")
            assert when != "initializing" or wheel.exitInitializationMode() == OK
        assert wheel.by(0.01).texts() == ["t = 0 s: the wheel starts to slide."]
        assert wheel.get("n_events", "contact_mode") == [1, SLIDING]


def test_a_start_with_slip_is_no_loss_of_grip(library: Library) -> None:
    with library.wheel(logging=True) as wheel:
        wheel.start(**ROAD, slip_x_start=1.0).by(0.01)
        assert wheel.texts() == [] and wheel.get("n_events", "contact_mode") == [0, SLIDING]
