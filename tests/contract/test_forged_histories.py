"""Every word of serialized states changed, the checksum made right again: refused, and nothing changes, or harmless.

A checksum guards against accidents, not against bytes from elsewhere. Run under the sanitizers with the contract tests.
"""

from time import process_time

import numpy as np
import pytest
from support.driver import DISCARD, ERROR, OK
from support.pieces import play

from contract.test_foreign_states import FELL_FLAT, HEADER, as_word, forged, signed, words_of

SOON = 5.0  # s of computing for what follows a state that was taken
SUM = HEADER - 1  # the word of the checksum
REGULARIZED = {"friction_law": 2, "s": 0.03, "omega_s": 1e-3}
RUNS = {
    "unfolded": ({}, {}),
    "Runge-Kutta": ({"s": 0.03}, {}),
    "Adams": ({"method": 2}, {}),
    "BDF": ({"method": 3}, {}),
    "regularized": (REGULARIZED, {}),
    "multibody, Adams": ({"formulation": 3}, {}),
    "multibody, Runge-Kutta": ({"formulation": 3, "s": 0.03}, {}),
    "multibody, BDF": ({"formulation": 3, "method": 3}, {}),
    "loaded": ({"s": 0.03}, {"M_3": (0.0, 0.5), "F_Z": (1.0, 2.0, 3.0, 4.0)}),
    "braked, Adams": ({"method": 2}, {"M_brake": (1.0, 2.0)}),
    "held": ({"s": 0.2, "theta_start": np.pi / 2, "phi_dot_start": 0.0}, {"M_3": (0.1,)}),
    "contact kept": ({"s": 0.03, "keep_contact": True}, {}),
    "ended": ({"theta_start": 0.3, "phi_dot_start": 0.0}, {}),
}


def saved(wheel, run, stop=0.7):
    start, inputs = RUNS[run]
    w = wheel().start(**start)
    play(w, [(0.0, inputs)], stop, [0.3])
    return w.serialized()


def changes(word, seed):
    """What a word may be changed to: nonsense for a double, nonsense for an integer, and small changes."""
    special = [as_word(x) for x in (np.nan, np.inf, -1.0, 0.0, 1e300, 5e-324)]
    special += [2, 13, 2**31, 2**53, 2**63 - 1, 2**64 - 1]
    small = [(word + 1) % 2**64, (word - 1) % 2**64, word ^ 1 << 63, word ^ 1 << 52]
    chosen = np.random.default_rng(seed)
    return [int(chosen.choice(np.array(row, dtype=object))) for row in (special, small)]


def is_harmless(w):
    """What follows ends soon, whatever its status."""
    begin = process_time()
    for h in (0.05, 0.3):
        if w.fmi2DoStep(w.component, w.time, h, 0) != OK:
            break
        w.time += h
        w.bits()
    return process_time() - begin < SOON


@pytest.mark.parametrize("run", RUNS)
def test_a_state_with_one_word_changed_is_refused_or_harmless(wheel, run):
    blob = saved(wheel, run)
    words = words_of(blob)
    assert signed(words) == blob  # the partner: the layout is as this test believes, and the bytes are taken
    w = wheel().start(s=0.01).back(blob)
    host = wheel().start(s=0.01).to(0.2)
    before, refused = host.serialized(), 0
    for place in [k for k in range(len(words)) if k != SUM]:
        for new in changes(words[place], place):
            changed = signed([*words[:place], new, *words[place + 1 :]])
            if new == words[place]:
                continue
            status = w.restore(changed)
            assert status in (OK, ERROR)
            if status == OK:
                w.time = 0.7
                assert is_harmless(w), (place, hex(words[place]), hex(new))
                w.close()
                w = wheel().start(s=0.01)
            else:
                refused += 1
            assert host.restore(changed) == status
            if status == OK:
                assert host.restore(before) == OK
            assert host.serialized() == before, (place, hex(new))
    assert refused > len(words) // 3


@pytest.mark.parametrize("run", RUNS)
def test_a_number_that_is_not_finite_is_refused_or_has_no_effect(wheel, run):
    blob = saved(wheel, run)
    words = words_of(blob)
    straight = wheel().back(blob)
    ended = run == "ended"
    expected = straight.fmi2DoStep(straight.component, 0.7, 0.3, 0), straight.bits()
    assert expected[0] == (ERROR if ended else OK)
    for place in range(HEADER, len(words)):
        w = wheel()
        if w.restore(signed([*words[:place], as_word(np.nan), *words[place + 1 :]])) == OK:
            assert (w.fmi2DoStep(w.component, 0.7, 0.3, 0), w.bits()) == expected, place
        w.close()


def test_a_run_that_claims_an_orbit_which_its_start_does_not_have_is_harmless(wheel):
    """Any number that is zero in the state of an unfolded run, the inputs' derivatives among them, becomes -1."""
    words = words_of(saved(wheel, "unfolded"))
    taken = 0
    for place in [k for k, word in enumerate(words) if word == 0]:
        w = wheel().start(s=0.01)
        if w.restore(signed([*words[:place], as_word(-1.0), *words[place + 1 :]])) == OK:
            taken += 1
            w.time = 0.7
            assert is_harmless(w), place
        w.close()
    assert taken > 27  # the pending inputs with three derivatives each are among them


def test_an_ended_run_stays_ended(wheel):
    """Whatever its state brings: no forged word makes an ended run step on without a sentence."""
    w = wheel().back(saved(wheel, "ended", 9.0))
    assert w.fmi2DoStep(w.component, 0.7, 0.1, 0) in (DISCARD, ERROR)


def test_an_ending_that_does_not_exist_is_refused(wheel):
    """Lifted off is the one before fallen flat, which is the last."""
    w, blob = wheel(), saved(wheel, "ended", 9.0)
    assert forged(w, blob, ended_by=FELL_FLAT) == blob
    assert [w.restore(forged(w, blob, ended_by=FELL_FLAT + k)) for k in (-1, 1, 2)] == [OK, ERROR, ERROR]
