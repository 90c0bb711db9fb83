"""Every function in every state: what the standard allows works, all else is an error with a sentence and no effect."""

from ctypes import POINTER, addressof, byref, c_char, c_char_p, c_double, c_int, c_void_p, cast, sizeof
from typing import Any

import pytest
from contract.call_states import KINDS, OF, SITUATIONS, STATES, TABLE, bring_to, call, sound_arguments
from fmpy.fmi2 import fmi2EventInfo

from wheelfmu.fmu import driver
from wheelfmu.fmu.driver import CO_SIMULATION, DISCARD, ERROR, OK, FMU2Wheel
from wheelfmu.truth.exchange import loaded

TYPES = ("Real", "Integer", "Boolean", "String")

each = pytest.mark.parametrize("situation", SITUATIONS, ids=lambda s: f"{s[1]}, {KINDS[s[0]]}")


@pytest.fixture
def brought(library, wheel):
    """brought((kind, state)) -> a new instance of that kind in that state."""
    return lambda s: bring_to(wheel() if s[0] == CO_SIMULATION else loaded(library).new(), s[1])


@each
def test_each_function_is_legal_exactly_where_the_standard_says(brought, situation):
    """Legal: it does not answer fmi2Error."""
    for function, legal in TABLE.items():
        with brought(situation) as w:
            assert (call(w, function) != ERROR) == (situation in legal), function


def refusal(function: str, situation) -> str:
    """The sentence, or how it begins."""
    kind, state = situation
    if OF[function] == KINDS[1 - kind]:
        return f"{function} belongs to {OF[function]}; this instance was made for {KINDS[kind]}."
    return f"{function}: the wheel" if state == "step failed" else f'{function} is not allowed in the state "{state}".'


@each
def test_an_illegal_call_is_an_error_with_one_sentence_and_changes_nothing(brought, situation):
    disturbed, undisturbed = brought(situation), brought(situation)
    before = disturbed.serialized()
    assert before == undisturbed.serialized()
    illegal = [function for function, legal in TABLE.items() if situation not in legal]
    assert len(illegal) >= 13
    for function in illegal:
        assert call(disturbed, function) == ERROR
        (message,) = disturbed.take_messages()
        assert (message.status, message.category) == (ERROR, "logStatusError")
        assert message.text.startswith(refusal(function, situation)) and message.text.endswith(".")
        assert disturbed.serialized() == before, function
    if situation == (CO_SIMULATION, "step complete"):
        assert disturbed.run([0.7, 1.0]) == undisturbed.run([0.7, 1.0])
    assert call(disturbed, "fmi2Reset") == OK  # the partner: a legal call shows in the bytes
    assert disturbed.serialized() != before or situation[1] == "instantiated"


@each
def test_a_null_pointer_is_an_error_in_the_place_of_any_array_result_or_state(brought, situation):
    with brought(situation) as w:
        before, refused = w.serialized(), 0
        for function in [function for function, legal in TABLE.items() if situation in legal]:
            types = w._functions[function].argtypes[1:]
            for k in [k for k, t in enumerate(types) if t is c_void_p or isinstance(t, type(POINTER(c_int)))]:
                arguments = [*sound_arguments(w)[function]]
                arguments[k] = None
                arguments[1:2] = [1 if x == 0 else x for x in arguments[1:2]]  # of no array
                freed = function == "fmi2FreeFMUstate"
                assert w.ask(function.removeprefix("fmi2"), *arguments) == (OK if freed else ERROR), (function, k)
                assert ["null pointer" in text for text in w.texts()] == [True] * (not freed), (function, k)
                refused += 1
        assert w.serialized() == before and refused > 10


def requests(w: FMU2Wheel) -> dict[str, tuple[list[Any], dict[int, int]]]:
    """Of each function that answers into memory of the caller's: arguments, with several entries where there are lists,
    and at the place of each answer its size in bytes."""
    state, size = w.snapshot(), len(w.serialized())
    states, z = len(driver.STATES), w.indicator_count
    unknowns, knowns = w.refer("tau", "E"), w.refer("M_1", "F_X")
    of_states = ("GetContinuousStates", "GetDerivatives", "GetNominalsOfContinuousStates")
    return {
        "GetReal": ([w.refer("E", "F_X", "m", "tau"), 4, None], {2: 32}),
        "GetInteger": ([w.refer("n_steps", "method", "n_events"), 3, None], {2: 12}),
        "GetBoolean": ([w.refer("guided", "keep_contact"), 2, None], {2: 8}),
        "GetRealOutputDerivatives": ([w.refer("phi", "lambda_x", "tau"), 3, [1, 1, 1], None], {3: 24}),
        "GetDirectionalDerivative": ([unknowns, 2, knowns, 2, [1.0, 2.0], None], {5: 16}),
        **{function: ([None, states], {0: 8 * states}) for function in of_states},
        "GetEventIndicators": ([None, z], {0: 8 * z}),
        "NewDiscreteStates": ([None], {0: sizeof(fmi2EventInfo)}),
        "CompletedIntegratorStep": ([1, None, None], {1: 4, 2: 4}),
        "SerializeFMUstate": ([state, None, size], {1: size}),
        "SerializedFMUstateSize": ([state, None], {1: 8}),
        "GetStatus": ([driver.DO_STEP_STATUS, None], {1: 4}),
        "GetBooleanStatus": ([driver.TERMINATED, None], {1: 4}),
        "GetRealStatus": ([driver.LAST_SUCCESSFUL_TIME, None], {1: 8}),
    }


