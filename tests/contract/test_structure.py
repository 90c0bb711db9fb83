"""ModelStructure tells the truth: an output depends on what it lists and on nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from support.driver import OK, FMU2Wheel
from support.scenes import KINDS

pytestmark = pytest.mark.contract

INPUTS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3", "M_brake")
# Values off every symmetry, so that no dependency hides behind a zero.
GENERAL = {
    **{"theta_start": 1.1, "psi_start": 0.7, "phi_start": 0.4, "psi_dot_start": 0.9, "theta_dot_start": -0.6},
    **{"slope": 0.2, "slope_direction": 0.6},
    **{"phi_dot_start": -3.0, "X_O_start": 0.2, "Y_O_start": -0.4, "m": 17.0, "F_X": 1.0, "M_2": 0.5, "M_brake": 0.2},
}
# The formulation changes rounding only, yet is listed; solver and contact have no part in a value.
CHOICES = {"formulation"}


def initialized(w: FMU2Wheel, **values: float) -> FMU2Wheel:
    assert w.set(**values) == OK
    assert (w.setupExperiment(), w.enterInitializationMode()) == (OK, OK)
    return w


def outputs(w: FMU2Wheel) -> list[str]:
    return [name for name, v in w.variables.items() if v.causality == "output"]


def moved(w: FMU2Wheel, name: str, relative: float = 0.01) -> set[str]:
    """The outputs that a small change of one parameter or input moves, in initialization mode."""
    names = outputs(w)
    before = np.frombuffer(w.read(names))
    (value,) = w.get(name)
    kind = w.variables[name].type
    changed = {"Boolean": 1 - value, "Integer": 1 if value == 2 else 2}.get(kind, value * (1 + relative) + 1e-3)
    assert w.set(**{name: changed}) == OK
    after = np.frombuffer(w.read(names))
    assert w.set(**{name: value}) == OK
    assert w.read(names) == before.tobytes()
    return {names[k] for k in np.flatnonzero(np.abs(after - before) > 1e-11)}


def measured_dependencies(wheel, description) -> dict[str, set[str]]:
    knowns = [v.name for v in description.modelVariables if v.causality in ("parameter", "input")]
    depends: dict[str, set[str]] = {}
    # omega_z below omega_s, where the regularized law is neither zero nor one
    slow = {"phi_dot_start": -GENERAL["psi_dot_start"] * np.cos(GENERAL["theta_start"]) + 5e-4}
    scenes = [KINDS["free"], KINDS["general inertia, friction"], KINDS["regularized"] | slow]
    for scene in (*scenes, KINDS["general inertia"] | KINDS["regularized"] | slow):
        w = initialized(wheel(), **GENERAL | {"J_z": 1.6} | scene)
        for known in knowns:
            if known != "formulation":  # reduced needs J_x = J_y
                for output in moved(w, known):
                    depends.setdefault(output, set()).add(known)
    return depends


def test_initial_unknowns_list_exactly_what_moves_them(wheel, description):
    measured = measured_dependencies(wheel, description)
    assert measured["theta"] == {"theta_start"} != {"theta_start", "m"}
    for unknown in description.initialUnknowns:
        declared = {v.name for v in unknown.dependencies}
        name = unknown.variable.name
        assert declared - CHOICES == measured[name], (name, declared ^ measured[name])


def test_outputs_list_exactly_the_inputs_that_move_them_at_once(wheel, description):
    w = wheel().start(**GENERAL | KINDS["general inertia, friction"])
    assert w.step(0.1) == OK
    names = outputs(w)
    measured: dict[str, set[str]] = {name: set() for name in names}
    for known in INPUTS:
        before = np.frombuffer(w.read(names))
        (value,) = w.get(known)
        assert w.set(**{known: value + 0.5}) == OK
        after = np.frombuffer(w.read(names))
        assert w.set(**{known: value}) == OK
        for k in np.flatnonzero(after != before):
            measured[names[k]].add(known)
    declared = {u.variable.name: {v.name for v in u.dependencies} for u in description.outputs}
    assert declared == measured
    assert declared != measured | {"theta": {"M_1"}}  # a false algebraic loop would be seen
