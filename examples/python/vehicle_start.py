"""Start values of a vehicle's wheel: upright, rolling at a speed along a heading, from a place. SI units.

python vehicle_start.py rolls one wheel for two seconds.
"""

from math import pi

from fmpy import simulate_fmu


def vehicle_start(v=0.0, heading=0.0, x=0.0, y=0.0, R=0.35):
    """v: speed, m/s. heading: from X to the left, rad. x, y: centre O, m. R: r_0 + r of the wheel, m."""
    pose = {"theta_start": pi / 2, "psi_start": heading, "X_O_start": x, "Y_O_start": y}
    return pose | {"phi_dot_start": -v / R}


if __name__ == "__main__":
    start = vehicle_start(v=5.0, heading=pi / 6, x=1.0) | {"guided": True}
    run = simulate_fmu("wheel.fmu", start_values=start, stop_time=2.0, output=["X_O", "Y_O"])
    print(f"After 2 s at 5 m/s and 30 degrees to the left: X_O = {run['X_O'][-1]:.3f} m, Y_O = {run['Y_O'][-1]:.3f} m.")
