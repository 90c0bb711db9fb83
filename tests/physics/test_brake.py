"""The dry brake M_brake on an upright wheel: hold and release against closed forms; it stops one: test_straight.py.

Upright (theta = 90 deg), heading along X (psi = 0): omega_z = phi_dot, v = -R omega_z, R = r_0 + r; the inertia that a
moment about the axle turns is J = J_z + m R^2. SI units.
"""

import numpy as np
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.schedule import Schedule

R, M, G = 0.35, 20.0, 9.81
J = 1.8 + M * R**2
UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0, "X_O_start": 0.0, "phi_dot_start": -5.0}
BRAKE = 20.0  # N m


def braked(library: Library, times: list[float], inputs: dict[str, tuple[float, ...]], **start: float) -> Run:
    return library.simulate(times, 1e-10, Schedule(((0.0, inputs),)), **(UPRIGHT | start))


def test_it_lets_go_where_a_growing_force_exceeds_it(library: Library) -> None:
    rate = 200.0  # N/s
    run = braked(library, [0.0, 0.25, 0.5], {"M_brake": (BRAKE,), "F_X": (0.0, rate)}, phi_dot_start=0.0)
    release = BRAKE / (R * rate)
    (t, mode) = run.events[-1]
    assert mode == -1
    within(abs(t - release), 1e-9, "instant at which it lets go, s")  # logged to the nanosecond
    late = 0.5 - release
    within(abs(run["omega_z"][-1] + rate * R * late**2 / (2 * J)), 128 * EPSILON, "omega_z, rad/s")
    beyond(abs(run["omega_z"][-1] + rate * R * 0.5**2 / (2 * J)), 0.1, "omega_z without the hold, rad/s")


def test_a_brake_that_is_let_off_leaves_nothing_behind(library: Library) -> None:
    off = Schedule(((0.0, {"M_brake": (BRAKE,)}), (0.1, {"M_brake": (0.0,)})))
    run = library.simulate([0.0, 0.1, 0.5, 1.0], 1e-10, off, **UPRIGHT)
    within(abs(run["omega_z"][1] - (-5.0 + BRAKE * 0.1 / J)), 64 * 5 * EPSILON, "omega_z, rad/s")
    assert (run["omega_z"][2:] == run["omega_z"][1]).all()
    assert (run["tau"][2:] == 0).all()


S, CAPACITY = 0.02, 100.0  # m, N m
ROLLING = S * M * G  # N m, capacity of the rolling resistance
SHARE = CAPACITY / (CAPACITY + ROLLING)


def test_of_a_rolling_wheel_the_brake_gives_its_capacity_and_the_ground_the_rest(library: Library) -> None:
    for spin in (-50.0, 50.0):
        run = braked(library, [0.0, 0.1, 0.2], {"M_brake": (CAPACITY, -10.0)}, phi_dot_start=spin, s=S)
        brake = -np.sign(spin) * (CAPACITY - 10.0 * run["t"])
        within(np.abs(run["tau_brake"] - brake).max(), 64 * CAPACITY * EPSILON, "moment of the brake, N m")
        ground = run["tau"] - run["tau_brake"]
        within(np.abs(ground + np.sign(spin) * ROLLING).max(), 16 * CAPACITY * EPSILON, "moment of the ground, N m")
        beyond(np.abs(run["tau"] - brake).min(), 3, "moment of both, N m")


def test_brake_and_rolling_resistance_hold_a_wheel_in_proportion_to_their_capacities(library: Library) -> None:
    load = {"M_brake": (CAPACITY,), "F_X": (10.0, 500.0)}
    held = braked(library, [0.0, 0.25, 0.5], load, phi_dot_start=0.0, s=S)
    tau = R * (10.0 + 500.0 * held["t"])
    within(np.abs(held["tau"] - tau).max(), 256 * tau[-1] * EPSILON, "moment of both, N m")
    within(np.abs(held["tau_brake"] - SHARE * tau).max(), 256 * tau[-1] * EPSILON, "moment of the brake, N m")
    beyond(np.abs(held["tau_brake"] - tau).min(), 0.1, "moment of both as the brake's, N m")
    alone = braked(library, [0.0, 0.25, 0.5], load, phi_dot_start=0.0)
    assert (alone["tau_brake"] == alone["tau"]).all() and (alone["tau"] > 0).all()


def test_the_brakes_moment_does_not_jump_where_it_lets_go(library: Library) -> None:
    rate = 500.0
    release = (CAPACITY + ROLLING) / (R * rate)
    times = [0.0, release - 1e-6, release + 1e-6, release + 0.1]
    run = braked(library, times, {"M_brake": (CAPACITY,), "F_X": (0.0, rate)}, phi_dot_start=0.0, s=S)
    assert run["omega_z"][1] == 0 > run["omega_z"][2]
    within(abs(run["tau_brake"][2] - run["tau_brake"][1]), 2e-6 * R * rate, "jump of the brake's moment, N m")
    within(np.abs(run["tau_brake"][2:] - CAPACITY).max(), 64 * CAPACITY * EPSILON, "moment of the brake, N m")
    beyond(run["tau"][2] - run["tau_brake"][1], 3, "jump to the moment of both, N m")
