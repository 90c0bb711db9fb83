"""The trusted tables of the paper's two scenes, made by this reference: python -m wheelfmu.truth.reference.tables.

paper_free.csv and paper_friction.csv: every 0.1 s of 10 s. paper_friction_events.csv: the instants at which the
friction changes its mode (sign of omega_z, 0 held), the first line being the start. SI.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .integrate import solve
from .model import Start, Wheel
from .outputs import Solution

FOLDER = Path(__file__).resolve().parent
SCENES = {"free": Wheel(), "friction": Wheel(s=0.03)}
COLUMNS = (
    *("X_O", "Y_O", "theta", "psi_dot", "theta_dot", "phi_dot", "omega_z"),
    *("lambda_1", "lambda_2", "lambda_3", "E"),
)
TOLERANCE = 1e-13


def read_table(name: str) -> dict[str, NDArray[np.float64]]:
    """Columns of `name`.csv by name: paper_free, paper_friction, paper_friction_events."""
    table = np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True)
    return {column: table[column] for column in table.dtype.names or ()}


def read_transitions() -> list[tuple[float, int]]:
    """Instant, and mode after it; the first is the start."""
    table = read_table("paper_friction_events")
    return list(zip(table["t"].tolist(), table["mode"].astype(int).tolist(), strict=True))


def solution(scene: str) -> Solution:
    return solve(SCENES[scene], Start(), np.linspace(0, 10, 101), rtol=TOLERANCE)


def write_table(path: Path, columns: dict[str, NDArray[np.float64]]) -> None:
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, fmt="%.12g", delimiter=",", header=",".join(columns), comments="")


def main() -> None:
    for scene in SCENES:
        found = solution(scene)
        write_table(FOLDER / f"paper_{scene}.csv", {"t": found.t, **{name: found[name] for name in COLUMNS}})
    events = np.array(found.events)
    write_table(FOLDER / "paper_friction_events.csv", {"t": events[:, 0], "mode": events[:, 1]})


if __name__ == "__main__":
    main()
