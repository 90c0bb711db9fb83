"""What the plane, the wheel and the direction of time leave unchanged, over whole motions of the FMU.

Friction and inputs are on unless said. Fixed axes for places and forces, non-spinning axes for moments.
"""

from dataclasses import dataclass
from math import pi

import numpy as np
import pytest
from numpy.typing import NDArray
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.schedule import Schedule

START = {
    **{"psi_start": 0.4, "theta_start": 1.2, "phi_start": 0.3, "psi_dot_start": 0.5, "theta_dot_start": -0.3},
    **{"phi_dot_start": 3.0, "X_O_start": 0.2, "Y_O_start": -0.1, "s": 0.03, "keep_contact": True},
}
LOAD = {"F_X": (1.0, 2.0), "F_Y": (-2.0, 0.5), "F_Z": (3.0, -1.0)}
LOAD |= {"M_1": (0.1,), "M_2": (-0.2, 0.1), "M_3": (0.5, -0.4), "M_brake": (0.3, 0.1)}
TIMES = np.linspace(0, 4, 81)
UNEQUAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
WHEELS = {"J_x = J_y": {}, "J_x != J_y": UNEQUAL, "J_x != J_y, multibody": {**UNEQUAL, "formulation": 3}}
WHEELS |= {"J_x != J_y, slides at times": {**UNEQUAL, "mu_max": 0.3, "mu_slide": 0.25}}
STEADY = {"guided": True, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
WHEELS |= {"guided, slides at times": {**STEADY, "mu_max": 0.03, "mu_slide": 0.025}}
wheels = pytest.mark.parametrize("inertia", WHEELS.values(), ids=WHEELS)


@dataclass(frozen=True)
class Symmetry:
    """plane: on (X, Y); signs, shifts: z -> sign z + shift of psi, theta, phi; moment: signs of M_1..3; move: X, Y."""

    plane: NDArray[np.float64]
    signs: tuple[int, int, int] = (1, 1, 1)
    shifts: tuple[float, float, float] = (0, 0, 0)
    moment: tuple[int, int, int] = (1, 1, 1)
    move: tuple[float, float] = (0, 0)

    @property
    def angles(self) -> list[tuple[str, int, float]]:
        return list(zip(("psi", "theta", "phi"), self.signs, self.shifts, strict=True))

    def on_plane(self, table, x: str, y: str) -> dict[str, NDArray[np.float64]]:
        """The images of two columns."""
        return dict(zip((x, y), self.plane @ np.array([table[x], table[y]]), strict=True))


TURN = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
SYMMETRIES = {
    "rotation": Symmetry(TURN, shifts=(0.7, 0, 0)),
    "translation": Symmetry(np.eye(2), move=(100.0, -30.0)),
    "mirror": Symmetry(np.diag([1, -1]), (-1, 1, -1), (pi, 0, 0), (1, -1, -1)),
    "axle named the other way": Symmetry(np.eye(2), (1, -1, -1), (pi, pi, pi), (-1, 1, -1)),
    "half a turn of the body": Symmetry(np.eye(2), shifts=(0, 0, pi)),
}


def image_of_start(symmetry: Symmetry) -> dict[str, float]:
    out = START | symmetry.on_plane(START, "X_O_start", "Y_O_start")
    for name, sign, shift in symmetry.angles:
        out[f"{name}_start"] = sign * START[f"{name}_start"] + shift
        out[f"{name}_dot_start"] = sign * START[f"{name}_dot_start"]
    out["X_O_start"] += symmetry.move[0]
    out["Y_O_start"] += symmetry.move[1]
    return out


def image_of_load(symmetry: Symmetry, moment: tuple[int, int, int]) -> Schedule:
    load = {name: np.pad(c, (0, 4 - len(c))) for name, c in LOAD.items()}
    turned = load | symmetry.on_plane(load, "F_X", "F_Y")
    for name, sign in zip(("M_1", "M_2", "M_3"), moment, strict=True):
        turned[name] = sign * load[name]
    return Schedule(((0.0, turned),))


def image_of_motion(symmetry: Symmetry, run: Run) -> dict[str, NDArray[np.float64]]:
    out = dict(run.columns)
    for pair in (("X_O", "Y_O"), ("X_O_dot", "Y_O_dot"), ("lambda_1", "lambda_2"), ("X_C", "Y_C")):
        out |= symmetry.on_plane(run, *pair)
    for name, sign, shift in symmetry.angles:
        out[name] = sign * run[name] + shift
        for rate in (f"{name}_dot", f"{name}_ddot"):
            out[rate] = sign * run[rate]
    for point in "OC":
        out[f"X_{point}"] = out[f"X_{point}"] + symmetry.move[0]
        out[f"Y_{point}"] = out[f"Y_{point}"] + symmetry.move[1]
    for name in ("omega_z", "omega_z_dot", "friction_mode", "tau", "tau_brake"):
        out[name] = symmetry.signs[2] * run[name]
    turned = -1 if symmetry.shifts[0] == pi else 1  # e1 points the other way than the image of e1
    for vector in ("lambda", "slip", "v"):
        out[f"{vector}_x"] = turned * run[f"{vector}_x"]
        out[f"{vector}_y"] = turned * np.linalg.det(symmetry.plane) * run[f"{vector}_y"]
    for axis in (1, 2):
        out[f"M_guide_{axis}"] = symmetry.moment[axis - 1] * run[f"M_guide_{axis}"]
    return out


def difference(expected: dict[str, NDArray[np.float64]], found: Run) -> dict[str, float]:
    """Of each variable relative to its largest value; a slip that is zero stays zero."""
    size = {name: np.abs(values).max() or 1e-300 for name, values in expected.items()}
    return {name: float(np.abs(found[name] - expected[name]).max() / size[name]) for name in expected}


@wheels
@pytest.mark.parametrize("name", SYMMETRIES)
def test_the_motion_keeps_the_symmetries_of_plane_and_wheel(library: Library, name: str, inertia: dict) -> None:
    symmetry = SYMMETRIES[name]
    plain = Symmetry(np.eye(2))
    before = library.simulate(TIMES, 1e-11, image_of_load(plain, (1, 1, 1)), **{**START, **inertia})
    expected = image_of_motion(symmetry, before)

    def gap(moment: tuple[int, int, int]) -> dict[str, float]:
        load = image_of_load(symmetry, moment)
        return difference(expected, library.simulate(TIMES, 1e-11, load, **{**image_of_start(symmetry), **inertia}))

    within(gap(symmetry.moment), 1e-10, "motion off the image, relative")  # ten tolerances
    beyond(max(gap(tuple(-sign for sign in symmetry.moment)).values()), 0.1, "with moments mapped wrongly")


def test_with_equal_J_x_and_J_y_the_turn_phi_of_the_body_at_the_start_does_not_matter(library: Library) -> None:
    def gap(**inertia: float) -> float:
        a, b = (library.simulate(TIMES, **{**START, "phi_start": phi}, **inertia) for phi in (0.0, 0.7))
        return float(np.abs(a["theta"] - b["theta"]).max())

    within(gap(), 2048 * EPSILON, "tilts apart, rad")  # phi takes part in the choice of steps
    beyond(gap(**UNEQUAL), 0.04, "tilts of unequal J_x and J_y apart, rad")


def test_the_free_wheel_run_backwards_returns_to_its_start(library: Library) -> None:
    def gap(s: float) -> float:
        forth = library.simulate([0.0, 4.0], 1e-12, **{**START, "s": s})
        back = {"s": s, "keep_contact": True}
        for name in ("psi", "theta", "phi"):
            back |= {f"{name}_start": forth[name][-1], f"{name}_dot_start": -forth[f"{name}_dot"][-1]}
        back |= {f"{name}_start": forth[name][-1] for name in ("X_O", "Y_O")}
        end = library.simulate([0.0, 4.0], 1e-12, **back)
        names = ("X_O", "Y_O", "psi", "theta", "phi")
        return max(abs(end[name][-1] - START[f"{name}_start"]) for name in names)

    within(gap(0.0), 1e-12, "place, m, and angles off the start, rad")  # the tolerance
    beyond(gap(1e-6), 6e-5, "place and angles off the start with friction")  # it has a direction of time
