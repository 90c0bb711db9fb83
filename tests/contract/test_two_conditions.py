"""Saving where two conditions meet: a restored wheel goes on with the bits and messages of the one that was saved, and
saving leaves no trace, whatever is under way at once: a pull with friction or a slip, a polynomial that goes on or
whose value stays, a road that changes, a layer, an event that is known and not reached, a brake, a carrier that turns.
"""

import re
from collections.abc import Callable
from math import cos
from typing import NamedTuple

import pytest

from wheelfmu.fmu.driver import OK, FMU2Wheel, Values
from wheelfmu.truth.scenes import AT_REST, GENERAL, PULLED, SCENES
from wheelfmu.truth.sliding import ROAD, SLIDES, THROWN

STEP = 1 / 32  # s
Inputs = dict[str, tuple[float, ...]]


class Meeting(NamedTuple):
    """A scene under inputs from its start, `how` they are set: once; again at each step, as one polynomial that is cut;
    at each step as the same polynomial from its beginning; as values that jump, those of a road too; or late, from half
    the time on. `meets`: what must be under way at once where states are saved.
    """

    values: Values
    inputs: Inputs = {}
    how: str = "once"
    meets: Callable[[dict[str, float]], bool] = lambda now: True
    stop: float = 1.5


CUBIC: Inputs = {"F_X": (1.0, 3.0, -4.0, 2.0), "F_Z": (-5.0, 9.0, 3.0, -2.0), "M_2": (0.1, -0.3, 0.2, 0.1)}
CUBIC |= {"M_3": (0.5, -2.0, 1.0, 0.5), "F_Y": (0.0, 1.0, 1.0, -1.0), "M_1": (0.0, 0.2, -0.1, 0.1)}
BRAKE: Inputs = {"M_brake": (6.0, -14.0, 8.0, 2.0), "M_3": (-4.0, 9.0)}
PULL: Inputs = {"F_Z": (100.0, 400.0, -300.0), "M_3": (4.0, -9.0)}
TURN: Inputs = {"psi_dot_guide": (0.4, 0.5, -0.3, 0.1), "theta_dot_guide": (-0.1, 0.3, -0.2), "F_X": (4.0, -20.0)}
PUSH: Inputs = {"M_1": (1e-6,)}
WAY: Inputs = {"slope": (0.3, 0.2), "slope_direction": (-1.0, 2.0), "s": (0.02, 0.01)}
STIFF = SCENES["stiff law"].start


def pulls(now: dict[str, float]) -> bool:
    return now["lambda_3"] < 0


def slides(now: dict[str, float]) -> bool:
    return now["contact_mode"] == 1


def held(now: dict[str, float]) -> bool:
    return now["friction_mode"] == 0


def brakes(now: dict[str, float]) -> bool:
    return now["tau_brake"] != 0


