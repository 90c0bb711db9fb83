"""The wheel that slides: two forms, and Newton and Euler with friction as a force at the contact (truth/reference).

Random states of any inertia, under loads, each law of rolling resistance, any slip; some wheels jam: N is
infinite. Errors relative to the largest entry of their group.
"""

from ctypes import byref
from math import pi

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.pointwise import Table, distance, random_motions, random_scenes, relative, sliding
from wheelfmu.truth.reference.frames import to_fixed
from wheelfmu.truth.reference.motion import angle_accelerations
from wheelfmu.truth.reference.sliding_contact import resting_directions

ROWS = 3000
FORMS = pytest.mark.parametrize("form", [eq.SLIDING, eq.MULTIBODY_SLIDING], ids=["reduced", "multibody"])
ROOM = 0.05  # states with less are not judged: N grows without bound
BOUND = 3e-10  # rounding grows with N


class Rows:
    """Scenes and motions; `found`: by the reference, with the sign of N decided."""

    def __init__(self, seed: int = 46) -> None:
        random = np.random.default_rng(seed)
        self.scenes = random_scenes(random, None, False, ROWS)
        self.scenes["contact"], self.scenes["mu_slide"] = 1, random.uniform(0, 1.2, ROWS)
        self.motions = random_motions(random, ROWS)
        for axis in ("slip_x", "slip_y"):
            self.motions[axis] = random.normal(size=ROWS) * 10 ** random.uniform(-6, 1, ROWS)
        self.chi = np.arctan2(self.motions["slip_y"], self.motions["slip_x"])
        self.found = [*map(sliding, self.scenes, self.motions)]
        pushes = [found.push(mu, chi) for (found, mu, *_), chi in zip(self.found, self.turned(), strict=True)]
        self.judged = np.array([push.room > ROOM for push in pushes])
        self.pushes = pushes

    def turned(self) -> list[float]:
        """Directions of slip from X."""
        return (self.chi + self.motions["psi"]).tolist()

    def referenced(self) -> Table:
        """WheelDynamics."""
        out = eq.table(eq.Dynamics, ROWS)
        for row, (found, _, R, w), push in zip(out, self.found, self.pushes, strict=True):
            x = found.at(*push.force)
            for name, value in zip(("X_O_ddot", "Y_O_ddot", "Z_O_ddot"), to_fixed(R, tuple(x[:3])), strict=True):
                row[name] = value
            turning = angle_accelerations(R[2], w, tuple(x[3:6]))
            for name, value in zip(("psi_ddot", "theta_ddot", "phi_ddot"), turning, strict=True):
                row[name] = value
            row["omega_z_dot"], row["tau"], row["lambda_"] = x[5], x[7], (*push.force, x[6])
        return out


@pytest.fixture(scope="module")
def rows() -> Rows:
    return Rows()


def states(form: eq.Formulation, rows: Rows) -> Table:
    return eq.start_each(form, rows.scenes, rows.motions)


@FORMS
def test_accelerations_and_reactions_of_a_sliding_wheel_are_newtons_and_eulers(form, rows: Rows) -> None:
    judge, seen = rows.referenced()[rows.judged], rows.judged
    assert seen.sum() > 0.6 * ROWS and (judge["lambda_"][:, 2] > 0).sum() > 0.3 * ROWS

    def error(scenes: Table) -> float:
        return distance(eq.dynamics_each(form, scenes, states(form, rows))[seen], judge, scenes[seen])

    within(error(rows.scenes), BOUND, "dynamics off the reference, relative")
    wrong = rows.scenes.copy()
    wrong["mu_slide"] *= 1 + 1e-6
    beyond(error(wrong), 1e-7, "dynamics with another coefficient, relative")


@FORMS
def test_the_slip_changes_as_newton_and_euler_have_it(form, rows: Rows) -> None:
    """|u|' and |u| (chi' + psi_dot), over their size."""
    y = states(form, rows)
    y_dot, _ = eq.derivative_each(form, rows.scenes, y)
    speed, psi_dot = y[:, eq.SLIP], rows.motions["psi_dot"]
    got = np.column_stack([y_dot[:, eq.SLIP], speed * (y_dot[:, eq.CHI] + psi_dot)])
    want = np.array([(push.grow, push.turn) for push in rows.pushes])
    within(relative(got[rows.judged], want[rows.judged]), 16384 * EPSILON, "rate of the slip, relative")
    slow = np.column_stack([got[:, 0], speed * y_dot[:, eq.CHI]])
    beyond(relative(slow[rows.judged], want[rows.judged]), 1e-2, "rate without the turning of the axes, relative")


