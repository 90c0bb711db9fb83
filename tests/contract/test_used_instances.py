"""A used instance equals a fresh one: nothing of what it did is left after a reset, in a restored state, or after a
value that was set and taken back; whatever differed before: orbit, tolerance, road, contact, law, method, ending.
"""

from collections.abc import Callable

import pytest

from wheelfmu.fmu.driver import DISCARD, ERROR, OK, WARNING, FMU2Wheel, Values
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import AT_REST, GENERAL, KINDS, PULLED
from wheelfmu.truth.sliding import ROAD, THROWN

# Another value of each parameter, off that of every base.
OTHERS: Values = {"m": 23.0, "r_0": 0.34, "r": 0.08, "J_x": 1.0, "J_y": 0.8, "J_z": 1.6, "g": 8.0, "s": 0.02}
OTHERS |= {"mu_max": 0.5, "mu_slide": 0.0, "slope": 0.2, "slope_direction": 0.7, "psi_start": 1.0, "theta_start": 1.2}
OTHERS |= {"phi_start": 0.6, "psi_dot_start": 0.8, "theta_dot_start": -0.4, "phi_dot_start": -3.0, "X_O_start": 2.0}
OTHERS |= {"Y_O_start": -3.0, "slip_x_start": 0.4, "slip_y_start": -0.3, "formulation": 2, "friction_law": 2}
OTHERS |= {"omega_s": 0.05, "method": 4, "keep_contact": True, "guided": True}
HUB: Values = {"guided": True, "theta_start": 1.3, "psi_start": 0.0}
BASES: dict[str, Values] = {
    "unfolded": {"psi_dot_start": 0.3},
    "unfolded, guided": HUB,
    "rolls": {**GENERAL, "s": 0.01, "slope": 0.1, "psi_dot_start": 0.3},
    "slides": {**ROAD, **THROWN, "s": 0.01, "slope": 0.1, "friction_law": 2},
}
bases = pytest.mark.parametrize("base", BASES)
LOAD = {"F_X": (3.0, 1.0), "F_Y": (-2.0, 0.5, -0.3), "M_1": (0.3,), "M_2": (0.2, 0.1), "M_3": (0.5, 0.0, 0.0, 0.2)}
RATES = ("lambda_1", "lambda_2", "tau", "v_y")


def others(values: Values) -> Values:
    flags = {name: not values.get(name, False) for name in ("keep_contact", "guided")}
    return OTHERS | flags | {"mu_slide": 0.0 if "mu_slide" in values else 0.3}


def answers(w: FMU2Wheel) -> list[object]:
    """All that a run answers after its start: left alone, then with a brake, another s and loads that vary."""
    seen: list[object] = [w.bits(), w.serialized()]
    for t in (0.3, 0.7, 1.1):
        if t > 1:
            w.put(M_brake=0.4, s=0.015).give(LOAD)
        seen += [w.step_to(t), w.bits(), w.rates(RATES)(), w.serialized()]
        if seen[-4] != OK:
            break
    return [*seen, w.texts()]


def reset(w: FMU2Wheel) -> FMU2Wheel:
    """All that was set is as at first, what fmi2SetupExperiment sets too."""
    assert w.reset() == OK
    with w.new() as fresh:
        assert w.serialized() == fresh.serialized()
    w.take_messages()
    return w


def used(w: FMU2Wheel, values: Values, **how: float) -> bytes:
    """What a run arrives at in 0.4 s; nothing where it is refused."""
    if w.set(**values) != OK or w.initialise(**how) > WARNING:
        return b""
    w.step_to(w.time + 0.4)
    return w.bits()


@bases
def test_after_a_run_with_any_one_other_parameter_a_run_is_that_of_a_fresh_instance(wheel, base):
    values, w, differed = BASES[base], wheel(), 0
    fresh, own = answers(wheel().start(**values)), used(wheel(), values)
    for name, other in others(values).items():
        alone = used(wheel(), values | {name: other})
        assert used(w, values | {name: other}) == alone, name
        assert answers(reset(w).start(**values)) == fresh, name
        differed += alone != own
        reset(w)
    assert differed > 15  # the partner: most of the runs before are others


