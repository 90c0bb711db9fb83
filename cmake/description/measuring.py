"""Measures on the built wheel.fmu what its outputs depend on: initially on parameters and inputs, at an instant on
inputs and continuous states, by model exchange.

No paper equation. One known is changed at a time and all unknowns are read again, in wheels off every symmetry, so that
no dependency hides behind a zero: each real start value of zero is set to 0.1.
"""

from __future__ import annotations

import shutil
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from ctypes import c_double
from math import cos
from pathlib import Path

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException

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
Change = Callable[[bool], None]  # puts another value of one known, or the old one back
SECTIONS = {
    "Outputs": "outputs",
    "Derivatives": "derivatives",
    "InitialUnknowns": "initialUnknowns",
}  # as FMPy names them


class Unit:
    """One instance in initialization mode with the values of a scene, read and set by name."""

    def __init__(self, folder: str, kind: str, scene: dict[str, float]) -> None:
        self.description = read_model_description(folder, validate=False)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.fmu = instantiate_fmu(folder, self.description, kind)
        zeros = [v.name for v in self.variables.values() if v.type == "Real" and v.start == "0"]
        for name, value in {**dict.fromkeys(zeros, 0.1), **GENERAL, **scene}.items():
            self.set(name, value)
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()

    def continuous_time(self) -> None:
        """From initialization mode into continuous-time mode of model exchange."""
        self.fmu.exitInitializationMode()
        while self.fmu.newDiscreteStates()[0]:
            pass
        self.fmu.enterContinuousTimeMode()

    def get(self, name: str) -> float:
        v = self.variables[name]
        return getattr(self.fmu, f"get{v.type}")([v.valueReference])[0]

    def set(self, name: str, value: float) -> None:
        v = self.variables[name]
        getattr(self.fmu, f"set{v.type}")([v.valueReference], [value])

    def changes(self, *causalities: str) -> Iterator[tuple[str, Change]]:
        """Of each parameter or input: a real number a little, a choice to its last value or from there to its first."""
        for name, v in self.variables.items():
            if v.causality in causalities:
                value = self.get(name)
                if v.type == "Real":
                    other = value * 1.01 + 1e-3
                else:
                    other = int((v.min or 0) if value == int(v.max or 1) else (v.max or 1))
                yield name, lambda on, name=name, values=(value, other): self.set(name, values[on])

    def changes_of_states(self) -> Iterator[tuple[str, Change]]:
        """Of each continuous state, in continuous-time mode."""
        count = len(self.description.derivatives)
        x = (c_double * count)()
        self.fmu.getContinuousStates(x, count)
        for k, row in enumerate(self.description.derivatives):

            def change(on: bool, k: int = k, values: tuple[float, float] = (x[k], x[k] * 1.01 + 1e-3)) -> None:
                x[k] = values[on]
                self.fmu.setContinuousStates(x, count)

            yield row.variable.derivative.name, change

    def depends(self, section: str, *changes: tuple[str, Change]) -> dict[str, set[str]]:
        """Of each unknown of a section of ModelStructure: what moves it among the knowns that are changed."""
        names = [row.variable.name for row in getattr(self.description, SECTIONS[section])]
        found: dict[str, set[str]] = {name: set() for name in names}
        for known, change in changes:
            before = np.array([self.get(name) for name in names])
            change(True)
            after = np.array([self.get(name) for name in names])
            change(False)
            for k in np.flatnonzero(np.abs(after - before) > ROUNDING * (1 + np.abs(before))):
                found[names[k]].add(known)
        return found


@contextmanager
def unit(fmu: Path, kind: str, scene: dict[str, float]) -> Iterator[Unit]:
    folder = extract(str(fmu))
    made = Unit(folder, kind, scene)
    try:
        yield made
    finally:
        made.fmu.freeInstance()
        shutil.rmtree(folder)


def event_indicators(fmu: Path) -> int:
    """How many event indicators model exchange has: the one length of array that the FMU fills."""
    with unit(fmu, "ModelExchange", {}) as u:
        u.continuous_time()
        u.fmu.setDebugLogging(False, [])
        for count in range(1, 100):
            with suppress(FMICallException):  # another length is refused
                u.fmu.getEventIndicators((c_double * count)(), count)
                return count
    raise SystemExit("The FMU gives no event indicators.")


def measured(fmu: Path) -> Dependencies:
    """All dependencies of the FMU, by section of ModelStructure."""
    found: Dependencies = {section: defaultdict(set) for section in SECTIONS}
    for scene in SCENES:
        with unit(fmu, "CoSimulation", scene) as u:
            parts = {"InitialUnknowns": u.depends("InitialUnknowns", *u.changes("parameter", "input"))}
        with unit(fmu, "ModelExchange", scene) as u:
            u.continuous_time()
            changes = [*u.changes("input"), *u.changes_of_states()]
            parts |= {section: u.depends(section, *changes) for section in ("Outputs", "Derivatives")}
        for section, unknowns in parts.items():
            for name, knowns in unknowns.items():
                found[section][name] |= knowns
    return found
