"""Lists: values, rates and derivatives of one call, in any order and repeated, equal those of single calls. Questions:
asking for anything changes nothing, no parameter, no later answer and no message either.
"""

from collections.abc import Callable, Iterator
from ctypes import byref, c_double, c_size_t
from math import pi

import numpy as np
import pytest
from support.bounds import beyond, within
from support.differences import LOADS, outputs

from wheelfmu.fmu.driver import DERIVATIVES, DISCARD, OK, STATES, Array, FMU2Wheel, Values
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import AT_REST, GENERAL, KINDS, PULLED
from wheelfmu.truth.sliding import ROAD, SLIDES, THROWN

TURNED: Values = {"psi_start": 1e5 + 0.3, "phi_start": -1e7 - 0.2, "slope": 0.2, "slope_direction": 3e6 + 0.1}
LEANING: Values = {"psi_start": 0.4, "theta_start": 1.2, "guided": True}
SCENES: dict[str, Values] = {name: KINDS[name] for name in ("free", "general inertia, friction", "stiff law", "adams")}
SCENES |= {
    "regularized": {**GENERAL, "s": 0.02, "friction_law": 2, "omega_s": 2.0},
    "turned": {**GENERAL, **TURNED, "s": 0.02, "mu_max": 0.9},
    "turned, multibody": {**TURNED, "s": 0.02, "formulation": 3},
    "slides": {**GENERAL, **TURNED, **ROAD, **THROWN, "s": 0.01},
    "slides, multibody, regularized": {**SLIDES["regularized"].start, "formulation": 3},
    "at rest, held": {**AT_REST, "s": 0.02},
    "guided": {**LEANING, "psi_dot_guide": 0.4, "theta_dot_guide": -0.2, "s": 0.01, "phi_dot_start": -8.0},
    "guided, slides": {**LEANING, **ROAD, "slip_x_start": 2.0, "slip_y_start": 0.5, "psi_dot_guide": -0.3},
    "pulled": {**PULLED, "s": 0.01},
}
LOAD = {"F_X": (3.0, 1.0), "F_Y": (-2.0, 0.5, -0.3), "M_1": (0.3,), "M_2": (0.2, 0.1), "M_brake": (0.5, 2.0)}
BRAKE = {"M_brake": (0.5, 2.0), "M_3": (-2.0, 9.0)}
each_scene = pytest.mark.parametrize("scene", SCENES)


def stored(w: FMU2Wheel) -> list[str]:
    return [name for name, v in w.variables.items() if v.causality in ("parameter", "input")]


def reals(w: FMU2Wheel, names: list[str]) -> list[str]:
    return [name for name in names if w.type_of(name) == "Real"]


def places(wheel: Callable[..., FMU2Wheel], values: Values) -> Iterator[tuple[str, FMU2Wheel]]:
    """Instances of a scene, from initialization to its end."""
    yield "initializing", wheel(logging=True).initializing(**values).give(LOAD)
    yield "at the start", wheel(logging=True).start(**values).put(M_2=0.3)
    yield "running", wheel(logging=True).start(**values).give(LOAD).to(0.05)
    yield "running, set", wheel(logging=True).start(**values).to(0.3).give(BRAKE).put(s=0.015)
    closed = wheel(logging=True).start(**values).to(0.3)
    assert closed.terminate() == OK
    yield "terminated", closed
    lifted = wheel(logging=True).start(**values).put(F_Z=5e3)
    if not values.get("keep_contact"):
        assert lifted.step(0.3) == DISCARD
        yield "ended", lifted


# ---- lists ----


def rates(w: FMU2Wheel, names: list[str]) -> Array:
    return np.array(w.rates(names)())


