"""The FMU's variables that a study sets, reads and measures, by their names in modelDescription.xml.

Python's standard library alone.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, Variable, suggestion, variables

SETTABLE, READABLE = ("parameter", "input"), ("output", "local")  # causalities
PLANE, SLIP = "plane_angle", "slip"  # quantities of a measure beside the variables
PLANE_TEXT = "Angle of the wheel's plane to the ground, from 0 to 90 deg on either side: 90 deg - |theta - 90 deg|"
SLIP_TEXT = "Speed of the slip: of the wheel's material point at the contact over the ground, 0 while it rolls"
QUANTITIES = {
    PLANE: Variable(PLANE, "local", "Real", "rad", "", "", "", PLANE_TEXT),
    SLIP: Variable(SLIP, "local", "Real", "m/s", "", "", "", SLIP_TEXT),
}


def description(fmu: Path = ROOT / "wheel.fmu") -> bytes:
    """modelDescription.xml of the FMU or, before it is built, of the project."""
    try:
        return ZipFile(fmu).read("modelDescription.xml")
    except (OSError, BadZipFile, KeyError):
        return (ROOT / "modelDescription.xml").read_bytes()


def variables_of(fmu: Path = ROOT / "wheel.fmu") -> dict[str, Variable]:
    return variables(description=description(fmu))


@cache
def quantities() -> dict[str, Variable]:
    """The variables of the project's FMU, and what a measure takes besides."""
    return variables_of() | QUANTITIES


def in_si(name: str, value: float | str) -> float:
    """A value, or a text as a user types it: `60deg`, `bdf`, `true`; nan for a name that is unknown."""
    if not isinstance(value, str):
        return float(value)
    return quantities()[name].number_of(value) if name in quantities() else math.nan


def counters_of(known: Mapping[str, Variable]) -> list[str]:
    """The FMU's counters: Integer variables whose name begins with n_."""
    return [name for name, v in known.items() if v.type == "Integer" and name.startswith("n_")]


def check_names(names: Iterable[str], causalities: tuple[str, str], known: Mapping[str, Variable]) -> None:
    """Fault about the first name that is not a variable of these causalities."""
    there = {name: v.description or "" for name, v in known.items() if v.causality in causalities}
    for name in names:
        if name not in there:
            hint = suggestion(name, there) or " docs/variables.md lists them."
            kind = "a parameter or input" if causalities == SETTABLE else "an output or local variable"
            raise Fault(f"'{name}' is not {kind} of this FMU.{hint}")
