"""The rules of docs/vehicle.md for coupling a wheel, each against its own system. SI units, the paper's wheel."""

import runpy
from collections.abc import Callable
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.bounds import beyond, within

from wheelfmu.fmu.driver import OK, FMU2Wheel
from wheelfmu.fmu.paths import ROOT, build_folder

M, R_0, TUBE, J_X, J_Z, G = 20.0, 0.3, 0.05, 0.9, 1.8, 9.81
R = R_0 + TUBE
UPRIGHT = {"guided": True, "psi_start": 0.0, "theta_start": pi / 2, "phi_dot_start": 0.0, "X_O_start": 0.0}
New = Callable[..., FMU2Wheel]
PYTHON = ROOT / "examples" / "python"


@pytest.fixture(scope="module")
def example() -> Callable[[str], dict]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(build_folder())
        yield lambda name: runpy.run_path(str(PYTHON / f"{name}.py"))


def tilting(theta: float) -> float:
    """Moment of inertia about e1 of a wheel that rolls, of which its carrier's moment lacks the part at held rates."""
    return J_X + M * (R_0**2 + 2 * R_0 * TUBE * sin(theta) + TUBE**2)


def fallen(new: New, h: float, inertia: Callable[[float], float], stop: float = 0.8) -> float:
    """theta of a carrier of 2 kg m2, without weight, that falls from a lean of 0.02 rad with its wheel."""
    theta, rate, J = pi / 2 - 0.02, 0.0, 2.0
    wheel = new().start(**UPRIGHT | {"theta_start": theta})
    for _ in range(round(stop / h)):
        assert wheel.set(theta_dot_guide=rate) == OK
        rate -= h * wheel.get("M_guide_1")[0] / (J + inertia(theta))
        assert wheel.step(h) == OK
        theta = wheel.get("theta")[0]
    return theta


def test_a_carrier_with_held_rates_adds_the_inertia_of_a_wheel_that_tilts_and_rolls(wheel: New) -> None:
    """Partner: J_x alone, at any step."""

    def rates(_: float, y: np.ndarray) -> list[float]:
        theta, rate = y
        return [rate, -M * R_0 * cos(theta) * (G + TUBE * rate**2) / (2.0 + tilting(theta))]

    exact = solve_ivp(rates, (0, 0.8), [pi / 2 - 0.02, 0.0], "DOP853", rtol=1e-12, atol=1e-12).y[0, -1]
    coarse, fine = (abs(fallen(wheel, h, tilting) - exact) for h in (0.0025, 0.00125))
    within(fine, 1e-3, "theta off the equation, rad")
    within(abs(np.log2(coarse / fine) - 1), 0.1, "order off 1")
    for h in (0.0025, 0.00125):
        beyond(abs(fallen(wheel, h, lambda _: J_X) - exact), 0.1, "theta with J_x alone, rad")


def test_a_brake_at_the_limit_in_a_turn_needs_more_than_one_newton_step(wheel: New, example) -> None:
    v, turn, grip = 10.0, 0.3, 0.4
    along = sqrt((grip * M * G) ** 2 - (M * v * turn) ** 2)  # what lambda_y = m v psi' leaves
    exact = along * R * (1 + J_Z / (M * R**2))  # the spin is slowed down too
    turning = wheel().start(**UPRIGHT | {"phi_dot_start": -v / R})
    assert turning.set(psi_dot_guide=turn, M_brake=500.0) == OK
    limited = example("anti_lock")["limited"]
    found = limited(Numbered(turning), 500.0, grip)
    within(abs(found / exact - 1), 1e-9, "capacity off the closed form, relative")
    within(abs(turning.get("mu_required")[0] / grip - 1), 1e-9, "friction required off the grip, relative")
    assert turning.set(M_brake=500.0) == OK
    once = 500 - (turning.get("mu_required")[0] - grip) / turning.jacobian(["mu_required"], ["M_brake"])[0, 0]
    beyond(abs(once / exact - 1), 0.2, "capacity after one step, relative")