@each_scene
def test_values_and_rates_of_one_call_are_those_of_single_calls_in_any_order(wheel, scene):
    random = np.random.default_rng(5)
    for place, w in places(wheel, SCENES[scene]):
        names = reals(w, [*stored(w), *w.reals])
        single = {name: w.read([name]) for name in names}
        for _ in range(4):
            order = [names[k] for k in random.integers(len(names), size=40)]
            assert w.read(order) == b"".join(single[name] for name in order), place
        assert len(set(single.values())) > 20
        if place == "initializing":
            continue
        one = {name: rates(w, [name])[0] for name in outputs(w)}
        for size in (2, 3, 28, 40):
            order = [outputs(w)[k] for k in random.integers(len(one), size=size)]
            assert (rates(w, order) == [one[name] for name in order]).all(), (place, order)
        assert len(set(one.values())) > 5, place  # the partner: they differ


def derivative(w: FMU2Wheel, unknowns: list[str], knowns: list[str], seeds: list[float]) -> Array:
    return np.array(w.getDirectionalDerivative(w.refer(*unknowns), w.refer(*knowns), seeds))


def check_derivatives(w: FMU2Wheel, knowns: list[str], place: str) -> None:
    """Lists of unknowns and of knowns with seeds against single calls, in units of the largest derivative by the same
    known; by one that is refined until all unknowns are exact, they differ by what is exact enough."""
    random = np.random.default_rng(6)
    unknowns = [name for name in w.reals if np.isfinite(w.get(name)[0])]
    single = {known: np.array([derivative(w, [u], [known], [1.0])[0] for u in unknowns]) for known in knowns}
    size = {known: max(1.0, np.abs(column).max()) for known, column in single.items()}
    for known in knowns:
        bound = 1e-7 if "guide" in known else 1e-9
        order = random.permutation(len(unknowns))
        found = derivative(w, [unknowns[k] for k in order], [known], [1.0])
        within(np.abs(found - single[known][order]).max() / size[known], bound, f"{place}: off single calls by {known}")
        if len(set(single[known].round(9))) > 3:  # the partner: another order is another list
            beyond(np.abs(found - single[known]).max() / size[known], bound, f"{place}: in order, by {known}")
    for _ in range(4):
        chosen = [knowns[k] for k in random.integers(len(knowns), size=5)]
        seeds = [float(seed) / size[known] for seed, known in zip(random.normal(size=5), chosen, strict=True)]
        sums = sum(seed * single[known] for seed, known in zip(seeds, chosen, strict=True))
        found = derivative(w, [*unknowns, unknowns[3]], chosen, seeds)
        within(np.abs(found - [*sums, sums[3]]).max(), 1e-7, f"{place}: off the sum along {chosen}")


@each_scene
def test_derivatives_of_one_call_are_those_of_single_calls_in_any_order(wheel, scene):
    for place, w in places(wheel, SCENES[scene]):
        inputs = [name for name, v in w.variables.items() if v.causality == "input"]
        check_derivatives(w, reals(w, stored(w)) if place == "initializing" else inputs, place)


def test_derivatives_of_one_call_by_states_and_inputs_are_those_of_single_calls(library: Library) -> None:
    for values in ({**GENERAL, "s": 0.02, "slope": 0.1}, {"s": 0.02, "friction_law": 2, "omega_s": 0.01}):
        with exchange(library, **values) as w:
            w.place(0.1, w.x() + 0.02)
            check_derivatives(w, [*STATES, *LOADS], "model exchange")


# ---- questions ----


def remembered(w: FMU2Wheel) -> list[object]:
    """All that was set, computed, counted and kept."""
    return [w.get(*stored(w)), w.bits(), w.serialized()]


def ask_everything(w: FMU2Wheel, place: str) -> None:
    """Each unknown by each known, each rate, twice; states, their sizes and the status; what is refused, too."""
    running = place != "initializing"
    knowns = [n for n in stored(w) if not running or w.variables[n].causality == "input"]
    for name in (*stored(w), *w.reals, *w.integers):
        w.get_one(name)
    for known in knowns:
        values = (c_double * len(w.reals))()
        w.ask("GetDirectionalDerivative", w.refer(*w.reals), len(w.reals), w.refer(known), 1, [1.0], values)
    if running:
        rates(w, outputs(w))
        for kind in range(4):
            w.ask("GetRealStatus", kind, [0.0])
    state, size = w.snapshot(), c_size_t()
    assert w.ask("SerializedFMUstateSize", state, byref(size)) == OK
    w.free(state)


