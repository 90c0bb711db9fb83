"""Runs many wheels on all cores or on a Dask cluster: a grid or a list of start values and parameters
(docs/studies.md)."""

from argparse import Namespace

from wheelfmu.commands.build import fmu
from wheelfmu.studies.options import arguments_of as reads  # noqa: F401 - by __main__

PART, STAYS, FINISHES, NEEDS = "examples/studies", True, True, ("study",)


def main(given: Namespace) -> int:
    from wheelfmu.studies.__main__ import carried_out

    fmu()
    return carried_out(given)
