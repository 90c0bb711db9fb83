"""Starts that no wheel can have, the FMU's message, and a start beside it that a wheel can have. SI.

A start gives every parameter that its message depends on: those that share none are also tried together.
"""

from math import inf, nan, pi

from wheelfmu.fmu.driver import Values

NUMBER, ABOVE = "a finite number is needed.", "it must be greater than 0."
TRIANGLE = "kg m2: none may exceed the sum of the other two."
STANDS = "it must lie between 0 and pi, where the wheel lies flat, and more than 1e-07 rad from both."
STEADY = "a guided wheel needs 0 for both; in co-simulation psi_dot_guide and theta_dot_guide turn it."
CARRIER = "these inputs need guided = true and co-simulation; otherwise they and their derivatives must be 0."
REFUSALS: list[tuple[Values, str, Values]] = [
    ({"m": nan}, f"m = nan: {NUMBER}", {"m": 1e-3}),
    ({"r_0": inf}, f"r_0 = inf: {NUMBER}", {"r_0": 0.01}),
    ({"r_0": -0.25}, "r_0 = -0.25: it must be greater than 0.", {"r_0": 0.25}),
    ({"r": -0.01}, "r = -0.01: it must be at least 0.", {"r": 0.0}),  # the thin disc
    (
        {"J_x": 0.8, "J_y": 1.1, "J_z": 2.5},
        f"J_x, J_y, J_z = 0.8, 1.1, 2.5 {TRIANGLE}",
        {"J_x": 0.8, "J_y": 1.1, "J_z": 1.9},
    ),
    ({"J_x": 3.0}, f"J_x, J_y, J_z = 3, 0.9, 1.8 {TRIANGLE}", {"J_x": 0.95}),
    ({"J_z": 1.8 * (1 + 1e-11)}, f"J_x, J_y, J_z = 0.9, 0.9, 1.8 {TRIANGLE}", {"J_z": 1.8 * (1 + 2e-16)}),
    ({"J_x": -1.0}, f"J_x = -1: {ABOVE}", {"J_x": 0.95}),
    ({"g": -9.81}, "g = -9.81: it must be at least 0.", {"g": 1e-300}),
    ({"s": -0.03}, "s = -0.03: it must be at least 0.", {"s": 0.0}),
    ({"slope": pi / 2}, "slope = 1.57079633 rad: it must be less than 1.5708.", {"slope": pi / 2 * (1 - 1e-12)}),
    ({"psi_start": -inf}, f"psi_start = -inf: {NUMBER}", {"psi_start": 7.0}),
    ({"theta_start": -0.1}, f"theta_start = -0.1 rad: {STANDS}", {"theta_start": 3.1}),
    ({"theta_start": 1e-9}, f"theta_start = 1e-09 rad: {STANDS}", {"theta_start": 1e-6}),
    ({"theta_start": 0.0}, f"theta_start = 0 rad: {STANDS}", {"theta_start": 2e-7}),
    ({"theta_start": pi}, f"theta_start = 3.14159265 rad: {STANDS}", {"theta_start": 3.14159}),
    ({"theta_start": 0.99e-7}, f"theta_start = 9.9e-08 rad: {STANDS}", {"theta_start": 1.01e-7}),
    ({"theta_start": 7.0}, f"theta_start = 7 rad: {STANDS}", {"theta_start": 0.7}),  # where its sine is above 0 again
    ({"phi_dot_start": nan}, f"phi_dot_start = nan: {NUMBER}", {"phi_dot_start": 0.0}),
    ({"formulation": 4}, "formulation = 4: it must be at most 3.", {"formulation": 3}),
    ({"friction_law": 0}, "friction_law = 0: it must be at least 1.", {"friction_law": 1}),
    ({"omega_s": 0.0}, f"omega_s = 0: {ABOVE}", {"omega_s": 1e-9}),
    ({"method": -1}, "method = -1: it must be at least 1.", {"method": 1}),
    ({"M_2": nan}, f"M_2 = nan: {NUMBER}", {"M_2": 1.0}),
    (
        {"guided": True, "psi_dot_start": 0.5, "theta_dot_start": -0.75},
        f"psi_dot_start, theta_dot_start = 0.5, -0.75 rad/s: {STEADY}",
        {"guided": False, "psi_dot_start": 0.5, "theta_dot_start": -0.75},
    ),
    *(
        (
            {"guided": True, f"{angle}_dot_start": 0.1},
            f"psi_dot_start, theta_dot_start = {both} rad/s: {STEADY}",
            {"guided": False, f"{angle}_dot_start": 0.1},
        )
        for angle, both in (("psi", "0.1, 0"), ("theta", "0, 0.1"))
    ),
    (
        {"mu_slide": 0.123456789123, "mu_max": 0.0},
        "mu_slide = 0.123456789: mu_max must be at least as large, and is 0.",
        {"mu_slide": 0.4, "mu_max": 0.4, "slip_y_start": 1e-3},
    ),
    (
        {"mu_slide": 0.4, "mu_max": 0.3},
        "mu_slide = 0.4: mu_max must be at least as large, and is 0.3.",
        {"mu_slide": 0.3, "mu_max": 0.3},
    ),
    ({"mu_max": -1.0}, "mu_max = -1: it must be at least 0.", {"mu_max": 0.6}),
    (
        {"mu_slide": 0.0, "slip_x_start": 0.5, "slip_y_start": -0.75},
        "slip_x_start, slip_y_start = 0.5, -0.75 m/s: an initial slip needs mu_slide.",
        {"slip_x_start": 0.0, "slip_y_start": 0.0},
    ),
    *(
        (
            {"mu_max": 0.4, "mu_slide": 0.0, f"slip_{axis}_start": 1.0},
            f"slip_x_start, slip_y_start = {both} m/s: an initial slip needs mu_slide.",
            {"mu_max": 0.4, "mu_slide": 0.4, f"slip_{axis}_start": 1.0},
        )
        for axis, both in (("x", "1, 0"), ("y", "0, 1"))
    ),
    (
        {"psi_start": 1.0001e12},
        "psi_start = 1.0001e+12 rad: beyond 1e+12 rad an angle has too few digits.",
        {"psi_start": 1e12},
    ),
    (
        {"phi_start": -1.0001e12},
        "phi_start = -1.0001e+12 rad: beyond -1e+12 rad an angle has too few digits.",
        {"phi_start": -1e12},
    ),
    (
        {"slope_direction": 1e13},
        "slope_direction = 1e+13 rad: beyond 1e+12 rad an angle has too few digits.",
        {"slope_direction": 1e12},
    ),
    (
        {"guided": False, "psi_dot_guide": 0.5, "theta_dot_guide": -0.75},
        f"psi_dot_guide, theta_dot_guide = 0.5, -0.75 rad/s: {CARRIER}",
        {"guided": True, "psi_dot_guide": 0.5, "theta_dot_guide": -0.75},
    ),
    *(
        (
            {"guided": False, f"{angle}_dot_guide": 0.1},
            f"psi_dot_guide, theta_dot_guide = {both} rad/s: {CARRIER}",
            {"guided": True, f"{angle}_dot_guide": 0.1},
        )
        for angle, both in (("psi", "0.1, 0"), ("theta", "0, 0.1"))
    ),
    (
        {"m": 1.7e308},
        "The initial energy or reaction force overflows: m = 1.7e+308 kg, J_z = 1.8 kg m2, r_0 = 0.3 m, g = 9.81 m/s2, "
        "omega_z = -2 rad/s.",
        {"m": 1e100, "J_x": 1e100, "J_y": 1e100, "J_z": 1.5e100},
    ),
]