MEETINGS = {
    "a pull, unfolded": Meeting(PULLED, meets=pulls),
    "a pull that was logged, a push off the orbit": Meeting(PULLED, PUSH, "late", meets=pulls),
    "a pull ahead, a push off the orbit": Meeting(
        {"keep_contact": True, "psi_dot_start": 5.0, "theta_dot_start": 3.0, "phi_dot_start": 4.0},
        PUSH,
        "late",
        stop=0.375,  # pushed at 0.1875 s, pulls at 0.2096 s
    ),
    "a pull, friction": Meeting({**PULLED, "s": 0.02}, meets=pulls),
    "a pull, friction, a cubic that goes on": Meeting({**PULLED, "s": 0.02}, CUBIC, "cut", meets=pulls),
    "a pull by a load, held by the brake": Meeting(
        {**AT_REST, "s": 0.02, "keep_contact": True},
        {**PULL, "M_brake": (20.0,)},
        "cut",
        meets=lambda now: pulls(now) and held(now),
    ),
    "a pull, regularized": Meeting({**PULLED, "s": 0.02, "friction_law": 2, "omega_s": 0.1}, PULL, "cut", meets=pulls),
    "a pull, a slip": Meeting(SLIDES["pulled"].start, meets=lambda now: pulls(now) and slides(now), stop=0.8),
    "a pull, a slip, a cubic": Meeting(
        SLIDES["pulled"].start, CUBIC, "cut", meets=lambda now: pulls(now) and slides(now), stop=0.8
    ),
    "sticks and releases": Meeting({"s": 0.03}, stop=2.5),
    "a loss of grip": Meeting(ROAD, stop=1.2),
    "a loss of grip, multibody": Meeting({**ROAD, "formulation": 3}, stop=1.2),
    "a cubic that goes on": Meeting({"s": 0.02}, CUBIC, "cut"),
    "a cubic that is left alone": Meeting({"s": 0.02}, CUBIC),
    "a cubic that begins anew at each step": Meeting({"s": 0.02}, CUBIC, "anew"),
    "loads that jump": Meeting({"s": 0.01, "method": 4}, CUBIC, "jump"),
    "a slip, loads that jump": Meeting({**ROAD, **THROWN, "s": 0.01}, CUBIC, "jump", meets=slides),
    "a road that changes": Meeting(GENERAL, WAY, "jump"),
    "a slip, a road that changes": Meeting(
        {**ROAD, **THROWN}, WAY | {"mu_max": (0.3, 0.2), "mu_slide": (0.2, 0.15)}, "jump", meets=slides
    ),
    "a slip on ice, loads that jump": Meeting(
        {**ROAD, "s": 0.01}, {"mu_max": (0.0, 0.0), "M_3": (-1.0, 3.0), "F_Y": (0.0, 2.0)}, "jump", meets=slides
    ),
    "a limit of the grip that is set on the way": Meeting(
        {**AT_REST, "phi_dot_start": -60.0},
        {"mu_max": (0.6, 0.2), "M_brake": (50.0, -20.0)},
        "jump",
        meets=brakes,
        stop=0.3125,  # ends after 0.25 s
    ),
    "a cubic, multibody, Adams": Meeting({**GENERAL, "s": 0.02, "formulation": 3, "method": 2}, CUBIC, "cut"),
    "a cubic, BDF, regularized": Meeting({"s": 0.02, "friction_law": 2, "omega_s": 0.01, "method": 3}, CUBIC, "cut"),
    "a slip, a cubic": Meeting({**ROAD, **THROWN, "s": 0.01}, CUBIC, "cut", meets=slides),
    "a slip, multibody, a brake": Meeting({**ROAD, **THROWN, "formulation": 3}, BRAKE, "cut", meets=slides),
    "a slip of a held wheel": Meeting(
        {**ROAD, **AT_REST, "slip_x_start": 4.0},
        {"M_brake": (900.0, 30.0)},
        meets=lambda now: slides(now) and held(now),
    ),
    "a slip, a stiff law, a brake": Meeting(
        {**STIFF, **ROAD, **THROWN}, BRAKE, "cut", meets=lambda now: slides(now) and brakes(now)
    ),
    "a layer": Meeting(STIFF, stop=2.2),
    "a layer, a cubic": Meeting(STIFF, CUBIC, "cut", stop=2.2),
    "a law that a ramp makes stiff": Meeting(
        {"s": 1e-5, "friction_law": 2, "omega_s": 1e-3, "phi_dot_start": -1.0},
        {"M_brake": (0.0, 60.0)},
        "cut",
        meets=brakes,
    ),
    "a brake past its zeros": Meeting({"s": 0.01}, BRAKE, "cut", meets=brakes),
    "a steered carrier": Meeting(
        {"guided": True, "psi_start": 0.0, "theta_start": 1.4, "phi_dot_start": -9.0, "s": 0.01}, TURN, "cut"
    ),
    "a steered carrier whose rates stay": Meeting(
        {"guided": True, "psi_start": 0.0, "theta_start": 1.4, "phi_dot_start": -9.0, "formulation": 3}, TURN, "anew"
    ),
    "a steered carrier that slides": Meeting(
        {"guided": True, "psi_start": 0.0, "theta_start": 1.4, **ROAD, "slip_x_start": 3.0, "s": 0.01},
        TURN | BRAKE,
        "cut",
        meets=slides,
    ),
    "a rest in a soft law": Meeting(
        {**AT_REST, "guided": True, "s": 0.003, "friction_law": 2, "omega_s": 3e-3, "phi_dot_start": -2.0},
        {"M_brake": (20.0,), "M_3": (7.0,)},
        meets=brakes,
    ),
    "a lift-off ahead": Meeting({"s": 0.01}, {"F_Z": (0.0, 150.0)}, "cut", stop=1.6),
    "a fall ahead": Meeting({"theta_start": 0.6, "phi_dot_start": 0.0, "psi_dot_start": 0.2, "s": 0.05}),
}


