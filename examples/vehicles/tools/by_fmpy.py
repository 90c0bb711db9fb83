"""Runs an SSP package in fmpy.ssp: python by_fmpy.py PACKAGE STEP STOP COMPONENT.VARIABLE... (package fmpy).

Prints the variables' values at the end, one a line.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from vehicles.ssp import run  # noqa: E402


def main() -> None:
    """One run."""
    package, step, stop, *wanted = sys.argv[1:]
    columns = run(Path(package), float(step), float(stop), float(step))
    for name in wanted:
        print(name, repr(float(columns[name][-1])))


if __name__ == "__main__":
    main()
