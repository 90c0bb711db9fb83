"""What the property tests draw, play and judge: scenes sound and unsound, energy."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from support.driver import FMU2Wheel

INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")
Values = dict[str, float]


def quick(examples: int, *, shrink: bool = True) -> settings:
    """The same examples in every run, those that are written down first. Partners do not shrink: that they fail is all
    that is asked."""
    phases = (Phase.explicit, Phase.generate, Phase.shrink) if shrink else (Phase.generate,)
    no_check = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
    same = {"derandomize": True, "deadline": None, "database": None}
    return settings(max_examples=examples, phases=phases, suppress_health_check=no_check, **same)


def check(holds: Callable[..., None], examples: int, *drawn: st.SearchStrategy, broken: bool = False) -> None:
    """Whether it holds for all examples, or, broken on purpose, not."""
    played = quick(examples, shrink=not broken)(given(*drawn)(holds))
    if not broken:
        played()
        return
    with pytest.raises(AssertionError):
        played()


def some(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high, allow_subnormal=False)


@st.composite
def scenes(draw: st.DrawFn) -> Values:
    """Sound start values of every kind: every formulation, law and method, any inertia a body can have."""
    across, share = draw(some(0.2, 2.0)), draw(st.sampled_from([1.0, 0.8, 1.3]))
    J_x, J_y = across, across * share
    return {
        **{"m": draw(some(1.0, 100.0)), "r_0": draw(some(0.1, 1.0)), "r": draw(some(0.0, 0.1))},
        **{"J_x": J_x, "J_y": J_y, "J_z": draw(some(abs(J_x - J_y), J_x + J_y)) or across},
        **{"g": draw(some(1.0, 20.0)), "s": draw(st.sampled_from([0.0, 0.01, 0.05]))},
        **{"theta_start": draw(some(0.7, 2.4)), "psi_dot_start": draw(some(-1.0, 1.0))},
        **{"theta_dot_start": draw(some(-1.0, 1.0)), "phi_dot_start": draw(some(-6.0, 6.0))},
        **{"formulation": draw(st.sampled_from([1, 2, 3])), "friction_law": draw(st.sampled_from([1, 2]))},
        **{"method": draw(st.sampled_from([1, 2, 3, 4])), "omega_s": draw(some(0.01, 1.0)), "keep_contact": True},
    }


def loads(size: float = 5.0) -> st.SearchStrategy[Values]:
    """All six inputs, N and N m."""
    return st.fixed_dictionaries(dict.fromkeys(INPUTS, some(-size, size)))


anything_whole = st.one_of(st.integers(0, 4), st.integers(-(2**31), 2**31 - 1))


NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)
POWERS = ("X_O_dot", "Y_O_dot", "Z_O_dot", "theta", "psi_dot", "theta_dot", "omega_z", "lambda_3", "E")


def energy_defect(w: FMU2Wheel, counted: Values, pieces: int = 8, width: float = 1 / 32) -> float:
    """|change of E - work of the loads and of the smooth friction| over the size of what moves; quadrature of power.

    P = F v + M omega (carrier axes) - s N tanh(omega_z / omega_s) omega_z, by six Gauss nodes a piece.
    """
    first = E = w.get("E")[0]
    work = moved = 0.0
    for k in range(pieces):
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            w.to((k + 0.5 * (1 + node)) * width)
            v_X, v_Y, v_Z, theta, psi_dot, theta_dot, omega_z, N, E = w.get(*POWERS)
            friction = counted["s"] * max(N, 0.0) * np.tanh(omega_z / counted["omega_s"])
            speeds = (v_X, v_Y, v_Z, theta_dot, psi_dot * np.sin(theta), omega_z)
            powers = [counted[name] * v for name, v in zip(INPUTS, speeds, strict=True)] + [-friction * omega_z]
            work += 0.5 * width * weight * sum(powers)
            moved += 0.5 * width * weight * sum(map(abs, powers))
        w.to((k + 1) * width)
        E = w.get("E")[0]
    return abs(E - first - work) / (abs(first) + moved)
