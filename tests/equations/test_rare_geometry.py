"""Rare states of a slip, found by a search: two neighbouring directions in which it rests, of which it keeps one and
leaves the other; and states where little room is left. Judged by the reference (truth/reference/sliding_contact.py).

A search changes a random wheel, its loads, motion and coefficient at random and keeps what leads closer.
"""

from collections.abc import Callable, Iterator
from ctypes import byref
from functools import cache
from math import atan2, hypot, inf, pi

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.pointwise import Table, random_motions, random_scenes, sliding
from wheelfmu.truth.reference.sliding_contact import Sliding, resting_directions

Random = np.random.Generator
INERTIA = ("J_x", "J_y", "J_z")


def first(random: Random) -> tuple[Table, Table]:
    scene, motion = random_scenes(random, None, False, 1), random_motions(random, 1)
    scene["contact"], scene["mu_slide"] = 1, random.uniform(0.5, 1.5)
    return scene, motion


def changed(random: Random, scene: Table, motion: Table, size: float) -> tuple[Table, Table]:
    scene, motion = scene.copy(), motion.copy()
    wheel, load = scene["wheel"], scene["load"]
    for name in ("m", "r_0", "r", "s"):
        wheel[name] *= np.exp(size * random.normal())
    J_x, J_y, J_z = (float(wheel[name][0]) for name in INERTIA)
    moments = np.maximum([J_y + J_z - J_x, J_x + J_z - J_y, J_x + J_y - J_z], 1e-9 * J_x) / 2
    a, b, c = moments * np.exp(size * random.normal(size=3))
    wheel["J_x"], wheel["J_y"], wheel["J_z"] = b + c, a + c, a + b
    weight = float(wheel["m"][0]) * 9.81
    load["F"] += size * weight * random.normal(size=3)
    load["M"] += size * weight * float(wheel["r_0"][0]) * random.normal(size=3)
    scene["mu_slide"] = np.minimum(scene["mu_slide"] * np.exp(size * random.normal()), 3.0)
    motion["theta"] = np.clip(motion["theta"] + size * random.normal(), 0.05, pi - 0.05)
    motion["phi"] += size * random.normal()
    for rate in ("psi_dot", "theta_dot", "phi_dot"):
        motion[rate] += 2 * size * random.normal()
    return scene, motion


class State:
    """What the reference knows of a slip that begins: its resting directions from e1, those that it keeps first."""

    def __init__(self, scene: Table, motion: Table) -> None:
        self.scene, self.motion, psi = scene, motion, float(motion["psi"][0])
        self.found, self.mu, *_ = sliding(scene[0], motion[0])
        roots = resting_directions(self.found, self.mu)
        self.kept = [chi - psi for chi in roots if self.is_kept(self.found, self.mu, chi)]
        self.left = [chi - psi for chi in roots if not self.is_kept(self.found, self.mu, chi)]

    @staticmethod
    def is_kept(found: Sliding, mu: float, chi: float) -> bool:
        """The slip grows, and turns back if it turns a little; the ground presses."""
        push, least = found.push(mu, chi), 1e-10 * hypot(*found.free)
        return push.grow > -least and push.room > 1e-5 and push.N > 0 and found.turning(mu, chi) < 0

    @property
    def gap(self) -> float:
        """From a direction that is kept to the next one that is not; infinite where there is none of a kind."""
        return min((abs(turned(a - b)) for a in self.kept for b in self.left), default=inf)

    @property
    def least_room(self) -> float:
        """Over all directions: 1 - mu |lift|."""
        return 1 - self.mu * hypot(self.found.by_X[6], self.found.by_Y[6])

    def direction(self) -> float:
        y = eq.start_each(eq.REDUCED, self.scene, self.motion)[0]
        record = eq.Scene.from_buffer_copy(self.scene[0].tobytes())
        return eq.LIBRARY.wheel_slip_direction(byref(record), y.ctypes.data_as(eq.DOUBLES))


def turned(angle: float) -> float:
    """From -pi to pi."""
    return float(np.remainder(angle + pi, 2 * pi) - pi)


