"""The control engineer's example: each of its three parts against what it must come to."""

from importlib.util import module_from_spec, spec_from_file_location

import numpy as np
from support.bounds import beyond, within

from wheelfmu.fmu.paths import ROOT

PROGRAM = spec_from_file_location("control", ROOT / "lab" / "vehicles" / "control.py")
control = module_from_spec(PROGRAM)
PROGRAM.loader.exec_module(control)


def test_the_eigenvalues_vanish_at_the_critical_spin_of_the_closed_form(fmu):
    for check, aside in ((beyond, -1e-6), (within, 1e-6)):
        A, _ = control.linearized(fmu, -(control.CRITICAL + aside))
        check(np.linalg.eigvals(A).real.max(), 5e-4, "largest real part, 1/s")


def test_the_regulator_holds_a_wheel_that_falls_alone(fmu):
    gains = control.regulator(fmu, -1.5)
    beyond(np.abs(control.leaning(fmu, 0 * gains, -1.5)["lean"]).max(), 45, "lean alone, deg")
    held = control.leaning(fmu, gains, -1.5)
    within(abs(held["lean"][-1]), 0.1, "lean at the end, deg")
    within(abs(held["off"][-1]), 0.01, "off the line at the end, m")


def test_the_optimal_moments_stay_in_their_bounds_and_lead_to_the_line(fmu):
    t, x, moments = control.optimal(fmu)
    within((np.abs(moments).max(axis=1) / control.BOUNDS).max(), 1 + 1e-6, "moment over its bound")
    off = np.abs(control.followed(fmu, t, x, moments))
    within(off.max(), 0.05, "off the end, m, rad")  # the midpoint rule with steps of 50 ms
    beyond(np.abs(control.followed(fmu, t, x, 0 * moments)).max(), 1, "off the end without moments, m, rad")
