"""Wheels in motion out of result files, from the CSV that `fmpy simulate` writes.

SI units, fixed axes X, Y, Z, Z up, angles in rad and not wrapped. A column `name.X_O` belongs to the wheel `name`;
columns without such a prefix are one wheel, called as the file. All other columns stay unread.
"""

from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wheelfmu.fmu.csv_file import Table, read_table
from wheelfmu.fmu.values import Fault, variables

Array = NDArray[np.float64]
POSE = ("X_O", "Y_O", "psi", "theta", "phi")
SHOWN = ("Z_O", "omega_z", "friction_mode", "n_events", "lambda_1", "lambda_2", "lambda_3", "E")
MORE = ("slip_x", "slip_y", "v_x", "v_y", "lambda_x", "lambda_y", "M_guide_1", "M_guide_2")
RATES = tuple(f"{name}_dot" for name in (*POSE, "Z_O"))
PARAMETERS = tuple(variables("parameter"))
PAPER_WHEEL = (0.3, 0.05)  # r_0, r in m, (27)


@dataclass(frozen=True)
class Body:
    """A wheel, one row per communication point.

    parameters: its values that do not change, among them r_0 and r, as far as they are known.
    """

    name: str
    columns: dict[str, Array]
    parameters: dict[str, float] = field(default_factory=dict)
    label: str = ""


def numbers(table: Table, name: str) -> Array:
    """One column as finite numbers."""
    values = np.array(table.numbers(name))
    if not np.isfinite(values).all():
        line = table.lines[int(np.argmin(np.isfinite(values)))]
        raise Fault(f"{table.path}, line {line}: {name} is not finite.")
    return values


def read_bodies(path: Path, given: dict[str, float] | None = None) -> list[Body]:
    """All wheels of one file. given: parameters in the place of the file's."""
    table = read_table(path)
    if "time" not in table.columns:
        raise Fault(f"{path} has no column time; a file as `fmpy simulate --output-file` writes it is needed.")
    time = numbers(table, "time")
    if not (np.diff(time) >= 0).all():
        raise Fault(f"{path}: the column time does not rise.")
    if time[-1] == time[0]:
        raise Fault(f"{path} has no motion to show: all rows are of one instant.")
    kept = np.append(np.diff(time) > 0, True)  # of two rows at one instant the later
    groups: dict[str, dict[str, str]] = defaultdict(dict)
    for name in filter("time".__ne__, table.columns):
        prefix, _, short = name.rpartition(".")
        groups[prefix][short] = name
    found = []
    for prefix, group in groups.items():
        if group.keys() >= set(POSE):
            wanted = (*POSE, *SHOWN, *MORE, *RATES, *PARAMETERS)
            columns = {short: numbers(table, group[short])[kept] for short in wanted if short in group}
            found.append(make_wheel(Body(prefix or path.stem, {"time": time[kept]} | columns), given or {}))
        elif not prefix and len(groups) == 1:
            raise Fault(f"{path} lacks the column {', '.join(short for short in POSE if short not in group)}.")
    if not found:
        raise Fault(f"{path} holds no wheel, which needs the columns {', '.join(POSE)}.")
    return found


def make_wheel(wheel: Body, given: dict[str, float]) -> Body:
    """The columns that hold a parameter become its value."""
    fixed = wheel.columns.keys() & set(PARAMETERS)
    values = {name: float(wheel.columns[name][0]) for name in PARAMETERS if name in fixed} | given
    columns = {name: column for name, column in wheel.columns.items() if name not in fixed}
    if not {"r_0", "r"} <= values.keys():
        values |= dict(zip(("r_0", "r"), shape_of(columns), strict=True))
    return replace(wheel, columns=columns, parameters=values)


def shape_of(columns: dict[str, Array]) -> tuple[float, float]:
    """r_0 and r in m from contact, Z_O = r_0 sin theta + r (32); the paper's proportions where theta hardly changes."""
    r_0, r = PAPER_WHEEL
    if "Z_O" not in columns:
        return PAPER_WHEEL
    rise = np.sin(columns["theta"])
    if np.ptp(rise) < 1e-4:
        scale = float(columns["Z_O"].mean() / (r_0 * rise.mean() + r))
        return r_0 * scale, r * scale
    r_0, r = np.polyfit(rise, columns["Z_O"], 1)
    if not (r_0 > 0 and r > -1e-6 * r_0):
        return PAPER_WHEEL
    return float(r_0), float(r) if r > 1e-6 * r_0 else 0.0
