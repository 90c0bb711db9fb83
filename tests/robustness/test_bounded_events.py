"""No call works for ever: transitions that come thick and fast, enormous loads, a million internal steps."""

import re
from math import pi
from random import Random
from time import process_time

import numpy as np
import pytest
from support.bounds import beyond, within
from support.playing import play

from wheelfmu.fmu.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK
from wheelfmu.truth.scenes import FORCED
from wheelfmu.truth.sliding import THROWN

SOON = 5.0  # s of computing, many times what is needed: a scene that chatters takes for ever
RISE = [(0.0, {"F_Z": (0.0, 4000.0)}), (0.1, {"F_Z": (400.0, -4000.0)}), (0.2, {"F_Z": (0.0,)})]


def played(wheel, kind, pieces, stop, **values):
    """Status, instant, states and number of transitions at the end."""
    w = wheel().start(**kind, **values)
    begin = process_time()
    status = play(w, pieces, stop, np.linspace(0, stop, 12))
    assert process_time() - begin < SOON, w.sentences
    assert status in (OK, DISCARD), w.sentences
    states = np.array(w.get("X_O", "Y_O", "theta", "psi_dot", "omega_z"))
    done = status, w.status(LAST_SUCCESSFUL_TIME), states, w.get("n_events")[0]
    w.close()
    return done


def agree(a, b, bound):
    return a[0] == b[0] and abs(a[1] - b[1]) < bound and np.max(np.abs(a[2] - b[2])) < bound


@pytest.mark.parametrize("s", [0.05, 1e-6, 1e-12, 1e-15])
def test_a_normal_force_that_rises_through_zero_makes_no_chatter(wheel, kind, s):
    """keep_contact; where N is next to nothing, s N is below the rounding of the moment that holds the wheel."""
    for spin in (0.0, 0.01):
        other_way = {"formulation": 5 - kind["formulation"], "method": 4}
        start = {"theta_start": 1.4, "phi_dot_start": spin, "s": s, "keep_contact": True}
        found, other = (played(wheel, k, RISE, 0.5, **start) for k in (kind, other_way))
        assert found[3] <= 6 and agree(found, other, 1e-6)
        assert not agree(found, played(wheel, kind, RISE, 0.5, **start | {"theta_start": 1.4001}), 1e-6)


@pytest.mark.parametrize("torque", [1e-9, 1e-3, 1.0])
def test_a_brake_that_is_put_on_from_zero_stops_the_wheel_once(wheel, kind, torque):
    """The torque turns the wheel until the brake, M_brake = 90 t, has overcome it: for 2e-11 s at the least torque."""
    pieces = [(0.0, {"M_brake": (0.0, 90.0), "M_3": (torque,)})]
    found = played(wheel, kind, pieces, 1.0, theta_start=pi / 2, phi_dot_start=0.0)
    assert (found[0], found[2][4], found[3]) == (OK, 0, 1)
    free = played(wheel, kind, [(0.0, {"M_3": (torque,)})], 1.0, theta_start=pi / 2, phi_dot_start=0.0)
    beyond(abs(free[2][4]), 2e-11, "spin without the brake, rad/s")


def test_a_torque_exactly_at_the_limit_is_held(wheel, kind):
    """s N = M_3 to the rounding of both; the partner, a billionth more, is not held."""
    for s in (0.03, 0.1, 0.123456789):
        limit = s * 20 * 9.81
        held, moved = (
            played(wheel, kind, [(0.0, {"M_3": (m,)})], 1.0, theta_start=pi / 2, phi_dot_start=0.0, s=s)
            for m in (limit, limit * (1 + 1e-9))
        )
        assert held[2][4] == held[3] == 0
        beyond(moved[2][4], 1e-10, "spin under a billionth more, rad/s")


def random_scene(seed):
    r = Random(seed)
    s = r.choice([0.03, 10 ** r.uniform(-15, -0.5), 0.0])
    start = {"theta_start": r.choice([pi / 2, 1.4, r.uniform(0.5, 2.6)])}
    start |= {"phi_dot_start": r.choice([0.0, r.gauss(0, 1)])}
    start |= {"psi_dot_start": r.choice([0.0, r.gauss(0, 1)]), "s": s, "keep_contact": r.random() < 0.6}
    pieces = []
    for k in range(3):
        force, torque = r.choice([0.0, r.uniform(-300, 600)]), r.choice([0.0, s * 196.2, 1e-9, r.gauss(0, 5)])
        rate = r.choice([0.0, r.gauss(0, 4000)])
        brake = (r.choice([0.0, 1e-9, abs(torque)]), r.choice([0.0, 90.0]))
        twist = (torque, r.choice([0.0, r.gauss(0, 20)]))
        pieces.append((0.1 * k, {"F_Z": (force, rate), "M_3": twist, "M_brake": brake}))
    return start, [*pieces, (0.3, {"F_Z": (0.0,), "M_3": (0.0,), "M_brake": (0.0,)})]


