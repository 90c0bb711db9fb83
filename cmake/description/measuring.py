"""Measures on the built wheel.fmu what its outputs depend on: initially on parameters and inputs, at an instant on
inputs and continuous states, by model exchange.

No paper equation. One known is changed at a time and all unknowns are read again, in wheels off every symmetry, so that
no dependency hides behind a zero: each real start value of zero is set to 0.1.
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from ctypes import c_double
from math import cos
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from fmpy import extract
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Model, FMU2Slave

from .numbering import Dependencies, unknowns_of, variables_of

GENERAL = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "J_z": 1.6, "s": 0.0, "mu_max": 9.0},
}
UNEQUAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
# omega_z below omega_s, where the regularized law is neither zero nor one
LAW = {"s": 0.03, "friction_law": 2, "phi_dot_start": -GENERAL["psi_dot_start"] * cos(GENERAL["theta_start"]) + 5e-4}
SCENES = ({}, {**UNEQUAL, "s": 0.03}, LAW, {**UNEQUAL, **LAW})
ROUNDING = 1e-11  # what changes less, relative to 1 + its size, has not changed: the formulation changes no more
Values = dict[str, float]


class Unit:
    """One instance, read and set by name."""

    def __init__(self, folder: str, driver: type[FMU2Slave | FMU2Model]) -> None:
        root = ElementTree.parse(Path(folder) / "modelDescription.xml").getroot()
        model = root.find("ModelExchange").get("modelIdentifier")
        self.fmu = driver(guid=root.get("guid"), unzipDirectory=folder, modelIdentifier=model, instanceName="measured")
        self.variables = {v.get("name"): (k, v) for k, v in enumerate(variables_of(root))}
        self.unknowns = unknowns_of(root)
        self.fmu.instantiate()

    def of_role(self, *roles: str) -> list[str]:
        return [name for name, (_, v) in self.variables.items() if v.get("causality") in roles]

    def type_of(self, name: str) -> str:
        return self.variables[name][1][0].tag

    def get(self, name: str) -> float:
        return getattr(self.fmu, f"get{self.type_of(name)}")([self.variables[name][0]])[0]

    def set(self, values: Values) -> None:
        for name, value in values.items():
            getattr(self.fmu, f"set{self.type_of(name)}")([self.variables[name][0]], [value])

    def start(self, scene: Values) -> None:
        """Into initialization mode, with the values of a scene."""
        zeros = [name for name, (_, v) in self.variables.items() if v[0].tag == "Real" and v[0].get("start") == "0"]
        self.set({**dict.fromkeys(zeros, 0.1), **GENERAL, **scene})
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()

    def continuous_time(self) -> int:
        """From initialization mode into continuous-time mode of model exchange; the number of states."""
        self.fmu.exitInitializationMode()
        while self.fmu.newDiscreteStates()[0]:
            pass
        self.fmu.enterContinuousTimeMode()
        return len(self.unknowns["Derivatives"])


@contextmanager
def unit(folder: str, driver: type[FMU2Slave | FMU2Model], scene: Values) -> Iterator[Unit]:
    made = Unit(folder, driver)
    try:
        made.start(scene)
        yield made
    finally:
        made.fmu.freeInstance()


def moved(unit: Unit, names: list[str], change: Callable[[int], None]) -> set[str]:
    """The unknowns that change(1) moves and change(0), which undoes it, puts back."""
    before = np.array([unit.get(name) for name in names])
    change(1)
    after = np.array([unit.get(name) for name in names])
    change(0)
    return {names[k] for k in np.flatnonzero(np.abs(after - before) > ROUNDING * (1 + np.abs(before)))}


def changer(unit: Unit, name: str) -> Callable[[int], None]:
    """Changes one parameter or input: a real number a little, a choice to its last value or from there to its first."""
    value, kind = unit.get(name), unit.type_of(name)
    other = value * 1.01 + 1e-3
    if kind != "Real":
        first, last = (int(unit.variables[name][1][0].get(limit, k)) for k, limit in enumerate(("min", "max")))
        other = first if value == last else last
    return lambda on: unit.set({name: other if on else value})


def initially(folder: str, scene: Values) -> Iterator[tuple[str, str]]:
    """Pairs (unknown, known) in initialization mode."""
    with unit(folder, FMU2Slave, scene) as u:
        for known in u.of_role("parameter", "input"):
            for name in moved(u, u.unknowns["InitialUnknowns"], changer(u, known)):
                yield name, known


def continuously(folder: str, scene: Values) -> Iterator[tuple[str, str]]:
    """Pairs (output or derivative, input or state) in continuous-time mode."""
    with unit(folder, FMU2Model, scene) as u:
        count = u.continuous_time()
        names = u.unknowns["Outputs"] + u.unknowns["Derivatives"]
        states = list(u.unknowns["States"])
        x = (c_double * count)()
        u.fmu.getContinuousStates(x, count)

        def state(k: int) -> Callable[[int], None]:
            value = x[k]

            def change(on: int) -> None:
                x[k] = value * 1.01 + 1e-3 if on else value
                u.fmu.setContinuousStates(x, count)

            return change

        changes = {states[k]: state(k) for k in range(count)} | {n: changer(u, n) for n in u.of_role("input")}
        for known, change in changes.items():
            for name in moved(u, names, change):
                yield name, known


def event_indicators(fmu: Path) -> int:
    """How many event indicators model exchange has: the one length of array that the FMU fills."""
    folder = extract(str(fmu))
    try:
        with unit(folder, "ModelExchange", {}) as u:
            u.continuous_time()
            u.fmu.setDebugLogging(False, [])
            for count in range(1, 100):
                with suppress(FMICallException):  # another length is refused
                    u.fmu.getEventIndicators((c_double * count)(), count)
                    return count
    finally:
        shutil.rmtree(folder)
    raise SystemExit("The FMU gives no event indicators.")


def gathered(pairs: Iterator[tuple[str, str]], names: list[str]) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {name: set() for name in names}
    for unknown, known in pairs:
        if unknown in found:
            found[unknown].add(known)
    return found


def measured(fmu: Path) -> Dependencies:
    """All dependencies of the FMU, by section of ModelStructure."""
    folder = extract(str(fmu))
    try:
        rows = unknowns_of(ElementTree.parse(Path(folder) / "modelDescription.xml").getroot())
        now = [pair for scene in SCENES for pair in continuously(folder, scene)]
        start = [pair for scene in SCENES for pair in initially(folder, scene)]
        return {
            "Outputs": gathered(iter(now), rows["Outputs"]),
            "Derivatives": gathered(iter(now), rows["Derivatives"]),
            "InitialUnknowns": gathered(iter(start), rows["InitialUnknowns"]),
        }
    finally:
        shutil.rmtree(folder)
