"""Rolling resistance as a switch: the 37 transitions of the paper's friction scene, and what friction takes.

s = 0.03 m, Filippov's law at omega_z = 0 (physics facts 3 and 5). friction_mode: sign of omega_z, 0 held.
"""

import numpy as np
import pytest
from support.bounds import absolute_error, beyond, within

from wheelfmu.fmu.driver import OK
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.measure import instants, instants_error, transitions
from wheelfmu.truth.motion import Library

INSTANTS, MODES = transitions().T


@pytest.mark.parametrize(
    ("tolerance", "off"), [(1e-2, 1.0), (1e-4, 1.0), (None, 3e-8), (1e-10, 5e-9), (1e-13, 5e-9)], ids=str
)
def test_all_37_transitions_are_found_at_their_instants(library: Library, tolerance: float | None, off: float) -> None:
    """None is lost or invented at any tolerance, and the instants converge with it."""
    found = instants(library, tolerance)
    assert [mode for _, mode in found] == MODES[1:].tolist() and len(found) == 37
    within(instants_error(found), off, "instants of the transitions, s")
    if off < 1:
        beyond(instants_error(instants(library, tolerance, s=0.03 * (1 + 1e-5))), 1e-6, "instants with another s, s")


def test_a_held_wheel_has_no_spin_and_a_rolling_one_has_that_of_its_mode(library: Library) -> None:
    run = library.simulate(np.linspace(0, 10, 5001), s=0.03)
    held = run["friction_mode"] == 0
    within(abs(held.mean() - 0.16), 1e-3, "share of the time in which friction holds, off 0.16")
    assert (run["omega_z"][held] == 0).all()
    assert (np.sign(run["omega_z"][~held]) == run["friction_mode"][~held]).all()
    lighter = library.simulate(np.linspace(0, 10, 5001), s=0.02)
    within((lighter["friction_mode"] == 0).mean(), 0.02, "share of the time in which a lighter friction holds")


FIRST = ("tau", "friction_mode", "omega_z_dot", "psi_ddot", "lambda_1", "lambda_2")


def spun_off(library: Library, excess: float, formulation: int, kind: str) -> tuple[float, list[str]]:
    """Of sixty wheels whose omega_z is `excess` and the rounding of psi_dot cos(theta) + phi_dot: the largest change of
    the first readings within 1e-9 s, or by the first event mode, and the messages until then."""
    rng, worst, sentences = np.random.default_rng(6), 0.0, []
    thetas = np.concatenate([np.full(20, np.pi / 2), rng.uniform(0.7, 2.4, 40)])
    for theta, psi_dot, s in zip(thetas, rng.uniform(-3, 3, 60), rng.uniform(1e-4, 0.1, 60), strict=True):
        phi_dot = excess - psi_dot * np.cos(theta) if theta != np.pi / 2 else excess
        start = {"theta_start": theta, "psi_dot_start": psi_dot, "phi_dot_start": phi_dot, "s": s}
        if kind == "model exchange":
            wheel = loaded(library).new(logging=True).start(**start)
            before = wheel.get(*FIRST)
            wheel.decide()
        else:
            wheel = library.wheel(logging=True).start(formulation=formulation, keep_contact=True, **start)
            before = wheel.get(*FIRST)
            assert wheel.step(1e-9) == OK
        worst = max(worst, absolute_error(wheel.get(*FIRST), before))
        sentences += [text for text in wheel.sentences if "omega_z" in text]
        wheel.close()
    return worst, sentences


@pytest.mark.parametrize(("formulation", "kind"), [(2, "reduced"), (3, "multibody"), (1, "model exchange")])
def test_a_spin_that_is_only_rounding_is_none_from_the_first_reading_on(library: Library, formulation, kind) -> None:
    worst, sentences = spun_off(library, 0.0, formulation, kind)
    within(worst, 1e-5, "change of the first readings, N m, 1/s2, N")
    assert sentences == []
    worst, sentences = spun_off(library, 1e-14, formulation, kind)  # the partner: a spin that is there
    beyond(worst, 1, "change of the first readings where there is a spin")
    assert len(sentences) > 20
