"""The bicycle of examples/python, against the published linear equations: its ride in model exchange, exact, and its
wheels on carriers in co-simulation, by the way of docs/vehicle.md for rigid couplings (ask, solve, pass). SI units.
"""

from collections.abc import Callable, Iterator
from importlib.util import module_from_spec, spec_from_file_location
from math import cos, pi, sin
from types import ModuleType

import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from wheelfmu.fmu.driver import OK, FMU2Wheel
from wheelfmu.fmu.paths import ROOT, build_folder


@pytest.fixture(scope="module")
def bicycle() -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(build_folder())
        spec = spec_from_file_location("bicycle", ROOT / "examples" / "python" / "bicycle.py")
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        yield module
        for wheel in module.wheels:
            wheel.fmu.freeInstance()


def matrices(b: ModuleType, c: float) -> tuple:
    """M, C_1, K_0 and K_2 from the parameters, as the appendix of the paper has them: x forward, z down; trail c."""
    (r_R, m_R, I_Rxx, I_Ryy), (r_F, m_F, I_Fxx, I_Fyy) = b.WHEELS
    (m_B, (x_B, z_B), I_B), (m_H, (x_H, z_H), I_H) = b.REAR, b.FORK
    w, lean, z_B, z_H = b.w, b.TILT, -z_B, -z_H
    m_T, m_A = m_R + m_B + m_H + m_F, m_H + m_F
    x_T = (x_B * m_B + x_H * m_H + w * m_F) / m_T
    z_T = (-r_R * m_R + z_B * m_B + z_H * m_H - r_F * m_F) / m_T
    I_Txx = I_Rxx + I_B[0] + I_H[0] + I_Fxx + m_R * r_R**2 + m_B * z_B**2 + m_H * z_H**2 + m_F * r_F**2
    I_Txz = I_B[3] + I_H[3] - m_B * x_B * z_B - m_H * x_H * z_H + m_F * w * r_F
    I_Tzz = I_Rxx + I_B[2] + I_H[2] + I_Fxx + m_B * x_B**2 + m_H * x_H**2 + m_F * w**2
    x_A, z_A = (x_H * m_H + w * m_F) / m_A, (z_H * m_H - r_F * m_F) / m_A
    I_Axx = I_H[0] + I_Fxx + m_H * (z_H - z_A) ** 2 + m_F * (r_F + z_A) ** 2
    I_Axz = I_H[3] - m_H * (x_H - x_A) * (z_H - z_A) + m_F * (w - x_A) * (r_F + z_A)
    I_Azz = I_H[2] + I_Fxx + m_H * (x_H - x_A) ** 2 + m_F * (w - x_A) ** 2
    u_A = (x_A - w - c) * cos(lean) - z_A * sin(lean)
    I_All = m_A * u_A**2 + I_Axx * sin(lean) ** 2 + 2 * I_Axz * sin(lean) * cos(lean) + I_Azz * cos(lean) ** 2
    I_Alx = -m_A * u_A * z_A + I_Axx * sin(lean) + I_Axz * cos(lean)
    I_Alz = m_A * u_A * x_A + I_Axz * sin(lean) + I_Azz * cos(lean)
    mu, S_R, S_F = c / w * cos(lean), I_Ryy / r_R, I_Fyy / r_F
    S_T, S_A = S_R + S_F, m_A * u_A + mu * m_T * x_T
    M_12, turn = I_Alx + mu * I_Txz, cos(lean) / w
    M = [[I_Txx, M_12], [M_12, I_All + 2 * mu * I_Alz + mu**2 * I_Tzz]]
    C_12, C_21 = mu * S_T + S_F * cos(lean) + I_Txz * turn - mu * m_T * z_T, -(mu * S_T + S_F * cos(lean))
    C_1 = [[0, C_12], [C_21, I_Alz * turn + mu * (S_A + I_Tzz * turn)]]
    K_0 = [[m_T * z_T, -S_A], [-S_A, -S_A * sin(lean)]]
    K_2 = [[0, (S_T - m_T * z_T) * turn], [0, (S_A + S_F * sin(lean)) * turn]]
    return M, C_1, K_0, K_2


