"""Do the tests notice? Each mutant is the project with one fault in it; some test must fail.

    python tests/robustness/mutants.py [WORD ...]     all, or those whose name contains one of the words

For each entry of mutants.toml a copy of the sources in build/mutants is changed, built and tested up to the first
failure: the tests that are meant to notice first, a wider suite only if they pass. Tests that fail without any fault
are left out. The table is mutants.csv. It takes some ten seconds for each mutant, so it is no part of the default run.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
SCRATCH = ROOT / "build" / "mutants"
BUILD = SCRATCH / "build" / "release"
LIST, TABLE = (Path(__file__).with_suffix(suffix) for suffix in (".toml", ".csv"))
SUITE = ("tests/contract", "tests/robustness", "tests/physics", "tests/equations", "tests/solver")
LONGEST = 600  # s: tests that take longer count as a failure
CORES = str(len(os.sched_getaffinity(0)))


class Mutant(NamedTuple):
    """One entry of mutants.toml."""

    name: str
    file: str
    old: str
    new: str
    tests: list[str]

    def source(self) -> Path:
        return SCRATCH / "fmu-src" / self.file

    def aimed(self) -> tuple[str, ...]:
        return tuple(f"tests/{name}" for name in self.tests)


class Verdict(NamedTuple):
    """One row of mutants.csv."""

    mutant: str
    killed_by: str  # empty: it survived
    seconds: str


def copy_sources() -> None:
    """The sources into the scratch folder; unchanged files keep their times, so that little is built again."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True)
    for name in listed.stdout.splitlines():
        path, target = ROOT / name, SCRATCH / name
        if path.is_file() and not (target.exists() and target.read_bytes() == path.read_bytes()):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target)
    if not (SCRATCH / ".venv").exists():
        (SCRATCH / ".venv").symlink_to(ROOT / ".venv")


def build() -> bool:
    commands = [["cmake", "--build", BUILD, "--parallel", CORES]]
    if not (BUILD / "Makefile").exists():
        sundials = next((ROOT / "build" / "sundials").glob("*/vendor"), "")
        commands.insert(0, ["cmake", "--preset", "release", f"-DWHEEL_SUNDIALS_SOURCE={sundials}"])
    return all(subprocess.run(command, cwd=SCRATCH, capture_output=True).returncode == 0 for command in commands)


def failures(paths: Sequence[str], *options: str) -> list[str]:
    """The tests that fail."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--no-header", "--tb=no", "-rfE"]
    environment = os.environ | {"WHEEL_BUILD": str(BUILD)}
    try:
        done = subprocess.run(
            [*command, *options, *paths], cwd=SCRATCH, env=environment, capture_output=True, text=True, timeout=LONGEST
        )
    except subprocess.TimeoutExpired:
        return ["(no end)"]
    lines = [line.split(" - ")[0].split(maxsplit=1) for line in done.stdout.splitlines()]
    failed = [words[1] for words in lines if words[:1] in (["FAILED"], ["ERROR"]) and len(words) > 1]
    return failed or ([] if done.returncode == 0 else ["(no result)"])


@cache
def failures_without_fault(paths: tuple[str, ...]) -> list[str]:
    assert build(), "the project itself does not build"
    return failures(paths)


def first_failure(mutant: Mutant, paths: tuple[str, ...], usual: list[str]) -> str | None:
    """The first test of `paths` that fails with the fault, those that fail as usual left out."""
    left_out = [option for name in usual for option in ("--deselect", name)]
    text = mutant.source().read_text()
    mutant.source().write_text(text.replace(mutant.old, mutant.new))
    try:
        assert build(), f"{mutant.name}: does not build"
        return next(iter(failures(paths, "-x", *left_out)), None)
    finally:
        mutant.source().write_text(text)


def judge(mutant: Mutant, usual: list[str]) -> Verdict:
    found = mutant.source().read_text().count(mutant.old)
    assert found == 1, f"{mutant.name}: {mutant.file} holds {mutant.old!r} {found} times, not once"
    begin = perf_counter()
    test = first_failure(mutant, mutant.aimed(), usual)
    if not test:
        test = first_failure(mutant, SUITE, failures_without_fault(SUITE)) or ""
    return Verdict(mutant.name, test, f"{perf_counter() - begin:.0f}")


def main(words: Sequence[str]) -> int:
    mutants = [Mutant(**entry) for entry in tomllib.loads(LIST.read_text())["mutant"]]
    chosen = [m for m in mutants if not words or any(word in m.name for word in words)]
    table = {}
    if TABLE.exists():
        with TABLE.open(newline="") as file:
            table = {row["mutant"]: Verdict(**row) for row in csv.DictReader(file)}
    copy_sources()
    usual = failures_without_fault(tuple(sorted({path for mutant in chosen for path in mutant.aimed()})))
    for mutant in chosen:
        verdict = table[mutant.name] = judge(mutant, usual)
        print(f"{mutant.name}: {verdict.killed_by or 'SURVIVED'} ({verdict.seconds} s)", flush=True)
        with TABLE.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([Verdict._fields, *(table[m.name] for m in mutants if m.name in table)])
    return sum(not table[m.name].killed_by for m in chosen)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
