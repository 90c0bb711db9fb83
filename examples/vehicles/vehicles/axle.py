"""The axle: two wheels and a rigid beam, coupled; the rigid axle on wheels that never slip in closed form.

With b half the track, R the wheels' radius, m all masses, S = m_B a the first moment of mass ahead of the axle,
m_t = m + 2 J_z / R^2, I_t the moment of inertia about the axle's middle with 2 J_z b^2 / R^2, and v, w the speed of the
middle and the yaw rate:

    m_t v' = S w^2 + (M_left + M_right) / R - friction,    I_t w' = -S v w + b (M_right - M_left) / R - friction
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from .component import Component
from .hubs import upright, wire
from .master import Master, Signal
from .options import starts
from .ssp import System

WHEELS = ("left", "right")
CONNECTIONS = [connection for wheel in WHEELS for connection in wire("axle", wheel)]
RECORD: list[Signal] = [
    *(("axle", name) for name in ("X", "Y", "psi", "v", "omega", "E", "W_loss")),
    *((wheel, name) for wheel in WHEELS for name in ("omega_z", "lambda_3", "mu_required", "E")),
    *((wheel, name) for wheel in WHEELS for name in ("X_O", "Y_O", "psi", "theta", "phi")),  # scripts/view needs these
]
COMPARED = ("X", "Y", "psi", "v", "omega")


@dataclass(frozen=True)
class Scene:
    """Parameters of the axle and its start; the defaults of the FMUs. SI units."""

    m_B: float = 120.0
    J_3: float = 16.0
    a: float = 0.0  # centre of mass ahead of the axle's line
    b: float = 0.75
    M_left: float = 0.0
    M_right: float = 0.0
    v: float = 0.0
    omega: float = 0.0
    s: float = 0.0
    stiffness: float = 1.0  # factor on all stiffnesses and dampings
    stop: float = 4.0
    more: dict[str, float] = field(default_factory=dict)  # further parameters of axle.fmu
    m: float = 20.0  # of a wheel
    J_x: float = 0.9
    J_z: float = 1.8
    R: float = 0.35
    g: float = 9.81
    slope: float = 0.0  # rad; the road rises along the start's heading X

    @property
    def m_t(self) -> float:
        """Effective mass along the heading, kg."""
        return self.m_B + 2 * self.m + 2 * self.J_z / self.R**2

    @property
    def I_t(self) -> float:
        """Effective moment of inertia about the axle's middle, kg m2."""
        wheels = 2 * (self.J_x + self.m * self.b**2 + self.J_z * (self.b / self.R) ** 2)
        return self.J_3 + self.m_B * self.a**2 + wheels

    @property
    def S(self) -> float:
        """First moment of mass ahead of the axle, kg m."""
        return self.m_B * self.a

    def axle_start(self) -> dict[str, float]:
        """Parameters of axle.fmu."""
        links = starts("axle")
        return {
            **{name: links[name] * self.stiffness for name in ("k", "c", "k_a", "c_a", "k_p", "c_p")},
            "inner_step": min(5e-4, 5e-4 / self.stiffness),
            **{"m_B": self.m_B, "J_3": self.J_3, "a": self.a, "b": self.b, "M_left": self.M_left},
            **{"M_right": self.M_right, "v_start": self.v, "omega_start": self.omega, "slope": self.slope},
            **self.more,
        }

    def wheel_start(self, wheel: str) -> dict[str, float]:
        """Parameters of a wheel.fmu."""
        y = self.b if wheel == "left" else -self.b
        return {"s": self.s, "slope": self.slope, **upright(0.0, y, 0.0, self.v - y * self.omega, self.omega, self.R)}


def components(fmus: dict[str, Path], scene: Scene) -> list[Component]:
    """The FMUs of the axle."""
    wheels = [Component(wheel, fmus["wheel"], scene.wheel_start(wheel)) for wheel in WHEELS]
    return [*wheels, Component("axle", fmus["axle"], scene.axle_start())]


def coupled(
    fmus: dict[str, Path], scene: Scene, step: float = 0.001, exchange: str = "derivatives", grid: float = 0.01, **how
) -> dict[str, np.ndarray]:
    """The co-simulation on the grid; columns by "component.variable", those of the axle by variable."""
    with Master(components(fmus, scene), CONNECTIONS) as master:
        table = master.run(scene.stop, step, RECORD, exchange, round(grid / step), **how)
    return {name.removeprefix("axle."): table[name] for name in table.dtype.names}


def without_closed_form(scene: Scene) -> str:
    """Why the rigid axle of a scene has no closed form here; empty where it has one."""
    if scene.slope and (scene.s or scene.S or scene.M_left != scene.M_right or scene.omega):
        return "on a slope it is that of a balanced axle that rolls straight without friction"
    driven, turning = scene.M_left or scene.M_right, scene.b * abs(scene.omega)
    if scene.s and (scene.S or driven or not scene.v > turning > 0):
        return "with rolling friction it is that of a balanced axle without torque, on a bend wider than half its track"
    if scene.S and (driven or not scene.v**2 + scene.omega**2 > 0):
        return "with mass ahead of the axle it is that of an axle in motion, without torque"
    return ""


