"""Measures on the built wheel.fmu what its outputs depend on: initially on parameters and inputs, at an instant on
inputs and continuous states, by model exchange.

No paper equation. One known is changed at a time and all unknowns are read again, in wheels off every symmetry, so that
no dependency hides behind a zero: each real start value of zero is set to 0.1.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from ctypes import c_double
from math import cos
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.model_description import Unknown

from .numbering import Dependencies

GENERAL = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "J_z": 1.6, "s": 0.0, "mu_max": 9.0},
}
UNEQUAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
# omega_z below omega_s, where the regularized law is neither zero nor one
LAW = {"s": 0.03, "friction_law": 2, "phi_dot_start": -GENERAL["psi_dot_start"] * cos(GENERAL["theta_start"]) + 5e-4}
SCENES = ({}, {**UNEQUAL, "s": 0.03}, LAW, {**UNEQUAL, **LAW})
ROUNDING = 1e-11  # what changes less, relative to 1 + its size, has not changed: the formulation changes no more


class Unit:
    """One instance with the values of a scene: in initialization mode, by model exchange in continuous-time mode."""

    def __init__(self, folder: str, kind: str, scene: dict[str, float]) -> None:
        self.description = read_model_description(folder, validate=False)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.states: list[str] = []  # in continuous-time mode
        self.fmu = instantiate_fmu(folder, self.description, kind)
        zeros = [v.name for v in self.variables.values() if v.type == "Real" and v.start == "0"]
        for name, value in {**dict.fromkeys(zeros, 0.1), **GENERAL, **scene}.items():
            self.set(name, value)
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        if kind == "ModelExchange":
            self.fmu.exitInitializationMode()
            while self.fmu.newDiscreteStates()[0]:
                pass
            self.fmu.enterContinuousTimeMode()
            self.states = [row.variable.derivative.name for row in self.description.derivatives]

    def get(self, names: list[str]) -> np.ndarray:
        found = [self.variables[name] for name in names]
        return np.array([getattr(self.fmu, f"get{v.type}")([v.valueReference])[0] for v in found], float)

    def set(self, name: str, value: float) -> None:
        v = self.variables[name]
        if name in self.states:
            x = (c_double * len(self.states))()
            self.fmu.getContinuousStates(x, len(x))
            x[self.states.index(name)] = value
            self.fmu.setContinuousStates(x, len(x))
        else:
            getattr(self.fmu, f"set{v.type}")([v.valueReference], [value if v.type == "Real" else int(value)])

    def depends(self, unknowns: list[Unknown], *causalities: str) -> dict[str, set[str]]:
        """Of each unknown: the states and the variables of these causalities that move it. A real number is changed a
        little, a choice to its last value or from there to its first."""
        knowns = [name for name, v in self.variables.items() if v.causality in causalities or name in self.states]
        names = [row.variable.name for row in unknowns]
        found: dict[str, set[str]] = {name: set() for name in names}
        before = self.get(names)
        for known in knowns:
            v, (value,) = self.variables[known], self.get([known])
            first, last = float(v.min or 0), float(v.max or 1)
            self.set(known, value * 1.01 + 1e-3 if v.type == "Real" else first if value == last else last)
            after = self.get(names)
            self.set(known, value)
            for k in np.flatnonzero(np.abs(after - before) > ROUNDING * (1 + np.abs(before))):
                found[names[k]].add(known)
        return found


@contextmanager
def unit(fmu: Path, kind: str, scene: dict[str, float]) -> Iterator[Unit]:
    with TemporaryDirectory() as folder:
        made = Unit(extract(str(fmu), folder), kind, scene)
        yield made
        made.fmu.freeInstance()


def event_indicators(fmu: Path) -> int:
    """How many event indicators model exchange has: the one length of array that the FMU fills."""
    with unit(fmu, "ModelExchange", {}) as u:
        u.fmu.setDebugLogging(False, [])
        for count in range(1, 100):
            with suppress(FMICallException):  # another length is refused
                u.fmu.getEventIndicators((c_double * count)(), count)
                return count
    raise SystemExit("The FMU gives no event indicators.")


def measured(fmu: Path) -> Dependencies:
    """All dependencies of the FMU, by section of ModelStructure."""
    found: Dependencies = defaultdict(lambda: defaultdict(set))
    for scene in SCENES:
        with unit(fmu, "CoSimulation", scene) as u:
            parts = {"InitialUnknowns": u.depends(u.description.initialUnknowns, "parameter", "input")}
        with unit(fmu, "ModelExchange", scene) as u:
            parts["Outputs"] = u.depends(u.description.outputs, "input")
            parts["Derivatives"] = u.depends(u.description.derivatives, "input")
        for section, unknowns in parts.items():
            for name, moved in unknowns.items():
                found[section][name] |= moved
    return found
