"""Zero as a limit that is reached gradually: ice under ramps, a hold that a ramp ends, a normal force that a ramp leads
to zero; every quantity that may be zero, which changes the motion by as much as itself; and a spin that is rounding.

Upright, heading along X, R = r_0 + r, I = J_z + m R^2, slip_x = v + R omega_z. SI.
"""

from math import sqrt

import numpy as np
import pytest
from support.bounds import absolute_error, beyond, within

from wheelfmu.fmu.driver import OK, Values
from wheelfmu.truth.closed_forms import rolling_inertia
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import THROWN, UPRIGHT

R, INERTIA, WEIGHT = PAPER.r_0 + PAPER.r, rolling_inertia(PAPER), PAPER.m * PAPER.g
v = 2.0  # m/s
ROLLS = {**UPRIGHT, "phi_dot_start": -v / R}
each_steepness = pytest.mark.parametrize("steep", [1e-9, 1e-5, 1e-2, 10.0])
each_order = pytest.mark.parametrize("order", [1, 2, 3])
each_order_and_a_jump = pytest.mark.parametrize("order", range(4))
ICE = [{"mu_max": 0.0}, {"mu_slide": 0.0, "mu_max": 0.0}]
each_ice = pytest.mark.parametrize("ice", ICE, ids=["no grip", "no friction"])


def ramp(steep: float, order: int) -> tuple[float, ...]:
    return (*(0.0 for _ in range(order)), steep)


def on_ice(wheel, ice, **inputs):
    """From rolling at v on a good road, which becomes ice at once. The wheel grips until it needs a force: the inputs
    act for a second from 0.5 s on."""
    w = wheel().start(tolerance=1e-12, mu_max=0.5, mu_slide=0.4, **ROLLS).put(**ice).to(0.5)
    assert w.get("contact_mode", "slip_x", "omega_z") == [0, 0.0, -v / R]
    w.give(inputs).to(1.5)
    assert w.get("contact_mode", "lambda_x", "lambda_y") == [1, 0.0, 0.0]
    return w


@each_steepness
@each_order_and_a_jump
@each_ice
def test_on_ice_a_torque_spins_the_wheel_from_the_first_instant_on(wheel, ice, steep, order):
    """J_z omega_z' = M_3, and O goes on. On a road that grips the rolling inertia would be turned."""
    w = on_ice(wheel, ice, M_3=ramp(steep, order))
    turn = steep / (order + 1) / PAPER.J_z
    within(abs((w.get("omega_z")[0] + v / R) / turn - 1), 1e-12 / turn + 1e-9, "spin of the ramp, relative")
    within(abs(w.get("X_O_dot")[0] - v), 1e-12 + 1e-12 * turn, "change of the velocity, m/s")
    within(abs(w.get("slip_x")[0] / (R * turn) - 1), 1e-12 / (R * turn) + 1e-9, "slip, relative")
    beyond(abs(PAPER.J_z / INERTIA - 1), 0.1, "spin on a road that grips, relative")


@pytest.mark.parametrize("steep", [1.0, 5.0, 30.0])
def test_on_ice_a_brake_that_begins_at_zero_stops_the_spin_and_holds_it_while_O_goes_on(wheel, steep):
    """J_z |omega_z|' = -steep t."""
    t = sqrt(2 * PAPER.J_z * v / R / steep)
    w = wheel().start(tolerance=1e-12, mu_max=0.5, mu_slide=0.4, **ROLLS).put(mu_max=0.0).give({"M_brake": (0, steep)})
    half = w.to(0.5 * t).get("omega_z")[0]
    within(abs(half + 0.75 * v / R), 1e-10, "spin at half the time, rad/s")
    w.give({"M_brake": (0, steep)}, 0.5 * t).to(1.5 * t)
    assert w.get("omega_z", "contact_mode", "friction_mode") == [0.0, 1, 0]
    within(abs(w.get("X_O_dot")[0] - v), 1e-11, "velocity, m/s")
    within(abs(w.get("slip_x")[0] - v), 1e-11, "slip, m/s")
    beyond(v * PAPER.J_z / INERTIA, 0.3, "velocity that a road which grips would take, m/s")


