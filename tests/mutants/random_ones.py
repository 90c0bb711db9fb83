"""Random mutants of the core, judged by the quick tests; docs/results/mutants.md tells what share of them is noticed.

A copy of the project for each core; the tests that noticed most so far run first, and the first failure ends a mutant.
Mutants that do not compile or leave the library as it was, bit by bit, do not count. Each survivor has a line in
survivors.csv, which says why it may stay.
"""

from __future__ import annotations

import csv
import os
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import NamedTuple

from mutants.copies import ROOT, Copy
from mutants.named import usual_failures
from mutants.syntax import Mutant, sample

LOG, REASONS = ROOT / "build" / "mutants" / "random.csv", Path(__file__).with_name("survivors.csv")
PAGE, DATA = ROOT / "docs" / "results" / "mutants.md", ROOT / "docs" / "results" / "data" / "mutants.csv"
AT_FIRST = 6  # files of tests that are asked before all others
SPARE = 1.4  # drawn for each that is wanted: some do not compile or change nothing


class Judged(NamedTuple):
    """One mutant that counts: where, the line of code, the change, the test that noticed (empty: it survived)."""

    file: str
    code: str
    change: str
    killed_by: str


class Judge:
    """Copies of the project, and which tests have noticed how much."""

    def __init__(self) -> None:
        self.copies: Queue[Copy] = Queue()
        self.noticed: Counter[str] = Counter()
        self.usual: list[str] = []

    def prepare(self, cores: int) -> None:
        with ThreadPoolExecutor(cores) as pool:
            for copy in pool.map(Copy, range(cores)):
                self.copies.put(copy)
        self.usual = usual_failures(copy, copy.suite())

    def __call__(self, mutant: Mutant) -> Judged | None:
        copy = self.copies.get()
        source = copy.source(mutant.file)
        text = source.read_bytes()
        try:
            source.write_bytes(text[: mutant.begin] + mutant.new.encode() + text[mutant.end :])
            if not copy.build() or copy.digest() == copy.binary:
                return None
            files = sorted(copy.suite(), key=lambda file: -self.noticed[file])
            killer = copy.failure(files[:AT_FIRST], self.usual) or copy.failure(files[AT_FIRST:], self.usual)
        finally:
            source.write_bytes(text)
            self.copies.put(copy)
        self.noticed[killer.split("::")[0]] += 1
        code = " ".join(text.decode().split("\n")[mutant.line - 1].split())
        return Judged(mutant.file, code, mutant.title(), killer)


def reasons() -> dict[tuple[str, str, str], str]:
    if not REASONS.exists():
        return {}
    with REASONS.open(newline="", encoding="utf-8") as file:
        return {(row["file"], row["code"], row["change"]): row["reason"] for row in csv.DictReader(file)}


def write(judged: list[Judged]) -> None:
    """The data and the page."""
    total, killed = Counter(j.file for j in judged), Counter(j.file for j in judged if j.killed_by)
    rows = [(file, total[file], killed[file]) for file in sorted(total)]
    with DATA.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([("file", "mutants", "killed"), *rows])
    why = reasons()
    survivors = [j for j in judged if not j.killed_by]
    share = 100 * sum(killed.values()) / max(1, len(judged))
    lines = [
        "# Random faults, and what the quick tests notice of them\n",
        f"{len(judged)} random changes of `fmu-src` that compile and change the library, judged by the tests of",
        f"`./scripts/test quick`, up to the first that fails: {share:.1f} % are noticed.",
        "`./scripts/mutants` makes this page.\n",
        "| file | mutants | noticed |\n|---|---|---|",
        *(f"| {file} | {count} | {noticed} |" for file, count, noticed in rows),
        f"| all | {len(judged)} | {sum(killed.values())} |\n",
        "## Survivors\n",
        "| file | line of code | change | why it stays |\n|---|---|---|---|",
        *(f"| {j.file} | `{cell(j.code)}` | `{cell(j.change)}` | {why.get(j[:3], '')} |" for j in survivors),
    ]
    PAGE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def cell(code: str) -> str:
    return code.replace("|", "\\|").replace("`", "")


def main(count: int, seed: int) -> int:
    judge, judged = Judge(), []
    cores = len(os.sched_getaffinity(0))
    judge.prepare(cores)
    drawn = sample(ROOT, ROOT / "build" / "release", int(SPARE * count), seed)
    drawn.sort()  # a file at a time: less to build again
    with LOG.open("w", newline="", encoding="utf-8") as file, ThreadPoolExecutor(cores) as pool:
        log = csv.writer(file, lineterminator="\n")
        for verdict in pool.map(judge, drawn):
            if verdict:
                judged.append(verdict)
                log.writerow(verdict)
                file.flush()
                print(f"{len(judged)}: {verdict.file}: {verdict.change}: {verdict.killed_by or 'SURVIVED'}", flush=True)
    write(judged)
    without = [j for j in judged if not j.killed_by and not reasons().get(j[:3])]
    survived = sum(not j.killed_by for j in judged)
    print(f"{len(judged)} mutants, {survived} survived, {len(without)} of these without a reason.")
    return 0