@bases
def test_after_another_tolerance_start_or_stop_time_a_run_is_that_of_a_fresh_instance(wheel, base):
    values, w = BASES[base], wheel()
    for own in ({}, {"tolerance": 1e-10}):
        fresh = answers(wheel().start(**own, **values))
        for other in ({"tolerance": 1e-6}, {"tolerance": 1e-11}, {"start": 5.0, "stop": 6.0}):
            assert used(w, values, **other) == used(wheel(), values, **other) != b""
            assert answers(reset(w).start(**own, **values)) == fresh
            reset(w)
    assert fresh != answers(w.start(**values))  # the partner: the tolerance shows


@bases
def test_a_value_that_is_set_in_initialization_mode_and_taken_back_was_never_set(wheel, base):
    values = BASES[base]
    fresh = answers(wheel().start(**values))
    for name, other in others(values).items():
        w = wheel().initializing(**values)
        (own,) = w.get(name)
        w.put(**{name: other}).get_one("theta_ddot")  # the start is computed with it
        w.put(**{name: type(other)(own)}).take_messages()
        assert w.exitInitializationMode() == OK
        assert answers(w) == fresh, name


def fails(w: FMU2Wheel) -> None:
    assert w.start(s=0.03).to(0.5).put(M_3=1e300).step(0.1) == ERROR


def needs_more_grip(w: FMU2Wheel) -> None:
    assert w.start(mu_max=0.45, start=2.0, tolerance=1e-6).step(1.0) == DISCARD


def falls(w: FMU2Wheel) -> None:
    assert w.start(theta_start=0.3, phi_dot_start=0.0, s=0.2).step(3.0) == DISCARD


def is_terminated(w: FMU2Wheel) -> None:
    assert w.start(**ROAD).to(0.7).put(F_Y=3.0).terminate() == OK


def is_refused(w: FMU2Wheel) -> None:
    assert w.put(m=-1.0, s=0.02, guided=True, F_Z=4.0).initialise(1e-5, 3.0, 4.0) == ERROR


def is_set(w: FMU2Wheel) -> None:
    assert w.put(**OTHERS).give(LOAD).setupExperiment(1e-6, 3.0, 4.0) == OK


def is_initializing(w: FMU2Wheel) -> None:
    assert w.initializing(**KINDS["sliding"], slip_x_start=1.0).give(LOAD).get("lambda_x")


def is_steered(w: FMU2Wheel) -> None:
    w.start(**HUB, s=0.01).give({"psi_dot_guide": (0.5, 0.2), "theta_dot_guide": (-0.1, 0.3), "F_Z": (-9.0, 3.0)})
    w.to(0.2).put(psi_dot_guide=0.7)


def is_pulled(w: FMU2Wheel) -> None:
    w.start(**PULLED, s=0.01).to(0.3)


def is_driven(w: FMU2Wheel) -> None:
    w.start(**AT_REST).put(M_3=-200.0).to(0.1)


LIVES: dict[str, Callable[[FMU2Wheel], object]] = {
    life.__name__: life
    for life in (fails, needs_more_grip, falls, is_terminated, is_refused, is_set, is_initializing, is_steered)
} | {"is_pulled": is_pulled, "is_driven": is_driven}
LIVES |= {name: lambda w, values=values: w.start(**values).to(0.2, 0.9) for name, values in KINDS.items()}
NEXT = KINDS | BASES | {"at rest": AT_REST, "pulled": PULLED, "pulled, friction": {**PULLED, "s": 0.01}}
NEXT |= {"at rest in a stiff law": {**KINDS["stiff law"], **AT_REST}}


def later(w: FMU2Wheel) -> list[object]:
    """What follows a state: alone, under a torque that makes a wheel slide if it can, and without it again."""
    w.take_messages()
    seen: list[object] = [w.bits(), w.serialized()]
    for t, torque in ((0.7, 0.0), (0.8, -30.0), (0.9, 0.0), (1.3, 1.0)):
        seen += [w.put(M_3=torque).step_to(t), w.bits(), w.serialized()]
        if seen[-3] != OK:
            break
    return [*seen, w.texts()]