class Numbered:
    """A wheel by the calls of FMPy."""

    def __init__(self, wheel: FMU2Wheel) -> None:
        self.setReal, self.getReal, self.getDirectionalDerivative = wheel.setReal, wheel.getReal, directional(wheel)


def directional(wheel: FMU2Wheel) -> Callable:
    return super(FMU2Wheel, wheel).getDirectionalDerivative


def test_a_position_that_is_held_over_the_step_brakes_a_body_by_the_drag_of_its_lag(wheel: New) -> None:
    """k v h / 2, of a link of stiffness k at speed v. Partner: a position that follows the velocity."""
    v, k, c, m_B, h = 10.0, 6e4, 2e3, 300.0, 0.002

    def speed(follow: float) -> float:
        """After 0.5 s: of the body, which is integrated with the position of the wheel held, or on a straight line."""
        rolling = wheel().start(**UPRIGHT | {"phi_dot_start": -v / R})
        at, moving = 0.0, v
        for _ in range(250):
            X, X_dot = rolling.get("X_O", "X_O_dot")
            assert rolling.set(F_X=k * (at - X) + c * (moving - X_dot)) == OK

            def rates(t: float, y: np.ndarray, X: float = X, X_dot: float = X_dot) -> list[float]:
                return [y[1], -(k * (y[0] - X - follow * X_dot * t) + c * (y[1] - X_dot)) / m_B]

            at, moving = solve_ivp(rates, (0, h), [at, moving], rtol=1e-9, atol=1e-12).y[:, -1]
            assert rolling.step(h) == OK
        return moving

    lost = [v - speed(follow) for follow in (0.0, 1.0)]
    drag = v * (1 - np.exp(-k * h / 2 * 0.5 / (m_B + M + J_Z / R**2)))
    within(abs(lost[0] / drag - 1), 0.05, "speed lost off that by the drag, relative")
    within(abs(lost[1] / drag), 0.05, "speed lost by a position that follows, over that of a held one")


def repeated(wheel: FMU2Wheel, h: float, speed: float, count: int = 12) -> np.ndarray:
    """The forces at the end of one step that is repeated on straight lines, of a bushing on a body of 300 kg that moves
    at `speed`."""
    k, c, m_B, before = 2e5, 4e3, 300.0, wheel.serialized()
    begin = c * (speed - wheel.get("X_O_dot")[0])
    forces = [begin]
    for _ in range(count):
        end = forces[-1]
        assert wheel.set(F_X=begin) == OK and wheel.set_input_derivatives(("F_X",), [[(end - begin) / h]]) == OK
        assert wheel.step(h) == OK
        X, X_dot = wheel.get("X_O", "X_O_dot")
        x, x_dot = speed * h - (2 * begin + end) / 6 * h**2 / m_B, speed - (begin + end) / 2 * h / m_B
        forces.append(k * (x - X) + c * (x_dot - X_dot))
        assert wheel.restore(before) == OK
    return np.diff(forces)


def limit_of_repeated(m_wheel: float) -> float:
    """The step at which k h^2 / 6 m + c h / 2 m is 1, m the reduced mass."""
    m = 1 / (1 / m_wheel + 1 / 300.0)
    return float(max(np.roots([2e5 / 6 / m, 4e3 / 2 / m, -1]).real))


def test_a_step_repeated_to_a_fixed_point_diverges_about_where_held_values_do(wheel: New) -> None:
    limit = limit_of_repeated(M + J_Z / R**2)
    within(limit, 2 * 31.1 / 4e3, "limit, s, over that of held values")
    for factor, grows in ((0.9, False), (1.1, True)):
        changes = np.abs(repeated(wheel().start(**UPRIGHT), factor * limit, 0.01))
        assert (changes[-1] > changes[1]) == grows, changes


def test_a_repeated_step_in_which_a_slip_begins_may_not_converge_where_that_of_a_rolling_wheel_does(wheel: New) -> None:
    """A sliding wheel is lighter. Partner: so much grip that it rolls."""
    h = 0.9 * limit_of_repeated(M + J_Z / R**2)
    assert h > limit_of_repeated(M)
    for grip, fails in ((0.3, True), (30.0, False)):
        road = {"mu_max": grip, "mu_slide": 0.9 * grip}
        changes = np.abs(repeated(wheel().start(**UPRIGHT | road), h, 0.05, 40))
        assert (changes[-1] > 0.1 * changes[0]) == fails, changes


