"""Random scenes, inputs and orders of calls: what holds for the scenes that the other tests name holds for any.

hypothesis draws the examples, the same in every run. Each property has a partner that breaks it on purpose.
"""

import pytest
from hypothesis import strategies as st
from support.bounds import within
from support.driver import OK

from contract import properties
from contract.properties import INPUTS, Values, check, energy_defect, go, grids, is_honest, loads, play_anything, scenes

BOUND = 6e-11  # of the energy moved; a part that is left out shows by far more
CHOICES = ("formulation", "friction_law", "method")
REALS = ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s", "theta_start", "psi_dot_start", "phi_dot_start", "omega_s")
mistakes = st.fixed_dictionaries(
    {}, optional={**dict.fromkeys(REALS, properties.anything), **dict.fromkeys(CHOICES, properties.anything_whole)}
)
extreme_loads = st.fixed_dictionaries({}, optional=dict.fromkeys(INPUTS, properties.anything))


@pytest.mark.parametrize("silent", [False, True])
def test_any_values_give_finite_outputs_or_a_sentence(wheel, silent):
    def holds(start: Values, load: Values) -> None:
        told = play_anything(wheel(), start, load)
        assert is_honest([(status, outputs, [] if silent else texts) for status, outputs, texts in told])

    check(holds, 60, mistakes, extreme_loads, broken=silent)


@pytest.mark.parametrize("push", [0.0, 1e-9])
def test_the_communication_grid_changes_no_bit(wheel, push):
    def holds(scene: Values, load: Values, times: list[float]) -> None:
        straight = go(wheel().start(**scene), [1.0], load)
        often = wheel().start(**scene)
        if push and len(times) > 1:  # the partner: an input that moves by a nano-newton at a communication point
            go(often, times[:1], load)
            load = load | {"F_X": load["F_X"] + push}
        assert go(often, times[1 if push else 0 :] or times, load)[-1] == straight[-1]

    check(holds, 30, scenes(), loads(), grids(), broken=push > 0)


@pytest.mark.parametrize("late", [False, True])
def test_a_rollback_gives_the_same_bits_here_and_in_another_instance(wheel, late):
    def holds(scene: Values, load: Values, before: list[float], after: list[float]) -> None:
        ahead = [0.5 + t for t in after]
        w = wheel().start(**scene)
        if go(w, before, load)[-1][-1] != OK:
            return
        blob, now = w.serialized(), w.bits()
        first = go(w, ahead, load)
        if late:  # the partner: a state taken later
            blob = w.serialized()
        for again in (w, wheel()):
            assert again.back(blob).bits() == now
            assert go(again, ahead) == first

    check(holds, 20, scenes(), loads(), grids(0.5), grids(0.5), broken=late)


@pytest.mark.parametrize("forgotten", ["nothing", *INPUTS, "s"])
def test_energy_changes_by_the_work_of_inputs_and_friction(wheel, forgotten):
    def holds(scene: Values, load: Values) -> None:
        smooth = {"friction_law": 2, "omega_s": 0.5 + scene["omega_s"], "theta_start": 1.4, "r_0": 0.3 + scene["r_0"]}
        calm = scene | smooth
        w = wheel().start(tolerance=1e-10, **calm)
        assert w.set(**load) == OK
        counted = {**calm, **load}
        if forgotten in counted:  # the partner: a hundredth of a newton, or a millimetre of s, is left out
            counted[forgotten] += 0.01 if forgotten in INPUTS else 0.001
        within(energy_defect(w, counted), BOUND, "energy defect")

    broken = forgotten != "nothing"
    check(holds, 3 if broken else 15, scenes(), loads(), broken=broken)


@pytest.mark.parametrize("disturbed", [False, True])
def test_the_order_of_reading_changes_no_bit(wheel, disturbed):
    def holds(scene: Values, load: Values, times: list[float], shuffle) -> None:
        unread, read = wheel().start(**scene), wheel().start(**scene)
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

    check(holds, 20, scenes(), loads(), grids(), st.randoms(use_true_random=False), broken=disturbed)
