"""Studies of the axle: error against the communication step and against the stiffness, limits, energy per bond.

A bond is an effort (force, moment) that a body gives to a wheel, and the flow (velocity, angular velocity) that the
wheel gives back. The body's side of it is the integral of its effort with the flow it received; the wheel's side that
of the effort it received with its flow. The difference is the energy that the coupling added. Both are taken over each
communication step with straight lines between the values at its ends.
"""

from dataclasses import replace
from functools import partial

import numpy as np

from . import axle, errors
from .axle import AXLE, WHEELS, rigid
from .errors import Table
from .master import Signal
from .options import Manoeuvre, manoeuvres
from .vehicle import FORCE, Fmus

SCENES = manoeuvres("axle")
STRAIGHT, CLOTHOID, TRAILING, ROLLING_OUT = SCENES.values()
LIMIT_STEPS = (0.00025, 0.0005, 0.00075, 0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.008, 0.012, 0.016)  # s
GRID = 0.048  # s, which all of them divide
BONDS = dict(zip(FORCE, ("X_O_dot", "Y_O_dot", "Z_O_dot"), strict=True)) | {"M_1": "theta_dot", "M_2": "psi_dot"}
KINDS = ("value", "rate", "at_end")

distance = partial(errors.distance, names=axle.COMPARED)


def step_errors(fmus: Fmus, scene: Manoeuvre, exchange: str, steps: tuple[float, ...] = errors.STEPS) -> list[float]:
    """Error against h at this stiffness: the truth is the run with rollback at a quarter of the smallest step."""
    truth = AXLE.drive(fmus, scene, min(steps) / 4, "rollback", 0.02).whole
    return [distance(AXLE.drive(fmus, scene, h, exchange, 0.02).whole, truth) for h in steps]


def stiffness_errors(fmus: Fmus, scene: Manoeuvre, factors: tuple[float, ...], step: float = 0.0005) -> list[float]:
    """Error against the closed form of the rigid axle, with a step small enough for it not to matter."""
    tables = [AXLE.drive(fmus, scene.changed(stiffness=factor), step, "rollback", 0.02).whole for factor in factors]
    return [distance(table, rigid(scene, table["time"])) for table in tables]


def signals(wheel: str, bond: str, kind: str) -> tuple[Signal, Signal]:
    """Effort and flow: at the begin of each step, their rates there, or at its end."""
    before = "" if kind == "value" else f"{kind} "
    return ("axle", f"{before}{bond}_{wheel}"), (wheel, f"{before}{BONDS[bond]}")


def energy(fmus: Fmus, scene: Manoeuvre, step: float, exchange: str) -> tuple[Table, float]:
    """Energy added over a run [J], by wheel and bond, and the gain of the sum of all energies: of a scene without drive
    and rolling friction, in which all energy is in the wheels, the beam and its dampers."""
    stored = [("left", "E"), ("right", "E"), ("axle", "E"), ("axle", "W_loss")]
    record = [s for wheel in WHEELS for bond in BONDS for kind in KINDS for s in signals(wheel, bond, kind)]
    table = replace(AXLE, record=[*record, *stored]).drive(fmus, scene, step, exchange, step).whole
    total = sum(table[AXLE.column(signal)] for signal in stored)
    h = step * (exchange == "derivatives")  # inputs go on straight lines, else they are held

    def added(wheel: str, bond: str) -> float:
        rows = [[table[AXLE.column(s)][:-1] for s in signals(wheel, bond, kind)] for kind in KINDS]
        (e, f), (e_dot, f_dot), (e_end, f_end) = rows
        received, given = product(e, e + h * e_dot, f, f_end), product(e, e_end, f, f + h * f_dot)
        return step * float((received - given).sum())

    bonds = {wheel: np.array([added(wheel, bond) for bond in BONDS]) for wheel in WHEELS}
    return bonds, float(total[-1] - total[0])


def product(a0: np.ndarray, a1: np.ndarray, b0: np.ndarray, b1: np.ndarray) -> np.ndarray:
    """Mean of the product of two straight lines."""
    return (2 * a0 * b0 + a0 * b1 + a1 * b0 + 2 * a1 * b1) / 6


def longest_step(fmus: Fmus, scene: Manoeuvre, exchange: str) -> float:
    """Of LIMIT_STEPS, s."""
    truth = rigid(scene, np.arange(int(scene.stop / GRID) + 1) * GRID)
    scene = scene.changed(stop=float(truth["time"][-1]))
    return errors.longest(LIMIT_STEPS, lambda h: distance(AXLE.drive(fmus, scene, h, exchange, GRID).whole, truth))
