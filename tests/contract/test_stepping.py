"""Communication points: the master's grid changes no bit of the result; times carry rounding; nonsense is refused."""

from itertools import pairwise

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu.driver import COUNTERS, ERROR, OK, FMU2Wheel
from wheelfmu.truth.scenes import AT_REST, KINDS, PULLED, SCENES
from wheelfmu.truth.sliding import ROAD, SLIDES, THROWN

SECONDS = [float(t) for t in range(1, 11)]
SCENES_AND_SLIDES = KINDS | {name: SLIDES[name].start for name in ("thrown", "thin disc", "regularized")}


@pytest.mark.parametrize("scene", KINDS)
def test_the_communication_grid_changes_no_bit(wheel, scene):
    """1 s steps, 1000 even steps, steps of random length and one step of 10 s: equal wherever they meet."""
    values = KINDS[scene]
    coarse = wheel().start(**values).run(SECONDS)
    even = wheel().start(**values).run(np.arange(1, 1001) * 0.01)
    ticks = np.random.default_rng(11).choice(10 * 2**20, 300, replace=False)
    uneven_times = np.union1d(ticks / 2**20, SECONDS)
    uneven = dict(zip(uneven_times, wheel().start(**values).run(uneven_times), strict=True))
    assert even[99::100] == coarse
    assert [uneven[t] for t in SECONDS] == coarse
    assert wheel().start(**values).run([10.0]) == coarse[-1:]
    assert wheel().start(tolerance=1.0000001e-8, **values).run(SECONDS)[-1] != coarse[-1]  # the partner


def test_steps_of_no_length_of_a_nanosecond_and_of_an_hour_change_no_bit(wheel):
    def end(*times: float) -> bytes:
        return wheel().start(s=0.03).run(times)[-1]

    once = end(10.0)
    assert end(*np.sort([*10 * np.linspace(0, 1, 77) ** 2, 5.0, 5.0])) == once
    assert end(*1e-6 * np.arange(1001), 10.0) == end(*(5.0 + 1e-9 * np.arange(20001)), 10.0) == once
    assert end(3600.0) == end(*np.arange(1.0, 3601.0)) != once


@pytest.mark.parametrize("values", [{}, {"s": 0.03}], ids=["free", "friction"])
def test_a_step_of_no_length_at_the_start_sets_nothing_in_motion(wheel, values):
    w = wheel().start(**values)
    before, state = w.get(*COUNTERS), w.serialized()
    assert w.by(0.0).get(*COUNTERS) == before and w.serialized() == state
    assert w.by(1e-3).get(*COUNTERS) != before  # the partner


def test_a_tolerance_and_a_stop_time_that_are_not_defined_count_for_nothing_whatever_they_are(wheel):
    ends = []
    for defined, tolerance, stop in ((0, 0.0, 0.0), (0, 1e-3, 0.5), (0, -1.0, np.nan), (1, 1e-3, 2.0)):
        w = wheel()
        assert w.ask("SetupExperiment", defined, tolerance, 0.0, defined, stop) == OK
        assert w.enterInitializationMode() == w.exitInitializationMode() == OK
        ends.append(w.to(1.0).bits())
    assert ends[0] == ends[1] == ends[2] != ends[3]


def test_of_several_experiments_that_are_set_up_the_last_alone_counts(wheel):
    """Nothing is left of a tolerance, a start or a stop time that it does not define."""
    found = []
    for first in ((), (1e-5, 3.0, 4.0)):
        w = wheel()
        assert not first or w.setupExperiment(*first) == OK
        found.append(w.start(formulation=2).run([0.5, 5.0]))
    assert found[0] == found[1]
    w = wheel()
    assert w.start(tolerance=1e-5, stop=5.0, formulation=2).run([0.5, 5.0]) != found[0]  # the partner


@pytest.mark.parametrize("values", [{}, {"s": 0.02}, {"formulation": 3}], ids=["free", "friction", "multibody"])
def test_what_is_read_between_two_changes_is_seen_in_no_counter(wheel, values):
    """Two changes 0.02 s apart: the step after the second is 0.02 s long, and a fine grid reads inside it."""

    def run(points: int) -> bytes:
        w = wheel().start(**values)
        for end, torque in ((0.5, 0.3), (0.52, 0.2), (1.0, 0.0)):
            w.to(*np.linspace(w.time, end, points + 1)[1:]).put(M_3=torque)
        return w.bits()

    assert run(1) == run(7) == run(100)


def test_steps_with_rounding_in_them_are_taken(wheel):
    """h = t_next - t as masters compute it, 0.09999999999999998 among them, up to a defined stop time."""
    times = np.arange(101) * 0.1
    steps = np.diff(times)
    assert 0.09999999999999998 in steps
    w, summing = wheel().start(stop=10.0), wheel().start(stop=10.0)
    for t, h in zip(times, steps, strict=False):
        assert w.ask("DoStep", t, h, 1) == OK
        summing.by(0.1)  # t += 0.1 ends at 9.99999999999998
    (exact,) = wheel().start().run([10.0])
    theta = np.frombuffer(exact, count=2)[1]
    within(abs(w.get("theta")[0] - theta), 64 * EPSILON, "theta, rad")
    assert summing.get("theta")[0] != theta  # the time is another
    within(abs(summing.get("theta")[0] - theta), 512 * EPSILON, "theta at the sum of the steps, rad")  # 2e-14 s early


