"""Exudyn's rolling coin, written anew with its Python interface: the contact point after 0.5 s for each step size.

`./scripts/report --peers others` installs Exudyn. Its disc turns about the body's x axis; z is up.
"""

from __future__ import annotations

import exudyn as exu
import numpy as np
from exudyn.utilities import ObjectGround, ObjectJointRollingDisc, RigidBodyInertia, RotationMatrixY
from others.wheels import COIN, COIN_LEAN, COIN_SPIN, Array


def contact(step: float) -> tuple[float, float]:
    """(x, y) of the contact point after 0.5 s."""
    system = exu.SystemContainer().AddSystem()
    turn, spin, r = RotationMatrixY(COIN_LEAN), [0, 0, COIN_SPIN], COIN.r_0
    centre = turn @ [0, 0, r]
    body = system.CreateRigidBody(
        referencePosition=[centre[0], 0, centre[2]],
        referenceRotationMatrix=turn,
        initialVelocity=np.cross(spin, centre),
        initialAngularVelocity=spin,
        inertia=RigidBodyInertia(mass=COIN.m, inertiaTensor=np.diag([COIN.J_z, COIN.J_x, COIN.J_y])),
        gravity=[0, 0, -COIN.g],
        returnDict=True,
    )["bodyNumber"]
    markers = [
        system.AddMarker({"markerType": "BodyRigid", "bodyNumber": number, "localPosition": [0, 0, 0]})
        for number in (system.AddObject(ObjectGround()), body)
    ]
    disc = system.AddObject(ObjectJointRollingDisc(markerNumbers=markers, constrainedAxes=[1, 1, 1], discRadius=r))
    system.Assemble()
    settings = exu.SimulationSettings()
    integration, newton = settings.timeIntegration, settings.timeIntegration.newton
    integration.numberOfSteps, integration.endTime, integration.verboseMode = round(0.5 / step), 0.5, 0
    newton.relativeTolerance, newton.absoluteTolerance = 1e-13, 1e-15
    alpha = integration.generalizedAlpha
    alpha.useIndex2Constraints = alpha.useNewmark = alpha.computeInitialAccelerations = True
    alpha.spectralRadius = 0.5
    settings.solutionSettings.writeSolutionToFile = False
    system.SolveDynamic(settings)
    x, y, _ = system.GetObjectOutput(disc, exu.OutputVariableType.Position)
    return float(x), float(y)


def steps(sizes: Array) -> dict[str, Array]:
    """The table of tests/others/exudyn_coin.csv, computed."""
    x, y = np.array([contact(step) for step in sizes]).T
    return {"h": sizes, "x": x, "y": y}
