"""What the pointwise tests share: random wheels, motions and loads, answers, and how far two answers are apart.

Tables have one C record per row; frames and symbols are those of wheel_equations.h. The ranges are wide but stay inside
the domain of the equations: theta between 3 and 177 degrees, inertias that a body can have. Errors are
relative to the largest entry of their group: accelerations of O, of the angles and the axle, reactions.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.reference import Wheel, accelerations
from wheelfmu.truth.reference.frames import Matrix, quaternion, rotation, to_body
from wheelfmu.truth.reference.model import Vector
from wheelfmu.truth.reference.motion import body_rates, with_weight
from wheelfmu.truth.reference.newton_euler import Law, carrier_moment
from wheelfmu.truth.reference.sliding_contact import Sliding, respond

Table = np.ndarray
GROUPS = (("X_O_ddot", "Y_O_ddot", "Z_O_ddot"), ("psi_ddot", "theta_ddot", "phi_ddot", "omega_z_dot"), ("lambda_",))
ACCELERATIONS = (*GROUPS[0], *GROUPS[1][:3])
COUNT = 10_000


def random_wheels(random: np.random.Generator, rows: int, symmetric: bool) -> Table:
    wheel = eq.table(eq.Parameters, rows)
    wheel["m"] = 10 ** random.uniform(-1, 3, rows)
    wheel["r_0"] = 10 ** random.uniform(-1, 0.5, rows)
    thin = random.random(rows) < 0.1
    wheel["r"] = np.where(thin, 0, wheel["r_0"] * random.uniform(0, 1, rows))
    # From second moments of the mass, a, b, c >= 0: any inertia that a body can have.
    a, b, c = wheel["m"] * wheel["r_0"] ** 2 * random.uniform(0.05, 1, (3, rows))
    c = np.where(random.random(rows) < 0.2, 0, c)  # the limit J_z = J_x + J_y
    a = b if symmetric else a
    wheel["J_x"], wheel["J_y"], wheel["J_z"] = b + c, a + c, a + b
    wheel["g_n"] = random.uniform(0, 20, rows)
    sloping = random.random(rows) < 0.5
    for axis in ("g_X", "g_Y"):
        wheel[axis] = np.where(sloping, random.normal(0, 5, rows), 0)
    wheel["s"] = wheel["r_0"] * random.uniform(0, 0.2, rows)
    return wheel


def random_scenes(random: np.random.Generator, kind=None, symmetric: bool = True, rows: int = COUNT) -> Table:
    """Scenes under random loads; kind None draws one of the four laws per row."""
    scene = eq.table(eq.Scene, rows)
    scene["wheel"] = random_wheels(random, rows, symmetric)
    scene["friction"]["kind"] = random.integers(eq.FRICTIONLESS, eq.REGULARIZED + 1, rows) if kind is None else kind
    scene["friction"]["sigma"] = random.choice([-1.0, 1.0], rows)
    scene["friction"]["omega_s"] = 10 ** random.uniform(-3, 1, rows)
    weight = scene["wheel"]["m"] * 9.81
    scene["load"]["F"] = weight[:, None] * random.normal(size=(rows, 3))
    scene["load"]["M"] = (weight * scene["wheel"]["r_0"])[:, None] * random.normal(size=(rows, 3))
    braked = random.random(rows) < 0.5
    scene["load"]["brake"] = braked * weight * scene["wheel"]["r_0"] * random.uniform(0, 0.5, rows)
    unloaded = random.random(rows) < 0.1
    scene["load"][unloaded] = 0
    return scene


def random_motions(random: np.random.Generator, rows: int = COUNT) -> Table:
    motion = eq.table(eq.Motion, rows)
    for angle in ("psi", "phi"):
        motion[angle] = random.uniform(-10, 10, rows)
    motion["theta"] = random.uniform(0.05, np.pi - 0.05, rows)
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motion[rate] = random.normal(0, 5, rows)
    for place in ("X_O", "Y_O"):
        motion[place] = random.uniform(-5, 5, rows)
    return motion


def draw(seed: int, law=None, symmetric: bool = True, rows: int = COUNT) -> tuple[Table, Table]:
    """Scenes and motions."""
    random = np.random.default_rng(seed)
    return random_scenes(random, law, symmetric, rows), random_motions(random, rows)


def dynamics(formulation: eq.Formulation, scenes: Table, motions: Table) -> Table:
    return eq.dynamics_each(formulation, scenes, eq.start_each(formulation, scenes, motions))


def relative(a: Table, b: Table) -> float:
    """Largest error over the rows, each relative to the row's largest entry."""
    size = np.abs(b).max(axis=1)
    return float((np.abs(a - b).max(axis=1) / np.where(size > 0, size, 1)).max())