@pytest.mark.parametrize("block", range(4))
def test_random_scenes_with_many_transitions_end_soon(wheel, block):
    """500 scenes, by every method and both formulations in turn."""
    for seed in range(125 * block, 125 * (block + 1)):
        start, pieces = random_scene(seed)
        played(wheel, FORCED[seed % len(FORCED)], pieces, 0.6, **start)


SLIDE = {"mu_max": 0.4, "mu_slide": 0.35, **THROWN}
STARTS = [{}, {"s": 0.03}, {"formulation": 3}, {"method": 2, "s": 0.03}, SLIDE, {**SLIDE, "formulation": 3}]
LOADS = [{"M_3": 1e80}, {"F_X": 1e80}, {"F_X": 3e80, "M_1": 1e200}]


@pytest.mark.parametrize("when", [7.0, 7.1])
@pytest.mark.parametrize("load", LOADS, ids=str)
@pytest.mark.parametrize("start", STARTS, ids=str)
def test_a_step_under_an_enormous_load_fails_with_its_reason_and_leaves_the_instance_as_it_was(
    wheel, start, load, when
):
    """Its reactions are those of the inputs that were set before it, not those of the step before."""
    w, again = wheel().start(7.0, keep_contact=True, **start).to(when), wheel()
    saved, before = w.serialized(), w.bits()
    after, bits = w.by(0.05).bits(), w.back(saved).put(**load).bits()
    assert w.step(0.05) == ERROR
    said = r"The solver stopped at t = (\S+) s, where omega_z = \S+ rad/s, in a step .+ slip of \S+ m/s: .+\."
    assert when <= float(re.fullmatch(said, w.texts()[-1])[1]) <= when + 0.05
    assert w.bits() == bits and w.get(*load) == [*load.values()]
    assert bits != before or "mu_max" in start  # a slip and its friction are those of before
    assert w.get("n_steps")[0] < 1.001e6
    assert again.back(w.serialized()).bits() == bits and again.step(0.1) == ERROR  # the error is part of the state
    assert w.back(saved).by(0.05).bits() == after


def test_one_call_takes_at_most_a_million_internal_steps_and_shorter_calls_go_on(wheel):
    w, careful = (wheel().start(phi_dot_start=1e4, s=1e-9) for _ in range(2))
    assert w.step_to(40.0) == ERROR
    assert "may take no more internal steps: a coupling diverges" in w.sentences[-1]
    assert careful.step_to(5.0) == careful.step_to(10.0) == OK
    stopped = float(re.search(r"t = (\S+) s", w.sentences[-1])[1])
    within(abs(careful.get("n_steps")[0] * stopped / 10.0 / 1e6 - 1), 1e-5, "steps until then, off a million, relative")


def test_a_coupling_that_diverges_is_named_with_its_slip(wheel):
    """A damper whose force is that of the velocity one step before, far beyond its limit."""
    w, slips = wheel().start(guided=True, theta_start=pi / 2, mu_max=0.5, mu_slide=0.4), [0.0]
    while w.put(F_X=-3e4 * w.get("X_O_dot")[0] + 300).step(0.01) == OK:
        slips.append(float(np.hypot(*w.get("slip_x", "slip_y"))))
        assert w.time < 5
    assert f"a step that began with a slip of {slips[-1]:.4g} m/s: " in w.sentences[-1] and "coupl" in w.sentences[-1]
    beyond(slips[-1], 1e3, "slip, m/s")


def test_a_step_that_fails_late_leaves_the_instance_as_it_was_and_its_state_can_be_taken(wheel):
    """A call that is asked for more than its share of work gives up thousands of seconds ahead of the last state."""
    w, other = wheel().start(s=0.03, tolerance=1e-4).by(1.0), wheel()
    before, bits = w.serialized(), w.bits()
    assert w.step(1e7) == ERROR and "may take no more internal steps" in w.sentences[-1]
    assert w.bits() == bits  # counters too
    failed = w.serialized()
    assert w.fmi2SetFMUstate(w.component, w.snapshot()) == OK, w.sentences[-1]
    for instance in (w, other):
        assert instance.back(failed).bits() == bits
        assert instance.step(0.1) == ERROR  # the error is part of the state
    assert w.back(before).by(0.5).bits() != bits