@pytest.mark.parametrize("mu", [1e-3, 1e-6, 1e-9, 1e-12])
def test_a_coefficient_that_falls_towards_zero_leads_to_ice(wheel, mu):
    """Under a torque that exceeds the grip soon, the velocity gained is mu g t less the begin, and none on ice."""
    w = wheel().start(tolerance=1e-12, mu_max=0.5, mu_slide=0.4, **ROLLS).put(mu_max=mu, mu_slide=mu)
    gained = w.give({"M_3": (0.0, -10.0)}).to(1.0).get("X_O_dot")[0] - v
    grips = mu * PAPER.g * INERTIA / R / 10.0  # s, m R M / I = mu m g
    expected = mu * PAPER.g * (1 - grips / 2)
    within(abs(gained - expected), 1e-3 * expected + 1e-13, "velocity gained, m/s")


# ---- what ramps lead to zero, or from it ----


@pytest.mark.parametrize("s", [0.03, 1e-3, 1e-6, 1e-9])
@each_order
def test_a_ramp_of_torque_ends_a_hold_at_its_capacity_however_small_that_is(wheel, s, order):
    steep, w = 10.0, wheel().start(tolerance=1e-12, s=s, **UPRIGHT)
    capacity = s * WEIGHT
    end = (capacity / steep) ** (1 / order)  # s
    w.give({"M_3": ramp(steep, order)}).to(1.0)
    spin = (steep * (1 - end ** (order + 1)) / (order + 1) - capacity * (1 - end)) / INERTIA
    within(abs(w.get("omega_z")[0] / spin - 1), 1e-9, "spin, relative")
    if s > 1e-7:  # else what rounding of the moment allows is more; just before and just after its end
        for t, mode in ((end * (1 - 1e-6), 0), (end * (1 + 1e-6), 1)):
            other = wheel().start(tolerance=1e-12, s=s, **UPRIGHT).give({"M_3": ramp(steep, order)}).to(t)
            assert other.get("friction_mode") == [mode]


@pytest.mark.parametrize("law", [{}, {"friction_law": 2, "omega_s": 1e-4}], ids=["exact", "regularized"])
def test_rolling_resistance_goes_with_the_normal_force_to_zero_and_is_none_where_the_ground_pulls(wheel, law):
    """F_Z = a t lifts: I omega_z' = s (m g - a t) against the spin up to t = m g / a."""
    a, s = 2 * WEIGHT, 0.01
    start = {**UPRIGHT, "phi_dot_start": -20.0, "keep_contact": True, "s": s, **law}
    w = wheel().start(tolerance=1e-11, **start)
    for t in (0.1, 0.3, 0.45, 0.5 - 1e-6, 0.5 + 1e-6, 0.6, 1.0):
        w.give({"F_Z": (0.0, a)}, w.time).to(t)
        until = min(t, 0.5)
        spin = -20.0 + s * (WEIGHT * until - a * until**2 / 2) / INERTIA
        within(abs(w.get("omega_z")[0] - spin), 1e-9, f"spin at {t} s, rad/s")
        assert (w.get("tau")[0] != 0) == (t < 0.5)
    beyond(s * WEIGHT * 0.5 / INERTIA, 0.1, "spin that a constant normal force would take, rad/s")


# ---- every quantity that may be zero ----

LEANING: Values = {"theta_start": 1.25, "psi_dot_start": 0.6, "phi_dot_start": -5.0, "X_O_start": 0.0}
CARRIED: Values = {"guided": True, "theta_start": 1.2, "phi_dot_start": -5.0, "psi_start": 0.0}
SLIP: Values = {**LEANING, **THROWN, "mu_max": 0.5, "mu_slide": 0.4}
BOUNDED: dict[str, tuple[Values, str]] = {
    "s": (LEANING, "s"),
    "s, regularized": ({**LEANING, "friction_law": 2, "omega_s": 0.5}, "s"),
    "s, stiff": ({**LEANING, "friction_law": 2, "omega_s": 1e-6}, "s"),
    "s of a slide": (SLIP, "s"),
    "s, guided": (CARRIED, "s"),
    "slope": (LEANING, "slope"),
    "slope, guided": (CARRIED, "slope"),
    "r": (LEANING, "r"),
    "r of a slide": (SLIP, "r"),
    "g": ({**LEANING, "keep_contact": True}, "g"),
    "psi_dot_start": (LEANING, "psi_dot_start"),
    "theta_dot_start": (LEANING, "theta_dot_start"),
    "phi_dot_start": (LEANING, "phi_dot_start"),
    "psi_start": ({**LEANING, "slope": 0.2, "s": 0.01}, "psi_start"),
    "slope_direction": ({**LEANING, "slope": 0.2, "s": 0.01}, "slope_direction"),
    "slip_x_start": ({**SLIP, "s": 0.01}, "slip_x_start"),
    "slip_y_start": ({**SLIP, "s": 0.01}, "slip_y_start"),
}
for _load in ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake"):
    BOUNDED |= {_load: (LEANING, _load), f"{_load} of a slide": (SLIP, _load), f"{_load}, guided": (CARRIED, _load)}
