"""The wheel by Siconos 4.4 (INRIA): Coulomb's law as a set-valued law, without regularization; Moreau and Jean's steps.

    python3 lab/reports/programs/siconos_wheel.py [HALVINGS] >siconos.csv

Needs Debian's python3-siconos and its Python alone. Scenes (paper's wheel, SI units):
  rolls     the paper's free wheel, mu = 10
  slides    the same start, mu = 0.3: it slides from swing to swing
  backspin  thrown at a lean of 10 degrees with 2 m/s along e1 and backspin of 10 rad/s, mu = 0.3: it slides, then rolls
  resists   upright and straight with -2 rad/s and s = 0.01 m: rolling resistance as a moment of at most s N
Each is run to its end with 2 ms, and with that step halved. A row: scene, step, X_O and Y_O at the end, computing time.
"""

import sys
from math import cos, pi, sin
from time import process_time

import numpy as np
import siconos.kernel as sk
from siconos.numerics import SICONOS_FRICTION_3D_ONECONTACT_NSN

M, R_0, R, J, G = 20.0, 0.3, 0.05, (0.9, 0.9, 1.8), 9.81
LONGEST = 2e-3  # s
PSI = pi / 2
# theta, omega_z, velocity over the ground added to rolling along e1, mu, s, end in s.
SCENES = {
    "rolls": (5 * pi / 12, -2.0, 0.0, 10.0, 0.0, 1.0),
    "slides": (5 * pi / 12, -2.0, 0.0, 0.3, 0.0, 1.0),
    "backspin": (4 * pi / 9, 10.0, 2.0 + 10.0 * (R_0 + R * sin(4 * pi / 9)), 0.3, 0.0, 1.0),
    "resists": (pi / 2, -2.0, 0.0, 10.0, 0.01, 1.0),
}


def touch(relation, place):
    """Lowest point of the torus, the point of the ground below it, and the upward normal; returns the gap."""
    w, x, y, z = place[3:7]
    axle = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), w * w - x * x - y * y + z * z])
    steepest = axle * axle[2] - (0, 0, 1)  # in the plane of the wheel, downwards
    lowest = place[:3] + R_0 * steepest / np.sqrt(1 - axle[2] ** 2) - (0, 0, R)
    relation.pc1()[:] = lowest
    relation.pc2()[:] = lowest * (1, 1, 0)
    relation.nc()[:] = (0, 0, 1)
    return lowest[2]


class Contact(sk.NewtonEuler3DR):
    def computeh(self, time, place, gap):
        gap[0] = touch(self, place)


class ResistingContact(sk.NewtonEuler5DR):
    def computeh(self, time, place, gap):
        gap[0] = touch(self, place)


def start(theta, omega_z, slip):
    """Position and quaternion; velocity, fixed axes, and angular velocity, body axes; psi_dot = theta_dot = phi = 0."""
    half_psi, half_theta = PSI / 2, theta / 2
    turned = [
        cos(half_psi) * cos(half_theta),
        cos(half_psi) * sin(half_theta),
        sin(half_psi) * sin(half_theta),
        sin(half_psi) * cos(half_theta),
    ]
    along = slip - (R_0 + R * sin(theta)) * omega_z  # along e1
    velocity = [along * cos(PSI), along * sin(PSI), 0, 0, 0, omega_z]
    return [0, 0, R_0 * sin(theta) + R, *turned], velocity


def run(theta, omega_z, slip, mu, s, end, step):
    """X_O, Y_O at the end, m, and the computing time, s."""
    wheel = sk.NewtonEulerDS(*start(theta, omega_z, slip), M, np.diag(J))
    wheel.setFExtPtr(np.array([0, 0, -M * G]))
    model = sk.NonSmoothDynamicalSystem(0, end)
    model.insertDynamicalSystem(wheel)
    if s > 0:
        contact, law = ResistingContact(), sk.NewtonImpactRollingFrictionNSL(0, 0, mu, s, 5)
        problem = sk.RollingFrictionContact(5)
    else:
        contact, law = Contact(), sk.NewtonImpactFrictionNSL(0, 0, mu, 3)
        problem = sk.FrictionContact(3, SICONOS_FRICTION_3D_ONECONTACT_NSN)
    interaction = sk.Interaction(law, contact)
    model.link(interaction, wheel)
    problem.numericsSolverOptions().dparam[0] = 1e-14
    steps = sk.TimeStepping(model, sk.TimeDiscretisation(0, step), sk.MoreauJeanOSI(0.5), problem)
    steps.setNewtonTolerance(1e-12)
    steps.setNewtonMaxIteration(50)
    began = process_time()
    for _ in range(round(end / step)):
        steps.computeOneStep()
        steps.nextStep()
    return *wheel.q()[:2], process_time() - began


def main():
    print("scene,h,x,y,seconds")
    for name, scene in SCENES.items():
        for halved in range(int(sys.argv[1]) if len(sys.argv) > 1 else 5):
            step = LONGEST / 2**halved
            print(name, step, *(f"{number:.12g}" for number in run(*scene, step)), sep=",", flush=True)


if __name__ == "__main__":
    main()
