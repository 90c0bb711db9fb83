"""The same four lines as examples/c/accelerations.c, from Python."""

from wheelfmu.fmu.wheel_equations import (
    FRICTIONLESS,
    HELD,
    REDUCED,
    ROLLING,
    Motion,
    dynamics,
    paper_wheel,
    scene,
    start,
)

wheel = paper_wheel(s=0.03)
rolling = start(REDUCED, wheel, Motion(psi=1.570796, theta=1.308997, phi_dot=-2))
held = start(REDUCED, wheel, Motion(psi=1.570796, theta=1.308997))
for name, state, law, drive in (
    ("free", rolling, FRICTIONLESS, 0),
    ("rolling", rolling, ROLLING, 0),
    ("driven", rolling, ROLLING, -5),
    ("held", held, HELD, -5),
):
    now = dynamics(REDUCED, scene(wheel, law, sigma=-1, moment=(0, 0, drive)), state)
    print(
        f"{name:9s} theta_ddot = {now.theta_ddot:8.4f} rad/s2, omega_z_dot = {now.omega_z_dot:8.4f} rad/s2, "
        f"N = {now.lambda_[2]:8.4f} N, tau = {now.tau + 0.0:7.4f} N m"
    )
