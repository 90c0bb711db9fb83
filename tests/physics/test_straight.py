"""Straight motions known in closed form: of an upright wheel, free or on its carrier, and of one that leans on it.

A wheel that leans at theta on its carrier rolls and slides as an upright one whose tube has the radius r sin(theta):
R = r_0 + r sin(theta), N = m g, v of O along e1, slip_x = v + R omega_z; the moments of ground, brake and motor turn
J_z + m R^2 while it grips. SI units.
"""

from dataclasses import dataclass
from math import atan, cos, pi, radians, sin

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.truth import sliding
from wheelfmu.truth.closed_forms import rolling_inertia
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import ROAD, UPRIGHT

M, G = 20.0, 9.81
GRIPS, SLIDES = 0, 1
DOWN = {"slope_direction": pi}  # the road falls towards X


@dataclass(frozen=True)
class Way:
    """rest: so long a wheel at rest keeps its tilt, s: a free one falls by the rounding of 90 degrees."""

    theta: float = pi / 2
    guided: bool = True
    rest: float = 60.0

    @property
    def wheel(self) -> Wheel:
        """The upright wheel that moves alike."""
        return Wheel(r=0.05 * sin(self.theta))

    @property
    def R(self) -> float:
        return self.wheel.r_0 + self.wheel.r

    @property
    def inertia(self) -> float:
        return rolling_inertia(self.wheel)


WAYS = {"free": Way(guided=False, rest=0.5), "guided": Way()}
WAYS |= {f"guided, {degrees} degrees": Way(radians(degrees)) for degrees in (80, 132)}


@pytest.fixture(params=WAYS.values(), ids=WAYS)
def way(request) -> Way:
    return request.param


@pytest.fixture
def move(library: Library, formulation: int, way: Way):
    """Along X, from rest unless said, under inputs by name."""

    def moved(times, inputs: dict | None = None, tolerance: float = 1e-11, **start) -> Run:
        pose = {**UPRIGHT, "theta_start": way.theta, "guided": way.guided, "formulation": formulation}
        return library.simulate(times, tolerance, Schedule(((0.0, inputs or {}),)), **{**pose, **start})

    return moved


# ---- it grips ----


@pytest.mark.parametrize("s", [0.0, 0.02], ids=["brake", "brake and friction"])
def test_brake_and_friction_stop_it_at_their_instant_and_hold_it(move, way: Way, s: float) -> None:
    brake, spin = 10.0, -8.0
    slowing = (s * M * G + brake) / way.inertia
    stop, distance = -spin / slowing, way.R * spin**2 / (2 * slowing)

    def error(judged: float) -> float:
        start = {"phi_dot_start": spin, "s": s * judged}
        run = move([0.0, stop / 2, stop + way.rest / 2, stop + way.rest], {"M_brake": brake * judged}, **start)
        assert not run["omega_z"][2:].any()
        ((instant, mode),) = run.events
        assert mode == 0 and (abs(instant - stop) < 1e-9) == (judged == 1)  # logged to the nanosecond
        within(absolute_error(run["tau"][:2], judged * (s * M * G + brake)), 64 * brake * EPSILON, "moment, N m")
        return absolute_error([*run["omega_z"][1:2], *run["X_O"][2:]], [spin / 2, distance, distance])

    within(error(1.0), 256 * EPSILON, "spin half-way, rad/s, and way, m")
    beyond(error(1.0001), 1e-5, "spin and way with 0.01 % more of both")


@pytest.mark.parametrize("s", [0.0, 0.03], ids=["free", "friction"])
def test_down_a_slope_it_rolls_with_uniform_acceleration(move, way: Way, s: float) -> None:
    acceleration = way.R * M * G * (way.R * sin(0.2) - s * cos(0.2)) / way.inertia

    def error(slope: float) -> float:
        return abs(move([0.0, 1.5], slope=slope, s=s, **DOWN)["X_O"][-1] / (acceleration * 1.5**2 / 2) - 1)

    within(error(0.2), 128 * EPSILON, "way, relative")
    beyond(error(0.2 * (1 + 1e-8)), 1e-9, "way on a steeper road, relative")


# ---- it slides ----


def test_locked_it_stops_after_v_squared_over_2_mu_g_and_stays(move, way: Way) -> None:
    t, distance = sliding.stopping(way.wheel, 0.4, 7.0)
    times = [0.0, t / 2, t - 1e-7, t + 1e-7, t + way.rest]
    run = move(times, {"M_brake": 1e3}, **ROAD, slip_x_start=7.0)
    assert run["contact_mode"].tolist() == [SLIDES] * 3 + [GRIPS] * 2
    assert not run["omega_z"].any() and not run["slip_x"][3:].any()
    tipping = np.abs(run["psi"] * run["Y_O_dot"])[3:].max()  # the free wheel tips, and turns a little
    within(absolute_error(run["X_O_dot"][3:], 0), 2 * tipping + EPSILON**2, "velocity after the stop, m/s")
    if way.guided:
        assert not any(run[name][3:].any() for name in ("X_O_dot", "Y_O_dot", "slip_y", "psi", "theta_dot", "psi_dot"))
        assert not np.ptp(run["theta"])
    within(absolute_error(run["X_O"][[1, 4]], [0.75 * distance, distance]), 1e-11, "way, m")
    force = 0.4 * M * G
    within(absolute_error(run["lambda_x"][:2], -force), 64 * force * EPSILON, "force of the road, N")
    within(absolute_error(run["tau"][:2], way.R * force), 32 * way.R * force * EPSILON, "moment of the brake, N m")
    beyond(move(times[:4], **ROAD, slip_x_start=7.0)["X_O"][-1] / distance, 1.1, "way where it is not locked, relative")


