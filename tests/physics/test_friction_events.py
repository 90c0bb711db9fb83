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
from wheelfmu.truth.scenes import Scene

INSTANTS, MODES = transitions().T


def test_all_37_transitions_are_found_at_their_instants(library: Library) -> None:
    assert len(instants(library)) == 37
    within(instants_error(instants(library)), 3e-8, "instants of the transitions, s")
    beyond(instants_error(instants(library, s=0.03 * (1 + 1e-5))), 1e-6, "instants with another s, s")


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6, 1e-10, 1e-13])
def test_no_transition_is_lost_or_invented_at_any_tolerance(library: Library, tolerance: float) -> None:
    modes = [mode for _, mode in instants(library, tolerance)]
    assert modes == MODES[1:].tolist()
    assert [mode for _, mode in instants(library, tolerance, s=0.05)] != modes


def test_the_instants_converge_with_the_tolerance(library: Library) -> None:
    within(instants_error(instants(library, 1e-10)), 5e-9, "instants of the transitions, s")
    beyond(instants_error(instants(library, 1e-5)), 1e-6, "instants at a loose tolerance, s")


def mode_error(library: Library, shift: float) -> int:
    """How many of 37 pairs of readings, 1e-7 s before and after a transition (shifted), show another mode."""
    times = np.sort(np.concatenate([INSTANTS[1:] - 1e-7, INSTANTS[1:] + 1e-7])) + shift
    modes = library.simulate([0.0, *times], s=0.03)["friction_mode"][1:].reshape(-1, 2)
    expected = np.column_stack([MODES[:-1], MODES[1:]])
    return int((modes != expected).any(axis=1).sum())


def test_the_friction_mode_read_between_steps_changes_at_the_same_instants(library: Library) -> None:
    assert mode_error(library, 0.0) == 0
    assert mode_error(library, 1e-6) == 37


def test_a_held_wheel_has_no_spin_and_a_rolling_one_has_that_of_its_mode(library: Library) -> None:
    run = library.simulate(np.linspace(0, 10, 5001), s=0.03)
    held = run["friction_mode"] == 0
    within(abs(held.mean() - 0.16), 1e-3, "share of the time in which friction holds, off 0.16")
    assert (run["omega_z"][held] == 0).all()
    assert (np.sign(run["omega_z"][~held]) == run["friction_mode"][~held]).all()
    lighter = library.simulate(np.linspace(0, 10, 5001), s=0.02)
    within((lighter["friction_mode"] == 0).mean(), 0.02, "share of the time in which a lighter friction holds")


def late_releases(library: Library, tolerance: float | None, s: float = 0.03) -> tuple[list[int], float]:
    """Transitions in 30 s as modes, and the energy at 30 s, J."""
    run = library.simulate([0.0, 30.0], tolerance, s=s)
    return [mode for _, mode in run.events], run["E"][-1]


def test_the_ever_weaker_releases_of_a_long_run_are_those_of_the_independent_reference(library: Library) -> None:
    want = Scene({"s": 0.03}).solved([0.0, 30.0], rtol=1e-11)
    modes, energy = late_releases(library, None)
    assert modes == [mode for _, mode in want.events[1:]]
    assert len(modes) == 150
    within(abs(energy - want["E"][-1]), 5e-6, "energy at 30 s, J")
    beyond(abs(late_releases(library, None, s=0.03 * (1 + 1e-4))[1] - want["E"][-1]), 5e-6, "energy with another s, J")


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
