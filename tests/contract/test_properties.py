"""Random scenes, inputs and orders of calls: what holds for the scenes that the other tests name holds for any.

hypothesis draws the examples, the same in every run. Each property has a partner that breaks it on purpose.
"""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.bounds import within
from support.driver import ERROR, OK, FMU2Wheel

from contract.properties import (
    INPUTS,
    Values,
    anything,
    anything_whole,
    crowd,
    energy_defect,
    go,
    grids,
    is_honest,
    loads,
    play_anything,
    quick,
    scenes,
)

pytestmark = pytest.mark.contract

BOUND = 6e-11  # of the energy moved; a part that is left out shows by far more
CHOICES = ("formulation", "friction_law", "method")
REALS = ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s", "theta_start", "psi_dot_start", "phi_dot_start", "omega_s")
mistakes = st.fixed_dictionaries(
    {}, optional={**dict.fromkeys(REALS, anything), **dict.fromkeys(CHOICES, anything_whole)}
)
extreme_loads = st.fixed_dictionaries({}, optional=dict.fromkeys(INPUTS, anything))


class FMU2SilentWheel(FMU2Wheel):
    """A partner: a wheel whose sentences are lost."""

    def keep_message(self, *_: object) -> None:
        pass


@pytest.mark.parametrize("kind", [FMU2Wheel, FMU2SilentWheel])
def test_any_values_give_finite_outputs_or_a_sentence(fmu, description, kind):
    @quick(60, shrink=kind is FMU2Wheel)
    @given(mistakes, extreme_loads)
    def holds(start: Values, load: Values) -> None:
        with crowd(fmu, description, kind) as make:
            assert is_honest(play_anything(make(), start, load))

    if kind is FMU2Wheel:
        holds()
    else:
        with pytest.raises(AssertionError):
            holds()


@pytest.mark.parametrize("push", [0.0, 1e-9])
def test_the_communication_grid_changes_no_bit(fmu, description, push):
    @quick(30, shrink=not push)
    @given(scenes(), loads(), grids())
    def holds(scene: Values, load: Values, times: list[float]) -> None:
        with crowd(fmu, description) as make:
            once, often = make().start(**scene), make().start(**scene)
            straight = go(once, [1.0], load)
            if push and len(times) > 1:  # the partner: an input that moves by a nano-newton at a communication point
                go(often, times[:1], load)
                load = load | {"F_X": load["F_X"] + push}
            assert go(often, times[1 if push else 0 :] or times, load)[-1] == straight[-1]

    if push:
        with pytest.raises(AssertionError):
            holds()
    else:
        holds()


@pytest.mark.parametrize("way", ["snapshot", "bytes", "bytes in another instance", "a snapshot taken later"])
def test_a_rollback_gives_the_same_bits(fmu, description, way):
    broken = way == "a snapshot taken later"

    @quick(20, shrink=not broken)
    @given(scenes(), loads(), grids(0.5), grids(0.5))
    def holds(scene: Values, load: Values, before: list[float], after: list[float]) -> None:
        ahead = [0.5 + t for t in after]
        with crowd(fmu, description) as make:
            w = make().start(**scene)
            if go(w, before, load)[-1][-1] != OK:
                return
            state, blob, now = w.snapshot(), w.serialized(), w.bits()
            first = go(w, ahead, load)
            if broken:
                state, way_back = w.snapshot(), "snapshot"
            else:
                way_back = way
            again = make() if way_back == "bytes in another instance" else w
            if way_back == "snapshot":
                assert again.fmi2SetFMUstate(again.component, state) == OK
            else:
                assert again.restore(blob) == OK
            again.time = 0.5
            assert again.bits() == now
            assert go(again, ahead) == first
            w.freeFMUState(state)

    if broken:
        with pytest.raises(AssertionError):
            holds()
    else:
        holds()


@quick(20)
@given(scenes(), st.data())
def test_a_damaged_state_is_refused_and_changes_nothing(fmu, description, scene, data):
    with crowd(fmu, description) as make:
        w, other = make().start(**scene), make().start(**scene)
        go(w, [0.25])
        blob, before = bytearray(w.serialized()), other.serialized()
        place = data.draw(st.integers(0, len(blob) - 1))
        blob[place] ^= data.draw(st.integers(1, 255))
        assert other.restore(bytes(blob)) == ERROR
        assert other.serialized() == before
        assert other.restore(w.serialized()) == OK and other.bits() == w.bits()  # the partner: undamaged


@pytest.mark.parametrize("forgotten", ["nothing", *INPUTS, "s"])
def test_energy_changes_by_the_work_of_inputs_and_friction(fmu, description, forgotten):
    @quick(15 if forgotten == "nothing" else 3, shrink=False)
    @given(scenes(), loads())
    def holds(scene: Values, load: Values) -> None:
        smooth = {"friction_law": 2, "omega_s": 0.5 + scene["omega_s"], "theta_start": 1.4, "r_0": 0.3 + scene["r_0"]}
        calm = scene | smooth
        with crowd(fmu, description) as make:
            w = make().start(tolerance=1e-10, **calm)
            assert w.set(**load) == OK
            counted = {**calm, **load}
            if forgotten in counted:  # the partner: a hundredth of a newton, or a millimetre of s, is left out
                counted[forgotten] += 0.01 if forgotten in INPUTS else 0.001
            within(energy_defect(w, counted), BOUND, "energy defect")

    if forgotten == "nothing":
        holds()
    else:
        with pytest.raises(AssertionError):
            holds()


@pytest.mark.parametrize("disturbed", [False, True])
def test_the_order_of_reading_changes_no_bit(fmu, description, disturbed):
    @quick(20, shrink=not disturbed)
    @given(scenes(), loads(), grids(), st.randoms(use_true_random=False))
    def holds(scene: Values, load: Values, times: list[float], shuffle) -> None:
        with crowd(fmu, description) as make:
            unread, read = make().start(**scene), make().start(**scene)
            names = [*read.reals, *read.integers]
            assert unread.set(**load) == read.set(**load) == OK
            for t in times:
                status = unread.step_to(t)
                assert read.step_to(t) == status
                shuffle.shuffle(names)
                shown = dict(zip(names, read.get(*names), strict=True))
                if disturbed:  # the partner: an input set between reading and stepping
                    read.set(M_3=shuffle.uniform(-1, 1))
                assert [shown[name] for name in names] == read.get(*names)
                if status != OK:
                    break
            assert unread.bits() == read.bits()

    if disturbed:
        with pytest.raises(AssertionError):
            holds()
    else:
        holds()
