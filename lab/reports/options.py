"""The arguments of ./scripts/report, read before anything is built or installed."""

from __future__ import annotations

import argparse
import ast
from collections.abc import Sequence
from pathlib import Path

from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault, Parser, one_of

DESCRIPTION = """Measures, and writes the page NAME.md, its pictures and its data into build/report/latest, or with
--publish into docs/results. Without NAME it lists the reports and their parts. The exit status is 1 if a figure exceeds
its bound (lab/reports/requirements.csv)."""
LAB = ROOT / "lab"
OF = {"vehicles": ("lab/vehicles", "examples/vehicles")}  # folders that may be absent
NAMES = tuple(
    name
    for name in ("accuracy", "stability", "speed", "vehicles", "others", "validation", "physics")
    if all((ROOT / folder).exists() for folder in OF.get(name, ()))
)
# Modules with further parts of a report, each with the folder of the lab that it measures.
FURTHER = {"speed": ("studies",) * (LAB / "studies").exists()}
GROUPS = {"speed": "reports-speed", "others": "reports-others"}  # of dependencies


def parts(name: str) -> dict[str, str]:
    """What each part of a report measures, as its source says."""
    found = {}
    for module in (name, *FURTHER.get(name, ())):
        source = Path(__file__).with_name(f"{module}.py").read_text(encoding="utf-8")
        for node in ast.parse(source).body:
            if isinstance(node, ast.FunctionDef) and any(
                isinstance(mark, ast.Call) and isinstance(mark.func, ast.Name) and mark.func.id == "part"
                for mark in node.decorator_list
            ):
                found[node.name] = (ast.get_docstring(node) or "").splitlines()[0]
    return found


def listing() -> str:
    """Every report that is here, with its parts."""
    lines = []
    for name in NAMES:
        lines += [name, *(f"  {part:<16} {words}" for part, words in parts(name).items())]
    return "\n".join(lines)


def report(name: str) -> str:
    """A name; Fault if there is none such."""
    return one_of((*NAMES, "all"), name, "report")


def needs(given: argparse.Namespace) -> list[str]:
    """The groups of dependencies of what is to be measured."""
    if given.render or given.check:
        return ["reports"]
    own = {GROUPS[name] for name in given.names if name in GROUPS}
    if "studies" in FURTHER["speed"] and "speed" in given.names:
        own = {"studies"} if given.part == "studies" else own if given.part else own | {"studies"}
    return ["reports", *sorted(own)] if given.names else []


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    parser = Parser(prog="./scripts/report", description=DESCRIPTION)
    parser.add_argument("names", nargs="*", metavar="NAME", type=report, help=", ".join((*NAMES, "all")))
    parser.add_argument("--part", metavar="PART", help="measure this part of one report alone; other data stay")
    target = parser.add_mutually_exclusive_group()
    target.add_argument("--publish", action="store_true", help="write into docs/results")
    target.add_argument("--quick", action="store_true", help="fewer cases, into build/report/quick")
    parser.add_argument("--render", action="store_true", help="measure nothing: write pages from the data in docs/")
    parser.add_argument("--check", action="store_true", help="change nothing: exit status 1 where page and data differ")
    given = parser.parse_args(words)
    given.names = list(NAMES) if "all" in given.names else list(dict.fromkeys(given.names))
    if not given.names and (given.part or given.publish or given.quick or given.render or given.check):
        raise Fault(f"which report? There are {', '.join(NAMES)} and all.")
    if given.part:
        if len(given.names) != 1 or given.render or given.check:
            raise Fault("--part measures a part of one report.")
        (name,) = given.names
        given.part = one_of(parts(name), given.part, f"part of {name}")
    return given
