"""Histories of the solver alone: restored they go on with the same bits; what could not have been saved is refused."""

import struct
from math import inf, isnan, nan

import pytest
from solving import STEPPED
from support.bounds import within

WORDS = [struct.pack("<Q", k) for k in (0, 1, 2, 13, 1 << 20, 2**64 - 1, 1 << 63, 1 << 62)]
WORDS += [struct.pack("<d", x) for x in (-1.0, 1e-300, 1e300, 1e-3, inf, -inf, nan)]
TIME_KNOWN = 3 * 8  # the place of that number in a history


@pytest.fixture
def watched(solver, method):
    """watched(steps) -> a solver after so many steps, with something to watch."""

    def make(steps=0):
        made = solver(method, "stiff", 3.0, each_step=lambda t, y: y[0] + 10)
        made.run(inf, steps)
        return made

    return make


def seen(one, steps):
    """What each step does: its kind, the time known, the state halfway, evaluations."""
    rows = []
    for _ in range(steps):
        outcome, now = one.step(), one.now
        rows.append((outcome, now.known, one.read(0.5 * (now.begin + now.known)), now.rhs, now.roots))
    return rows


@pytest.mark.parametrize("steps", [0, 1, 2, 7, 60, 300])
def test_a_restored_solver_goes_on_with_the_same_bits(watched, steps):
    original, copy, once_more = watched(steps), watched(), watched()
    history = original.save()
    assert copy.restore(history) and copy.save() == history
    t = original.now.begin + 0.3 * (original.now.known - original.now.begin)
    assert original.read(t) == copy.read(t)
    assert seen(original, 200) == seen(copy, 200)
    assert once_more.restore(history) and copy.restore(history)  # back to the past, in a solver that has gone on
    assert seen(once_more, 100) == seen(copy, 100)


def test_a_history_is_small(watched):
    within(len(watched(60).save()), 4096, "bytes")


def test_forged_histories_are_refused_or_harmless(watched):
    """Each word replaced by integers and doubles of every kind; those that are taken could have been saved.

    A solver that has refused a history starts as a new one does.
    """
    history, usual = watched(60).save(), seen(watched(), 3)
    tried = taken = stepped = 0
    for place in range(0, len(history), 8):
        for word in WORDS:
            forged = history[:place] + word + history[place + 8 :]
            if forged == history:
                continue
            tried, victim = tried + 1, watched()
            if not victim.restore(forged):
                victim.start()
                assert seen(victim, 3) == usual
                continue
            assert not isnan(struct.unpack("<d", word)[0])
            taken += 1
            stepped += sum(victim.step() == STEPPED for _ in range(20))
            victim.read(victim.now.known)
    within(taken / tried, 0.65, "taken")  # other states, counts and sizes are possible
    assert stepped > 0


def test_half_a_step_and_a_part_of_a_history_are_refused(watched):
    original = watched(60)
    history, half = original.save(), struct.pack("<d", 0.5 * (original.now.begin + original.now.known))
    assert not watched().restore(history[:TIME_KNOWN] + half + history[TIME_KNOWN + 8 :])
    assert not any(watched().restore(history[:size]) for size in range(0, len(history), 8))
