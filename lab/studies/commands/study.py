"""Runs many wheels on all cores or on a Dask cluster: a grid or a list of start values and parameters
(lab/studies/README.md)."""

from argparse import Namespace

from lab.studies.options import INTERRUPTED  # noqa: F401 - by __main__
from lab.studies.options import arguments_of as reads  # noqa: F401
from wheelfmu.commands.build import fmu

STAYS, FINISHES, NEEDS = True, True, ("studies",)


def main(given: Namespace) -> int:
    from lab.studies.__main__ import carried_out

    fmu()
    return carried_out(given)
