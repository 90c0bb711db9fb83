"""Numbers modelDescription.xml anew after a variable has been added, moved or removed: value references, indices, GUID,
ModelStructure with the dependencies measured on the built FMU, and the tables of docs/variables.md and of the FMU's
page. Give a new variable no valueReference, and leave ModelStructure as it is. Numbers, builds, measures, builds
again; a step that fails changes nothing."""

from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT

CHECK = "changes nothing and builds nothing; exit status 1 if a number or a table is stale"
OPTIONS = {"--check": {"action": "store_true", "help": CHECK}}


def number(*options: str) -> None:
    processes.check(*processes.python("wheelfmu.fmu.description", *options))


def tables(*options: str) -> None:
    processes.check(*processes.python("wheelfmu.publishing.variables", *options))


def main(given: Namespace) -> None:
    if given.check:
        number("--check")
        tables("--check")
        return
    description, done = ROOT / "modelDescription.xml", False
    kept = description.read_bytes()
    try:
        number()
        build("release")
        number("--measure", "build/release/wheel.fmu")
        build("release")
        tables()
        done = True
    finally:
        if not done:
            description.write_bytes(kept)