def test_the_published_matrices_are_those_of_the_published_parameters(bicycle: ModuleType) -> None:
    published = bicycle.M, bicycle.C_1, bicycle.K_0, bicycle.K_2
    for c, check in ((bicycle.c, within), (bicycle.c * 1.001, beyond)):
        apart = [np.abs(np.subtract(*pair)).max() for pair in zip(matrices(bicycle, c), published, strict=True)]
        check(max(apart), 1e-13 if check is within else 1e-4, "entry of a matrix off the published one")


@pytest.mark.parametrize("v", [3.0, 5.0, 7.0])
def test_it_falls_rights_itself_and_capsizes_as_the_published_equations(bicycle: ModuleType, v: float) -> None:
    """Partner: a trail 1 % longer in the equations."""
    times = np.linspace(0, min(bicycle.RIDES[v], 5.0), 51)
    found, exact = (of(v, 1e-5, times) for of in (bicycle.ride, bicycle.linear))
    sizes = np.abs(exact).max(1, keepdims=True)
    within(np.abs((found - exact) / sizes).max(), 1e-5, "lean, steer and their rates off the equations, of the largest")
    with pytest.MonkeyPatch.context() as patch:
        for name, table in zip(("M", "C_1", "K_0", "K_2"), matrices(bicycle, 1.01 * bicycle.c), strict=True):
            patch.setattr(bicycle, name, np.array(table))
        other = bicycle.linear(v, 1e-5, times)
    beyond(np.abs((found - other) / sizes).max(), 1e-3, "the same with a trail 1 % longer")


def test_its_motion_has_the_published_eigenvalues_weave_and_capsize_speed(bicycle: ModuleType) -> None:
    published = [-14.07838969279822, -0.77534188219585 - 4.46486771378823j, -0.77534188219585 + 4.46486771378823j]
    found = bicycle.eigenvalues(5.0)
    within(relative_error(found, [*published, -0.32286642900409]), 1e-5, "eigenvalues at 5 m/s, relative")
    for speed in (4.29238253634111, 6.02426201538837):
        below, above = (bicycle.eigenvalues(speed + off)[-1].real for off in (-1e-4, 1e-4))
        assert below * above < 0


