"""The free wheel through the FMU: read from half a nutation, it is the motion that stepping gives, at any horizon.

s = 0, no input, J_x = J_y, method automatic. A forced method (2: adams) steps through. Fixed axes.
"""

import numpy as np
from support.bounds import beyond, range_error, range_errors, within
from support.driver import HEADLINE
from support.motion import Library

ADAMS = 2


def test_unfolding_is_the_motion_that_stepping_gives(library: Library) -> None:
    t = np.linspace(0, 30, 301)
    want = library.simulate(t, 1e-13, method=ADAMS)
    within(range_errors(library.simulate(t, 1e-12), want, HEADLINE), 1e-9, "range error")
    beyond(range_error(library.simulate(t, 1e-5), want, HEADLINE), 1e-9, "range error")


def test_the_energy_neither_grows_nor_wears_off(library: Library) -> None:
    late = library.simulate([0.0, 1e3, 1e6])["E"]
    within(np.abs(late / late[0] - 1).max(), 4e-11, "change of the energy in 1e6 s")


def test_heading_place_and_roll_angle_of_the_start_leave_tilt_and_rates_bit_identical(library: Library) -> None:
    """They are added to a motion that is integrated from zero; a motion that is stepped through has their rounding."""
    t = np.linspace(0, 100, 201)
    far = {"psi_start": 1e9, "phi_start": -1e9, "X_O_start": 1e3, "Y_O_start": -1e4}

    def changed(**method: float) -> list[str]:
        here, there = library.simulate(t, **method), library.simulate(t, **method, **far)
        names = ("theta", "theta_dot", "psi_dot", "phi_dot", "omega_z", "lambda_3")
        return [name for name in names if not np.array_equal(here[name], there[name])]

    assert changed() == []
    assert changed(method=ADAMS) != []
