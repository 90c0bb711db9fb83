"""The bicycle of examples/python, against the published linear equations: its ride in model exchange, exact, and its
wheels on carriers in co-simulation, by the way of docs/vehicle.md for rigid couplings (ask, solve, pass). SI units.
"""

from collections.abc import Callable, Iterator
from importlib.util import module_from_spec, spec_from_file_location
from math import pi, sin
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


@pytest.mark.parametrize("v", [3.0, 5.0, 7.0])
def test_it_falls_rights_itself_and_capsizes_as_the_published_equations(bicycle: ModuleType, v: float) -> None:
    """Of parameters and matrices, published apart. Partner: the equations at a speed 1 % higher."""
    times, push = np.linspace(0, min(bicycle.RIDES[v], 5.0), 51), bicycle.SMALL
    found, exact, other = bicycle.ride(v, push, times), *(bicycle.linear(of, push, times) for of in (v, 1.01 * v))
    sizes = np.abs(exact).max(1, keepdims=True)
    within(np.abs((found - exact) / sizes).max(), 1e-6, "lean, steer and their rates off the equations, of the largest")
    beyond(np.abs((found - other) / sizes).max(), 1e-3, "the same at a speed 1 % higher")


def test_its_motion_has_the_published_eigenvalues_weave_and_capsize_speed(bicycle: ModuleType) -> None:
    published = [-14.07838969279822, -0.77534188219585 - 4.46486771378823j, -0.77534188219585 + 4.46486771378823j]
    found = bicycle.eigenvalues(5.0)
    within(relative_error(found, [*published, -0.32286642900409]), 1e-5, "eigenvalues at 5 m/s, relative")
    for speed in (4.29238253634111, 6.02426201538837):
        below, above = (bicycle.eigenvalues(speed + off)[-1].real for off in (-1e-4, 1e-4))
        assert below * above < 0


def test_gravity_at_the_top_of_the_file_is_that_of_the_wheels(
    bicycle: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A third of the earth's; partner: wheels that keep the earth's."""
    times, push = np.linspace(0, 2, 11), bicycle.SMALL
    monkeypatch.setattr(bicycle, "g", 3.71)
    exact = bicycle.linear(5.0, push, times)

    def error() -> float:
        return float((np.abs(bicycle.ride(5.0, push, times) - exact).max(1) / np.abs(exact).max(1)).max())

    beyond(error(), 0.1, "the earth's in the wheels")
    monkeypatch.setattr(bicycle, "wheels", [bicycle.Wheel(*values) for values in bicycle.WHEELS])
    within(error(), 1e-6, "lean, steer and their rates off the equations, of the largest")
    for wheel in bicycle.wheels:
        wheel.fmu.freeInstance()


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

    def ask(self, wheel: FMU2Wheel, rates: list[float]) -> tuple[np.ndarray, np.ndarray]:
        """lambda and M_guide without force and slope, and what each force and slope of a rate adds: six readings."""
        answers = []
        for load in np.vstack([np.zeros(5), np.eye(5)]):
            assert wheel.set(**dict(zip((*self.FORCE, *self.RATE), (*load[:3], *rates), strict=True))) == OK
            assert wheel.set_input_derivatives(self.RATE, [load[3:]]) == OK
            answers.append(wheel.get(*self.READ))
        by = np.transpose(answers[1:] - np.array(answers[0]))
        return np.array(answers[0]), by * [1, 1, 1, *[self.asks_slopes] * 2]

    def step(self, h: float) -> bool:
        """Over h; False where a wheel ends its run."""
        b, (frames, hubs, A, right) = self.b, self.b.frames(self.q, self.u)
        system, known, axles = np.zeros((13, 13)), np.zeros(13), [b.axle(frame) for frame in frames]
        system[:7, :7], known[:7] = A, right
        for i, (wheel, frame, (V, rest, _), (_, theta, *rates, E, turning)) in enumerate(
            zip(self.wheels, frames, hubs, axles, strict=True)
        ):
            at, m, scale = slice(7 + 3 * i, 10 + 3 * i), b.WHEELS[i][1], np.array([1, sin(theta)])
            answer, by = self.ask(wheel, rates[::-1])
            slopes, drift = (E @ frame.W) / scale[:, None], -(E @ turning) / scale  # theta'', psi'' = slopes u' + drift
            with_u, alone, arm = by[:, 3:] @ slopes, answer + by[:, 3:] @ drift, frame.W.T @ E.T
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
        ends = [b.axle(frame) for frame in b.frames(q, u)[0]]
        for wheel, begin, end, load, old in zip(self.wheels, axles, ends, loads, last[1], strict=True):
            rates, later = (np.array([of[3], of[2]]) for of in (begin, end))
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
