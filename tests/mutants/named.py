"""The named faults: each entry of named.toml must be noticed; the table is named.csv.

The tests that are meant to notice run first, all others of the quick tests only if they pass.
"""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from mutants.copies import THE_BUILD, Copy

LIST, TABLE = (Path(__file__).with_suffix(suffix) for suffix in (".toml", ".csv"))


class Fault(NamedTuple):
    """One entry of named.toml."""

    name: str
    file: str
    old: str
    new: str
    tests: list[str]


class Verdict(NamedTuple):
    """One row of named.csv."""

    mutant: str
    killed_by: str  # empty: it survived
    seconds: str


def judge(fault: Fault, copy: Copy, usual: Sequence[str]) -> Verdict:
    """`usual`: the tests that fail without any fault; they tell nothing."""
    begin, source = perf_counter(), copy.source(fault.file)
    text = source.read_text()
    found = text.count(fault.old)
    assert found == 1, f"{fault.name}: {fault.file} holds {fault.old!r} {found} times, not once"
    aimed = [f"tests/{name}" for name in fault.tests]
    source.write_text(text.replace(fault.old, fault.new))
    try:
        assert copy.compiles(), f"{fault.name}: does not compile"
        others = [file for file in copy.suite() if file not in aimed]
        killer = copy.failure(aimed, usual) or copy.failure(others, usual) if copy.packs() else THE_BUILD
    finally:
        source.write_text(text)
    return Verdict(fault.name, killer, f"{perf_counter() - begin:.0f}")


def usual_failures(copy: Copy, tests: Sequence[str]) -> list[str]:
    """What fails of these without a fault."""
    usual: list[str] = []
    while failing := copy.failures(tests, usual):
        assert not set(failing) & set(usual), f"{failing} fail without any fault, even when they are left out"
        usual += failing
    return usual


def main(words: Sequence[str]) -> int:
    faults = [Fault(**entry) for entry in tomllib.loads(LIST.read_text())["mutant"]]
    chosen = [f for f in faults if not words or any(word in f.name for word in words)]
    table = {}
    if TABLE.exists():
        with TABLE.open(newline="") as file:
            table = {row["mutant"]: Verdict(**row) for row in csv.DictReader(file)}
    copy = Copy()
    usual = usual_failures(copy, sorted({f"tests/{name}" for f in chosen for name in f.tests}))
    for fault in chosen:
        verdict = table[fault.name] = judge(fault, copy, usual)
        print(f"{fault.name}: {verdict.killed_by or 'SURVIVED'} ({verdict.seconds} s)", flush=True)
        with TABLE.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([Verdict._fields, *(table[f.name] for f in faults if f.name in table)])
    return sum(not table[f.name].killed_by for f in chosen)