class Carried:
    """Both wheels guided, in co-simulation, rigidly coupled to the frames: ask, solve, pass."""

    READ = ("lambda_1", "lambda_2", "lambda_3", "M_guide_1", "M_guide_2")
    asks_slopes = True
    FORCE, RATE = ("F_X", "F_Y", "F_Z"), ("theta_dot_guide", "psi_dot_guide")

    def __init__(self, b: ModuleType, new: Callable[..., FMU2Wheel], v: float, push: float) -> None:
        self.b, self.q, self.u, self.before = b, np.zeros(7), np.zeros(7), None
        self.q[[2, 4]], self.u[[0, 1, 4]] = (b.WHEELS[0][0], pi / 2), (v, -b.WHEELS[0][0] * push, push)
        self.wheels = []
        for (radius, m, J_x, J_z), x in zip(b.WHEELS, (0.0, b.w), strict=True):
            start = {"m": m, "r_0": radius, "r": 0.0, "J_x": J_x, "J_y": J_x, "J_z": J_z, "guided": True}
            pose = {"theta_start": pi / 2, "psi_start": 0.0, "X_O_start": x, "phi_dot_start": -v / radius}
            self.wheels.append(new().start(**start, **pose))

    def ask(self, wheel: FMU2Wheel, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """lambda and M_guide without force and slope, and what each force and slope of a rate adds: six readings."""
        answers = []
        for load in np.vstack([np.zeros(5), np.eye(5)]):
            assert wheel.set(**dict(zip((*self.FORCE, *self.RATE), (*load[:3], *rates), strict=True))) == OK
            assert wheel.set_input_derivatives(self.RATE, [load[3:]]) == OK
            answers.append(wheel.get(*self.READ))
        by = np.transpose(answers[1:] - np.array(answers[0]))
        return np.array(answers[0]), by * [1, 1, 1, *[self.asks_slopes] * 2]

    def axles(self, q: np.ndarray, u: np.ndarray) -> list[tuple]:
        """Of each wheel: rates of its tilt and heading; e1 and e2 with the latter's factor; what of the acceleration of
        the axle its angles' second derivatives leave."""
        found = []
        for frame in self.b.frames(q, u)[0]:
            psi, theta = np.arctan2(frame.R[0, 2], -frame.R[1, 2]), np.arccos(frame.R[2, 2])
            e1, e2, _ = self.b.carrier(psi, theta)
            theta_dot, psi_dot = frame.omega @ e1, frame.omega @ e2 / sin(theta)
            own = psi_dot * self.b.UP + theta_dot * e1
            turning = psi_dot * theta_dot * np.cross(self.b.UP, e1) + np.cross(own, frame.omega) - frame.rest
            found.append((np.array([theta_dot, psi_dot]), np.array([e1, e2]), np.array([1, sin(theta)]), turning))
        return found

    def step(self, h: float) -> bool:
        """Over h; False where a wheel ends its run."""
        b, (frames, hubs, A, right) = self.b, self.b.frames(self.q, self.u)
        system, known, axles = np.zeros((13, 13)), np.zeros(13), self.axles(self.q, self.u)
        system[:7, :7], known[:7] = A, right
        for i, (wheel, frame, (V, rest, _), (rates, E, scale, turning)) in enumerate(
            zip(self.wheels, frames, hubs, axles, strict=True)
        ):
            at, m = slice(7 + 3 * i, 10 + 3 * i), b.WHEELS[i][1]
            answer, by = self.ask(wheel, rates)
            slopes, drift = (E @ frame.W) / scale[:, None], -(E @ turning) / scale  # theta'', psi'' = slopes u' + drift
            with_u, alone = by[:, 3:] @ slopes, answer + by[:, 3:] @ drift
            arm = frame.W.T @ E.T
            system[:7, :7] += arm @ with_u[3:]
            system[:7, at] = V.T + arm @ by[3:, :3]
            known[:7] -= arm @ alone[3:]
            system[at, :7], system[at, at] = V - with_u[:3] / m, -(by[:3, :3] + np.eye(3)) / m
            known[at] = alone[:3] / m - rest - b.g * b.UP
        solved = np.linalg.solve(system, known)
        now, loads = solved[:7], solved[7:].reshape(2, 3)
        last, self.before = (now, loads) if self.before is None else self.before, (now, loads)
        u = self.u + h * (1.5 * now - 0.5 * last[0])
        q = self.q + h * (self.u + u) / 2
        for wheel, (rates, *_), (later, *_), load, old in zip(
            self.wheels, axles, self.axles(q, u), loads, last[1], strict=True
        ):
            assert wheel.set(**dict(zip((*self.FORCE, *self.RATE), (*load, *rates), strict=True))) == OK
            straight = [*(load - old) / h, *(later - rates) / h]
            assert wheel.set_input_derivatives((*self.FORCE, *self.RATE), [straight]) == OK
        self.q, self.u = q, u
        return [wheel.step(h) for wheel in self.wheels] == [OK, OK]


def test_wheels_on_carriers_that_ask_solve_and_pass_are_rigidly_coupled_with_order_two(
    bicycle: ModuleType, wheel: Callable[..., FMU2Wheel], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At 5 m/s; partner: the moments as read, without what they add as the rates change."""
    times, push = np.linspace(0, 2, 11), 1e-5
    exact = bicycle.linear(5.0, push, times)[:2]

    def error(h: float) -> float:
        carried, found = Carried(bicycle, wheel, 5.0, push), []
        for n in range(round(2 / h) + 1):
            if n % round(0.2 / h) == 0:
                found.append([carried.q[4] - pi / 2, carried.q[6]])
            if not carried.step(h):
                return np.inf
        return float((np.abs(np.transpose(found) - exact).max(1) / np.abs(exact).max(1)).max())

    coarse, fine = (error(h) for h in (0.008, 0.004))
    within(abs(np.log2(coarse / fine) - 2), 0.1, "order off 2")
    within(fine, 1e-3, "lean and steer at 4 ms, off the published equations, of the largest")
    monkeypatch.setattr(Carried, "asks_slopes", False)
    beyond(error(0.004), 0.05, "the same without the slopes")
