"""Random mutants of the core, judged by the quick tests; docs/results/mutants.md tells what share of them is noticed.

A copy of the project for each core; the tests that noticed most for the time that they take run first, and the first
failure ends a mutant. Mutants that do not compile or leave the library as it was, bit by bit, do not count.
Each survivor has a line in survivors.csv, which says why it may stay. An interrupted run goes on where it stopped: what
was judged stands in build/mutants/random.csv. It is kept as long as that file of the core is the same; survivors are
judged again where the tests have changed.
"""

from __future__ import annotations

import csv
import hashlib
import os
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import NamedTuple

from mutants.copies import FOLDERS, ROOT, THE_BUILD, Copy
from mutants.named import usual_failures
from mutants.syntax import Mutant, sample

LOG, REASONS = ROOT / "build" / "mutants" / "random.csv", Path(__file__).with_name("survivors.csv")
PAGE, DATA = ROOT / "docs" / "results" / "mutants.md", ROOT / "docs" / "results" / "data" / "mutants.csv"
AT_FIRST = 6  # files of tests that are asked before all others
BATCH = 100  # judged between two writings of the page
SPARE = 1.4  # drawn for each that is wanted, more than enough: some do not compile or change nothing


class Judged(NamedTuple):
    """One mutant that counts: where, the line of code, the change, the test that noticed (empty: it survived)."""

    file: str
    code: str
    change: str
    killed_by: str


class Judge:
    """Copies of the project, and which tests have noticed how much."""

    def __init__(self, cores: int) -> None:
        self.cores = cores
        self.copies: Queue[Copy] = Queue()
        self.noticed: Counter[tuple[str, str]] = Counter()  # (file of the core or "", file of tests)
        with ThreadPoolExecutor(cores) as pool:
            for copy in pool.map(Copy, range(cores)):
                self.copies.put(copy)
        self.usual = usual_failures(copy, copy.suite())
        self.seconds = copy.seconds()

    def order(self, files: list[str], mutated: str) -> list[str]:
        """By what they noticed in a second: in this file of the core, and, for a tenth, in all."""

        def worth(file: str) -> float:
            return (self.noticed[mutated, file] + self.noticed["", file] / 10 + 0.1) / (self.seconds[file] + 0.3)

        return sorted(files, key=worth, reverse=True)

    def note(self, judged: Judged) -> None:
        for file in (judged.file, ""):
            self.noticed[file, judged.killed_by.split("::")[0]] += 1

    def killer(self, copy: Copy, mutated: str) -> str:
        if not copy.packs():
            return THE_BUILD
        files = self.order(copy.suite(mutated), mutated)
        return copy.failure(files[:AT_FIRST], self.usual) or copy.failure(files[AT_FIRST:], self.usual)

    def __call__(self, mutant: Mutant) -> Judged | None:
        copy = self.copies.get()
        source = copy.source(mutant.file)
        text = source.read_bytes()
        try:
            source.write_bytes(text[: mutant.begin] + mutant.new.encode() + text[mutant.end :])
            if not copy.compiles() or copy.digest() == copy.binary:
                return None
            killer = self.killer(copy, mutant.file)
        finally:
            source.write_bytes(text)
            self.copies.put(copy)
        judged = Judged(mutant.file, code_of(text, mutant.line), mutant.title(), killer)
        self.note(judged)
        return judged


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
    equal = sum(why.get(j[:3], "").startswith("equivalent") for j in survivors)
    share, of_others = (100 * sum(killed.values()) / max(1, count) for count in (len(judged), len(judged) - equal))
    lines = [
        "# Random faults, and what the quick tests notice of them\n",
        f"{len(judged)} random changes of `fmu-src` that compile and change the library, judged by the build and",
        f"the tests of `./scripts/test quick`, up to the first that fails: {share:.1f} % are noticed; without the",
        f"{equal} survivors that are equivalent, which no test can notice, {of_others:.1f} %.",
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


def code_of(text: bytes, line: int) -> str:
    return " ".join(text.decode().split("\n")[line - 1].split())


def key_of(mutant: Mutant) -> str:
    """The change and the file that it changes."""
    text = (ROOT / "fmu-src" / mutant.file).read_bytes()
    return f"{hashlib.sha256(text).hexdigest()[:16]} {mutant.begin} {mutant.end} {mutant.new}"


def digest_of_tests() -> str:
    folders = [ROOT / "tests" / name for name in (*FOLDERS, "support", "reference")]
    files = sorted(path for folder in folders for path in folder.rglob("*.py"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:16]


def known(tests: str) -> dict[str, Judged | None]:
    """What an earlier run judged; None: a change that does not count. `tests`: their digest."""
    if not LOG.exists():
        return {}
    with LOG.open(newline="", encoding="utf-8") as file:
        rows = [(key, judged_by, Judged(*judged) if judged else None) for key, judged_by, *judged in csv.reader(file)]
    return {key: judged for key, by, judged in rows if by == tests or judged is None or judged.killed_by}


def judge_all(drawn: list[Mutant], found: dict[str, Judged | None], judge: Judge, tests: str) -> list[Judged]:
    missing = [mutant for mutant in drawn if key_of(mutant) not in found]
    with LOG.open("a", newline="", encoding="utf-8") as file, ThreadPoolExecutor(judge.cores) as pool:
        log = csv.writer(file, lineterminator="\n")
        for mutant, judged in zip(missing, pool.map(judge, missing), strict=True):
            found[key_of(mutant)] = judged
            log.writerow([key_of(mutant), tests, *(judged or ())])
            file.flush()
            if judged:
                print(f"{judged.file}: {judged.change}: {judged.killed_by or 'SURVIVED'}", flush=True)
    return [judged for mutant in drawn if (judged := found[key_of(mutant)])]


def main(count: int, seed: int) -> int:
    judge, tests = Judge(len(os.sched_getaffinity(0))), digest_of_tests()
    found = known(tests)
    for judged_before in filter(None, found.values()):
        judge.note(judged_before)
    drawn = sample(ROOT, ROOT / "build" / "release", int(SPARE * count), seed)
    judged: list[Judged] = []
    for begin in range(0, len(drawn), BATCH):
        if len(judged) >= count:
            break
        batch = sorted(drawn[begin : begin + BATCH])  # a file at a time: less to build again
        judged += judge_all(batch, found, judge, tests)
        write(judged)
    without = [j for j in judged if not j.killed_by and not reasons().get(j[:3])]
    survived = sum(not j.killed_by for j in judged)
    print(f"{len(judged)} mutants, {survived} survived, {len(without)} of these without a reason.")
    return 0