def search(seed: int, aim: Callable[[State], float], enough: float) -> Iterator[State]:
    """The states on the way of ever smaller `aim`, until it is small enough."""
    random, size = np.random.default_rng(seed), 0.3
    best = State(*first(random))
    for _ in range(400):
        if aim(best) < enough:
            break
        tried = State(*changed(random, best.scene, best.motion, size))
        if aim(tried) < aim(best):
            best = tried
            yield best
        else:
            size = max(0.97 * size, 1e-3)


def neighbours() -> list[State]:
    """Two resting directions within two degrees of each other, of which one is kept."""
    ways = (state for seed in range(14) for state in search(seed, lambda state: state.gap, 2e-3))
    return [state for state in ways if 1e-3 < state.gap < 0.035]


def test_the_direction_that_a_slip_keeps_is_found_next_to_one_that_it_leaves() -> None:
    """One search in three comes so far."""
    states = neighbours()
    beyond(len(states), 12, "states found")
    beyond(sum(len(state.kept) == 1 for state in states), 10, "states with one direction that is kept")
    for state in states:
        found = state.direction()
        off = min(abs(turned(found - chi)) for chi in state.kept)
        within(off, 1e-8 / state.gap, f"direction off, rad, where the other is {state.gap:.4f} away")
        beyond(min(abs(turned(found - chi)) for chi in state.left), 5e-4, "direction off the other, rad")


def test_a_slip_that_turns_more_than_a_right_angle_off_the_force_of_rolling_is_found_to_either_side() -> None:
    """Rolling resistance of many radii alone leads so far; without it every direction that is kept lies closer."""
    sides = {s: [0, 0] for s in (0.0, 20.0)}
    for s, found in sides.items():
        for seed in range(60, 660):
            scene, motion = first(np.random.default_rng(seed))
            scene["wheel"]["s"] = s * scene["wheel"]["r_0"]
            state = State(scene, motion)
            f_X, f_Y = state.found.grip()
            against = atan2(-f_Y, -f_X) - float(motion["psi"][0])
            if not state.kept or min(abs(turned(chi - against)) for chi in state.kept) < 1.6:
                continue
            slip = state.direction()
            within(min(abs(turned(slip - chi)) for chi in state.kept), 1e-9, "direction off, rad")
            found[int(turned(state.kept[0] - against) > 0)] += 1
    assert sides[0.0] == [0, 0]
    beyond(min(sides[20.0]), 4, "states found to a side")


# ---- little room ----


@cache
def cramped() -> list[State]:
    """Least room between 0.0003 and 0.1, in the direction of the slip: it is turned there."""
    ways = (state for seed in range(40, 48) for state in search(seed, lambda s: abs(s.least_room - 1e-3), 5e-4))
    return [state for state in ways if 3e-4 < state.least_room < 0.1 and state.mu > 0]


def towards(state: State) -> float:
    """The direction of least room, from X."""
    return atan2(-state.found.by_Y[6], -state.found.by_X[6])


def slipping(state: State, speed: float = 1.0) -> Table:
    motion, chi = state.motion.copy(), towards(state) - float(state.motion["psi"][0])
    motion["slip_x"], motion["slip_y"] = speed * np.cos(chi), speed * np.sin(chi)
    return motion


@pytest.mark.parametrize("form", [eq.SLIDING, eq.MULTIBODY_SLIDING], ids=["reduced", "multibody"])
def test_the_wheel_jams_from_the_coefficient_on_that_leaves_a_hundred_thousandth_of_the_room(form) -> None:
    """Room is linear in the coefficient."""
    for state in cramped():
        limit = (1 - 1e-5) / (1 - state.least_room) * state.mu
        y = eq.start_each(form, state.scene, slipping(state))
        jams = []
        for share in (1 - 3e-7, 1 + 3e-7):
            scene = state.scene.copy()
            scene["mu_slide"] = limit * share
            jams.append(bool(np.isinf(eq.derivative_each(form, scene, y)[1][0])))
        assert jams == [False, True]
