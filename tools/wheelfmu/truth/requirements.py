"""What is asked of the FMU: the upper bounds of the reports' figures, requirements.csv. Tests read them too."""

import csv
from pathlib import Path

FILE = Path(__file__).with_name("requirements.csv")


def asked(report: str, figure: str) -> float:
    with FILE.open(encoding="utf-8", newline="") as file:
        bounds = {(row["report"], row["figure"]): row["asked"] for row in csv.DictReader(file)}
    return float(bounds[report, figure])
