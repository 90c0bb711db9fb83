"""Every field of a serialized state: its least and its largest value, what lies just outside of either, and the length
of the whole; with the checksum right, as only a forger has it. A field that is taken comes back as it was.
"""

import struct
from collections.abc import Sequence
from math import inf, nan, pi

import numpy as np
import pytest
from contract.test_serialization import HEADER, signed, words_of

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, Values
from wheelfmu.fmu.values import variables
from wheelfmu.truth.scenes import AT_REST, GENERAL, KINDS
from wheelfmu.truth.sliding import ROAD, THROWN

PARAMETERS = len(variables("parameter"))
EVENTS = 8  # names of `Event` in in_force.hpp, `none` included
MOST, COUNT = float(np.finfo(float).max), 2**53
FORGED = "fmi2SetFMUstate: a number is out of its bounds."
Bound = int | float | None
Field = tuple[str, int, Bound, Bound]  # a name, how often it stands there, its bounds; none: any bits


def fields(kind: str, states: int, watched: int, stages: int, phase: int) -> list[Field]:
    """In their order. Whole numbers have whole bounds. `stages`: rows of rates of the engine at work."""
    found: list[Field] = [("parameter", PARAMETERS, None, None), ("start_time", 1, -MOST, MOST)]
    found += [("stop_time", 1, -MOST, inf), ("tolerance", 1, 1e-13, 1e-4)]
    for k in range(9):
        name = "derivatives" if k < 7 else "derivatives of a carrier's rate"
        found += [("input", 1, None, None), (name, 3, -MOST, MOST)]
    found += [("news", 1, 0, 2), ("slides", 1, 0, 1), ("phase", 1, 0, 12), ("ended by", 1, 0, EVENTS - 1)]
    found += [("s, mu_max, mu_slide", 3, 0.0, MOST), ("slope", 1, 0.0, pi / 2), ("slope_direction", 1, -1e12, 1e12)]
    found += [("law", 1, 0, 4), ("sigma", 1, -1.0, 1.0), ("contact", 1, 0, 1)]
    found += [("origin", 1, -MOST, MOST), ("polynomials", 36, -MOST, MOST), ("below", EVENTS, 0, 1)]
    found += [("t, last change", 2, -MOST, MOST), ("grip due", 1, 0.0, inf), ("y", 10, -MOST, MOST)]
    found += [("observed", EVENTS, 0, 1)]
    found += [("transitions", 1, 0, COUNT), ("counted", 5, 0, COUNT)]
    if phase != STEPPING:
        return found
    found += [
        ("rests in a law", 1, 0, 0),
        ("start", 1, -MOST, MOST),
        ("end", 1, -MOST, MOST),
        ("y at both", 2 * states, -MOST, MOST),
    ]
    found += [("lowest margin", 1, -MOST, inf), ("inside at", 1, 0.0, 1.0), ("y inside", states, -MOST, MOST)]
    found += [("known until", 1, -MOST, MOST), ("first stop", 1, -MOST, inf)]
    found += [("first step of collocation", 1, 0.0, inf), ("pending", 1, 0, 2)]
    found += [("fallen", 1, 0, watched - 1), ("values", 13, -MOST, MOST), ("counters", 5, 0, COUNT)]
    found += [("size that is liked", 1, 0.0, MOST)]
    if kind == "runge_kutta":
        found += [("limit, size", 2, 0.0, MOST), ("last error", 1, 0.0, 1.0), ("margin", 1, -MOST, MOST)]
        found += [("limited by a law", 1, 0, 1), ("end is known", 1, 0, 1), ("rates", stages * states, -MOST, MOST)]
    elif kind == "collocation":
        found += [("sizes", 2, 0.0, MOST), ("known", 1, 0, 1), ("rates", stages * states, -MOST, MOST)]
    else:
        found += [("next", 1, 0, 2)]
        found += [("start of all", 1, -MOST, MOST), ("y there", states, -MOST, MOST), ("steps", 1, 1, 10000)] * stages
    return found


AT_START, STEPPING, UNFOLDED, ENDED, CLOSED = 4, 5, 6, 9, 10
# Start, instant, engine, length of its state, what is watched, rows of rates, phase.
STATES: dict[str, tuple[Values, float, str, int, int, int, int]] = {
    "DOP853": ({"s": 0.02, **GENERAL}, 0.7, "runge_kutta", 8, 3, 13, STEPPING),
    "DOP853, a wheel that can slide": ({**ROAD, "s": 0.02}, 0.3, "runge_kutta", 8, 4, 13, STEPPING),
    "collocation": ({**ROAD, **THROWN, "s": 0.02}, 0.1, "collocation", 10, 5, 6, STEPPING),
    "Adams": (KINDS["adams"], 0.7, "cvode", 8, 3, 1, STEPPING),
    "multibody, BDF": (KINDS["multibody, bdf"], 0.7, "cvode", 8, 3, 1, STEPPING),
    "unfolded": ({}, 0.7, "", 8, 2, 0, UNFOLDED),
    "at the start": ({"s": 0.02}, 0.0, "", 8, 2, 0, AT_START),
}
each_state = pytest.mark.parametrize("name", STATES)