@each
def test_an_answer_replaces_all_that_its_memory_held_and_nothing_behind_it(brought, situation):
    """Each function answers two instances: one into bytes of 1, the other into bytes of 254."""
    answered = 0
    for function, (_, sizes) in requests(brought(situation)).items():
        if situation not in TABLE[f"fmi2{function}"]:
            continue
        memories = []
        for held in (b"\x01", b"\xfe"):
            w = brought(situation)
            arguments, types = requests(w)[function][0], w._functions[f"fmi2{function}"].argtypes[1:]
            memory = {k: (c_char * (size + 8)).from_buffer_copy(held * (size + 8)) for k, size in sizes.items()}
            for k in sizes:
                arguments[k] = cast(memory[k], types[k])
            assert w.ask(function, *arguments) == OK, function
            assert all(memory[k].raw[size:] == held * 8 for k, size in sizes.items()), function
            memories.append([memory[k].raw[:size] for k, size in sizes.items()])
        assert memories[0] == memories[1], function
        answered += 1
    assert answered > 4 - 3 * (situation[1] == "instantiated") - (situation[1] == "error")


# Of each function with lists: the places of the arguments that make one list, its count among them.
LISTS = dict.fromkeys((f"fmi2{way}{kind}" for way in ("Get", "Set") for kind in TYPES), ((0, 1, 2),))
LISTS |= dict.fromkeys(("fmi2SetRealInputDerivatives", "fmi2GetRealOutputDerivatives"), ((0, 1, 2, 3),))
LISTS |= {"fmi2GetDirectionalDerivative": ((0, 1, 5), (2, 3, 4), (0, 1, 5, 2, 3, 4))}
LISTS |= {"fmi2SetDebugLogging": ((1, 2),)}  # last: no categories are all, and their messages end


@each
@pytest.mark.parametrize("mass", [20.0, -1.0])
def test_empty_lists_ask_for_nothing_in_any_state(brought, situation, mass):
    """Whatever else a call names, and where no initial state exists (or the mass that is set has none)."""
    with brought(situation) as w:
        if situation[1] in ("instantiated", "initialization mode"):
            w.put(m=mass)
        w.take_messages()
        for function, lists in LISTS.items():
            for places in lists:
                before, arguments = w.serialized(), [*sound_arguments(w)[function]]
                for k in places:
                    arguments[k] = 0 if isinstance(arguments[k], int) else None
                status = w.ask(function.removeprefix("fmi2"), *arguments)
                legal = situation in TABLE[function]
                assert (status == OK, bool(w.take_messages())) == (legal, not legal), (function, places)
                assert w.serialized() == before, function


@pytest.mark.parametrize("state", STATES)
def test_a_snapshot_brings_back_the_call_state_it_was_taken_in(wheel, state):
    blob = bring_to(wheel(), state).serialized()
    for other_state in STATES:
        other = bring_to(wheel(), other_state)
        assert (other.serialized() == blob) == (other_state == state)
        assert other.back(blob).serialized() == blob
        assert (other.setupExperiment() == OK) == (state == "instantiated")


def test_calls_on_no_instance_are_errors(wheel):
    """On a null pointer, a state, the middle of an instance, memory of the caller's, an odd number."""
    w, other = wheel(), wheel().start()
    state, own, arguments, undisturbed = other.snapshot(), (c_char * 64)(), sound_arguments(w), other.serialized()
    w.close()
    for w.component in (None, state.value, other.component + 8, addressof(own), 1):
        assert {w.ask(function.removeprefix("fmi2"), *arguments[function]) for function in TABLE} == {ERROR}
        w.fmi2FreeInstance(w.component)  # without effect
    w.component = None
    assert own.raw == bytes(64) and other.serialized() == undisturbed
    assert other.ask("SetFMUstate", state) == OK


@pytest.mark.parametrize("kind", [*range(-1, 9), -(2**31), 2**31 - 1])
def test_a_status_of_any_kind_is_answered_or_there_is_none(wheel, kind):
    """Outside of the enumeration too: under the sanitizers, to read such a number as its type is a fault."""
    w = wheel(logging=True).start()
    calls = ("", c_int), ("String", c_char_p), ("Real", c_double), ("Boolean", c_int), ("Integer", c_int)
    for known, (name, c_type) in enumerate(calls):
        answered = kind == known < 4  # there is no whole number to ask for
        assert w.ask(f"Get{name}Status", kind, byref(c_type())) == (OK if answered else DISCARD)
        assert [f"there is no status of kind {kind}." in text for text in w.texts()] == [True] * (not answered)
    w.close()
