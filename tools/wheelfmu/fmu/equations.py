"""The equations module for tests: wheel_equations.py, and functions that work on whole tables.

Names, order, frames and units are those of wheel_equations.h.
"""

from collections.abc import Callable
from ctypes import CFUNCTYPE, Structure, addressof, c_void_p, cast

import numpy as np

from wheelfmu.fmu.wheel_equations import *  # noqa: F403
from wheelfmu.fmu.wheel_equations import Dynamics, Formulation, Kinematics, Motion

PAPER_START = Motion(np.pi / 2, 5 * np.pi / 12, 0, 0, 0, -2, -0.3 * np.cos(5 * np.pi / 12), 0)


def values(record: Structure) -> np.ndarray:
    """All numbers of a record, in the header's order."""
    numbers = [getattr(record, name) for name, _ in record._fields_]
    return np.hstack([np.atleast_1d(np.asarray(x, dtype=float)) for x in numbers])


def each(function: Callable, *tables: np.ndarray, of: tuple[Structure, ...] = ()) -> list:
    """function(*of, row i of every table) for all i; rows go by address, a microsecond a call."""
    assert all(t.flags.c_contiguous for t in tables)
    fixed = [addressof(record) for record in of]
    arguments = [c_void_p] * len((*of, *tables))
    call = CFUNCTYPE(function.restype, *arguments)(cast(function, c_void_p).value)
    starts = [range(t.ctypes.data, t.ctypes.data + t.nbytes, t.strides[0]) for t in tables]
    return [call(*fixed, *addresses) for addresses in zip(*starts, strict=True)]


def table(record: type[Structure], rows: int) -> np.ndarray:
    """A table with one C record per row, zero; its columns are the record's fields."""
    return np.zeros(rows, dtype=np.dtype(record))


def filled(out: np.ndarray, function: Callable, *tables: np.ndarray, of: tuple[Structure, ...] = ()) -> np.ndarray:
    """`out`, of which function(*of, row i of every table, row i of out) has written row i."""
    each(function, *tables, out, of=of)
    return out


def start_each(formulation: Formulation, scenes: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """The wheel is a scene's first field."""
    return filled(np.zeros((len(scenes), formulation.states)), formulation.start, scenes, motions)


def derivative_each(formulation: Formulation, scenes: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """y_dot and the normal force, row by row."""
    y_dot = np.zeros_like(y)
    normal = each(formulation.derivative, scenes, y, y_dot)
    return y_dot, np.array(normal)


def kinematics_each(formulation: Formulation, scenes: np.ndarray, y: np.ndarray) -> np.ndarray:
    return filled(table(Kinematics, len(y)), formulation.kinematics, scenes, y)


def dynamics_each(formulation: Formulation, scenes: np.ndarray, y: np.ndarray) -> np.ndarray:
    return filled(table(Dynamics, len(y)), formulation.dynamics, scenes, y)


def columns(records: np.ndarray, *names: str) -> np.ndarray:
    """Named columns of a table side by side, one row per record."""
    return np.column_stack([records[name] for name in names])