def test_rates_in_initialization_mode_belong_to_the_start_and_after_it_they_jump(wheel: New) -> None:
    """Of a cambered wheel: phi_dot keeps its start value, or spin and speed change as by the impulse of a jump."""
    lean, turn, spin = 0.1, 0.5, -10 / R
    theta = pi / 2 + lean
    start = UPRIGHT | {"theta_start": theta, "phi_dot_start": spin}
    before = wheel().initializing(**start)
    assert before.set(psi_dot_guide=turn) == OK and before.exitInitializationMode() in (OK, None)
    after = wheel().start(**start)
    assert after.set(psi_dot_guide=turn) == OK
    rho, eta = R_0 + TUBE * sin(theta), TUBE * cos(theta)
    jumped = spin + M * rho * eta * turn * sin(theta) / (
        J_Z + M * rho**2
    )  # (J_z + m rho^2) omega_z' = m rho eta omega_2'
    for found, omega_z in ((before, spin + turn * cos(theta)), (after, jumped)):
        within(abs(found.get("omega_z")[0] - omega_z), 1e-9, "omega_z, rad/s")
    beyond(abs(before.get("omega_z")[0] - after.get("omega_z")[0]), 0.01, "difference of both, rad/s")


def test_a_steered_and_a_sliding_wheel_cannot_be_linearized(fmu: str) -> None:
    """Model exchange refuses both."""
    from fmpy import instantiate_fmu, read_model_description
    from fmpy.fmi1 import FMICallException

    description = read_model_description(fmu)
    ref = {v.name: v.valueReference for v in description.modelVariables}
    for values, refused in (({"mu_max": 0.5, "mu_slide": 0.4}, True), ({"mu_max": 0.5}, False)):
        model = instantiate_fmu(fmu, description, "ModelExchange")
        model.setupExperiment()
        model.enterInitializationMode()
        model.setBoolean([ref["guided"]], [True])
        start = {"psi_start": 0.0, "theta_start": pi / 2} | values
        model.setReal([ref[name] for name in start], [*start.values()])
        if refused:
            with pytest.raises(FMICallException):
                model.exitInitializationMode()
        else:
            model.exitInitializationMode()
            with pytest.raises(FMICallException):
                model.setReal([ref["psi_dot_guide"]], [0.1])
        model.freeInstance()


def test_the_carriers_functions_give_the_wheels_axes_angles_rates_and_camber(wheel: New, example) -> None:
    of, omega, h = example("carrier"), np.array([0.3, -0.2, 0.5]), 1e-6
    n = np.array([0.3, -0.8, 0.2]) / sqrt(0.77)
    psi, theta = of["angles"](n)
    e1, e2, e3 = of["axes"](psi, theta)
    within(np.abs(e3 - n).max(), 1e-14, "axle off that of its angles")
    within(np.abs(np.cross(e1, e2) - e3).max() + abs(e1[2]) + abs(e2 @ n), 1e-14, "axes off a right-handed frame")
    turned = [of["angles"](n + side * h * np.cross(omega, n)) for side in (1, -1)]
    slopes = np.subtract(*turned) / (2 * h)
    within(np.abs(slopes - of["rates"](n, omega)).max(), 1e-8, "rates off differences, rad/s")
    beyond(np.abs(slopes - of["rates"](n, 1.1 * omega)).max(), 1e-2, "those of a faster body, rad/s")
    for side in (1, -1):  # the contact of a wheel that leans outwards lies inside of its centre
        leaning = wheel().start(**UPRIGHT | {"theta_start": of["camber"](0.05, side)})
        Y_O, Y_C = leaning.get("Y_O", "Y_C")
        within(abs(side * (Y_O - Y_C) - R_0 * sin(0.05)), 1e-12, "centre outside of the contact, m")
