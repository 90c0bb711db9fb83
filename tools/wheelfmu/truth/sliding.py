"""Scenes in which the wheel slides, as data for the FMU and the reference; closed forms of upright straight sliding.

SI; names of modelDescription.xml. Closed forms: R = r_0 + r, N = m g cos(slope), v of O along e1, slip = v + R omega_z.
"""

from math import atan, cos, pi, sin, tan

import numpy as np

from wheelfmu.fmu.driver import Values
from wheelfmu.truth.reference import Wheel

from .closed_forms import rolling_inertia
from .scenes import GENERAL, PUSH, Scene
from .schedule import Schedule

UPRIGHT = {"psi_start": 0.0, "theta_start": pi / 2, "phi_dot_start": 0.0, "X_O_start": 0.0}
ROAD: Values = {"mu_max": 0.45, "mu_slide": 0.4}
EQUAL: Values = {"mu_max": 0.4, "mu_slide": 0.4}
THROWN: Values = {"slip_x_start": -1.5, "slip_y_start": 0.8, "phi_dot_start": -6.0}
LOCK = Schedule(((0.0, {"M_brake": 1e3}),))
STEPS = Schedule(((0.0, {"M_3": -60.0}), (0.4, {"M_brake": 90.0}), (1.2, {"M_3": (0, 4), "F_Y": 30.0, "M_1": 2.0})))
ROLLER: Values = {"r": 0.1, "J_x": 1.62, "J_y": 1.69, "J_z": 0.36, "phi_start": 1.03}
HUB: Values = {"r": 0.0, "J_x": 0.09, "J_y": 0.09, "J_z": 0.1, "psi_start": 0.0, "phi_dot_start": 0.0}

SLIDES = {
    "paper's wheel": Scene(ROAD, 2.5),
    "slippery": Scene({"mu_max": 0.3, "mu_slide": 0.25}, 1.5),
    "equal coefficients": Scene(EQUAL, 1.0),
    "rolling resistance": Scene({**ROAD, "s": 0.03}, 2.0),
    "general inertia, rolling resistance": Scene({**GENERAL, "s": 0.03, "mu_max": 0.35, "mu_slide": 0.3}, 1.4),
    "thrown": Scene({**ROAD, **THROWN, "s": 0.01}, 2.0),
    "thrown, equal coefficients": Scene({**EQUAL, **THROWN, **GENERAL}, 2.0),
    "thin disc": Scene({**ROAD, **THROWN, "r": 0.0}, 2.0),
    "slope": Scene({**ROAD, **THROWN, "slope": 0.5, "slope_direction": 0.7}, 1.0),
    "pushed": Scene({**ROAD, **GENERAL, "s": 0.01}, 1.0, PUSH),
    "driven and braked": Scene({**ROAD, "s": 0.01}, 1.5, STEPS),
    "locked": Scene({**ROAD, **UPRIGHT, "slip_x_start": 7.0}, 2.5, LOCK),
    "locked, leaning": Scene({**ROAD, "slip_x_start": 3.0, "phi_dot_start": 0.0}, 0.6, LOCK),
    "regularized": Scene({**ROAD, **THROWN, "s": 0.03, "friction_law": "regularized", "omega_s": 0.05}, 2.0),
    "pulled": Scene({"mu_max": 0.3, "mu_slide": 0.25, "theta_start": 0.4, "theta_dot_start": 7.0, "phi_dot_start": -1.0}
        | {"slip_y_start": 3.0, "keep_contact": True}, 0.8),
    "turns at once": Scene(
        {**ROLLER, "mu_max": 0.4, "mu_slide": 0.4, "psi_start": 0.0, "theta_start": 2.17, "psi_dot_start": -8.0}
        | {"theta_dot_start": 0.8, "phi_dot_start": 1.6, "slip_x_start": 0.0, "slip_y_start": 0.05},
        0.05,
    ),
    "jams": Scene({**HUB, "mu_max": 0.8, "mu_slide": 0.8, "theta_start": 0.87, "theta_dot_start": 2.0}
        | {"slip_x_start": 2.0, "slip_y_start": -5.0}, 0.2),
}  # fmt: skip