def saved(wheel, name: str) -> tuple[tuple[int, ...], list[Field]]:
    """The words behind the header, and the fields."""
    values, t, kind, states, watched, stages, phase = STATES[name]
    w = wheel().start(**values)
    blob = (w.to(t) if t else w).serialized()
    w.close()
    return words_of(blob)[HEADER:], fields(kind, states, watched, stages, phase)


def forged(body: Sequence[int], mark: int) -> bytes:
    """With header: mark, size, checksum."""
    return signed([mark, 8 * (HEADER + len(body)), 0, *body])


@pytest.fixture
def mark(wheel) -> int:
    return words_of(wheel().start().serialized())[0]


def word(value: float) -> int:
    return struct.unpack("<Q", struct.pack("<q" if isinstance(value, int) else "<d", value))[0]


def outside(least: Bound, most: Bound) -> list[float]:
    if least is None or most is None:
        return [nan]
    if isinstance(least, int):
        return [least - 1, most + 1, -(2**63), 2**63 - 1]
    found = [nan, -inf] + [inf] * (most < inf)
    if least > -MOST:
        found.append(float(np.nextafter(least, -inf)))
    return [*found, float(np.nextafter(most, inf))] if most < MOST else found


def places(found: list[Field]) -> list[tuple[str, int, Bound, Bound]]:
    """Each field as often as it stands there, with the place of its word."""
    single = [(name, least, most) for name, count, least, most in found for _ in range(count)]
    return [(name, place, least, most) for place, (name, least, most) in enumerate(single)]


@each_state
def test_the_fields_are_those_that_this_test_believes_and_a_state_without_its_last_or_with_one_more_is_refused(
    wheel, mark: int, name: str
) -> None:
    body, found = saved(wheel, name)
    assert len(places(found)) == len(body)
    w = wheel().start()
    assert w.restore(forged(body, mark)) == OK  # the partner: the bytes are taken
    before = w.serialized()
    for wrong in (body[:-1], (*body, 0), body[:-8], (*body, *body), body[:40], (), (*body[:-1], word(nan))):
        assert w.restore(forged(wrong, mark)) == ERROR
        assert w.said() == FORGED
    assert STATES[name][6] == STEPPING or w.serialized() == before


@each_state
def test_a_word_just_outside_the_bounds_of_its_field_is_refused(wheel, mark: int, name: str) -> None:
    body, found = saved(wheel, name)
    w = wheel().start(s=0.01)
    refused = 0
    for field, place, least, most in places(found):
        for value in outside(least, most):
            forgery = forged((*body[:place], word(value), *body[place + 1 :]), mark)
            assert w.restore(forgery) == ERROR and w.said() == FORGED, (field, place, value)
            refused += 1
    assert refused > 250


@pytest.mark.parametrize("name", ["Adams", "multibody, BDF"])
@pytest.mark.parametrize("field", ["steps", "end"])
def test_a_history_whose_steps_lead_elsewhere_is_refused(wheel, mark: int, name: str, field: str) -> None:
    """CVODE's steps since its last start are made again; they must end where the state says."""
    body, found = saved(wheel, name)
    place, step = place_of(found, field), -1 if field == "steps" else 1
    forgery = (*body[:place], body[place] + step, *body[place + 1 :])
    w = wheel().start(s=0.01)
    assert w.restore(forged(forgery, mark)) == ERROR and w.said() == FORGED
    assert w.restore(forged(body, mark)) == OK  # the partner


# Whatever else the state says, these may have any value within their bounds.
FREE = {"start_time", "stop_time", "tolerance", "derivatives", "news", "s, mu_max, mu_slide", "slope", "sigma"}
FREE |= {"slope_direction", "origin", "polynomials", "t, last change", "grip due", "y", "transitions", "counted"}
FREE |= {"lowest margin", "y inside", "values", "counters", "size that is liked", "limit, size", "last error", "margin"}
FREE |= {"rates", "sizes", "y at both"}