@FORMS
def test_the_velocity_of_O_is_that_of_rolling_and_the_slip_on_top(form, rows: Rows) -> None:
    y = states(form, rows)
    fast, still = y.copy(), y.copy()
    still[:, eq.SLIP] = 0
    fast = eq.columns(eq.kinematics_each(form, rows.scenes, fast), "X_O_dot", "Y_O_dot", "Z_O_dot")
    still = eq.columns(eq.kinematics_each(form, rows.scenes, still), "X_O_dot", "Y_O_dot", "Z_O_dot")
    rolling = eq.kinematics_each(eq.REDUCED, rows.scenes, eq.start_each(eq.REDUCED, rows.scenes, rows.motions))
    within(relative(still, eq.columns(rolling, "X_O_dot", "Y_O_dot", "Z_O_dot")), 64 * EPSILON, "velocity without slip")
    slip = (rows.motions["slip_x"] + 1j * rows.motions["slip_y"]) * np.exp(1j * rows.motions["psi"])
    off = (fast - still)[:, 0] + 1j * (fast - still)[:, 1] - slip
    within(float((np.abs(off) / (1 + np.abs(fast).max(axis=1))).max()), 64 * EPSILON, "slip in the velocity, relative")


@FORMS
def test_a_wheel_jams_where_no_room_is_left_whatever_the_sign_of_N(form, rows: Rows) -> None:
    """N = N_free / room: without room it is positive where the ground would pull without friction."""
    scenes = rows.scenes.copy()
    scenes["mu_slide"] *= 8
    scenes["ground"] = 1  # presses
    _, N = eq.derivative_each(form, scenes, eq.start_each(form, scenes, rows.motions))
    reduced, hidden = eq.start_each(eq.REDUCED, scenes, rows.motions), 0
    for scene, y, chi, jams in zip(scenes, reduced, rows.chi, np.isinf(N), strict=True):
        record = eq.Scene.from_buffer_copy(scene.tobytes())
        slip = eq.LIBRARY.wheel_slip(byref(record), y.ctypes.data_as(eq.DOUBLES), float(chi))
        assert jams == (slip.room < 0) or abs(slip.room) < 1e-4, slip.room
        hidden += slip.room < 0 < slip.N
    assert hidden > 20 and np.isinf(N).sum() > 2 * hidden


def slips(rows: Rows, directions: Table) -> Table:
    """wheel_slip in each direction: N, room, growth, turn, settling."""
    reduced = eq.start_each(eq.REDUCED, rows.scenes, rows.motions)
    out = []
    for scene, y, chi in zip(rows.scenes, reduced, directions, strict=True):
        record = eq.Scene.from_buffer_copy(scene.tobytes())
        out.append(eq.values(eq.LIBRARY.wheel_slip(byref(record), y.ctypes.data_as(eq.DOUBLES), chi)))
    return np.array(out)


def test_growth_turning_and_settling_of_a_slip_follow_from_three_quantities(rows: Rows) -> None:
    want = []
    for (found, mu, *_), push, chi in zip(rows.found, rows.pushes, rows.turned(), strict=True):
        want.append((push.N, push.room, push.grow, push.turn, -found.turning(mu, chi)))
    got, judge, seen = slips(rows, rows.chi), np.array(want), rows.judged
    turned = slips(rows, rows.chi + 1e-6)
    parts = {"normal force": ([0], BOUND), "room": ([1], 1024 * EPSILON)}
    parts["growth, turning and settling"] = ([2, 3, 4], 4096 * EPSILON)
    for name, (columns, bound) in parts.items():
        within(relative(got[seen][:, columns], judge[seen][:, columns]), bound, f"{name}, relative")
        beyond(relative(turned[seen][:, columns], judge[seen][:, columns]), 1e-7, f"{name} in another direction")


def test_a_slip_begins_in_the_direction_that_grows_and_is_kept(rows: Rows) -> None:
    """Against the roots of a quartic, the nearest to the opposite of grip's force first; none where there is none."""
    reduced = eq.start_each(eq.REDUCED, rows.scenes, rows.motions)
    directions, none, count = [], 0, 0
    for scene, y, (found, mu, *_), psi in zip(rows.scenes, reduced, rows.found, rows.motions["psi"], strict=True):
        record = eq.Scene.from_buffer_copy(scene.tobytes())
        got = eq.LIBRARY.wheel_slip_direction(byref(record), y.ctypes.data_as(eq.DOUBLES))
        record.mu_slide *= 1 + 1e-9
        near = eq.LIBRARY.wheel_slip_direction(byref(record), y.ctypes.data_as(eq.DOUBLES))
        least = 1e-10 * float(np.hypot(*found.free))
        starts = []
        for chi in resting_directions(found, mu):
            push = found.push(mu, chi)
            if push.grow > -least and push.room > 0 and push.N > 0 and found.turning(mu, chi) < 0:
                starts.append(chi)
        f_X, f_Y = found.grip()
        starts.sort(key=lambda chi: -np.cos(chi - np.arctan2(-f_Y, -f_X)))
        if not starts:
            none += bool(np.isnan(got))
            count += 1
            continue
        directions.append((got + psi - starts[0], near + psi - starts[0]))
    assert none == count > 100 and ROWS - count > 500
    off, moved = np.abs(np.remainder(np.array(directions).T + pi, 2 * pi) - pi)
    within(np.max(off), 1024 * EPSILON, "direction, rad")
    beyond(np.nanmax(moved), 1e-10, "direction with another coefficient, rad")
