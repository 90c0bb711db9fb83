"""The shared tables of the paper's two scenes: ../shared/reference, beside the project."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "reference"


def read_table(name: str) -> dict[str, NDArray[np.float64]]:
    """Columns of `name`.csv by name: paper_free, paper_friction, paper_friction_events."""
    table = np.genfromtxt(FOLDER / f"{name}.csv", delimiter=",", names=True)
    return {column: table[column] for column in table.dtype.names}