@pytest.mark.parametrize("mu", [0.3, 0.05])
def test_thrown_with_backspin_it_slides_grips_and_comes_back(move, way: Way, mu: float) -> None:
    t, v, distance = sliding.backspin(way.wheel, mu, 2.0, 10.0)

    def error(judged: float) -> float:
        throw = {"phi_dot_start": 10.0, "slip_x_start": 2 + way.R * 10.0, "mu_max": judged, "mu_slide": judged}
        run = move([0.0, t - 1e-7, t + 1e-7, t + 1], **throw)
        within(abs(run["X_O_dot"][0] - 2.0), 16 * EPSILON, "velocity at the start, m/s")
        assert judged != mu or run["contact_mode"].tolist() == [SLIDES, SLIDES, GRIPS, GRIPS]
        return absolute_error([run["X_O_dot"][-1], run["omega_z"][-1], run["X_O"][-1]], [v, -v / way.R, distance + v])

    assert v < 0
    within(error(mu), 1e-10 if mu < 0.1 else 1e-11, "velocity, m/s, spin, rad/s, and place, m")
    beyond(error(mu * 1.001), 1e-5, "those with a coefficient 0.1 % larger")


@pytest.mark.parametrize("excess", [0.9999, 1.0001, 1.5])
def test_a_motor_spins_it_only_beyond_the_torque_that_the_road_can_hold(move, way: Way, excess: float) -> None:
    torque = excess * sliding.gripping_torque(way.wheel, 0.45)
    grips, spins = (way.R * torque / way.inertia, -torque / way.inertia), sliding.spinning(way.wheel, 0.4, torque)
    a, spin = spins if excess > 1 else grips
    run = move([0.0, 0.5, 1.0], {"M_3": -torque}, **ROAD)
    assert run["contact_mode"].tolist() == [int(excess > 1)] * 3
    found = np.array([run["X_O_dot"][1:], run["omega_z"][1:], run["slip_x"][1:]])
    bound = 1024 * EPSILON if excess < 1 and way.guided else 3e-11
    within(absolute_error(found.T, np.outer([0.5, 1], [a, spin, a + way.R * spin])), bound, "speeds, SI")
    beyond(abs(spins[1] - grips[1]), 0.3, "difference of the two closed forms, rad/s2")


def test_a_motor_on_a_ramp_spins_it_from_the_closed_forms_instant_on(move, way: Way) -> None:
    rate = 100.0  # N m/s
    t = sliding.gripping_torque(way.wheel, 0.45) / rate

    def modes(shift: float, **road: float) -> list[float]:
        times = [0.0, t - 1e-7 + shift, t + 1e-7 + shift]
        return move(times, {"M_3": (0.0, -rate)}, **{**ROAD, **road})["contact_mode"].tolist()

    assert modes(0.0) == [GRIPS, GRIPS, SLIDES]
    assert modes(0.0, mu_max=0.4501) == [GRIPS, GRIPS, GRIPS]
    assert modes(1e-4) == [GRIPS, SLIDES, SLIDES]


@pytest.mark.parametrize("share", [0.9999, 1.0001])
@pytest.mark.parametrize("mu_slide", [0.2, 0.15])
def test_on_a_slope_it_rolls_up_to_its_limit_and_slides_above(move, way: Way, share: float, mu_slide: float) -> None:
    slope, slides = share * sliding.gripping_slope(way.wheel, 0.2), share > 1
    run = move([0.0, 0.5, 1.0], mu_max=0.2, mu_slide=mu_slide, slope=slope, **DOWN)
    assert run["contact_mode"].tolist() == [int(slides)] * 3

    def error(judged: bool) -> float:
        a, spin = sliding.downhill(way.wheel, mu_slide, slope, judged)
        return absolute_error(
            [run["X_O"], run["X_O_dot"], run["omega_z"]], [a / 2 * run.t**2, a * run.t, -spin * run.t]
        )

    within(error(slides), 1e-11 if slides else 1024 * EPSILON, "way, m, velocity, m/s, and spin, rad/s")
    if mu_slide < 0.2:
        beyond(error(not slides), 0.3, "way, velocity and spin off the other closed form")


def test_locked_it_stays_on_a_slope_up_to_mu_max_and_slides_down_above(move, way: Way) -> None:
    above, below = (move([0.0, 1.0], {"M_brake": 1e3}, **ROAD, slope=atan(mu), **DOWN) for mu in (0.4501, 0.4499))
    assert below["contact_mode"].tolist() == [GRIPS] * 2
    creep = EPSILON**2 if way.theta == pi / 2 else EPSILON  # cos(90 deg) twice; multibody: its height rounds
    within(abs(below["X_O"][-1]), creep, "way of the wheel that grips, m")
    a = G * (sin(atan(0.4501)) - 0.4 * cos(atan(0.4501)))
    assert above["contact_mode"].tolist() == [SLIDES] * 2
    within(abs(above["slip_x"][-1] - a), 3e-12, "slip after 1 s, m/s")


def test_a_slip_across_the_heading_ends_in_a_straight_line_on_the_carrier(move, way: Way) -> None:
    """There friction across the heading turns nothing; it turns and tilts a free wheel."""
    run = move(np.linspace(0, 1, 11), mu_max=0.4, mu_slide=0.4, slip_y_start=2.0)
    t = np.minimum(run.t, 2.0 / (0.4 * G))
    off = absolute_error(run["Y_O"], 2.0 * t - 0.2 * G * t**2)
    if way.guided:
        within(off, 4096 * EPSILON, "way, m")
        within(absolute_error(run["slip_x"], 0.0), 2 * EPSILON, "slip along the heading, m/s")  # cos(90 deg)
        assert not run["psi_dot"].any() and not run["theta_dot"].any()
    else:
        beyond(off, 0.1, "way of a free wheel off that line, m")