def instants(w: FMU2Wheel) -> np.ndarray:
    return np.array([float(text.split()[2]) for text in w.sentences if text.startswith("t = ")])


@pytest.mark.parametrize("scene", SCENES_AND_SLIDES)
@pytest.mark.parametrize("start", [-1e9, 1e9])
def test_a_start_time_of_a_billion_seconds_costs_no_bit(wheel, scene, start):
    """Nor do logged instants move, but for their rounding."""
    times, values = np.arange(1, 17) * 0.125, SCENES_AND_SLIDES[scene]
    late, early = wheel(logging=True).start(start=start, **values), wheel(logging=True).start(**values)
    assert late.run(start + times) == early.run(times)
    assert len(instants(late)) == len(instants(early))
    within(np.abs(instants(late) - start - instants(early)).max(initial=0), 2.5e-7, "instants apart, s")
    assert late.ask("DoStep", start + 1.875, 0.125, 1) == ERROR  # the partner: a repeated step is noticed
    assert "the FMU has reached" in late.sentences[-1]


NO_SENSE = [(t, h, "times must be finite") for t, h in ((0.5, -0.1), (0.5, np.nan), (np.nan, 0.1), (0.5, np.inf))]


@pytest.mark.parametrize(("t", "h", "why"), NO_SENSE)
def test_times_that_make_no_sense_are_refused_and_nothing_changes(wheel, t, h, why):
    w, other = (wheel().start().by(0.5) for _ in range(2))
    assert w.ask("DoStep", t, h, 1) == ERROR
    logged = w.said()
    assert why in logged and logged.startswith("fmi2DoStep ")
    assert w.run([1.0]) == other.run([1.0])
    assert w.ask("DoStep", 1.0 + 1e-14, 0.1, 1) == OK  # the partner: rounding is no fault


@pytest.mark.parametrize("values", [{}, {**ROAD, **THROWN, "M_brake": 5.0}], ids=["rolls", "slides"])
def test_an_input_rewritten_at_its_value_is_no_restart_and_changes_no_bit(wheel, values):
    rewritten, once, jumping = (wheel().start(F_Y=4.0, **values) for _ in range(3))
    for t in np.arange(1, 61) * 0.03125:
        rewritten.put(F_X=0.0, F_Y=4.0, M_3=0.0, s=0.0, M_brake=values.get("M_brake", 0.0))
        assert rewritten.run([t]) == once.run([t])
        jumping.put(F_Y=4.0 + t).to(t)
    assert rewritten.get("n_restarts") == once.get("n_restarts")
    beyond(jumping.get("n_restarts")[0], 58, "restarts")  # the first value is that of the start


def test_the_hint_about_rollback_changes_no_bit(wheel):
    w, other = wheel().start(s=0.03), wheel().start(s=0.03)
    for k in range(20):
        assert w.ask("DoStep", k / 8, 0.125, 0) == other.ask("DoStep", k / 8, 0.125, 1) == OK
    assert w.bits() == other.bits()


# Start, an instant on the way, and whether the ground pulls there.
FREE = [({}, 0.5, False), ({"keep_contact": True}, 0.5, False), (PULLED, 0.1, False), (PULLED, 0.22, True)]


def test_each_change_and_each_transition_counts_as_one_restart(wheel):
    """Of a wheel that is unfolded, the change that ends this is the first, also where the ground may pull, or pulls."""
    for values, t, pulls in FREE:
        w = wheel().start(**values).to(t)
        assert (w.get("lambda_3")[0] < 0) == pulls
        for k in range(4):
            assert w.get("n_restarts", "n_events") == [k, 0]
            w.put(F_X=1.0 + k, s=1e-3).by(1e-3)
    for values in ({"s": 0.03}, {"mu_max": 0.45, "mu_slide": 0.4}, {"s": 0.03, "mu_max": 0.45, "mu_slide": 0.4}):
        w = wheel(logging=True).start(**values).to(2.0)
        restarts, events = w.get("n_restarts", "n_events")
        assert restarts == events == len(w.texts()) > 2


def test_counters_count_on_through_restarts(wheel):
    w = wheel().start(s=0.03)
    counts = np.array([w.to(t).get(*COUNTERS) for t in SECONDS])
    assert (np.diff(counts, axis=0) >= 0).all()
    assert w.reset() == OK
    assert w.start().get(*COUNTERS) == [0] * 6


# What a scene does not need is not done; what each omission saves is in docs/results/speed.md. Each statement has a
# partner in which the thing is asked for and the same counter moves.
REGULARIZED = {"s": 0.03, "friction_law": 2}
SMOOTH = {name: SCENES[name].start for name in ("free", "fast rolling", "near flat", "general inertia")}


