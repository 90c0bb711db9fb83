"""Energy changes by the power of inputs and rolling friction and by nothing else, pointwise.

dE/dt = m v a + omega J omega_dot + m g v_Z, from the accelerations of either formulation; power =
F v + M omega (carrier) + tau omega_z. The reaction does no work: the contact point is at rest.
"""

import numpy as np
from support import equations as eq
from support.bounds import EPSILON, beyond, within

from equations.paper_transcription import Paper, times
from equations.pointwise import draw


class Instants:
    """Random states with their velocities, accelerations and powers."""

    def __init__(self, formulation: eq.Formulation, kind: int) -> None:
        self.scenes, motions = draw(31, kind, symmetric=False)
        y = eq.start_each(formulation, self.scenes, motions)
        self.k = eq.kinematics_each(formulation, self.scenes, y)
        self.d = eq.dynamics_each(formulation, self.scenes, y)

    def input_power(self) -> np.ndarray:
        k, load = self.k, self.scenes["load"]
        velocity = eq.columns(k, "X_O_dot", "Y_O_dot", "Z_O_dot")
        omega = np.column_stack([k["theta_dot"], k["psi_dot"] * np.sin(k["theta"]), k["omega_z"]])
        return (load["F"] * velocity + load["M"] * omega).sum(axis=1)

    def friction_power(self) -> np.ndarray:
        return self.d["tau"] * self.k["omega_z"]

    def energy_rates(self) -> tuple[np.ndarray, np.ndarray]:
        """dE/dt, and the size of its terms."""
        k, d, wheel = self.k, self.d, self.scenes["wheel"]
        paper = Paper(wheel, eq.columns(k, *k.dtype.names[:12]))
        a = eq.columns(d, "X_O_ddot", "Y_O_ddot", "Z_O_ddot")
        a += eq.columns(wheel, "g_X", "g_Y", "g") * [-1, -1, 1]  # the energy counts the height against gravity
        beta_ddot = eq.columns(d, "psi_ddot", "theta_ddot", "phi_ddot")
        omega_dot = times(paper.Q, beta_ddot) + times(paper.Q_dot, paper.beta_dot)
        terms = np.hstack([wheel["m"][:, None] * paper.q_dot[:, :3] * a, paper.omega * times(paper.J, omega_dot)])
        return terms.sum(axis=1), np.abs(terms).sum(axis=1)


def test_energy_changes_by_the_power_of_inputs_and_friction(formulation: eq.Formulation, law: int) -> None:
    now = Instants(formulation, law)
    rate, size = now.energy_rates()
    power = now.input_power() + now.friction_power()
    within((np.abs(rate - power) / size).max(), 4096 * EPSILON, "relative error")  # of accelerations from a solution
    without_inputs = now.friction_power()
    beyond((np.abs(rate - without_inputs) / size).max(), 0.1, "relative error")
    if law in (eq.ROLLING, eq.REGULARIZED):
        friction_reversed = now.input_power() - now.friction_power()
        beyond((np.abs(rate - friction_reversed) / size).max(), 1, "relative error, 2")


def test_stop_spin_leaves_a_rolling_wheel_without_spin_that_holding_takes_no_energy_from(
    formulation: eq.Formulation,
) -> None:
    scenes, motions = draw(32, eq.HELD, symmetric=False)
    y = eq.start_each(formulation, scenes, motions)
    before = eq.kinematics_each(formulation, scenes, y)
    assert (before["omega_z"] != 0).all()
    eq.each(formulation.stop_spin, scenes, y)
    after = eq.kinematics_each(formulation, scenes, y)
    kept = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi", "psi_dot", "theta_dot")
    assert (after["omega_z"] == 0).all()
    within(np.abs(eq.columns(after, *kept) - eq.columns(before, *kept)).max(), 64 * EPSILON, "columns")
    rolling = eq.columns(after, *after.dtype.names[:12])
    slip = times(Paper(scenes["wheel"], rolling).B, rolling[:, 6:])
    within(np.abs(slip).max(), 32 * 60 * EPSILON, "slip")  # speeds of 60 m/s
    slid = np.hstack([rolling[:, :11], eq.columns(before, "phi_dot")])
    beyond(np.abs(times(Paper(scenes["wheel"], slid).B, slid[:, 6:])).max(), 6, "wheel")
    assert (eq.dynamics_each(formulation, scenes, y)["tau"] * after["omega_z"] == 0).all()
