"""Rates of the ground's force and of tau that the FMU gives, against a complex step through the numpy transcription of
(24).

The complex step is exact to rounding and shares no code with the product: state, load and law move along their rates
by 1e-40 i. Fixed axes, N/s and N m/s; errors relative to the row's largest rate.
"""

from collections.abc import Callable

import numpy as np
import pytest
from support.bounds import beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.fmu.driver import OK, FMU2Wheel
from wheelfmu.truth.paper_transcription import Paper, set_rolling, solved
from wheelfmu.truth.pointwise import Table, random_motions, random_scenes, relative

BOUND = 1e-9
STEP = 1e-40
ROWS = 300
FORCES = ("lambda_1", "lambda_2", "lambda_3", "tau")
Make = Callable[[], FMU2Wheel]


class Rows:
    """Random states under loads and brakes that change; some are upright, straight or at rest, where entries are zero
    for an instant, or under regularized laws of any width near zero spin. The law is one that the FMU chooses there."""

    def __init__(self, law: int, symmetric: bool = False, width: tuple[float, float] = (-3, 1)) -> None:
        random = np.random.default_rng(8)
        self.scenes = random_scenes(random, law, symmetric, ROWS)
        self.scenes["friction"]["omega_s"] = omega_s = 10 ** random.uniform(*width, ROWS)
        self.scenes["wheel"][["g_X", "g_Y"]] = 0
        self.motions = random_motions(random, ROWS)
        if law == eq.REGULARIZED:  # within a few widths of zero spin
            held = -self.motions["psi_dot"] * np.cos(self.motions["theta"])
            near = held + omega_s * random.normal(0, 3, ROWS)
            self.motions["phi_dot"] = np.where(random.random(ROWS) < 0.5, near, self.motions["phi_dot"])
        else:
            for name, value in {"theta": np.pi / 2, "psi_dot": 0, "theta_dot": 0, "phi_dot": 0}.items():
                self.motions[name] = np.where(random.random(ROWS) < 0.4, value, self.motions[name])
        spin = self.motions["phi_dot"] + self.motions["psi_dot"] * np.cos(self.motions["theta"])
        load = self.scenes["load"]
        if law == eq.FRICTIONLESS:
            self.scenes["wheel"]["s"] = load["brake"] = 0
        if law == eq.ROLLING:
            self.motions["phi_dot"] += np.where(np.abs(spin) < 0.1, 1, 0)
            spin = self.motions["phi_dot"] + self.motions["psi_dot"] * np.cos(self.motions["theta"])
            self.scenes["friction"]["sigma"] = np.sign(spin)
        if law == eq.HELD:
            self.motions["psi_dot"] = np.where(self.motions["theta"] == np.pi / 2, self.motions["psi_dot"], 0)
            self.motions["phi_dot"] = 0
            load["brake"] = 1e6 * self.scenes["wheel"]["m"] * self.scenes["wheel"]["r_0"]
        self.load_dot = load.copy()
        for part in ("F", "M", "brake"):
            self.load_dot[part] *= random.normal(size=self.load_dot[part].shape)
        self.load_dot["F"] += self.scenes["wheel"]["m"][:, None]

    def wheels(self, make: Make, **changed: float):
        """One instance, in the state of each row in turn."""
        w = make()
        for scene, motion, load_dot in zip(self.scenes, self.motions, self.load_dot, strict=True):
            names = ("m", "r_0", "r", "J_x", "J_y", "J_z", "s")
            values = {name: float(scene["wheel"][name]) for name in names} | {"g": float(scene["wheel"]["g_n"])}
            values |= {f"{name}_start": float(motion[name]) for name in motion.dtype.names if "slip" not in name}
            if scene["friction"]["kind"] == eq.REGULARIZED:
                changed |= {"friction_law": 2, "omega_s": float(scene["friction"]["omega_s"])}
            assert w.ask("Reset") == OK
            w.initializing(keep_contact=True, **values, **changed)
            now, rate = ([*row["F"], *row["M"], row["brake"]] for row in (scene["load"], load_dot))
            names = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake")
            w.give({name: (float(c), float(c_1)) for name, c, c_1 in zip(names, now, rate, strict=True)})
            assert w.exitInitializationMode() == OK
            yield w

    def rates(self, make: Make, **changed: float) -> Table:
        return np.array([w.rates(FORCES)() for w in self.wheels(make, **changed)])

    def judged(self) -> Table:
        """lambda_dot and tau_dot by the complex step, along q_dot and the accelerations of the transcription."""
        load, change = self.scenes["load"], self.load_dot
        q, spin = (
            set_rolling(self.scenes["wheel"], self.motions),
            eq.start_each(eq.REDUCED, self.scenes, self.motions)[:, 3],
        )
        # A narrow law magnifies its last bit.
        q[:, 11] = spin - self.motions["psi_dot"] * np.cos(self.motions["theta"])
        accelerations = solved(Paper(self.scenes["wheel"], q), self.scenes)[:, :6]
        moved = q + 1j * STEP * np.hstack([q[:, 6:], accelerations])
        loads = {part: load[part] + 1j * STEP * change[part] for part in ("F", "M", "brake")}
        return solved(Paper(self.scenes["wheel"], moved), self.scenes, loads)[:, 6:].imag / STEP

    def error(self, rates: Table, judge: Table) -> float:
        """lambda_dot and tau_dot / r_0 side by side."""
        arm = np.column_stack([np.ones((ROWS, 3)), self.scenes["wheel"]["r_0"]])
        return relative(rates / arm, judge / arm)


def test_rates_are_those_of_lambda_and_tau_along_the_motion(wheel: Make, law: int, symmetric: bool) -> None:
    rows = Rows(law, symmetric)
    judge, found = rows.judged(), rows.rates(wheel)
    within(rows.error(found, judge), BOUND, "rates off the complex step, relative")
    rows.load_dot["F"] *= 1 + 1e-5
    beyond(rows.error(rows.rates(wheel), judge), 2e-6, "rates under another rate of the load, relative")
    rows.load_dot["F"] /= 1 + 1e-5
    rows.scenes["wheel"]["J_x"] *= 1 + 1e-6
    beyond(rows.error(rows.rates(wheel), judge), 1e-7, "rates with another J_x, relative")


@pytest.mark.parametrize("width", [(-4, -3), (-7, -6), (-10, -9)], ids=["1e-3", "1e-6", "1e-9"])
def test_rates_under_a_stiff_regularized_law_are_as_exact(wheel: Make, width: tuple[float, float]) -> None:
    rows = Rows(eq.REGULARIZED, width=width)
    judge, found = rows.judged(), rows.rates(wheel)
    within(rows.error(found, judge), 3e-10, "rates off the complex step, relative")
    rows.scenes["friction"]["omega_s"] *= 1 + 1e-6
    beyond(rows.error(rows.rates(wheel), judge), 1e-7, "rates with another width, relative")
