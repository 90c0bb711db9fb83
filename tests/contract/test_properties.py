"""Random scenes, inputs and orders of calls: what holds for the scenes that the other tests name holds for any.

hypothesis draws the examples, the same in every run. Each property has a partner that breaks it on purpose.
"""

import pytest
from contract import properties
from contract.properties import INPUTS, Values, check, energy_defect, grids, is_honest, loads, play_anything, scenes
from hypothesis import strategies as st
from support.bounds import within
from support.driver import OK

BOUND = 6e-11  # of the energy moved; a part that is left out shows by far more
CHOICES = ("formulation", "friction_law", "method")
REALS = ("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s", "theta_start", "psi_dot_start", "phi_dot_start", "omega_s")
mistakes = st.fixed_dictionaries(
    {}, optional={**dict.fromkeys(REALS, properties.anything), **dict.fromkeys(CHOICES, properties.anything_whole)}
)
extreme_loads = st.fixed_dictionaries({}, optional=dict.fromkeys(INPUTS, properties.anything))


@pytest.mark.parametrize("silent", [False, True])
def test_any_values_give_finite_outputs_or_a_message(wheel, silent):
    def holds(start: Values, load: Values) -> None:
        logged = play_anything(wheel(), start, load)
        assert is_honest([(status, outputs, [] if silent else texts) for status, outputs, texts in logged])

    check(holds, 60, mistakes, extreme_loads, broken=silent)


@pytest.mark.parametrize("push", [0.0, 1e-9])
def test_neither_grid_nor_rollback_nor_reading_changes_a_bit(wheel, push):
    """Each step is taken twice, again in a new instance, and all is read in any order after it."""

    def holds(scene: Values, load: Values, times: list[float], shuffle) -> None:
        straight = wheel().start(**scene).put(**load)
        end, w = straight.step_to(1.0), wheel().start(**scene).put(**load)
        names = [*w.reals, *w.integers]
        for t in times:
            blob, status = w.serialized(), w.step_to(t)
            first, w = w.bits(), wheel().back(blob)
            assert (w.step_to(t), w.bits()) == (status, first)
            shuffle.shuffle(names)
            shown = dict(zip(names, w.get(*names), strict=True))
            assert [shown[name] for name in sorted(names)] == w.get(*sorted(names))
            if status != OK:
                break
            w.put(F_X=load["F_X"] + push)  # the partner: an input that moves by a nano-newton at a point
        assert (status, w.bits()) == (end, straight.bits())

    check(holds, 30, scenes(), loads(), grids(), st.randoms(use_true_random=False), broken=push > 0)


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
