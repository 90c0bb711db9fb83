"""Small tables of other people's numbers: tests/others/*.csv; lines that begin with # name their source."""

from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray


def read(name: str) -> dict[str, NDArray[np.float64]]:
    """Columns by name."""
    table = pd.read_csv(Path(__file__).with_name(f"{name}.csv"), comment="#", dtype=float)
    return {column: table[column].to_numpy() for column in table}
