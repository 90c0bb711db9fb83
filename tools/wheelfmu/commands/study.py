"""Runs many wheels on all cores or on a Dask cluster: a grid or a list of start values and parameters
(docs/studies.md)."""

from argparse import Namespace

from wheelfmu.commands.build import fmu
from wheelfmu.fmu.values import Fault
from wheelfmu.studies import StudyError, options

PART, STAYS, FINISHES, NEEDS = "examples/studies", True, True, ("study",)


def reads(words: list[str]) -> Namespace:
    try:
        return options.arguments_of(words)
    except StudyError as fault:
        raise Fault(fault) from None


def main(given: Namespace) -> int:
    from wheelfmu.studies.__main__ import carried_out

    fmu()
    return carried_out(given)
