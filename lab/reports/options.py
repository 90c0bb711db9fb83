"""The arguments of ./scripts/report, read before anything is built or installed."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, Parser, suggestion

DESCRIPTION = """Measures, and writes the page NAME.md, its pictures and its data into build/report/latest, or with
--publish into docs/results, which is kept under version control."""
EXAMPLES = ROOT / "examples"
OF = {"vehicles": "vehicles", "others": "vehicles"}  # may be deleted
EVERY = "accuracy stability speed vehicles others validation physics"
NAMES = tuple(name for name in EVERY.split() if (EXAMPLES / OF.get(name, "")).exists())


def report(name: str) -> str:
    """A name; Fault if there is none such."""
    if name not in (*NAMES, "all"):
        meant = suggestion(name, dict.fromkeys(NAMES, ""))
        raise Fault(f'there is no report "{name}"; there are {", ".join(NAMES)} and all.{meant}')
    return name


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    parser = Parser(prog="./scripts/report", description=DESCRIPTION)
    parser.add_argument("names", nargs="+", metavar="NAME", type=report, help=", ".join((*NAMES, "all")))
    target = parser.add_mutually_exclusive_group()
    target.add_argument("--publish", action="store_true", help="write into docs/results")
    target.add_argument("--quick", action="store_true", help="fewer cases, into build/report/quick")
    parser.add_argument("--render", action="store_true", help="measure nothing: write pages from the data in docs/")
    parser.add_argument("--check", action="store_true", help="change nothing: exit status 1 where page and data differ")
    return parser.parse_args(words)
