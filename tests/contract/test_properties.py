"""Random scenes and inputs, cubic in time: the energy balance of the scenes that other tests name holds for any.

Random calls and values are the fuzzer's. hypothesis draws the examples, the same in every run.
"""

from contextlib import nullcontext
from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from numpy.polynomial.polynomial import polyval
from scipy.optimize import brentq
from support.bounds import within

from wheelfmu.fmu.driver import FMU2Wheel

INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")
BOUND = 6e-11  # of the energy moved; a part that is left out shows by far more
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)
POWERS = ("X_O_dot", "Y_O_dot", "Z_O_dot", "theta", "psi_dot", "theta_dot", "omega_z", "lambda_3")
CUBICS = st.tuples(*[st.floats(-5, 5)] * 4)  # N or N m, over powers of seconds
LOADS = st.fixed_dictionaries(dict.fromkeys(INPUTS, CUBICS))
Loads = dict[str, tuple[float, ...]]


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, float]:
    """Sound start values of every kind: every formulation and method, any inertia a body can have, smooth friction."""
    J_x = draw(st.floats(0.2, 2.0))
    J_y = J_x * draw(st.sampled_from([1.0, 0.8, 1.3]))
    return {
        **{"m": draw(st.floats(1.0, 100.0)), "r_0": draw(st.floats(0.4, 1.3)), "r": draw(st.floats(0.0, 0.1))},
        **{"J_x": J_x, "J_y": J_y, "J_z": draw(st.floats(abs(J_x - J_y), J_x + J_y)) or J_x},
        **{"g": draw(st.floats(1.0, 20.0)), "s": draw(st.sampled_from([0.0, 0.01, 0.05])), "theta_start": 1.4},
        **{"psi_dot_start": draw(st.floats(-1.0, 1.0)), "theta_dot_start": draw(st.floats(-1.0, 1.0))},
        **{"phi_dot_start": draw(st.floats(-6.0, 6.0)), "formulation": draw(st.sampled_from([1, 2, 3]))},
        **{"method": draw(st.sampled_from([1, 2, 3, 4])), "omega_s": draw(st.floats(0.51, 1.5))},
        **{"friction_law": 2, "keep_contact": True, "slope": draw(st.sampled_from([0.0, 0.2]))},
    }


def smooth_pieces(w: FMU2Wheel, ends: np.ndarray) -> list[float]:
    """The ends of pieces, and between them the instants at which N passes zero, kinks of the power of friction."""
    state = w.serialized()

    def normal_force(t: float) -> float:
        return w.back(state).to(t).get("lambda_3")[0]

    forces = [w.get("lambda_3")[0], *map(normal_force, ends[1:])]
    changes = [k for k in range(1, len(ends)) if forces[k - 1] * forces[k] < 0]
    kinks = [brentq(normal_force, ends[k - 1] + 1e-9, ends[k], xtol=1e-14) for k in changes]
    w.back(state)
    return sorted([*ends, *kinks])


def energy_defect(w: FMU2Wheel, loads: Loads, counted: Loads, law: dict[str, float]) -> float:
    """|change of E - work of the loads and of the smooth friction| over the size of what moves; quadrature of power.
    loads, counted: those that act and those whose work is counted.

    P = F v + M omega (non-spinning axes) - s N tanh(omega_z / omega_s) omega_z, by six Gauss nodes a piece.
    """
    first = w.give(loads).get("E")[0]
    work = moved = 0.0
    for begin, end in pairwise(smooth_pieces(w, np.arange(9) / 32)):
        width = end - begin
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            t = begin + 0.5 * (1 + node) * width
            w.give(loads, w.time).to(t)
            v_X, v_Y, v_Z, theta, psi_dot, theta_dot, omega_z, N = w.get(*POWERS)
            friction = law["s"] * max(N, 0.0) * np.tanh(omega_z / law["omega_s"])
            speeds = (v_X, v_Y, v_Z, theta_dot, psi_dot * np.sin(theta), omega_z)
            powers = [polyval(t, counted[name]) * v for name, v in zip(INPUTS, speeds, strict=True)]
            powers.append(-friction * omega_z)
            work += 0.5 * width * weight * sum(powers)
            moved += 0.5 * width * weight * sum(map(abs, powers))
    return abs(w.give(loads, w.time).to(end).get("E")[0] - first - work) / (abs(first) + moved)


@pytest.mark.parametrize("forgotten", [(), *product(INPUTS, range(4)), ("s",)], ids=str)
def test_energy_changes_by_the_work_of_inputs_and_friction(wheel, forgotten):
    broken = bool(forgotten)

    @settings(max_examples=3 if broken else 15, phases=[Phase.generate])
    @given(scenes(), LOADS)
    def check(scene, load):
        w = wheel().start(tolerance=1e-10, **scene)
        law, counted = dict(scene), dict(load)
        match forgotten:  # the partner: 0.01 of one coefficient of a load, or a millimetre of s, is left out
            case ("s",):
                law["s"] += 0.001
            case (name, order):
                counted[name] = tuple(c + 0.01 * (k == order) for k, c in enumerate(load[name]))
        within(energy_defect(w, load, counted, law), BOUND, "energy off the work, relative")

    with pytest.raises(AssertionError) if broken else nullcontext():
        check()
