"""Do the tests notice? Each mutant is the project with one fault in it; some test must fail.

    python tests/robustness/mutants.py [WORD ...]     all, or those whose name contains one of the words

For each entry of mutants.toml a copy of the sources in build/mutants is changed, built and tested up to the first
failure: the tests that are meant to notice first, a wider suite only if they pass. A test that fails without the fault
too does not count. The table is mutants.csv. Some twenty seconds for each, so it is no part of the default run.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
SCRATCH = ROOT / "build" / "mutants"
BUILD = SCRATCH / "build" / "release"
LIST, TABLE = (Path(__file__).with_suffix(suffix) for suffix in (".toml", ".csv"))
SUITE = ("tests/contract", "tests/robustness", "tests/physics", "tests/equations", "tests/solver")
LONGEST = 600  # s: tests that take longer count as a failure
NOTHING_TO_TEST = 5  # exit status of pytest
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


def failure(root: Path, what: str, left_out: Sequence[str] = ()) -> str:
    """The first test that fails of a file or a test, or the file itself if its tests crash or hang; empty: none."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--no-header", "--tb=no", "-rfE"]
    command += [what, *(option for test in left_out for option in ("--deselect", test))]
    environment = os.environ | {"WHEEL_BUILD": str(root / "build" / "release")}
    try:
        done = subprocess.run(
            command, cwd=root, env=environment, capture_output=True, text=True, timeout=LONGEST, check=False
        )
    except subprocess.TimeoutExpired:
        return what
    if done.returncode in (0, NOTHING_TO_TEST):
        return ""
    lines = [line.split(" - ")[0].split(maxsplit=1) for line in done.stdout.splitlines()]
    return next((words[1] for words in lines if words[:1] in (["FAILED"], ["ERROR"])), what)


def find_killer(mutant: Mutant, usual: list[str]) -> str:
    """The first test that fails with the fault and passes without it; those that fail in any case join `usual`."""
    text = mutant.source().read_text()
    suite = sorted(str(path.relative_to(SCRATCH)) for folder in SUITE for path in (SCRATCH / folder).glob("test_*.py"))
    waiting = [*mutant.aimed(), *(path for path in suite if path not in mutant.aimed())]
    mutant.source().write_text(text.replace(mutant.old, mutant.new))
    try:
        assert build(), f"{mutant.name}: does not build"
        while waiting:
            test = "" if waiting[0] in usual else failure(SCRATCH, waiting[0], usual)
            if not test:
                waiting.pop(0)
            elif not failure(ROOT, test):
                return test
            else:
                usual.append(test)
    finally:
        mutant.source().write_text(text)
    return ""


def judge(mutant: Mutant, usual: list[str]) -> Verdict:
    found = mutant.source().read_text().count(mutant.old)
    assert found == 1, f"{mutant.name}: {mutant.file} holds {mutant.old!r} {found} times, not once"
    begin = perf_counter()
    test = find_killer(mutant, usual)
    return Verdict(mutant.name, test, f"{perf_counter() - begin:.0f}")


def main(words: Sequence[str]) -> int:
    mutants = [Mutant(**entry) for entry in tomllib.loads(LIST.read_text())["mutant"]]
    chosen = [m for m in mutants if not words or any(word in m.name for word in words)]
    table = {}
    if TABLE.exists():
        with TABLE.open(newline="") as file:
            table = {row["mutant"]: Verdict(**row) for row in csv.DictReader(file)}
    copy_sources()
    subprocess.run([ROOT / "scripts" / "build", "release"], check=True)
    usual: list[str] = []
    for mutant in chosen:
        verdict = table[mutant.name] = judge(mutant, usual)
        print(f"{mutant.name}: {verdict.killed_by or 'SURVIVED'} ({verdict.seconds} s)", flush=True)
        with TABLE.open("w", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows([Verdict._fields, *(table[m.name] for m in mutants if m.name in table)])
    return sum(not table[m.name].killed_by for m in chosen)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