@pytest.mark.parametrize("name", [name for name in STATES if STATES[name][2] != "cvode"])
def test_a_word_at_a_bound_of_its_field_is_taken_and_comes_back(wheel, mark: int, name: str) -> None:
    body, found = saved(wheel, name)
    taken = 0
    for field, place, least, most in places(found):
        if least is None or most is None or field not in FREE:
            continue
        whole = isinstance(least, int)
        for value in (least, most) if whole else (least, most, 0.75 * least + 0.25 * min(most, 1.0)):
            w = wheel()
            forgery = (*body[:place], word(value), *body[place + 1 :])
            assert w.restore(forged(forgery, mark)) == OK, (field, place, value, w.sentences)
            again = w.serialized()
            w.close()
            back = words_of(again)[HEADER:]
            assert back[place] == word(value) and sum(a != b for a, b in zip(back, body, strict=True)) <= 1, (
                field,
                place,
                value,
            )
            taken += 1
    assert taken > 150


def place_of(found: list[Field], field: str) -> int:
    return next(place for name, place, *_ in places(found) if name == field)


def with_words(body: tuple[int, ...], found: list[Field], **values: float) -> tuple[int, ...]:
    changed = list(body)
    for field, value in values.items():
        changed[place_of(found, field.replace("_", " "))] = word(value)
    return tuple(changed)


def test_a_run_that_has_ended_names_an_event_that_ends_one_and_no_other_run_does(wheel, mark: int) -> None:
    """Lost grip, lost contact, a jam and lying flat end a run; a layer, the spin and the end of a slip do not."""
    body, found = saved(wheel, "at the start")
    for event in range(8):
        w = wheel().start()
        status = w.restore(forged(with_words(body, found, phase=ENDED, ended_by=event), mark))
        assert status == (OK if event in (3, 5, 6, 7) else ERROR), event
        if status == OK:
            assert w.step(0.1) == ERROR and "Restore a state or reset." in w.sentences[-1]
    names = {3: "needs a friction", 5: "lifted off", 6: "jams", 7: "lies flat"}
    for event, text in names.items():
        w = wheel().start().back(forged(with_words(body, found, phase=ENDED, ended_by=event), mark))
        assert w.step(0.1) == ERROR and text in w.said()


def test_a_state_that_comes_from_a_run_which_failed_or_was_closed_is_read_and_goes_no_further(wheel) -> None:
    failed = wheel().start(s=0.02).to(0.4).put(M_3=1e300)
    assert failed.step(0.1) == ERROR
    closed = wheel().start(s=0.02).to(0.4)
    assert closed.terminate() == OK
    ended = wheel().start(mu_max=0.45)
    assert ended.step(1.0) == DISCARD
    for w in (failed, closed, ended):
        blob, restored = w.serialized(), wheel().start(**AT_REST)
        assert restored.back(blob).bits() == w.bits() and restored.serialized() == blob
        assert restored.step(0.1) == w.step(0.1) == ERROR
        assert len(blob) == 8 * (HEADER + sum(count for _, count, *_ in fields("", 8, 2, 0, CLOSED)))


@pytest.mark.parametrize("counter", ["transitions", "counted", "counters"])
def test_counts_at_their_largest_stay_there_and_are_read_as_the_largest_integer(wheel, mark: int, counter: str) -> None:
    body, found = saved(wheel, "DOP853")
    w = wheel().start().back(forged(with_words(body, found, **{counter: COUNT}), mark))
    w.time = 0.7
    name = "n_events" if counter == "transitions" else "n_steps"
    assert w.get(name) == [2**31 - 1]
    w.to(3.0)
    assert w.get(name) == [2**31 - 1] and w.get("theta") == wheel().start(s=0.02, **GENERAL).to(3.0).get("theta")
    again = w.serialized()
    assert wheel().start().restore(again) == OK  # and can be saved again
    less = wheel().start().back(forged(with_words(body, found, **{counter: 1000}), mark))
    beyond_thousand = less.get(name)[0]
    assert 1000 <= beyond_thousand < 2000


def test_instants_of_a_history_that_are_out_of_their_order_are_refused_and_so_is_another_size_in_the_header(
    wheel, mark
):
    body, found = saved(wheel, "DOP853")
    start, end = (struct.unpack("<d", struct.pack("<Q", body[place_of(found, name)]))[0] for name in ("start", "end"))
    w = wheel().start()
    for wrong in (
        {"end": start - 1e-9},
        {"known_until": end + 1e-9},
        {"known_until": start - 1e-9},
        {"first_stop": start},
    ):
        assert w.restore(forged(with_words(body, found, **wrong), mark)) == ERROR and w.said() == FORGED, wrong
    sound = forged(body, mark)
    for size in (0, len(sound) - 8, len(sound) + 8):
        assert w.restore(sound[:8] + struct.pack("<Q", size) + sound[16:]) == ERROR and "damaged" in w.said()
    assert w.restore(sound) == OK
