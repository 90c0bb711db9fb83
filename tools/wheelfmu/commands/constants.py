"""Halves and doubles each chosen constant of the solver, and writes the consequences into docs/constants.md.

./scripts/constants           fails if a constant leads beyond the stated factors
./scripts/constants --check   does the same but writes nothing
"""

import sys
from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT

PAGE = ROOT / "docs" / "constants.md"
NEEDS = ("test",)
OPTIONS = {"--check": {"action": "store_true", "help": "writes nothing"}}


def main(given: Namespace) -> None:
    from fmpy import extract  # noqa: PLC0415

    from wheelfmu.publishing.markdown import page  # noqa: PLC0415
    from wheelfmu.truth import constants  # noqa: PLC0415

    build("constants")
    chosen = constants.constants()
    table = constants.measured(extract(str(ROOT / "build" / "constants" / "wheel.fmu")), chosen)
    if not given.check:
        PAGE.write_text(page("constants.md.j2", **constants.described(chosen, table)), encoding="utf-8")
    beyond = constants.beyond(table)
    print(*(f"{name} x {factor:g}: {said}" for name, factor, said in beyond), sep="\n", file=sys.stderr)
    if beyond:
        raise processes.Failed(1)
    print(f"{len(chosen)} constants, halved and doubled: within the stated factors.")
