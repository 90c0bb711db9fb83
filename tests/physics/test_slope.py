"""A road that slopes, or begins to: a wheel at rest, and any other that goes on from its state on the next road.

The axes are the road's, Z across it; the weight is m g (-sin a cos b, -sin a sin b, -cos a) for a slope a that rises
towards b. Upright wheels head along X (psi = 0), R = r_0 + r. Straight down: test_straight.py. SI units.
"""

from math import asin, atan, cos, pi, sin

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.truth.cases import random_scene
from wheelfmu.truth.exact_motions import UPRIGHT
from wheelfmu.truth.motion import Library

R, WEIGHT = 0.35, 20 * 9.81
REST = {**UPRIGHT, "phi_dot_start": 0.0}


@pytest.mark.parametrize(
    ("hold", "steepest"),
    [({"s": 0.03}, atan(0.03 / R)), ({"M_brake": 20.0}, asin(20.0 / (R * WEIGHT)))],
    ids=["rolling resistance", "brake"],
)
def test_a_parked_wheel_stays_while_the_road_tilts_and_rolls_where_it_tilts_too_far(
    library: Library, hold: dict[str, float], steepest: float
) -> None:
    """On a slope from the start on, and step by step, up to the capacity; then beyond it, downhill whichever side that
    is."""
    stays = library.simulate([0.0, 5.0], slope=steepest * (1 - 1e-9), **hold, **REST)
    assert (stays["omega_z"] == 0).all()
    for direction, sense in ((0.0, 1), (pi, -1)):
        with library.wheel() as wheel:
            wheel.start(**hold, **REST)
            for k, share in enumerate((0.3, 0.9, 1 - 1e-9, 0.0, 1 - 1e-9)):
                wheel.put(slope=share * steepest, slope_direction=direction).to(k + 1.0)
            assert wheel.get("omega_z", "friction_mode") == [0.0, 0]
            X_O, Y_O, psi = wheel.get("X_O", "Y_O", "psi")
            within(abs(X_O), abs(psi * Y_O) + 64 * EPSILON**2, "creep, m")  # it tips by the rounding of 90 deg
            wheel.put(slope=steepest * (1 + 1e-6)).to(7.0)
            assert wheel.get("friction_mode") == [sense] and -sense * wheel.get("X_O")[0] > 0


@pytest.mark.parametrize("seed", range(8))
def test_a_road_that_changes_is_the_next_road_from_the_state_reached(library: Library, seed: int) -> None:
    """Beside a wheel that starts there; the energy jumps by the weight's turn about the origin."""
    values = {**random_scene(np.random.default_rng(seed)).start, "slope": 0.3, "X_O_start": 3.0, "Y_O_start": -2.0}
    names = ("X_O", "Y_O", "theta", "psi", "phi", "omega_z")
    with library.wheel() as wheel, library.wheel() as fresh:
        wheel.start(tolerance=1e-11, **values).to(0.4)
        reached = ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")
        there = dict(zip((f"{name}_start" for name in reached), wheel.get(*reached), strict=True))
        E, place = wheel.get("E")[0], np.array(wheel.get("X_O", "Y_O", "Z_O"))
        change = gravity(0.6, -2.0) - gravity(values["slope"], values["slope_direction"])
        jump = wheel.put(slope=0.6, slope_direction=-2.0).get("E")[0] - E
        within(abs((jump + 20.0 * change @ place) / E), 32 * EPSILON, "jump of the energy less the weight's, relative")
        beyond(abs(jump / E), 1e-4, "jump of the energy, relative")
        wheel.to(0.8)
        fresh.start(tolerance=1e-11, **values | there | {"slope": 0.6, "slope_direction": -2.0}).to(0.4)
        within(absolute_error(wheel.get(*names), fresh.get(*names)), 1e-10, "state, m, rad, rad/s")
        fresh.put(slope=0.6 + 1e-5).to(0.5)
        beyond(absolute_error(wheel.to(0.9).get(*names), fresh.get(*names)), 1e-8, "state on a steeper road")


def gravity(slope: float, direction: float) -> np.ndarray:
    """Its acceleration on a road that slopes, m/s2."""
    return -9.81 * np.array([sin(slope) * cos(direction), sin(slope) * sin(direction), cos(slope)])
