"""Rates of lambda and tau along the motion, against a complex step through the numpy transcription of (24).

The complex step is exact to rounding and shares no code with the product: state, load and law move along their rates
by 1e-40 i. Fixed axes, N/s and N m/s; errors relative to the row's largest rate.
"""

import numpy as np
import pytest
from equations.paper_transcription import Paper, papers_state, solved
from equations.pointwise import Table, random_motions, random_scenes, relative
from support import equations as eq
from support.bounds import EPSILON, beyond, within

BOUND = 1e-9
PRESSES, PULLS = 1, 2  # WheelGround
STEP = 1e-40
ROWS = 5000


class Rows:
    """Random states under loads and brakes that change; some are upright, straight or at rest, where entries are zero
    for an instant, or under regularized laws of any width near zero spin."""

    def __init__(self, law: int, symmetric: bool = False, width: tuple[float, float] = (-3, 1)) -> None:
        random = np.random.default_rng(8)
        self.scenes = random_scenes(random, law, symmetric, ROWS)
        self.scenes["friction"]["omega_s"] = omega_s = 10 ** random.uniform(*width, ROWS)
        self.motions = random_motions(random, ROWS)
        if law == eq.REGULARIZED:  # within a few widths of zero spin
            held = -self.motions["psi_dot"] * np.cos(self.motions["theta"])
            near = held + omega_s * random.normal(0, 3, ROWS)
            self.motions["phi_dot"] = np.where(random.random(ROWS) < 0.5, near, self.motions["phi_dot"])
        else:
            for name, value in {"theta": np.pi / 2, "psi_dot": 0, "theta_dot": 0, "phi_dot": 0}.items():
                self.motions[name] = np.where(random.random(ROWS) < 0.4, value, self.motions[name])
        self.load_dot = self.scenes["load"].copy()
        for part in ("F", "M", "brake"):
            self.load_dot[part] *= random.normal(size=self.load_dot[part].shape)
        self.load_dot["F"] += self.scenes["wheel"]["m"][:, None]

    def states(self, formulation: eq.Formulation) -> Table:
        return eq.start_each(formulation, self.scenes, self.motions)

    def rates(self, formulation: eq.Formulation) -> Table:
        return eq.rates_each(formulation, self.scenes, self.load_dot, self.states(formulation))

    def judged(self) -> Table:
        """lambda_dot and tau_dot by the complex step, along q_dot and the accelerations of the transcription."""
        load, change = self.scenes["load"], self.load_dot
        q = papers_state(self.states(eq.MULTIBODY))
        accelerations = solved(Paper(self.scenes["wheel"], q), self.scenes)[:, :6]
        moved = q + 1j * STEP * np.hstack([q[:, 6:], accelerations])
        loads = {part: load[part] + 1j * STEP * change[part] for part in ("F", "M", "brake")}
        return solved(Paper(self.scenes["wheel"], moved), self.scenes, loads)[:, 6:].imag / STEP

    def error(self, rates: Table, judge: Table) -> float:
        """lambda_dot and tau_dot / r_0 side by side."""
        arm = np.column_stack([np.ones((ROWS, 3)), self.scenes["wheel"]["r_0"]])
        return relative(rates / arm, judge / arm)


def test_rates_are_those_of_lambda_and_tau_along_the_motion(law: int, symmetric: bool) -> None:
    rows = Rows(law, symmetric)
    judge, found = rows.judged(), rows.rates(eq.REDUCED)
    within(rows.error(found, judge), BOUND, "error")
    rows.load_dot["F"] *= 1 + 1e-5
    beyond(rows.error(rows.rates(eq.REDUCED), judge), 2e-6, "error")  # the rate of the load counts
    rows.load_dot["F"] /= 1 + 1e-5
    rows.scenes["wheel"]["J_x"] *= 1 + 1e-6
    beyond(rows.error(rows.rates(eq.REDUCED), judge), 1e-6, "error, 2")


@pytest.mark.parametrize("width", [(-4, -3), (-7, -6), (-10, -9)], ids=["1e-3", "1e-6", "1e-9"])
def test_rates_under_a_stiff_regularized_law_are_as_exact(width: tuple[float, float]) -> None:
    rows = Rows(eq.REGULARIZED, width=width)
    judge, found = rows.judged(), rows.rates(eq.REDUCED)
    within(rows.error(found, judge), 3e-10, "error")
    rows.scenes["friction"]["omega_s"] *= 1 + 1e-6
    beyond(rows.error(rows.rates(eq.REDUCED), judge), 4e-6, "error")


FAST = {"theta": np.pi / 2, "theta_dot": 0, "phi_dot": 0, "psi_dot": 1000}
FAR = {"psi": 2e4 * np.pi, "phi": 2e4 * np.pi}


@pytest.mark.parametrize(("changed", "bound"), [(FAST, 1e-10), (FAR, BOUND)], ids=["on the spot", "after many turns"])
def test_rates_do_not_fade_at_extreme_motions(changed: dict[str, float], bound: float) -> None:
    rows = Rows(eq.ROLLING)
    for name, value in changed.items():
        rows.motions[name] = value
    judge = rows.judged()
    within(rows.error(rows.rates(eq.REDUCED), judge), bound, "error")
    rows.motions["psi_dot"] *= 1 + 1e-6
    beyond(rows.error(rows.rates(eq.REDUCED), judge), 4e-7, "error")


@pytest.mark.parametrize("law", [eq.ROLLING, eq.REGULARIZED])
def test_rates_on_a_ground_that_pulls_are_those_without_rolling_friction(formulation: eq.Formulation, law: int) -> None:
    """Whatever the sign of N; and on a ground that presses those of the law by force, where N > 0."""
    rows = Rows(law)
    pressed = eq.dynamics_each(formulation, rows.scenes, rows.states(formulation))["lambda_"][:, 2] > 0
    by_force = rows.rates(formulation)
    rows.scenes["ground"] = PRESSES
    assert (rows.rates(formulation)[pressed] == by_force[pressed]).all()
    rows.scenes["ground"] = PULLS
    pulled = rows.rates(formulation)
    rows.scenes["wheel"]["s"] = 0
    within(rows.error(pulled, rows.rates(formulation)), 64 * EPSILON, "error")
    beyond(rows.error(by_force, pulled), 1e-3, "error with the friction of a ground that presses")


def test_the_multibody_form_gives_the_rates_of_the_reduced_form(law: int) -> None:
    rows = Rows(law)
    reduced, multibody = rows.rates(eq.REDUCED), rows.rates(eq.MULTIBODY)
    within(rows.error(multibody, reduced), 64 * EPSILON, "error")
    rows.motions["theta_dot"] += 1e-6
    beyond(rows.error(rows.rates(eq.MULTIBODY), reduced), 1e-6, "error")


def test_a_load_without_a_rate_is_a_constant_load(formulation: eq.Formulation) -> None:
    rows = Rows(eq.ROLLING)
    changing = rows.rates(formulation)
    rows.load_dot = np.zeros_like(rows.load_dot)
    constant, y = rows.rates(formulation), rows.states(formulation)
    for i in range(20):
        without = eq.values(eq.rates(formulation, eq.Scene.from_buffer_copy(rows.scenes[i]), y[i]))
        assert (without == constant[i]).all()
    beyond((changing != constant).any(axis=1).mean(), 0.8, "changing")  # a tenth has no load
