"""The dry brake M_brake on an upright wheel: hold, release and share of the moment, by closed forms; it stops a wheel:
test_straight.py.

Upright (theta = 90 deg), heading along X (psi = 0): omega_z = phi_dot, R = r_0 + r; the inertia that a moment about the
axle turns is J = J_z + m R^2. SI units.
"""

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.truth.closed_forms import rolling_inertia
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import UPRIGHT

R, J = PAPER.r_0 + PAPER.r, rolling_inertia(PAPER)
S, CAPACITY, RATE = 0.02, 100.0, 500.0  # m, N m, N/s
ROLLING = S * PAPER.m * PAPER.g  # N m, capacity of the rolling resistance
RELEASE = (CAPACITY + ROLLING) / (R * RATE)  # s
SHARE = CAPACITY / (CAPACITY + ROLLING)
FADING, PUSHED = {"M_brake": (CAPACITY, -10.0)}, {"M_brake": (CAPACITY,), "F_X": (0.0, RATE)}
# Start, inputs, times; the whole moment and that of the brake there, and omega_z.
SCENES = {
    f"rolls {way}": (
        *({"phi_dot_start": 50.0 * sign, "s": S}, FADING, np.array([0.0, 0.1, 0.2])),
        lambda t, sign=sign: -sign * (CAPACITY - 10 * t + ROLLING),
        lambda t, sign=sign: -sign * (CAPACITY - 10 * t),
        lambda t, sign=sign: sign * (50.0 - ((CAPACITY + ROLLING) * t - 5 * t**2) / J),
    )
    for way, sign in (("forward", -1), ("backward", 1))
}
SCENES["held"] = (
    *({"s": S}, PUSHED, np.array([0.0, 0.25, RELEASE - 1e-6])),
    *(lambda t: R * RATE * t, lambda t: SHARE * R * RATE * t, lambda t: 0 * t),
)
SCENES["lets go"] = (
    *({"s": S}, PUSHED, RELEASE + np.array([1e-6, 0.1])),
    *(
        lambda t: 0 * t + CAPACITY + ROLLING,
        lambda t: 0 * t + CAPACITY,
        lambda t: -RATE * R * (t - RELEASE) ** 2 / 2 / J,
    ),
)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_brake_and_rolling_resistance_share_the_moment_by_their_capacities(library: Library, scene) -> None:
    start, inputs, times, *truth = scene

    def errors(brake: float) -> list[float]:
        scaled = {name: tuple(brake * c if name == "M_brake" else c for c in shape) for name, shape in inputs.items()}
        run = library.simulate([0.0, *times], 1e-10, Schedule(((0.0, scaled),)), **UPRIGHT | start)
        found = (run[name][1:] for name in ("tau", "tau_brake", "omega_z"))
        return [float(np.abs(one - expected(times)).max()) for one, expected in zip(found, truth, strict=True)]

    within(max(errors(1.0)), 256 * CAPACITY * EPSILON, "moments, N m, and spin, rad/s")
    beyond(max(errors(1.01)), 0.02, "those with a brake 1 % stronger")


def test_it_lets_go_at_the_closed_forms_instant_and_leaves_nothing_behind_when_it_is_let_off(library: Library) -> None:
    (instant, mode) = library.simulate([0.0, 1.0], 1e-10, Schedule(((0.0, PUSHED),)), **UPRIGHT, s=S).events[-1]
    assert mode == -1
    within(abs(instant - RELEASE), 1e-9, "instant at which it lets go, s")  # logged to the nanosecond
    off = Schedule(((0.0, {"M_brake": (20.0,)}), (0.1, {"M_brake": (0.0,)})))
    run = library.simulate([0.0, 0.1, 0.5, 1.0], 1e-10, off, **{**UPRIGHT, "phi_dot_start": -5.0})
    within(abs(run["omega_z"][1] - (-5.0 + 20.0 * 0.1 / J)), 64 * 5 * EPSILON, "omega_z, rad/s")
    assert (run["omega_z"][2:] == run["omega_z"][1]).all() and (run["tau"][2:] == 0).all()


def test_a_brake_that_was_let_off_is_out_of_use_where_the_spin_changes_its_sign(library: Library) -> None:
    """The partner: it hardly presses."""
    found = []
    for left in (0.0, 1e-9):
        with library.wheel(logging=True).start(**{**UPRIGHT, "phi_dot_start": -1.0}, M_brake=1.0) as w:
            w.by(0.1).put(M_brake=left, M_3=20.0).take_messages()
            (before,) = w.get("n_events")
            beyond(w.by(1.0).get("omega_z")[0], 1, "omega_z, rad/s")
            found.append((w.get("n_events")[0] - before, bool(w.texts())))
    assert found == [(0, False), (1, True)]