@pytest.mark.parametrize("following", NEXT)
def test_whatever_an_instance_did_it_is_as_a_fresh_one_after_a_reset_and_in_a_restored_state(wheel, following):
    values = NEXT[following]
    fresh = answers(wheel().start(**values))
    saved = [wheel().start(**values).to(*times).serialized() for times in ((), (0.35,), (0.62,))]
    ahead = [later(wheel().back(blob)) for blob in saved]
    for name, live in LIVES.items():
        for blob, expected in zip(saved, ahead, strict=True):
            w = wheel()
            live(w)
            assert later(w.back(blob)) == expected, name
        assert answers(reset(w).start(**values)) == fresh, name
        live(reset(w))
        assert answers(reset(w).start(**values)) == fresh, name
    assert ahead[0] != ahead[1] != ahead[2]


def test_an_orbit_that_ends_where_grip_is_lost_is_not_that_of_a_wheel_that_can_slide(wheel):
    """Both without sliding friction: the second had some at its start."""
    w, fresh = wheel().start(mu_max=0.45), wheel()
    assert w.step(1.0) == DISCARD
    ends = [each.start(mu_max=0.45, mu_slide=0.4).put(mu_slide=0.0).to(1.0).bits() for each in (reset(w), fresh)]
    assert ends[0] == ends[1] and w.get("contact_mode") == [1]


def test_what_is_logged_once_per_run_is_logged_in_each_run_of_an_instance(wheel):
    """The grip that a load needs; a ground that pulls; and ends, of which a hundred are logged until a reset."""
    w = wheel()
    for _ in range(3):
        is_driven(w)
        assert len(w.to(0.3).texts()) == 1
        is_pulled(reset(w))
        assert len(w.to(1.0, 2.0).texts()) == 1
        reset(w)
    blob = w.start(mu_max=0.45).serialized()
    for k in range(120):
        assert w.back(blob).step(1.0) == DISCARD
        assert len(w.texts()) == (1 if k < 99 else 2 if k == 99 else 0)
    assert reset(w).start(mu_max=0.45).step(1.0) == DISCARD and len(w.texts()) == 1


EXCHANGED: dict[str, Values] = {
    "free": {"psi_dot_start": 0.3},
    "rolls": {**GENERAL, "s": 0.02, "slope": 0.1, "psi_dot_start": 0.3},
    "regularized": {"s": 0.02, "friction_law": 2, "omega_s": 0.01},
    "held": {**AT_REST, "s": 0.03},
    "guided": {**HUB, "phi_dot_start": -9.0, "s": 0.01},
    "pulled": {**PULLED, "s": 0.01},
}


def enter(w: FMU2Wheel, values: Values, **how: float) -> FMU2Wheel:
    w.start(**how, **values)
    assert not w.decide().terminateSimulation and w.enterContinuousTimeMode() == OK
    return w


def exchanged(w: FMU2Wheel, t: float = 0.0) -> list[object]:
    """Steps of Euler's, with an input, another s and an event on the way."""
    w.take_messages()
    seen: list[object] = []
    for k in range(8):
        if k == 4:
            seen.append(w.put(M_3=3.0, s=0.01).event().valuesOfContinuousStatesChanged)
        w.place(t + 0.01 * k, w.x() + 0.01 * w.derivatives())
        seen += [w.wants_event(), bytes(w.derivatives()), bytes(w.indicators()), w.bits(), w.serialized()]
    return [*seen, bytes(w.jacobian(("lambda_2", "psi_ddot"), ("M_2", "psi_dot"))), w.texts()]


@pytest.mark.parametrize("following", EXCHANGED)
def test_in_model_exchange_too(library: Library, following: str):
    new, values = loaded(library).new, EXCHANGED[following]
    with new(logging=True) as w, new(logging=True) as fresh, new(logging=True) as saved:
        expected = exchanged(enter(fresh, values))
        blob = enter(saved, values).serialized()
        for name, other in (EXCHANGED | {"steep": {"slope": 0.5, "mu_max": 0.9}}).items():
            exchanged(enter(w, other, tolerance=1e-6))
            assert exchanged(enter(reset(w), values)) == expected, name
            exchanged(enter(reset(w), other, start=3.0, stop=9.0), 3.0)
            assert exchanged(w.back(blob)) == expected, name
            reset(w)
    assert expected[:4] != expected[5:9]