RATES = ("lambda_1", "lambda_3", "tau", "v_x")


def step(w: FMU2Wheel, meeting: Meeting, t: float) -> list[object]:
    """To t, and all that is seen there."""
    w.take_messages()
    if meeting.how == "cut" or (meeting.how == "anew" and w.time > 0):
        w.give(meeting.inputs, w.time if meeting.how == "cut" else 0.0)
    if meeting.how == "late" and w.time >= meeting.stop / 2:
        w.give(meeting.inputs)
    if meeting.how == "jump":
        w.put(**{name: c[0] + c[1] * cos(9 * w.time) for name, c in meeting.inputs.items()})
    return [w.step_to(t), w.bits(), w.rates(RATES)(), w.get(*meeting.inputs), w.texts()]


def steps(w: FMU2Wheel, meeting: Meeting, times: list[float]) -> list[list[object]]:
    """Up to the last of the times or the end of the run."""
    seen: list[list[object]] = []
    while len(seen) < len(times) and (not seen or seen[-1][0] == OK):
        seen.append(step(w, meeting, times[len(seen)]))
    return seen


def started(w: FMU2Wheel, meeting: Meeting) -> FMU2Wheel:
    w.start(tolerance=1e-7, **meeting.values)
    return w if meeting.how in ("jump", "late") else w.give(meeting.inputs)


def instants(seen: list[list[object]]) -> list[float]:
    """Those of the first events that are logged."""
    found = re.findall(r"t = (\S+) s", " ".join(text for *_, texts in seen for text in texts))
    return sorted({float(t) for t in found})[:6]


NAMES = ("lambda_3", "contact_mode", "friction_mode", "tau_brake")
NEAR = (-1e-9, -1e-14, 0.0, 1e-14, 1e-9)


@pytest.mark.parametrize("name", MEETINGS)
def test_a_restored_wheel_goes_on_as_the_saved_one_wherever_two_conditions_meet(wheel, name):
    """Saved at every step, at logged events, a few roundings and a nanosecond before and after them."""
    meeting = MEETINGS[name]
    grid = [STEP * (k + 1) for k in range(round(meeting.stop / STEP))]
    events = instants(steps(started(wheel(logging=True), meeting), meeting, grid))
    times = sorted({*grid, *(t + near for t in events for near in NEAR if 0 < t + near < meeting.stop)})
    straight = steps(started(wheel(logging=True), meeting), meeting, times)
    w, met = started(wheel(logging=True), meeting), 0
    other = wheel(logging=True).start(s=0.01, m=7.0, tolerance=1e-5).to(0.3)
    for k, expected in enumerate(straight):
        blob, fresh = w.serialized(), wheel(logging=True)
        met += meeting.meets(dict(zip(NAMES, w.get(*NAMES), strict=True)))
        for restored in (fresh, other):
            assert (restored.back(blob).bits(), restored.serialized()) == (w.bits(), blob), w.time
            assert steps(restored, meeting, times[k : k + 3]) == straight[k : k + 3], w.time
        fresh.close()
        assert step(w, meeting, times[k]) == expected  # saving has left no trace
    assert met > 3  # the partner: the conditions have met
    assert len({bits for _, bits, *_ in straight}) > 0.7 * len(grid)  # and the wheel has moved


ROAD_AND_INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake")
ROAD_AND_INPUTS += ("s", "mu_max", "mu_slide", "slope", "slope_direction")


@pytest.mark.parametrize(
    ("start", "contact"), [({"mu_max": 0.9, "mu_slide": 0.8}, 0), ({"mu_max": 0.2, "mu_slide": 0.2, **THROWN}, 1)]
)
def test_what_is_set_and_not_in_force_yet_is_part_of_the_state_while_a_polynomial_goes_on(wheel, start, contact):
    w = wheel().start(s=0.02, slope=0.1, M_brake=5.0, **start).give(CUBIC).to(0.5).give(CUBIC, 0.5)
    assert w.get("contact_mode") == [contact]
    blob, ahead = w.serialized(), w.to(0.6).bits()
    for name in ROAD_AND_INPUTS:
        news = w.back(blob).put(**{name: w.get(name)[0] - 1e-3}).serialized()
        restored = wheel().back(news)
        assert restored.get(*ROAD_AND_INPUTS) == w.get(*ROAD_AND_INPUTS), name
        assert restored.to(0.6).bits() == w.to(0.6).bits() != ahead, name
