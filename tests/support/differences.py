"""Derivatives of an instance against differences of its values."""

from collections.abc import Callable, Sequence

import numpy as np

from wheelfmu.fmu.driver import Array, FMU2Wheel

LOADS = ("F_X", "F_Y", "F_Z", "M_1", "M_2", "M_3")


def outputs(w: FMU2Wheel) -> list[str]:
    return [name for name, v in w.variables.items() if v.causality == "output" and v.type == "Real"]


def slope(values: Callable[[float], Sequence[float]], h: float, places: Sequence[int]) -> Array:
    """The derivative at 0 by the values at the places, in steps of h: exact for polynomials through them."""
    powers = np.vander(places, increasing=True).T
    weights = np.linalg.solve(powers, np.eye(len(places))[1])
    return weights @ [values(place * h) for place in places] / h


def difference(w: FMU2Wheel, names: Sequence[str], known: str, h: float, places: Sequence[int] = (-1, 1)) -> Array:
    """d names / d known, about its value, which it has again afterwards."""
    (own,) = w.get(known)
    found = slope(lambda off: w.put(**{known: own + off}).get(*names), h, places)
    w.put(**{known: own})
    return found


def rates(w: FMU2Wheel) -> Array:
    return np.array(w.rates(outputs(w))())


def rate_errors(w: FMU2Wheel, h: float = 2.0**-9) -> dict[str, float]:
    """Of d/dt of all outputs, relative, off the difference of order 6 from here on; leaves the instance here. Inputs
    are polynomials that were just set."""
    blob, exact = w.serialized(), rates(w)
    difference = slope(lambda t: (w.back(blob).by(t) if t else w).get(*outputs(w)), h, range(7))
    w.back(blob)
    return dict(zip(outputs(w), np.abs(exact - difference) / (1 + np.abs(exact)), strict=True))
