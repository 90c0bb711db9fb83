"""Do the tests notice? Each mutant is the project with one fault in it; some test must fail.

    python tests/robustness/mutants.py [NAME ...]     all, or those whose name contains one of the words

For each entry of mutants.toml a copy of the sources in build/mutants is changed, built and tested; the tests that are
meant to notice come first. Tests that fail without any fault are left out. The table is tests/robustness/mutants.csv.
About half a minute for each mutant on two cores, so it is no part of the default run.
"""

from __future__ import annotations

import csv
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
SCRATCH = ROOT / "build" / "mutants"
LIST, TABLE = (Path(__file__).with_suffix(suffix) for suffix in (".toml", ".csv"))
QUICK = ["tests/contract", "tests/robustness", "tests/physics", "tests/equations"]


class Mutant(NamedTuple):
    """One entry of mutants.toml."""

    name: str
    file: str
    old: str
    new: str
    tests: list[str]


def copy_sources() -> None:
    """The sources into the scratch folder; unchanged files keep their times, so that little is built again."""
    for folder in ("fmu-src", "cmake", "tests", "docs", "scripts"):
        for path in (ROOT / folder).rglob("*"):
            target = SCRATCH / path.relative_to(ROOT)
            if path.is_file() and not (target.exists() and target.read_bytes() == path.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, target)
    for path in ROOT.iterdir():
        if path.is_file() and path.suffix in (".txt", ".json", ".xml", ".md", ".toml"):
            target = SCRATCH / path.name
            if not (target.exists() and target.read_bytes() == path.read_bytes()):
                shutil.copy(path, target)
    shutil.copy(ROOT / "LICENSE", SCRATCH / "LICENSE")


def build() -> bool:
    folder = SCRATCH / "build" / "release"
    source = next((ROOT / "build" / "sundials").glob("*/vendor"), "")
    configure = ["cmake", "-S", SCRATCH, "-B", folder, f"-DWHEEL_SUNDIALS_SOURCE={source}"]
    steps = [] if (folder / "CMakeCache.txt").exists() else [configure]
    for command in [*steps, ["cmake", "--build", folder, "--parallel", "2"]]:
        if subprocess.run(command, capture_output=True).returncode != 0:
            return False
    return True


def tested(paths: list[str], left_out: list[str], first: bool) -> list[str]:
    """The tests that fail, at the first one if that is enough; a run that hangs counts as one."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "--no-header",
        "-rfE",
        *(["-x"] if first else []),
    ]
    command += [path for path in paths if (SCRATCH / path).exists()]
    command += [part for name in left_out for part in ("--deselect", name)]
    environment = os.environ | {"WHEEL_BUILD": str(SCRATCH / "build" / "release")}
    try:
        done = subprocess.run(command, cwd=SCRATCH, env=environment, capture_output=True, text=True, timeout=900)
    except subprocess.TimeoutExpired:
        return ["(no end)"]
    lines = [line.split() for line in done.stdout.splitlines()]
    failed = [words[1] for words in lines if words[:1] in (["FAILED"], ["ERROR"]) and len(words) > 1]
    return failed or ([] if done.returncode in (0, 5) else ["(no result)"])


def judge(mutant: Mutant, left_out: list[str]) -> tuple[str, str]:
    """killed, survived or unbuilt; and the test that noticed."""
    path = SCRATCH / "fmu-src" / mutant.file
    text = path.read_text()
    assert text.count(mutant.old) >= 1, f"{mutant.name}: {mutant.file} does not hold {mutant.old!r}"
    path.write_text(text.replace(mutant.old, mutant.new, 1))
    try:
        if not build():
            return "unbuilt", ""
        for paths in ([f"tests/{name}" for name in mutant.tests], QUICK):
            failed = tested(paths, left_out, first=True)
            if failed:
                return "killed", failed[0]
        return "survived", ""
    finally:
        path.write_text(text)


def main(words: list[str]) -> int:
    mutants = [Mutant(**entry) for entry in tomllib.loads(LIST.read_text())["mutant"]]
    chosen = [m for m in mutants if not words or any(word in m.name for word in words)]
    copy_sources()
    assert build(), "the project itself does not build"
    others = sorted({f"tests/{name}" for m in chosen for name in m.tests} - set(QUICK))
    left_out = tested([*QUICK, *(path for path in others if not path.startswith(tuple(QUICK)))], [], first=False)
    rows = []
    for mutant in chosen:
        begin = perf_counter()
        verdict, test = judge(mutant, left_out)
        rows.append((mutant.name, mutant.file, verdict, test))
        print(f"{verdict:9} {mutant.name} ({perf_counter() - begin:.0f} s) {test}", flush=True)
    if not words:
        with TABLE.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([("mutant", "file", "verdict", "test"), *rows])
    return sum(row[2] != "killed" for row in rows)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