for _rate in ("psi_dot_guide", "theta_dot_guide"):
    BOUNDED |= {
        _rate: (CARRIED, _rate),
        f"{_rate} of a slide": ({**CARRIED, **THROWN, "mu_max": 0.5, "mu_slide": 0.4}, _rate),
    }
OUTPUTS = ("X_O", "Y_O", "theta", "psi", "phi", "theta_dot", "psi_dot", "omega_z", "v_x", "v_y", "slip_x", "slip_y")
REACTIONS = ("lambda_y", "lambda_3", "M_guide_1", "M_guide_2")
TIMES = np.linspace(0.0, 0.4, 5)


@pytest.mark.parametrize("case", BOUNDED)
def test_next_to_zero_the_motion_changes_by_as_much_as_the_quantity(library: Library, case: str) -> None:
    """Linearly down to where the tolerance counts: a branch for zero that is another motion would stay behind, one that
    takes what is small for zero would not move.
    """
    start, name = BOUNDED[case]
    start = {key: value for key, value in start.items() if key != name}

    def motion(x: float) -> np.ndarray:
        run = library.simulate(TIMES, 1e-12, Schedule(), **start, **{name: x})
        return np.array([run[output] for output in (*OUTPUTS, *(REACTIONS if "guided" in start else ()))])

    at_zero = motion(0.0)
    moved = {x: absolute_error(motion(x), at_zero) for x in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)}
    slope = max(moved[1e-2] / 1e-2, moved[1e-4] / 1e-4)
    beyond(slope, 1e-4, "change over the quantity")
    for x in (1e-6, 1e-8, 1e-10, 1e-12):
        within(moved[x], 3 * slope * x + 1e-9, f"change by {x:g}")
        if (linear := moved[1e-4] / 1e-4 * x) > 1e-8:
            beyond(moved[x], 0.3 * linear, f"change by {x:g}")


@pytest.mark.parametrize("order", range(4))
@pytest.mark.parametrize("name", ["M_3", "F_X", "M_brake", "psi_dot_guide"])
def test_however_small_its_one_coefficient_an_input_acts_throughout_a_long_step(wheel, name, order):
    """Of a guided wheel: what it gains is the integral of the input."""
    coefficient, t = 1e-11, 500.0
    start = {**UPRIGHT, "guided": True, "phi_dot_start": -1.0 if name == "M_brake" else 0.0}
    w = wheel().start(tolerance=1e-12, **start).give({name: ramp(coefficient, order)}).to(t)
    spin, heading = w.get("omega_z", "psi")
    gained = {"M_3": spin, "F_X": -spin / R, "M_brake": spin + 1.0, "psi_dot_guide": heading / INERTIA}[name] * INERTIA
    expected = coefficient * t ** (order + 1) / (order + 1)
    within(abs(gained - expected), 1e-9 * expected + 1e-11, "gained off the integral, SI")
    beyond(expected, 4e-9, "integral, which a wheel that takes the input for none does not gain, SI")


STEERED: Values = {**CARRIED, "psi_dot_guide": 0.8, "theta_dot_guide": -0.5}


@pytest.mark.parametrize("case", ["rolls", "rolls, multibody", "slides", "slides, multibody", "guided"])
def test_moments_of_inertia_that_become_equal_lead_to_the_simpler_equations(library: Library, case: str) -> None:
    start = {**(SLIP if "slides" in case else STEERED if case == "guided" else LEANING), "s": 0.01, "phi_start": 0.4}
    start |= {"formulation": 3} if "multibody" in case else {}

    def motion(difference: float) -> np.ndarray:
        moments = {"J_x": 0.9 + difference, "J_y": 0.9 - difference, "J_z": 1.5}
        run = library.simulate(TIMES, 1e-12, Schedule(), **start, **moments)
        return np.array([run[output] for output in (*OUTPUTS, *REACTIONS)])

    equal = motion(0.0)
    moved = {x: absolute_error(motion(x), equal) for x in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10)}
    for x in (1e-4, 1e-6, 1e-8, 1e-10):
        within(moved[x], 3 * moved[1e-2] / 1e-2 * x + 1e-8, f"change by a difference of {x:g} kg m2")
    beyond(moved[1e-2], 1e-4, "change by a difference of 0.01 kg m2")


# ---- a spin that is rounding ----

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