def velocities(scene: Scene, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """v and omega of the rigid axle at `times`, for the scenes that have a closed form."""
    if scene.s:
        return rolling_out(scene, times)
    if scene.S:
        return trailing(scene, times)
    pull = (scene.M_left + scene.M_right) / scene.R - (scene.m_B + 2 * scene.m) * scene.g * np.sin(scene.slope)
    v = scene.v + pull / scene.m_t * times
    return v, scene.omega + scene.b * (scene.M_right - scene.M_left) / (scene.R * scene.I_t) * times


def trailing(scene: Scene, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """No torque, mass ahead of the axle: m_t v^2 + I_t w^2 = m_t V^2 stays, and v' = kappa (V^2 - v^2) / V.

    So v = V tanh(kappa t + c), w = V sqrt(m_t / I_t) sech(kappa t + c), kappa = S V / I_t: whatever the start, it ends
    running straight with the mass in front.
    """
    V = np.sqrt(scene.v**2 + scene.I_t / scene.m_t * scene.omega**2)
    phase = scene.S * V / scene.I_t * times + np.arctanh(scene.v / V)
    return V * np.tanh(phase), np.sign(scene.omega) * V * np.sqrt(scene.m_t / scene.I_t) / np.cosh(phase)


def stops(scene: Scene) -> tuple[float, float]:
    """Instants at which the inner and the outer wheel stop, s: rolling friction, S = 0, no torque, v > b |omega| > 0.

    Both roll: v' = -A with A = s m g / (R m_t). The load moves outwards by dN = m_t R v w / (2 b) per wheel, so
    w' = -(s m_t / I_t) v w and w = omega exp(-(s m_t / I_t) x), x = v t - A t^2 / 2. The inner wheel stops where
    v = b w. Then the axle turns about it: w' = -D (1 + B w^2), B = m_t R / (m g), D = s b m g / (R (m_t b^2 + I_t)).
    """
    A, D, B, w_1, t_1 = _rolling_out(scene)
    return t_1, t_1 + np.arctan(np.sqrt(B) * w_1) / (D * np.sqrt(B))


def _rolling_out(scene: Scene) -> tuple[float, float, float, float, float]:
    mass = scene.m_B + 2 * scene.m
    weight = mass * scene.g
    A = scene.s * weight / (scene.R * scene.m_t)
    D = scene.s * scene.b * weight / (scene.R * (scene.m_t * scene.b**2 + scene.I_t))
    B = scene.m_t * scene.R / weight

    def omega(t: float) -> float:
        return abs(scene.omega) * np.exp(-scene.s * scene.m_t / scene.I_t * (scene.v * t - A * t**2 / 2))

    t_1 = brentq(lambda t: scene.v - A * t - scene.b * omega(t), 0.0, scene.v / A, xtol=1e-14)
    return A, D, B, omega(t_1), t_1


def rolling_out(scene: Scene, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """v and omega of a turning axle that rolling friction brings to rest, wheel by wheel; see `stops`."""
    A, D, B, w_1, t_1 = _rolling_out(scene)
    t = np.minimum(times, t_1)
    both = abs(scene.omega) * np.exp(-scene.s * scene.m_t / scene.I_t * (scene.v * t - A * t**2 / 2))
    angle = np.arctan(np.sqrt(B) * w_1) - D * np.sqrt(B) * np.maximum(times - t_1, 0.0)
    about = np.tan(np.maximum(angle, 0.0)) / np.sqrt(B)
    omega = np.where(times < t_1, both, about)
    return np.where(times < t_1, scene.v - A * t, scene.b * about), np.sign(scene.omega) * omega


def rigid(scene: Scene, times: np.ndarray) -> dict[str, np.ndarray]:
    """X, Y, psi, v, omega of the rigid axle at `times` (rising from 0); the path from v and omega by SciPy."""

    def rate(t: float, y: np.ndarray) -> tuple[float, float, float]:
        v, omega = velocities(scene, t)
        return v * np.cos(y[2]), v * np.sin(y[2]), omega

    cuts = [t for t in stops(scene) if 0 < t < times[-1]] if scene.s and scene.omega else []  # where a wheel stops
    y, path = np.zeros(3), []
    for begin, end in pairwise([0.0, *cuts, times[-1]]):
        at = times[(times >= begin) & ((times < end) | (end == times[-1]))]
        found = solve_ivp(rate, (begin, end), y, "DOP853", np.union1d(at, [end]), rtol=1e-12, atol=1e-12)
        y = found.y[:, -1]
        path.append(found.y[:, : len(at)])
    v, omega = velocities(scene, times)
    return {"time": times, **dict(zip(("X", "Y", "psi"), np.hstack(path), strict=True)), "v": v, "omega": omega}


def system(fmus: dict[str, Path], scene: Scene, step: float = 0.001) -> System:
    """What axle.ssp holds. A master that begins with zero inputs finds the hubs free for its first steps."""
    parts = components(fmus, replace(scene, more={"t_couple": 3 * step, **scene.more}))
    return System("axle", parts, CONNECTIONS, step, scene.stop)
