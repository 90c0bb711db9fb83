"""The axle: two wheels and a rigid beam, coupled; the rigid axle on wheels that never slip in closed form.

With b half the track, R the wheels' radius, m all masses, S = m_B a the first moment of mass ahead of the axle,
m_t = m + 2 J_z / R^2, I_t the moment of inertia about the axle's middle with 2 J_z b^2 / R^2, and v, w the speed of the
middle and the yaw rate:

    m_t v' = S w^2 + (M_left + M_right) / R - friction,    I_t w' = -S v w + b (M_right - M_left) / R - friction
"""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.integrate import odeint
from scipy.optimize import brentq

from . import options
from .options import Manoeuvre, manoeuvres
from .vehicle import DRY_ROAD, STEPS, Fmus, Run, Table, Vehicle, beyond_dry, road, upright

WHEELS = {"left": "left", "right": "right"}
COMPARED = options.file("axle")["compared"]
SCENES = manoeuvres("axle")
STRAIGHT, CLOTHOID, TRAILING, ROLLING_OUT = SCENES.values()
OFF, SOFT = 0.05, 4.0  # deviation from the rigid axle with the standard links, of the range; it grows as their softness
OF_WHEEL = {"m": 20.0, "J_x": 0.9, "J_z": 1.8}  # the wheels' defaults


def starts(scene: Manoeuvre) -> dict[str, dict[str, float]]:
    """Of two wheels and the beam."""
    v, omega, R, factor = (scene[name] for name in ("v", "omega", "R", "stiffness"))
    hubs = zip(WHEELS, (scene["b"], -scene["b"]), strict=True)
    wheels = {wheel: road(scene) | upright(0.0, y, 0.0, v - y * omega, omega, R) for wheel, y in hubs}
    links = {name: scene[name] * factor for name in ("k", "c", "k_a", "c_a", "k_p", "c_p")}
    return wheels | {"axle": links | {"inner_step": min(5e-4, 5e-4 / factor)}}


def constants(scene: Manoeuvre) -> SimpleNamespace:
    """Parameters of the axle and its wheels by name, with m_t, I_t and S."""
    c = SimpleNamespace(**OF_WHEEL | {name: scene[name] for name in options.every("axle")} | scene.given)
    c.mass = c.m_B + 2 * c.m
    c.m_t = c.mass + 2 * c.J_z / c.R**2
    c.I_t = c.J_3 + c.m_B * c.a**2 + 2 * (c.J_x + c.m * c.b**2 + c.J_z * (c.b / c.R) ** 2)
    c.S = c.m_B * c.a
    return c


def without_closed_form(scene: Manoeuvre) -> str:
    """Why the rigid axle of a scene has no closed form here; empty where it has one."""
    c = constants(scene)
    driven, turning, rises = c.M_left or c.M_right, c.b * abs(c.omega), np.cos(c.slope_direction)
    if c.t_couple or c.X_start or c.Y_start:
        return "it assumes links that carry from the start, on the wheels' axle"
    if softness(scene) > SOFT:
        return f"it assumes rigid links, and these are softer than 1/{SOFT:g} of the standard ones"
    if c.slope and abs(rises) < 1 - 1e-9:
        return "on a slope it assumes an axle that rolls up or down"
    if c.slope and (c.s or c.S or c.M_left != c.M_right or c.omega):
        return "on a slope it assumes a balanced axle that rolls straight without friction"
    if c.s and (c.S or driven or not c.v > turning > 0):
        return "with rolling friction it assumes a balanced axle without torque, on a bend wider than half its track"
    if c.S and (driven or not c.v**2 + c.omega**2 > 0):
        return "with mass ahead of the axle it assumes an axle in motion, without torque"
    return ""


def softness(scene: Manoeuvre) -> float:
    """The largest ratio of a link's standard stiffness to its own."""
    standard = options.parameters("axle")
    return max(standard[name].start / max(scene[name] * scene["stiffness"], 1e-300) for name in ("k", "k_a", "k_p"))


Velocities = Callable[[Any], tuple[np.ndarray, np.ndarray]]


def velocities(scene: Manoeuvre) -> tuple[Velocities, tuple[float, ...]]:
    """v and omega of the rigid axle over time, for the scenes that have a closed form, and when one of its wheels
    stops."""
    c = constants(scene)
    if c.s:
        return rolling_out(c)
    if c.S:
        return trailing(c), ()
    grade = np.sin(c.slope) * np.cos(c.slope_direction)
    a = ((c.M_left + c.M_right) / c.R - c.mass * c.g * grade) / c.m_t
    return lambda t: (c.v + a * t, c.omega + c.b * (c.M_right - c.M_left) / (c.R * c.I_t) * t), ()


def trailing(c: SimpleNamespace) -> Velocities:
    """No torque, mass ahead of the axle: m_t v^2 + I_t w^2 = m_t V^2 stays, and v' = kappa (V^2 - v^2) / V.

    So v = V tanh(kappa t + p), w = V sqrt(m_t / I_t) sech(kappa t + p), kappa = S V / I_t: whatever the start, it ends
    running straight with the mass in front.
    """
    V = np.sqrt(c.v**2 + c.I_t / c.m_t * c.omega**2)
    kappa, p, most = c.S * V / c.I_t, np.arctanh(c.v / V), np.sign(c.omega) * V * np.sqrt(c.m_t / c.I_t)
    return lambda t: (V * np.tanh(kappa * t + p), most / np.cosh(kappa * t + p))