@each_scene
def test_asking_changes_nothing_no_parameter_either(wheel, scene):
    pairs = zip(places(wheel, SCENES[scene]), places(wheel, SCENES[scene]), strict=True)
    for (place, asked), (_, other) in pairs:
        before = remembered(asked)
        assert before == remembered(other), place
        ask_everything(asked, place)
        assert remembered(asked) == before, place
        for w in (asked, other):
            w.take_messages()
            if place == "initializing":
                assert w.exitInitializationMode() == OK
                w.time = 0.0
        ends = []
        for w in (asked, other):
            status = w.step(0.1)
            ends.append((status, w.step(0.3), remembered(w), w.texts()))
        assert ends[0] == ends[1], place
        assert ends[0][2] != before or place in ("terminated", "ended")


@each_scene
def test_asking_at_each_instant_changes_nothing_of_a_motion_and_of_what_it_logs(wheel, scene):
    asked, other = (wheel(logging=True).start(**SCENES[scene]) for _ in range(2))
    for k in range(1, 20):
        for w in (asked, other):
            w.give(BRAKE, w.time)
        ask_everything(asked, "running")
        asked.messages = [m for m in asked.messages if m.category == "logEvents"]
        other.messages = [m for m in other.messages if m.category == "logEvents"]
        assert asked.step_to(0.05 * k) == other.step_to(0.05 * k) == OK
        assert asked.bits() == other.bits()
    assert remembered(asked) == remembered(other) and asked.texts() == other.texts()


@pytest.mark.parametrize("name", ["rolls", "regularized", "held"])
def test_asking_changes_nothing_in_model_exchange(library: Library, name: str) -> None:
    values = {"rolls": {**GENERAL, "s": 0.02, "slope": 0.1, "psi_start": 1e6}, "held": {**AT_REST, "s": 0.02}}
    values |= {"regularized": {"s": 0.02, "friction_law": 2, "omega_s": 0.01}}
    counts = ("n_rhs", "n_roots")
    with exchange(library, **values[name]) as w, exchange(library, **values[name]) as other:
        for k in range(4):
            for each in (w, other):
                each.place(0.1 * k, each.x() + 0.01 * each.derivatives())
            before, counted = [w.x().tolist(), w.serialized()], w.get(*counts)
            ask_everything(w, "model exchange")
            w.jacobian(DERIVATIVES, STATES)
            assert w.get(*counts) == counted and [w.x().tolist(), w.serialized()] == before
            w.vector("NominalsOfContinuousStates")
            assert (w.x() == other.x()).all() and w.bits() == other.bits()
            assert bytes(w.derivatives()) == bytes(other.derivatives())
            assert bytes(w.indicators()) == bytes(other.indicators())
            assert [a - b for a, b in zip(w.get(*counts), counted, strict=True)] == [1, 1]  # each counts what it asks
            assert w.event().valuesOfContinuousStatesChanged == other.event().valuesOfContinuousStatesChanged
        assert w.serialized() == other.serialized()


def test_a_derivative_at_a_limit_of_its_parameter_leaves_the_parameter(wheel):
    """One-sided: zero of s, r, slope, mu, g, omega_s and M_brake; J_z at J_x + J_y; a slope next to a wall."""
    limits = {"s": 0.0, "r": 0.0, "slope": 0.0, "mu_max": 0.0, "g": 0.0, "M_brake": 0.0, "J_z": 1.8}
    limits |= {"omega_s": 1e-12, "slope_direction": 1e12, "psi_start": -1e12, "phi_start": 1e12}
    start = {"keep_contact": True, "friction_law": 2, "psi_dot_start": 0.5}
    for name, value in limits.items():
        w = wheel().initializing(**{**start, name: value})
        before = remembered(w)
        found = w.jacobian(w.reals, [name])
        assert np.isfinite(found).all() and w.get(name) == [value] and remembered(w) == before, name
    w = wheel().initializing(slope=pi / 2 - 1e-9, keep_contact=True)
    assert np.isfinite(w.jacobian(["lambda_3"], ["slope"])).all() and w.get("slope") == [pi / 2 - 1e-9]
