"""Model exchange: the wheel moved by solvers that are not ours, with our events, against reference and closed forms.

SciPy's DOP853 with the events of truth/exchange.py, and FMPy's CVODE. SI units.
"""

import re
from math import pi

import numpy as np
import pytest
from fmpy import simulate_fmu
from support.bounds import beyond, within

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.truth.closed_forms import fall_time, rolling_inertia
from wheelfmu.truth.errors import range_error, range_errors
from wheelfmu.truth.exact_motions import UPRIGHT
from wheelfmu.truth.exchange import Run, exchange, no_inputs
from wheelfmu.truth.measure import FRICTION, instants_error, paper, transitions
from wheelfmu.truth.motion import Library, start_values
from wheelfmu.truth.reference import Start, Wheel, solve
from wheelfmu.truth.scenes import PULLED, PUSH

RIM = start_values(Wheel(J_x=0.05, J_y=0.05, J_z=0.1), Start(theta=1.4, phi_dot=0.0))


def moved(library: Library, times: list[float], rtol: float = 1e-11, inputs=no_inputs, **values: float):
    """The run, its rows of all outputs and local variables at the times that it reached, and its sentences."""
    with exchange(library, logging=True, **values) as wheel:
        run, rows = Run(wheel, rtol, inputs), []
        for t in times:
            run.to(t)
            rows.append(wheel.reader(wheel.reals)())
            if run.ended is not None:
                break
        return run, dict(zip(wheel.reals, np.array(rows).T, strict=True)), wheel.sentences


MODES = {"stick": 0, "positive.": 1, "negative.": -1}


@pytest.mark.parametrize("scene", FRICTION)
def test_the_papers_scenes_and_all_37_transitions_come_out_of_another_solver(library: Library, scene: str) -> None:
    want, s = paper(scene), FRICTION[scene]

    def errors(s: float, rtol: float = 1e-11) -> tuple[float, float]:
        run, got, sentences = moved(library, list(want.t), rtol, s=s)
        modes = [next(mode for word, mode in MODES.items() if word in sentence) for sentence in sentences]
        late = instants_error(list(zip(run.events, modes, strict=True))) if scene == "friction" else 0.0
        return range_error(got, want, HEADLINE), late

    error, late = errors(s)
    within(error, 1e-8, "error / range")
    within(late, 1e-9, "instants of the transitions, s")
    beyond(errors(s, 1e-5)[0], 5e-5, "error at a loose tolerance / range")
    beyond(errors(s + 1e-6)[0], 3e-5, "error of another s / range")
    if s:
        beyond(errors(s * (1 + 1e-6))[1], 2e-7, "instants of another s, s")


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-10])
def test_fmpys_cvode_finds_them_too_within_some_thousand_of_its_tolerances(library, tolerance: float, capfd) -> None:
    want = paper("friction")
    grid = {"stop_time": 10, "output_interval": 0.1, "relative_tolerance": tolerance, "record_events": False}
    how = {"fmi_type": "ModelExchange", "start_values": {"s": 0.03}, "output": [*HEADLINE], "debug_logging": True}
    run = simulate_fmu(library.folder, **grid, **how)
    within(range_errors(run, want, HEADLINE), 1e4 * tolerance, "error / range")
    # FMPy prints the sentences. (Its argument `logger` would stay in use, freed, by all later runs of this process.)
    found = [float(t) for t in re.findall(r"^\[OK\] t = (\S+) s", capfd.readouterr().out, re.M)]
    assert len(found) == 37
    late = np.abs(np.array(found) - transitions()[1:, 0]).max()
    within(late / tolerance, 1e4, "instants of the transitions over tolerance, s")


def test_a_released_wheel_lies_flat_at_the_instant_of_the_closed_form(library: Library) -> None:
    run, _, sentences = moved(library, [2.0], phi_dot_start=0.0)
    assert "lies flat" in sentences[-1]
    within(abs(run.ended - fall_time(Wheel(), 5 * pi / 12, 1e-7)), 3e-11, "instant at which it lies flat, s")
    beyond(abs(run.ended - fall_time(Wheel(r=0.051), 5 * pi / 12, 1e-7)), 1e-4, "instant of another wheel, s")


