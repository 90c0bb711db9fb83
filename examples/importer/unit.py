"""One wheel.fmu through plain FMPy, for the scripts of this folder: from the file to the first communication point."""

import sys
from pathlib import Path

from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi2 import FMU2Slave

FMU = Path(sys.argv[1] if sys.argv[1:] else Path(__file__).parents[2] / "wheel.fmu")
FOLDER = extract(str(FMU))
DESCRIPTION = read_model_description(FOLDER)
REFERENCE = {v.name: v.valueReference for v in DESCRIPTION.modelVariables}


def wheel(**start: float) -> FMU2Slave:
    """A wheel at t = 0 with these real start values, tolerance 1e-8."""
    unit = instantiate_fmu(FOLDER, DESCRIPTION, "CoSimulation")
    unit.setReal(references(*start), list(start.values()))
    unit.setupExperiment(tolerance=1e-8, startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    return unit


def references(*names: str) -> list[int]:
    return [REFERENCE[name] for name in names]


def read(unit: FMU2Slave, *names: str) -> list[float]:
    return unit.getReal(references(*names))


def verdict(passed: bool, what: str) -> None:
    """Prints pass or fail; the exit status is the same."""
    print(f"{'pass' if passed else 'fail'}: {what}")
    sys.exit(not passed)