@pytest.fixture
def counters(wheel):
    """counters(step, stop, **start values) -> the counters at the stop time."""

    def run(step: float = 0.1, stop: float = 2.0, **values) -> dict[str, float]:
        w = wheel().start(**values).to(*np.arange(1, round(stop / step) + 1) * step)
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


@pytest.mark.parametrize("values", [*SMOOTH.values(), {"s": 0.03}], ids=[*SMOOTH, "friction"])
def test_the_smooth_method_needs_no_jacobian_and_only_a_regularized_law_gets_one_by_itself(counters, values):
    assert counters(**{**values, "method": 2})["n_jac"] == 0 < counters(**{**values, "method": 3})["n_jac"]
    assert counters(**values)["n_jac"] == 0 < counters(**REGULARIZED)["n_jac"]


def test_each_start_of_bdf_counts_a_jacobian(wheel):
    """Each load that jumps starts it anew."""
    w, counts = wheel().start(s=0.03, method=3), []
    for k in range(8):
        counts.append(w.put(M_3=0.1 * k).by(0.1).get("n_jac", "n_restarts"))
    assert min(later[0] - before[0] for before, later in pairwise(counts)) > 0
    assert [later[1] - before[1] for before, later in pairwise(counts)] == [1] * 7  # the partner: they are starts


def test_a_wheel_that_leaves_the_layer_in_which_it_rested_needs_no_jacobian_any_more(wheel):
    w = wheel().start(**AT_REST, s=0.03, friction_law=2, omega_s=1e-3).by(1.0)
    (resting,) = w.get("n_jac")
    (left,) = w.put(M_3=50.0).by(0.5).get("n_jac")
    assert (w.by(2.0).get("n_jac"), resting > 0) == ([left], True)


def test_only_cvode_starts_anew_at_each_communication_point_of_a_course_and_counts_it(wheel):
    found = []
    for method in (2, 3, 4):
        w, counts = wheel().start(method=method), []
        for k in range(8):
            w.give({"M_3": (0.1, 0.3, -0.2)}, since=0.1 * k).by(0.1)
            counts.append(w.get("n_restarts")[0])
        found.append([later - before for before, later in pairwise(counts)])
    assert found == [[1] * 7, [1] * 7, [0] * 7]


def test_a_step_that_ends_at_a_jump_of_a_varying_input_evaluates_nothing_beyond_its_stages(wheel):
    """DOP853 has twelve; the rate at the end of a step is the first of the next only where nothing changes."""
    w, counts = wheel().start(method=4), []
    for k in range(20):
        counts.append(w.give({"M_3": (0.1 * k, 0.3)}).by(0.01).get("n_steps", "n_rhs"))
    steps, evaluations = np.diff(counts, axis=0)[2:].T
    assert (steps == 1).all() and (evaluations == 12).all()


def test_a_step_is_a_little_longer_to_end_at_a_communication_point_and_one_cut_short_shortens_no_other(wheel):
    """Of a load that goes on. No step is longer than 0.6 time scales, but by up to a hundredth."""
    w = wheel().start(guided=True, psi_start=0.0, theta_start=np.pi / 2, phi_dot_start=-20.0)
    longest, counts = 0.6 * (0.35 / 9.81) ** 0.5, []
    for h in (*[1.005] * 8, 1e-3, 1.005, 1.005, 1.015):
        w.give({"F_X": (5.0, 1.0)}, since=w.time).by(h * longest)
        counts.append(w.get("n_steps")[0])
    assert np.diff(counts)[5:].tolist() == [1, 1, 1, 1, 1, 2]


@pytest.mark.parametrize("moments", [{"J_x": 0.7, "J_y": 1.2}, {"J_x": 0.9, "J_y": 0.9}], ids=["any J", "J_x = J_y"])
def test_the_large_system_is_left_out_whatever_the_moments_of_inertia_are(counters, moments):
    automatic, reduced, multibody = (counters(**moments, s=0.03, formulation=k) for k in (1, 2, 3))
    assert automatic == reduced
    within(abs(multibody["n_rhs"] / reduced["n_rhs"] - 1), 0.1, "evaluations of the two forms apart, relative")


def test_the_large_system_gives_other_last_bits(wheel):
    """The partner: the two forms are two sets of equations."""
    automatic, reduced, multibody = (wheel().start(s=0.03, formulation=k).to(2.0).get("phi_dot") for k in (1, 2, 3))
    assert automatic == reduced != multibody


def test_the_free_wheel_is_integrated_over_one_nutation_only(counters):
    unfolded, stepped = counters(stop=10.0), counters(stop=10.0, formulation=2)
    assert counters(stop=1000.0, step=100.0) == unfolded
    within(unfolded["n_rhs"] / stepped["n_rhs"], 0.2, "evaluations over those of the stepped wheel")
    assert unfolded["n_steps"] > 0  # one nutation is counted