def test_a_light_rim_lifts_off_where_co_simulation_ends(library: Library) -> None:
    done = library.simulate([0.0, 2.0], 1e-12, **RIM)
    run, _, sentences = moved(library, [2.0], **RIM)
    assert "lifted off" in sentences[-1]
    within(abs(run.ended - done.end), 1e-10, "instant at which it lifts off, s")
    other = moved(library, [2.0], **{**RIM, "r": 0.051})[0]
    beyond(abs(other.ended - done.end), 2e-4, "instant of another wheel, s")


def test_a_brake_put_on_by_a_continuous_input_stops_and_holds(library: Library) -> None:
    def brake(t: float) -> dict[str, float]:
        return {"M_brake": max(0.0, 40.0 * (t - 0.5))}

    run, got, sentences = moved(library, [0.4, 3.0], inputs=brake, **{**UPRIGHT, "phi_dot_start": -5.0})
    stop = 0.5 + (2 * 5.0 * rolling_inertia(Wheel()) / 40.0) ** 0.5
    assert "stick" in sentences[0] and len(sentences) == 1
    within(abs(run.events[-1] - stop), 1e-11, "instant at which it stops, s")
    assert got["omega_z"][-1] == 0
    late, _, _ = moved(library, [3.0], inputs=brake, s=1e-5, **{**UPRIGHT, "phi_dot_start": -5.0})
    beyond(abs(late.events[-1] - stop), 1e-5, "instant with a trace of rolling resistance, s")


SOON = 1e-7 * (0.35 / 9.81) ** 0.5  # s: an event that lies ahead by less has happened
ENDS, CHANGES = "terminateSimulation", "valuesOfContinuousStatesChanged"
FALL = {"phi_dot_start": 0.0}
AHEAD = {  # start values, which event of the run, what it calls for
    "stick": ({"s": 0.03}, 0, CHANGES),
    "release": ({"s": 0.03}, 1, CHANGES),
    "lift-off": (RIM, 0, ENDS),
    "a ground that presses again": (PULLED, 0, CHANGES),
    "a ground that begins to pull": (PULLED, 1, CHANGES),
    "loss of grip": ({"mu_max": 0.3}, 0, ENDS),
    "flat": (FALL, 0, ENDS),
    "flat on the other side": ({**FALL, "theta_start": 1.8}, 0, ENDS),
}


@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize("event", AHEAD)
def test_an_event_counts_that_lies_ahead_by_less_than_the_wheels_own_tenmillionth(library, event: str, share: float):
    values, number, what = AHEAD[event]
    with exchange(library, **values) as whole, exchange(library, **values) as wheel:
        run, early = (Run(w, 1e-12, no_inputs) for w in (whole, wheel))
        while len(run.events) <= number:
            run.to(run.t + 0.1)
        assert what == ENDS or all(run.changed)  # fmusim restarts its solver only there
        early.to(run.events[number] - share * SOON)
        happened = len(early.events) > number or bool(getattr(wheel.event(), what))
        assert happened == (share < 1)


def test_a_driven_wheel_on_a_slope_agrees_with_the_reference(library: Library) -> None:
    wheel, start = Wheel(J_x=0.7, J_y=1.2, s=0.02, slope=0.1, slope_direction=0.5), Start(psi_dot=0.4)
    times = list(np.linspace(0, 3, 7))
    names = ("X_O", "Y_O", "theta", "psi", "omega_z", "lambda_3", "E")

    def push(t: float) -> dict[str, float]:
        values = PUSH.derivatives(t)[0]
        return dict(zip(("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3"), values.tolist(), strict=False))

    def gap(judged: Wheel) -> float:
        want = solve(judged, start, times, PUSH.for_reference(), rtol=1e-12)
        _, got, _ = moved(library, times, 1e-11, push, keep_contact=True, **start_values(wheel, start))
        return max(float(np.abs(got[n] - want[n]).max() / (1 + np.abs(want[n]).max())) for n in names)

    within(gap(wheel), 1e-9, "outputs off the reference, relative")
    beyond(gap(Wheel(**{**vars(wheel), "slope": 0.1 + 1e-6})), 5e-6, "outputs off those of a steeper road, relative")
