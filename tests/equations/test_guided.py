"""The equations on a wheel carrier against the paper's system (24) with the carrier's two moments as unknowns.

Random wheels whose axle turns as prescribed, under loads and each law; frames of wheel_equations.h.
"""

from ctypes import byref

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import Carried, dynamics_of, set_rolling, solved
from wheelfmu.truth.pointwise import ACCELERATIONS, Table, draw

FORMS, SLIDES = (eq.REDUCED, eq.MULTIBODY), (eq.SLIDING, eq.MULTIBODY_SLIDING)
BOUND = 1e-10


def guided(seed: int, law: int, rows: int = 3000) -> tuple[Table, Table]:
    """Scenes and motions."""
    scenes, motions = draw(seed, law, symmetric=False, rows=rows)
    random = np.random.default_rng(seed)
    still = random.random(rows) < 0.2
    motions["psi_dot"][still] = motions["theta_dot"][still] = 0
    if law == eq.HELD:
        motions["phi_dot"] = -motions["psi_dot"] * np.cos(motions["theta"])
    scenes["load"]["guide"] = np.where(still[:, None], 0, random.normal(0, 5, (rows, 2)))
    scenes["mu_slide"], scenes["contact"] = random.uniform(0, 1.2, rows), 1
    scenes["guided"] = 1
    for axis in ("slip_x", "slip_y"):
        motions[axis] = random.normal(size=rows)
    return scenes, motions


def transcribed(scenes: Table, motions: Table, slides: bool) -> tuple[Table, Table]:
    """WheelDynamics, and the carrier's moments about e1 and e2."""
    paper = Carried(scenes["wheel"], set_rolling(scenes["wheel"], motions))
    paper.turn = scenes["load"]["guide"]
    if slides:
        theta, theta_dot, theta_ddot = motions["theta"], motions["theta_dot"], scenes["load"]["guide"][:, 1]
        rise = scenes["wheel"]["r_0"] * (np.cos(theta) * theta_ddot - np.sin(theta) * theta_dot**2)
        N = scenes["wheel"]["m"] * (scenes["wheel"]["g"] + rise) - scenes["load"]["F"][:, 2]
        mu = np.where(N > 0, scenes["mu_slide"], 0)
        paper.slip_of = mu, motions["psi"] + np.arctan2(motions["slip_y"], motions["slip_x"])
    x = solved(paper, scenes)
    return dynamics_of(paper, x, scenes), x[:, 9:11]


def apart(found: Table, want: Table, scenes: Table) -> float:
    """Largest error over the rows, as a force over those that act: of a wheel that is held all else is zero."""
    wheel, load = scenes["wheel"], scenes["load"]
    size = wheel["m"] * 9.81 + np.abs(load["F"]).max(axis=1) + np.abs(load["M"]).max(axis=1) / wheel["r_0"]
    as_force = dict.fromkeys(ACCELERATIONS[:3], wheel["m"])
    as_force |= dict.fromkeys(("psi_ddot", "theta_ddot", "phi_ddot", "omega_z_dot"), wheel["J_z"] / wheel["r_0"])
    as_force |= {"lambda_": np.ones_like(size), "tau": 1 / wheel["r_0"]}
    errors = [np.abs(found[name] - want[name]).T * factor for name, factor in as_force.items()]
    return max(float((error / size).max()) for error in errors)


def moments(scenes: Table, k: Table, found: Table) -> Table:
    """wheel_guide_moment row by row."""
    out = np.zeros((len(k), 2))
    for row, *records in zip(out, scenes, k, found, strict=True):
        kinds = zip((eq.Scene, eq.Kinematics, eq.Dynamics), records, strict=True)
        scene, place, answer = (kind.from_buffer_copy(record) for kind, record in kinds)
        eq.LIBRARY.wheel_guide_moment(byref(scene), byref(place), byref(answer), row.ctypes.data_as(eq.DOUBLES))
    return out


@pytest.mark.parametrize("slides", [False, True], ids=["grips", "slides"])
def test_accelerations_reactions_and_the_carriers_moments_are_those_of_24(law: int, slides: bool) -> None:
    scenes, motions = guided(12, law)
    want, carried = transcribed(scenes, motions, slides)
    pulls = want["lambda_"][:, 2] <= 0
    within(abs(pulls.mean() - 0.37), 0.1, "share of wheels that the ground pulls, less 0.37")
    arm = scenes["wheel"]["r_0"] * (np.abs(want["lambda_"]).max(axis=1) + scenes["wheel"]["m"] * 9.81)
    for form in SLIDES if slides else FORMS:
        y = eq.start_each(form, scenes, motions)
        found = eq.dynamics_each(form, scenes, y)
        within(apart(found, want, scenes), BOUND, "distance")
        held = moments(scenes, eq.kinematics_each(form, scenes, y), found)
        within(float((np.abs(held - carried).max(axis=1) / arm).max()), BOUND, "moment over r_0 times the force")
        y_dot, normal = eq.derivative_each(form, scenes, y)
        answer = found.copy()
        answer["lambda_"][:, 2], answer["omega_z_dot"] = normal, y_dot[:, eq.OMEGA_3]
        within(apart(answer, want, scenes), BOUND, "derivative")
        wrong = scenes.copy()
        wrong["wheel"]["J_z"] *= 1 + 1e-7
        wrong["mu_slide"] *= 1 + 1e-7
        other = apart(eq.dynamics_each(form, wrong, y), want, scenes)
        if law != eq.HELD or slides:
            beyond(other, 1e-9, "distance with another inertia and coefficient")
