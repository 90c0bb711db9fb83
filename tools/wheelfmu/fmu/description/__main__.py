"""Numbers modelDescription.xml: value references, indices, ModelStructure and the GUID. For scripts/variables."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from . import numbering

DESCRIPTION = Path(__file__).resolve().parents[4] / "modelDescription.xml"

parser = argparse.ArgumentParser(prog="scripts/variables", description=__doc__)
parser.add_argument("--check", action="store_true", help="change nothing; exit status 1 if a number is stale")
parser.add_argument("--measure", type=Path, metavar="FMU", help="take dependencies and event indicators from this FMU")
arguments = parser.parse_args()
text, depends = DESCRIPTION.read_text(encoding="utf-8"), None
if arguments.measure:
    from . import measuring

    depends = measuring.measured(arguments.measure)
    text = numbering.with_event_indicators(text, measuring.event_indicators(arguments.measure))
fresh = numbering.numbered(text, depends)
if arguments.check:
    sys.exit(fresh != text)
if fresh != DESCRIPTION.read_text(encoding="utf-8"):
    DESCRIPTION.write_text(fresh, encoding="utf-8")
