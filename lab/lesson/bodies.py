"""Bodies in motion out of result files: wheels, and a car's body, from the CSV that `fmpy simulate` writes.

SI units, fixed axes X, Y, Z, Z up, angles in rad and not wrapped. A column `name.X_O` belongs to the body `name`;
columns without such a prefix are one wheel, called as the file.
"""

from collections import defaultdict
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wheelfmu.diagrams.start_values import variables
from wheelfmu.fmu.csv_file import Table, read_table
from wheelfmu.fmu.values import Fault

Array = NDArray[np.float64]
POSE = ("X_O", "Y_O", "psi", "theta", "phi")
SHOWN = ("Z_O", "omega_z", "friction_mode", "n_events", "lambda_1", "lambda_2", "lambda_3", "E")
SLIDING = ("slip_x", "slip_y")
GUIDED = ("M_guide_1", "M_guide_2")
RATES = tuple(f"{name}_dot" for name in (*POSE, "Z_O"))
PARAMETERS = tuple(variables("parameter"))
BODY_POSE = ("X", "Y", "Z", "yaw", "pitch", "roll")
ALIASES = {"psi": "yaw", "theta": "pitch", "phi": "roll"}  # of a car's body
PAPER_WHEEL = (0.3, 0.05)  # r_0, r in m, (27)


@dataclass(frozen=True)
class Body:
    """A wheel (size None) or a box (size: length, width, height in m), one row per communication point.

    parameters: a wheel's values that do not change, among them r_0 and r, as far as they are known.
    """

    name: str
    columns: dict[str, Array]
    parameters: dict[str, float] = field(default_factory=dict)
    size: tuple[float, float, float] | None = None
    label: str = ""


def numbers(table: Table, name: str) -> Array:
    """One column as finite numbers."""
    values = np.array(table.numbers(name))
    if not np.isfinite(values).all():
        line = table.lines[int(np.argmin(np.isfinite(values)))]
        raise Fault(f"{table.path}, line {line}: {name} is not finite.")
    return values


def read_bodies(path: Path, given: dict[str, float] | None = None, box: tuple | None = None) -> list[Body]:
    """All bodies of one file. given: parameters in the place of the file's; box: size of a car's body in m."""
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
    bodies = []
    for prefix, group in groups.items():
        rolls = group.keys() >= set(POSE)
        if not rolls:
            group = {ALIASES.get(short, short): column for short, column in group.items()}
        wanted = (*POSE, *SHOWN, *SLIDING, *GUIDED, *RATES, *PARAMETERS) if rolls else BODY_POSE
        if rolls or group.keys() >= {"X", "Y", "Z"}:
            columns = {short: numbers(table, group[short])[kept] for short in wanted if short in group}
            body = Body(prefix or path.stem, {"time": time[kept]} | columns)
            bodies.append(make_wheel(body, given or {}) if rolls else body)
        elif not prefix and len(groups) == 1:
            raise Fault(f"{path} lacks the column {', '.join(short for short in POSE if short not in group)}.")
    if not bodies:
        raise Fault(f"{path} holds no body: a wheel needs the columns {', '.join(POSE)}, a car's body X, Y, Z.")
    wheels = [body for body in bodies if body.parameters]
    return [body if body.parameters else make_box(body, wheels, box) for body in bodies]


def make_wheel(wheel: Body, given: dict[str, float]) -> Body:
    """The columns that hold a parameter become its value."""
    fixed = wheel.columns.keys() & set(PARAMETERS)
    values = {name: float(wheel.columns[name][0]) for name in PARAMETERS if name in fixed} | given
    columns = {name: column for name, column in wheel.columns.items() if name not in fixed}
    if not {"r_0", "r"} <= values.keys():
        values |= dict(zip(("r_0", "r"), shape_of(columns), strict=True))
    return replace(wheel, columns=columns, parameters=values)


def make_box(body: Body, wheels: list[Body], box: tuple[float, float, float] | None) -> Body:
    """A car's body; without a given size as long and wide as the wheels' centres stand apart at the start."""
    columns = dict.fromkeys(BODY_POSE, np.zeros_like(body.columns["time"])) | body.columns  # missing angles: 0
    size = box or (1.0, 0.6, 0.4)
    if wheels and not box:
        yaw = columns["yaw"][0]
        apart = np.array([[wheel.columns[name][0] for name in ("X_O", "Y_O")] for wheel in wheels])
        along, across = apart @ [np.cos(yaw), np.sin(yaw)], apart @ [-np.sin(yaw), np.cos(yaw)]
        least = 2 * max(wheel.parameters["r_0"] + wheel.parameters["r"] for wheel in wheels)
        size = max(float(np.ptp(along)), least), max(0.8 * float(np.ptp(across)), 0.5 * least), 0.7 * least
    return replace(body, columns=columns, size=size)


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