def distance(a: Table, b: Table, scenes: Table) -> float:
    """Largest relative error over all groups of WheelDynamics; tau is measured by r_0 lambda."""
    errors = [relative(eq.columns(a, *names), eq.columns(b, *names)) for names in GROUPS]
    force = scenes["wheel"]["r_0"] * np.abs(b["lambda_"]).max(axis=1)
    errors.append(float((np.abs(a["tau"] - b["tau"]) / (force + np.abs(b["tau"]))).max()))
    return max(errors)


class Given(NamedTuple):
    """One row as a function of it takes it that counts the weight of a level road; sigma None: held."""

    wheel: Wheel
    angles: Vector
    rates: Vector
    F: Vector  # with the weight along a slope
    M: Vector
    sigma: float | None
    brake: float


def given(scene: Table, motion: Table) -> Given:
    constants, friction, load = scene["wheel"], scene["friction"], scene["load"]
    sizes = {name: float(constants[name]) for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "s")}
    wheel = Wheel(**sizes, g=float(constants["g_n"]))
    angles = tuple(float(motion[name]) for name in ("psi", "theta", "phi"))
    rates = tuple(float(motion[name]) for name in ("psi_dot", "theta_dot", "phi_dot"))
    soft = np.tanh((rates[2] + rates[0] * np.cos(angles[1])) / friction["omega_s"])
    sigma = [0.0, float(friction["sigma"]), None, float(soft)][friction["kind"] - eq.FRICTIONLESS]
    F_X, F_Y, F_Z = load["F"].tolist()
    F = (F_X + wheel.m * float(constants["g_X"]), F_Y + wheel.m * float(constants["g_Y"]), F_Z)
    return Given(wheel, angles, rates, F, tuple(load["M"].tolist()), sigma, float(load["brake"]))


def answers(accelerations: Callable, scenes: np.ndarray, motions: np.ndarray) -> Iterator:
    """By a function of Given, row by row. Without pressure there is no friction but the brake's."""
    for row in map(given, scenes, motions):
        found = accelerations(*row)
        if row.sigma is not None and found.lambda_3 <= 0:
            found = accelerations(*row._replace(wheel=replace(row.wheel, s=0.0)))
        yield found


def sliding(scene: Table, motion: Table) -> tuple[Sliding, float, Matrix, Vector]:
    """One row under any friction at the contact, by the reference; the coefficient, 0 where the ground pulls; attitude
    and rotation."""
    wheel, angles, rates, F, M, sigma, brake = given(scene, motion)
    R = rotation(*quaternion(*angles))
    w = body_rates(R[2], *rates)
    loads = R, w, to_body(R, with_weight(wheel, F)), carrier_moment(R[2], M)
    law = Law(wheel.s, sigma or 0.0, sigma is None, brake)
    found = respond(wheel, *loads, law)
    if found.base[6] > 0:
        return found, float(scene["mu_slide"]), R, w
    return respond(wheel, *loads, law._replace(s=0.0)), 0.0, R, w


def referenced(scenes: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """WheelDynamics from the reference."""
    out = eq.table(eq.Dynamics, len(scenes))
    for row, found in zip(out, answers(accelerations, scenes, motions), strict=True):
        for name in (*ACCELERATIONS, "tau"):
            row[name] = getattr(found, name)
        row["lambda_"] = found.lambda_1, found.lambda_2, found.lambda_3
    s, c = np.sin(motions["theta"]), np.cos(motions["theta"])
    turning = out["psi_ddot"] * c - motions["psi_dot"] * motions["theta_dot"] * s
    out["omega_z_dot"] = out["phi_ddot"] + turning
    return out
