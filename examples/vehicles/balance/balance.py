"""Controller that keeps a slowly rolling wheel from falling and steers it along a line, then a circle (pythonfmu).

It samples theta, theta_dot, psi, psi_dot and phi_dot once per communication step and answers one step later:

    psi_ref_dot = 0 on the line, v / R on the circle, rising over t_bend;  v = r_roll |omega_ref|
    theta_ref   = pi/2 + (psi_ref_dot - k_psi (psi - psi_ref)) / a      a wheel turns to the side it leans to
    M_1         = k_theta (theta_ref - theta) - c_theta theta_dot       about e1, the rolling direction
    M_3         = -k_omega (omega_z - omega_ref) - k_i integral         about the axle: holds the speed

a = J_z omega_ref / J_x is the wheel's gyroscopic gain: without a moment about e2, psi_dot - a theta is constant near
upright, which is how leaning steers.
"""

import csv
from math import cos, pi
from pathlib import Path

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

with Path(__file__).with_name("balance.csv").open() as table:
    VARIABLES = list(csv.DictReader(line for line in table if not line.startswith("#")))


class Balance(Fmi2Slave):
    """One controller; its memory is the course psi_ref and the integral of the speed error."""

    description = "Balances and steers a rolling wheel by M_1, holds its speed by M_3"

    def __init__(self, **kwargs: object) -> None:
        super().__init__(**kwargs)
        self.modelName = "balance"
        for row in VARIABLES:
            setattr(self, row["name"], float(row["start"] or 0))
            parameter = row["causality"] == "parameter"
            how = {"variability": Fmi2Variability.tunable if parameter else Fmi2Variability.continuous}
            self.register_variable(Real(row["name"], causality=Fmi2Causality[row["causality"]], **how))
        self.psi_ref = self.integral = 0.0

    def do_step(self, current_time: float, step_size: float) -> bool:
        """The moments for the step after this one."""
        omega_z = self.phi_dot + self.psi_dot * cos(self.theta)
        bend = min(max((current_time - self.t_circle) / self.t_bend, 0.0), 1.0)
        psi_ref_dot = bend * self.r_roll * abs(self.omega_ref) / self.R
        theta_ref = pi / 2 + (psi_ref_dot - self.k_psi * (self.psi - self.psi_ref)) / self.a
        self.M_1 = self.k_theta * (theta_ref - self.theta) - self.c_theta * self.theta_dot
        error = omega_z - self.omega_ref
        self.M_3 = -self.k_omega * error - self.k_i * self.integral
        self.integral += step_size * error
        self.psi_ref += step_size * psi_ref_dot
        return True
