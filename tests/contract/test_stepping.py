"""Communication points: the master's grid changes no bit of the result; times carry rounding; nonsense is refused."""

import numpy as np
import pytest
from support.bounds import EPSILON, within
from support.driver import COUNTERS, ERROR, OK
from support.scenes import KINDS

SECONDS = [float(t) for t in range(1, 11)]


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


@pytest.mark.parametrize("values", [{}, {"s": 0.02}, {"formulation": 3}], ids=["free", "friction", "multibody"])
def test_what_is_read_between_two_changes_is_seen_in_no_counter(wheel, values):
    """Two changes 0.02 s apart: the step after the second is 0.02 s long, and a fine grid reads inside it."""

    def run(points: int) -> bytes:
        w = wheel().start(**values)
        for end, torque in ((0.5, 0.3), (0.52, 0.2), (1.0, 0.0)):
            w.run(np.linspace(w.time, end, points + 1)[1:])
            assert w.set(M_3=torque) == OK
        return w.bits()

    assert run(1) == run(7) == run(100)


def test_steps_with_rounding_in_them_are_taken(wheel):
    """h = t_next - t as masters compute it, 0.09999999999999998 among them, up to a defined stop time."""
    times = np.arange(101) * 0.1
    steps = np.diff(times)
    assert 0.09999999999999998 in steps
    w, summing = wheel().start(stop=10.0), wheel().start(stop=10.0)
    for t, h in zip(times, steps, strict=False):
        assert w.fmi2DoStep(w.component, t, h, 1) == OK
        summing.by(0.1)  # t += 0.1 ends at 9.99999999999998
    (exact,) = wheel().start().run([10.0])
    theta = np.frombuffer(exact, count=2)[1]
    within(abs(w.get("theta")[0] - theta), 64 * EPSILON, "theta")  # rad
    assert summing.get("theta")[0] != theta  # the time is another
    within(abs(summing.get("theta")[0] - theta), 512 * EPSILON, "theta at the sum of the steps")  # 2e-14 s early


def test_a_start_time_of_a_billion_seconds_costs_no_bit(wheel):
    times = np.arange(1, 41) * 0.125
    late = wheel().start(start=1e9, s=0.03)
    assert late.run(1e9 + times) == wheel().start(s=0.03).run(times)
    assert late.fmi2DoStep(late.component, 1e9 + 4.875, 0.125, 1) == ERROR  # the partner: a repeated step is noticed
    assert late.take_messages()[0].text == "fmi2DoStep from 1000000004.875 s: the FMU has reached 1000000005 s."


def test_a_step_of_no_length_changes_nothing(wheel):
    w, other = (wheel().start(s=0.03) for _ in range(2))
    for t in (0.0, 0.7, 1.3):
        before = w.to(t).serialized()
        assert w.by(0.0).serialized() == before
    assert w.run([2.0]) == other.run([2.0])
    assert w.by(1e-9).bits() != other.bits()


def test_no_step_leads_past_the_stop_time(wheel):
    w = wheel().start(stop=1.0).by(0.5)
    before = w.serialized()
    assert (w.step(0.6), w.step(0.5 + 1e-8)) == (ERROR, ERROR)
    assert w.take_messages()[0].text == "fmi2DoStep to 1.1 s: the stop time is 1 s."
    assert w.serialized() == before
    w.by(0.5 + 1e-10)  # a relative rounding of the master's sum
    assert w.step(0.1) == ERROR
    assert wheel().start().step(1.1) == OK


NO_SENSE = [(t, h, "times must be finite") for t, h in ((0.5, -0.1), (0.5, np.nan), (np.nan, 0.1), (0.5, np.inf))]
NO_SENSE += [(t, 0.1, "the FMU has reached 0.5 s") for t in (0.4, 0.5 + 1e-6)]


@pytest.mark.parametrize(("t", "h", "why"), NO_SENSE)
def test_times_that_make_no_sense_are_refused_and_nothing_changes(wheel, t, h, why):
    w, other = (wheel().start().by(0.5) for _ in range(2))
    assert w.fmi2DoStep(w.component, t, h, 1) == ERROR
    (message,) = w.take_messages()
    assert why in message.text and message.text.startswith("fmi2DoStep ")
    assert w.run([1.0]) == other.run([1.0])
    assert w.fmi2DoStep(w.component, 1.0 + 1e-14, 0.1, 1) == OK  # the partner: rounding is no fault


def test_an_input_rewritten_at_its_value_is_no_restart_and_changes_no_bit(wheel):
    rewritten, once, jumping = (wheel().start(F_Y=4.0) for _ in range(3))
    for t in np.arange(1, 101) * 0.03125:
        assert rewritten.set(F_X=0.0, F_Y=4.0, M_3=0.0, s=0.0) == OK
        assert jumping.set(F_Y=4.0 + t) == OK
        assert rewritten.run([t]) == once.run([t])
        jumping.to(t)
    assert rewritten.get("n_restarts") == [0]
    assert jumping.get("n_restarts") == [99]  # the first value is that of the start


def test_the_hint_about_rollback_changes_no_bit(wheel):
    w, other = wheel().start(s=0.03), wheel().start(s=0.03)
    for k in range(20):
        assert w.fmi2DoStep(w.component, k / 8, 0.125, 0) == other.fmi2DoStep(other.component, k / 8, 0.125, 1) == OK
    assert w.bits() == other.bits()


def test_counters_count_on_through_restarts(wheel):
    w, last = wheel().start(s=0.03), [0] * 6
    for t in SECONDS:
        w.run([t])
        now = w.get(*COUNTERS)
        assert all(a >= b for a, b in zip(now, last, strict=True))
        last = now
    assert w.reset() == OK
    assert w.start().get(*COUNTERS) == [0] * 6
