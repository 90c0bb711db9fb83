"""Measures on the built wheel.fmu what its outputs depend on: initially on parameters and inputs, at an instant on
inputs and continuous states, by model exchange, and on inputs by co-simulation, where alone a wheel carrier turns.

No paper equation. One known is changed at a time and all unknowns are read again, in wheels off every symmetry, so that
no dependency hides behind a zero: each real start value of zero is set to 0.1, unless the wheel then does not start, as
with a limit that 0 switches off. What one scene does not let change, as `guided` the rates of the axle, another does.
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
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "J_z": 1.6, "s": 0.0},
}
UNEQUAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
# omega_z below omega_s, where the regularized law is neither zero nor one
LAW = {"s": 0.03, "friction_law": 2, "phi_dot_start": -GENERAL["psi_dot_start"] * cos(GENERAL["theta_start"]) + 5e-4}
GUIDED = {"guided": 1, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
PLAIN: dict[str, float] = {}
SCENES = (
    PLAIN,
    {**UNEQUAL, "s": 0.03},
    LAW,
    {**UNEQUAL, **LAW},
    {**LAW, **GUIDED, "phi_dot_start": 5e-4},
    {**UNEQUAL, **GUIDED, "s": 0.03},
)
# Of a guided wheel: in model exchange only as states that are tried, in co-simulation by its carrier.
TURNING = {"psi_dot": 0.4, "theta_dot": -0.3}
# Co-simulation alone slides: a slip changes what the force of the ground depends on.
ROAD = {"mu_max": 9.0, "mu_slide": 0.1}
SLIPS = ({"slip_x_start": 0.0, "slip_y_start": 0.0}, {"slip_x_start": 0.1, "slip_y_start": 0.1})
ROUNDING = 1e-11  # what changes less, relative to 1 + its size, has not changed: the formulation changes no more


class Unit:
    """One instance with the values of a scene: in initialization mode, or running, by model exchange in continuous-time
    mode."""

    def __init__(self, folder: str, kind: str, scene: dict[str, float], runs: bool) -> None:
        self.description = read_model_description(folder, validate=False)
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.states: list[str] = []  # in continuous-time mode
        self.fmu = instantiate_fmu(folder, self.description, kind)
        self.fmu.setDebugLogging(False, [])
        for name, value in scene.items():
            self.put(name, value)
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        if runs:
            self.fmu.exitInitializationMode()
        if runs and kind == "ModelExchange":
            _, self.ended, *_ = self.fmu.newDiscreteStates()
            self.fmu.enterContinuousTimeMode()
            self.states = [row.variable.derivative.name for row in self.description.derivatives]

    def get(self, names: list[str]) -> np.ndarray:
        found = [self.variables[name] for name in names]
        return np.array([getattr(self.fmu, f"get{v.type}")([v.valueReference])[0] for v in found], float)

    def put(self, name: str, value: float) -> None:
        v = self.variables[name]
        if name in self.states:
            x = (c_double * len(self.states))()
            self.fmu.getContinuousStates(x, len(x))
            x[self.states.index(name)] = value
            self.fmu.setContinuousStates(x, len(x))
        else:
            getattr(self.fmu, f"set{v.type}")([v.valueReference], [value if v.type == "Real" else int(value)])

    def depends(self, unknowns: list[Unknown], *causalities: str) -> dict[str, set[str]]:
        """Of each unknown: the states and the variables of these causalities that move it. Under "": those of them that
        can be changed."""
        knowns = [name for name, v in self.variables.items() if v.causality in causalities or name in self.states]
        names = [row.variable.name for row in unknowns]
        found: dict[str, set[str]] = {name: set() for name in names}
        before = self.get(names)
        for known in knowns:
            (value,) = self.get([known])
            after = self.get_with(known, value, names)
            self.put(known, value)
            if after is None:
                continue
            found.setdefault("", set()).add(known)
            for k in np.flatnonzero(np.abs(after - before) > ROUNDING * (1 + np.abs(before))):
                found[names[k]].add(known)
        return found

    def get_with(self, known: str, value: float, names: list[str]) -> np.ndarray | None:
        """These variables with another value of one; None where the wheel starts with no other. A real number changes a
        little, downwards where it can be no larger; a choice changes to its last value or from there to its first."""
        v = self.variables[known]
        first, last = float(v.min or 0), float(v.max or 1)
        others = (value * 1.01 + 1e-3, value * 0.99 - 1e-3) if v.type == "Real" else (first if value == last else last,)
        for other in others:
            with suppress(FMICallException):
                self.put(known, other)
                return self.get(names)
        return None


@contextmanager
def unit(folder: str, kind: str, scene: dict[str, float], runs: bool = True) -> Iterator[Unit]:
    made = Unit(folder, kind, scene, runs)
    yield made
    made.fmu.freeInstance()


def starts(folder: str, scene: dict[str, float]) -> bool:
    """Whether a run can begin and does not end there."""
    with suppress(FMICallException), unit(folder, "ModelExchange", scene) as u:
        return not u.ended
    return False


def without_zeros(folder: str, scene: dict[str, float]) -> dict[str, float]:
    """The scene with the start values of zero set to 0.1, one after the other, as far as the wheel starts."""
    scene = {**GENERAL, **scene}
    for v in read_model_description(folder, validate=False).modelVariables:
        if v.type == "Real" and v.start == "0" and v.name not in scene and starts(folder, {**scene, v.name: 0.1}):
            scene[v.name] = 0.1
    return scene


def event_indicators(fmu: Path) -> int:
    """How many event indicators model exchange has: the one length of array that the FMU fills."""
    with TemporaryDirectory() as folder, unit(extract(str(fmu), folder), "ModelExchange", {}) as u:
        for count in range(1, 100):
            with suppress(FMICallException):  # another length is refused
                u.fmu.getEventIndicators((c_double * count)(), count)
                return count
    raise SystemExit("The FMU gives no event indicators.")


def measured(fmu: Path) -> Dependencies:
    """All dependencies of the FMU, by section of ModelStructure."""
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    with TemporaryDirectory() as folder:
        extract(str(fmu), folder)
        for scene in (without_zeros(folder, changed) for changed in SCENES):
            parts, turns = [], bool(scene.get("guided")) and scene["phi_dot_start"] == GENERAL["phi_dot_start"]
            turning = TURNING if turns else {}
            for slip in SLIPS:
                driven = {**scene, **ROAD, **slip, **{f"{name}_guide": rate for name, rate in turning.items()}}
                with unit(folder, "CoSimulation", driven, runs=False) as u:
                    parts += [("InitialUnknowns", u.depends(u.description.initialUnknowns, "parameter", "input"))]
                with unit(folder, "CoSimulation", driven) as u:
                    parts += [("Outputs", u.depends(u.description.outputs, "input"))]
            with unit(folder, "ModelExchange", scene) as u:
                for name, rate in turning.items():
                    u.put(name, rate)
                parts += [("Outputs", u.depends(u.description.outputs, "input"))]
                parts += [("Derivatives", u.depends(u.description.derivatives, "input"))]
            for section, unknowns in parts:
                for name, moved in unknowns.items():
                    found[section][name] |= moved
        variables = read_model_description(folder, validate=False).modelVariables
    knowns = {v.name for v in variables if v.causality in ("parameter", "input")}
    if stuck := knowns - found["InitialUnknowns"][""]:
        raise SystemExit(f"No scene lets {', '.join(sorted(stuck))} be changed.")
    for of_section in found.values():
        del of_section[""]
    return found