def rolling_out(c: SimpleNamespace) -> tuple[Velocities, tuple[float, float]]:
    """Rolling friction brings a turning axle to rest, wheel by wheel: S = 0, no torque, v > b |omega| > 0.

    Both roll: v' = -A with A = s m g / (R m_t). The load moves outwards by dN = m_t R v w / (2 b) per wheel, so
    w' = -(s m_t / I_t) v w and w = omega exp(-(s m_t / I_t) x), x = v t - A t^2 / 2. The inner wheel stops at t_1,
    where v = b w. Then the axle turns about it: w' = -D (1 + B w^2), B = m_t R / (m g),
    D = s b m g / (R (m_t b^2 + I_t)), so sqrt(B) w = tan(angle) with an angle that falls by D sqrt(B) per second.
    """
    A = c.s * c.mass * c.g / (c.R * c.m_t)
    root = np.sqrt(c.m_t * c.R / (c.mass * c.g))
    fall = root * c.s * c.b * c.mass * c.g / (c.R * (c.m_t * c.b**2 + c.I_t))

    def omega(t: np.ndarray) -> np.ndarray:
        return abs(c.omega) * np.exp(-c.s * c.m_t / c.I_t * (c.v * t - A * t**2 / 2))

    t_1 = brentq(lambda t: c.v - A * t - c.b * omega(t), 0.0, c.v / A, xtol=1e-14)
    angle = np.arctan(root * omega(t_1))

    def at(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        about = np.tan(np.maximum(angle - fall * np.maximum(t - t_1, 0.0), 0.0)) / root
        turning = np.where(t < t_1, omega(np.minimum(t, t_1)), about)
        return np.where(t < t_1, c.v - A * t, c.b * about), np.sign(c.omega) * turning

    return at, (t_1, t_1 + angle / fall)


def rigid(scene: Manoeuvre, times: np.ndarray) -> Table:
    """X, Y, psi, v, omega of the rigid axle at `times` (rising from 0); the path from v and omega by SciPy."""
    at, stops = velocities(scene)

    def rate(t: float, y: np.ndarray) -> tuple[np.ndarray, ...]:
        v, omega = at(t)
        return v * np.cos(y[2]), v * np.sin(y[2]), omega

    path = odeint(rate, np.zeros(3), times, tfirst=True, rtol=1e-12, atol=1e-12, tcrit=stops or None)
    return dict(zip(("time", *COMPARED), (times, *path.T, *at(times)), strict=True))


def beside_rigid(run: Run, scene: Manoeuvre, _fmus: Fmus) -> Run:
    """With the columns of the rigid axle beside those of the co-simulation, where it has a closed form."""
    if without_closed_form(scene) or len(run.table["time"]) < 2:
        return run
    exact = rigid(scene, run.table["time"])
    return replace(run, table=run.table | {f"rigid.{name}": exact[name] for name in COMPARED})


def verdict(table: Table, scene: Manoeuvre) -> tuple[bool, list[str]]:
    """How near it is to the rigid axle where its closed form holds; wheels that require more than a dry road fail."""
    if (most := AXLE.grip(table)) > DRY_ROAD:
        return False, [f"Failed: a wheel requires a friction coefficient of {beyond_dry(most)}."]
    slides = any(np.any(table[f"{w}.{n}"]) for w in WHEELS for n in ("slip_x", "slip_y"))
    if why := without_closed_form(scene) or "it assumes wheels that never slide" * slides:
        return True, [f"No closed form to compare with: {why}."]
    off = AXLE.distance(table, {n: table[f"rigid.{n}"] for n in COMPARED} | {"time": table["time"]})
    bound, said = OFF * max(1.0, softness(scene)), f"deviation from the rigid axle in closed form: {100 * off:.2g} %"
    if off > bound:
        return False, [f"Failed: {said} of the range, more than {100 * bound:.2g} %."]
    return True, [f"Largest {said} of the range."]


AXLE = Vehicle("axle", starts, verdict, wheels=WHEELS, complete=beside_rigid)


def step_errors(fmus: Fmus, scene: Manoeuvre, exchange: str, steps: tuple[float, ...] = STEPS) -> dict:
    """Error by h at this stiffness: the truth is the run with rollback at a quarter of the smallest step."""
    truth = AXLE.drive(fmus, scene, min(steps) / 4, "rollback", 0.02).whole
    return {h: AXLE.error(fmus, scene, truth, h, exchange) for h in steps}


def stiffness_errors(fmus: Fmus, scene: Manoeuvre, factors: tuple[float, ...], step: float = 0.0005) -> dict:
    """Error by factor against the closed form of the rigid axle, with a step small enough for it not to matter."""
    truth = rigid(scene, np.arange(round(scene.stop / 0.02) + 1) * 0.02)
    return {k: AXLE.error(fmus, scene.changed(stiffness=k), truth, step, "rollback") for k in factors}


def energy_gain(table: Table) -> float:
    """Of wheels, beam and dampers together over a run without drive and rolling friction, J: added by the coupling."""
    total = table["E"] + table["left.E"] + table["right.E"] + table["W_loss"]
    return float(total[-1] - total[0])
