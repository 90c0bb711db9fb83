"""Measures on the built wheel.fmu what its outputs depend on: initially on parameters and inputs, at an instant on
inputs and continuous states, in model exchange, and on inputs in co-simulation, where alone a wheel carrier turns.

No paper equation. One known is changed at a time and all unknowns are read again, in wheels off every symmetry, so that
no dependency hides behind a zero: each real start value of zero is set to 0.1, unless the wheel then does not start, as
with a limit that 0 switches off. What one scene does not let change, as `guided` the rates of the axle, another does.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from math import cos
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from fmpy import extract, read_model_description
from fmpy.model_description import ModelDescription, Unknown

from wheelfmu.fmu.driver import CO_SIMULATION, MODEL_EXCHANGE, STATES, WARNING, FMU2Wheel, Values

from .numbering import Dependencies

GENERAL = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "J_z": 1.6, "s": 0.0},
}
UNEQUAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}
# omega_z below omega_s, where the regularized law is neither zero nor one
LAW: Values = {
    "s": 0.03,
    "friction_law": 2,
    "phi_dot_start": -GENERAL["psi_dot_start"] * cos(GENERAL["theta_start"]) + 5e-4,
}
GUIDED = {"guided": 1, "psi_dot_start": 0.0, "theta_dot_start": 0.0}
# Of a guided wheel: in model exchange only as states that are tried, in co-simulation by its carrier.
TURNING = {"psi_dot": 0.4, "theta_dot": -0.3}
BRAKED: Values = {"s": 0.03, "M_brake": 500.0}


def held(psi_dot: float) -> Values:
    """omega_z is zero, and tau_brake the brake's share of the moment that keeps it there."""
    return {**BRAKED, "phi_dot_start": -psi_dot * cos(GENERAL["theta_start"])}


PLAIN: Values = {}
SCENES: tuple[Values, ...] = (
    PLAIN,
    {**UNEQUAL, "s": 0.03},
    LAW,
    {**UNEQUAL, **LAW},
    {**UNEQUAL, **held(GENERAL["psi_dot_start"])},
    {**UNEQUAL, **GUIDED, **held(TURNING["psi_dot"])},
    {**LAW, **GUIDED, "phi_dot_start": 5e-4},
    {**UNEQUAL, **GUIDED, "s": 0.03},
)
# Co-simulation alone slides: a slip changes what the force of the ground depends on, and the direction in which one
# begins follows from all that acts. On a road that gives this share of the friction that rolling needs it begins at the
# start, or where inputs jump: there the carrier's jump meets friction too.
ROAD = {"mu_max": 9.0, "mu_slide": 0.1}
TOO_LITTLE, ENOUGH = 0.995, 1.005
PUSH: Values = {"F_X": 40.0, "F_Y": -60.0, "M_3": 20.0}
SWING: Values = {"psi_dot_guide": -1.0, "theta_dot_guide": 0.8}
SLIPS = ({"slip_x_start": 0.0, "slip_y_start": 0.0}, {"slip_x_start": 0.1, "slip_y_start": 0.1})
TIGHTEST = 1e-13  # a slip begins with a speed next to zero, in proportion to the tolerance
ROUNDING = 1e-11  # what changes less, relative to 1 + its size, has not changed: the formulation changes no more


class Unit:
    """One instance with the values of a scene: in initialization mode, or running, by model exchange in continuous-time
    mode; `refused` where the scene does not begin, `ended` where it ends at once."""

    def __init__(self, loaded: FMU2Wheel, kind: int, scene: Values, runs: bool) -> None:
        loaded.kind, self.ended = kind, False
        self.states: tuple[str, ...] = ()
        self.wheel = loaded.new()
        statuses = [self.wheel.set(**scene), self.wheel.setupExperiment(tolerance=TIGHTEST)]
        statuses += [self.wheel.enterInitializationMode()]
        statuses += [self.wheel.exitInitializationMode()] if runs else []
        self.refused = max(statuses) > WARNING
        if runs and kind == MODEL_EXCHANGE and not self.refused:
            self.ended, self.states = bool(self.wheel.decide().terminateSimulation), STATES
            self.wheel.enterContinuousTimeMode()

    def put(self, name: str, value: float) -> int:
        if name not in self.states:
            return self.wheel.set(**{name: value})
        x = self.wheel.x()
        x[STATES.index(name)] = value
        return self.wheel.ask("SetContinuousStates", x, len(x))

    def depends(self, unknowns: list[Unknown], *causalities: str) -> dict[str, set[str]]:
        """Of each unknown: the states and the variables of these causalities that move it. Under "": those of them that
        can be changed."""
        knowns = [name for name, v in self.wheel.variables.items() if v.causality in causalities or name in self.states]
        names = [row.variable.name for row in unknowns]
        found: dict[str, set[str]] = {name: set() for name in names}
        before = np.array(self.wheel.get(*names))
        for known in knowns:
            (value,) = self.wheel.get(known)
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
        v = self.wheel.variables[known]
        first, last = (int(float(limit or other)) for limit, other in ((v.min, 0), (v.max, 1)))
        choice = first if value == last else last
        others = (value * 1.01 + 1e-3, value * 0.99 - 1e-3) if v.type == "Real" else (choice,)
        for other in others:
            if self.put(known, other) <= WARNING:
                statuses, after = zip(*map(self.wheel.get_one, names), strict=True)
                if max(statuses) <= WARNING:
                    return np.array(after)
        return None


