"""Runs an SSP package in OMSimulator: python by_omsimulator.py EXECUTABLE PACKAGE STEP STOP COMPONENT.VARIABLE...

Prints the variables' values at the end, one a line. The package says itself that the step is fixed and how long it is;
STEP only spaces the rows of the result.
"""

from __future__ import annotations

import csv
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory


def main() -> None:
    """One run in a separate folder, where OMSimulator unpacks."""
    program, package, step, stop, *wanted = sys.argv[1:]
    with TemporaryDirectory() as folder:
        rows = round(float(stop) / float(step))
        options = ["--mode=cs", f"--intervals={rows}", f"--stopTime={stop}", "--resultFile=result.csv"]
        done = subprocess.run(
            [program, *options, str(Path(package).resolve())], cwd=folder, capture_output=True, text=True
        )
        result = Path(folder) / "result.csv"
        if done.returncode or not result.exists():
            raise RuntimeError(f"OMSimulator said:\n{done.stdout}{done.stderr}")
        with result.open() as file:
            head, *table = csv.reader(file, skipinitialspace=True)
    for name in wanted:
        column = next(i for i, title in enumerate(head) if title.endswith(f".{name}"))
        print(name, repr(float(table[-1][column])))


if __name__ == "__main__":
    main()