def random_slide(random: np.random.Generator) -> Scene:
    """0.6 s of any wheel on any road: thrown or not, loaded or not, with and without rolling resistance and a brake."""
    a, b, c = random.uniform(0.2, 0.9, 3)
    a = b if random.random() < 0.3 else a
    mu_max = random.uniform(0.1, 0.8)
    start = {"r": random.uniform(0, 0.1), "J_x": b + c, "J_y": a + c, "J_z": a + b}
    start |= {"s": random.choice([0, random.uniform(0, 0.05)]), "slope": random.choice([0, random.uniform(0, 0.5)])}
    start |= {"slope_direction": random.uniform(-pi, pi), "theta_start": random.uniform(0.9, 2.2)}
    start |= dict(zip(("psi_start", "phi_start"), random.uniform(-pi, pi, 2), strict=True))
    start |= dict(zip(("psi_dot_start", "theta_dot_start", "phi_dot_start"), random.normal(0, 3, 3), strict=True))
    start |= {"mu_max": mu_max, "mu_slide": mu_max * random.choice([1, random.uniform(0.4, 1), random.uniform(0.4, 1)])}
    if random.random() < 0.5:
        start |= dict(zip(("slip_x_start", "slip_y_start"), random.normal(0, 1, 2), strict=True))
    pieces: list[tuple[float, dict]] = []
    if random.random() < 0.5:
        pieces = [(0.0, {name: tuple(random.uniform(-9, 9, 2)) for name in ("F_X", "F_Y", "F_Z")})]
        pieces[0][1].update({name: tuple(random.uniform(-2, 2, 2)) for name in ("M_1", "M_2", "M_3")})
        torque, brake = float(random.uniform(-20, 20)), tuple(random.uniform(0, 20, 2))
        pieces.append((float(random.uniform(0.1, 0.5)), {"M_3": torque, "M_brake": brake}))
    return Scene({name: float(value) for name, value in start.items()}, 0.6, Schedule(tuple(pieces)))


# ---- closed forms: upright and straight ----


def stopping(wheel: Wheel, mu: float, v: float) -> tuple[float, float]:
    """Time and distance of a locked wheel from v to rest."""
    return v / (mu * wheel.g), v**2 / (2 * mu * wheel.g)


def backspin(wheel: Wheel, mu: float, v: float, omega_z: float) -> tuple[float, float, float]:
    """Thrown with v > 0 and slip v + R omega_z > 0: instant of grip, v there, distance.

    v' = -mu g, omega_z' = -mu m g R / J_z: the slip falls at mu g (1 + m R^2 / J_z).
    """
    R, mass = wheel.r_0 + wheel.r, wheel.m / wheel.J_z
    t = (v + R * omega_z) / (mu * wheel.g * (1 + mass * R**2))
    return t, v - mu * wheel.g * t, v * t - mu * wheel.g * t**2 / 2


def gripping_torque(wheel: Wheel, mu: float) -> float:
    """Largest torque of a motor under which the wheel rolls away from rest: m R M / (J_z + m R^2) = mu m g."""
    return mu * wheel.g * rolling_inertia(wheel) / (wheel.r_0 + wheel.r)


def spinning(wheel: Wheel, mu: float, torque: float) -> tuple[float, float]:
    """(dv/dt, d omega_z/dt) under a larger torque M_3 = -torque: the wheel spins forward, mu m g drives it."""
    return mu * wheel.g, -(torque - mu * wheel.m * wheel.g * (wheel.r_0 + wheel.r)) / wheel.J_z


def gripping_slope(wheel: Wheel, mu: float) -> float:
    """The steepest slope on which the wheel rolls straight down: tan = mu (1 + m R^2 / J_z)."""
    return atan(mu * rolling_inertia(wheel) / wheel.J_z)


def downhill(wheel: Wheel, mu: float, slope: float, slides: bool) -> tuple[float, float]:
    """(acceleration, |d omega_z/dt|) straight down the slope from rest, sliding or rolling."""
    R = wheel.r_0 + wheel.r
    if not slides:
        a = wheel.g * sin(slope) / (1 + wheel.J_z / (wheel.m * R**2))
        return a, a / R
    return wheel.g * cos(slope) * (tan(slope) - mu), mu * wheel.m * wheel.g * cos(slope) * R / wheel.J_z


def jamming(wheel: Wheel, theta: float) -> float:
    """Least coefficient at which friction across a wheel with J_x = J_y, leaning at theta, can jam it.

    Friction f pulls the contact in under the leaning wheel. Per N, O rises by 1/m, and the moment about e1 turns the
    contact down at (mu h - l) l / J, h = r_0 sin + r the height of O, l = r_0 |cos|: mu h l >= J/m + l^2 leaves no N.
    """
    h, l = wheel.r_0 * sin(theta) + wheel.r, wheel.r_0 * abs(cos(theta))  # noqa: E741
    return (wheel.J_x / wheel.m + l**2) / (h * l)