@contextmanager
def unit(loaded: FMU2Wheel, kind: int, scene: Values, runs: bool = True) -> Iterator[Unit]:
    made = Unit(loaded, kind, scene, runs)
    yield made
    made.wheel.close()


def starts(loaded: FMU2Wheel, scene: Values) -> bool:
    """Whether a run can begin and does not end there."""
    with unit(loaded, MODEL_EXCHANGE, scene) as u:
        return not u.refused and not u.ended


def without_zeros(loaded: FMU2Wheel, scene: Values) -> Values:
    """The scene with the start values of zero set to 0.1, one after the other, as far as the wheel starts."""
    scene = {**GENERAL, **scene}
    for v in loaded.variables.values():
        if v.type == "Real" and v.start == "0" and v.name not in scene and starts(loaded, {**scene, v.name: 0.1}):
            scene[v.name] = 0.1
    return scene


def roads(loaded: FMU2Wheel, scene: Values) -> Iterator[Values]:
    """A wheel that can slide and grips, one that slides, and two at the limit of their grip."""
    for slip in SLIPS:
        yield {**scene, **ROAD, **slip}
    with unit(loaded, CO_SIMULATION, {**scene, **ROAD, **SLIPS[0]}) as u:
        needed = u.wheel.get("mu_required")[0]
    for share in (TOO_LITTLE, ENOUGH):
        yield {**scene, **SLIPS[0], "mu_max": share * needed, "mu_slide": 0.9 * needed}


def event_indicators(fmu: Path) -> int:
    """How many event indicators model exchange has: the one length of array that the FMU fills."""
    with TemporaryDirectory() as folder:
        _, loaded = unpacked(fmu, folder)
        with unit(loaded, MODEL_EXCHANGE, {}) as u:
            for count in range(1, 100):
                if u.wheel.ask("GetEventIndicators", [0.0] * count, count) <= WARNING:
                    return count
    raise SystemExit("The FMU gives no event indicators.")


def unpacked(fmu: Path, folder: str) -> tuple[ModelDescription, FMU2Wheel]:
    description = read_model_description(extract(str(fmu), folder), validate=False)
    return description, FMU2Wheel(folder, description)


def measured(fmu: Path) -> Dependencies:
    """All dependencies of the FMU, by section of ModelStructure."""
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    with TemporaryDirectory() as folder:
        description, loaded = unpacked(fmu, folder)
        for scene in (without_zeros(loaded, changed) for changed in SCENES):
            parts, small_spin = [], scene.get("friction_law") == LAW["friction_law"]
            turning = TURNING if scene.get("guided") and not small_spin else {}
            rates = {f"{name}_guide": rate for name, rate in turning.items()}
            for driven in roads(loaded, {**scene, **rates}):
                with unit(loaded, CO_SIMULATION, driven, runs=False) as u:
                    parts += [("InitialUnknowns", u.depends(description.initialUnknowns, "parameter", "input"))]
                for jump in ({}, PUSH | (SWING if turning else {})):
                    with unit(loaded, CO_SIMULATION, driven) as u:
                        u.wheel.set(**jump)
                        parts += [("Outputs", u.depends(description.outputs, "input"))]
            with unit(loaded, MODEL_EXCHANGE, scene) as u:
                for name, rate in turning.items():
                    u.put(name, rate)
                parts += [("Outputs", u.depends(description.outputs, "input"))]
                parts += [("Derivatives", u.depends(description.derivatives, "input"))]
            for section, unknowns in parts:
                for name, moved in unknowns.items():
                    found[section][name] |= moved
    knowns = {v.name for v in description.modelVariables if v.causality in ("parameter", "input")}
    if stuck := knowns - found["InitialUnknowns"][""]:
        raise SystemExit(f"No scene lets {', '.join(sorted(stuck))} be changed.")
    for of_section in found.values():
        del of_section[""]
    return found
