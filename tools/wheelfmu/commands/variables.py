"""Renumbers modelDescription.xml after a variable has been added, moved or removed.

It writes the value references of new variables, all indices, the GUID, ModelStructure with the dependencies measured on
the built FMU, and the tables of docs/variables.md and of the FMU's page. Give a new variable no valueReference, and
leave ModelStructure as it is. If a step fails, nothing is changed."""

from argparse import Namespace

from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT

CHECK = "change and build nothing, and exit with status 1 if a number or a table is stale"
OPTIONS = {"--check": {"action": "store_true", "help": CHECK}}
DESCRIPTION, FMU = ROOT / "modelDescription.xml", ROOT / "build" / "release" / "wheel.fmu"


def read() -> str:
    return DESCRIPTION.read_text(encoding="utf-8")


def write(text: str) -> None:
    if text != read():  # else nothing is built anew
        DESCRIPTION.write_text(text, encoding="utf-8")


def renew() -> None:
    from wheelfmu.fmu.description import measuring, numbering

    write(numbering.numbered(read()))
    build("release")
    counted = numbering.with_event_indicators(read(), measuring.event_indicators(FMU))
    write(numbering.numbered(counted, measuring.measured(FMU)))
    build("release")


def main(given: Namespace) -> int:
    from wheelfmu.fmu.description import numbering
    from wheelfmu.publishing import variables

    kept = read()
    if given.check:
        stale = numbering.numbered(kept) != kept
        return int(variables.fill(check=True) or stale)
    done = False
    try:
        renew()
        variables.fill()
        done = True
    finally:
        if not done:
            write(kept)
    return 0
