"""Small tables of other people's numbers: tests/others/*.csv; lines that begin with # name their source."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def read(name: str) -> dict[str, NDArray[np.float64]]:
    """Columns by name."""
    path = Path(__file__).with_name(f"{name}.csv")
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    header, rows = lines[0].split(","), np.array([line.split(",") for line in lines[1:]], dtype=float)
    return dict(zip(header, rows.T, strict=True))
