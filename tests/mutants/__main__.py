"""Do the tests notice? Faults are put one by one into copies of the project, built, and judged by the quick tests.

    python -m mutants [COUNT [SEED]] | named [WORD...]          see ./scripts/mutants

The named faults stand in named.toml. The random ones are made by universalmutator and the rules in core.rules; those
that do not compile or leave the library as it was, bit by bit, do not count. A survivor has a line in survivors.csv,
which says why it may stay. An interrupted run goes on where it stopped: verdicts stand in build/mutants/random.csv, and
hold as long as the tests are the same.
"""

import csv
import os
import random
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stdout
from hashlib import sha256
from io import StringIO
from pathlib import Path
from queue import Queue
from typing import NamedTuple

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
CORE, COPIES = ROOT / "fmu-src", ROOT / "build" / "mutants"
LOG, DATA = COPIES / "random.csv", ROOT / "docs" / "results" / "data"
FOLDERS = ("contract", "physics", "orbit", "robustness", "solver", "exchange", "equations")  # what runs the core
# These folders call a part of the core alone, made of these modules; faults elsewhere cannot show there.
OF_A_PART = {"equations": {"equations"}, "solver": {"solver", "support"}}
MOST, MOST_OF_A_TEST = 400, 60  # s of processor time of all tests; of one test, or one program of the build
AT_FIRST = 6  # files of tests that are asked before all others
THE_BUILD, NOTHING = "the build, which runs the paper's scenes", "nothing: it does not compile or changes no bit"
SPARE = 3  # drawn for each that is wanted, more than enough: many do not compile
# Without link-time optimisation, which costs more than it shows; the bits are the same.
FAST = [f"-DCMAKE_{language}_FLAGS_RELWITHDEBINFO=-O2 -DNDEBUG" for language in ("C", "CXX")]


class Fault(NamedTuple):
    """In `file`, under fmu-src, `code` becomes `change`, and the whole file `text`; the tests `aimed` are to notice."""

    file: str
    code: str
    change: str
    text: str
    aimed: Sequence[str] = ()


class Copy:
    """One copy of the project, in build/mutants/NUMBER."""

    def __init__(self, number: int) -> None:
        self.root = COPIES / str(number)
        self.built = self.root / "build" / "release"
        listed = subprocess.check_output(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, text=True)
        for name in listed.splitlines():  # unchanged files keep their times, so that little is built again
            path, target = ROOT / name, self.root / name
            if path.is_file() and not (target.exists() and target.read_bytes() == path.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, target)
        if not (self.built / "Makefile").exists():
            (self.root / ".venv").symlink_to(ROOT / ".venv")
            sundials = next((ROOT / "build" / "sundials").glob("*/vendor"), "")
            options = [f"-DWHEEL_SUNDIALS_SOURCE={sundials}", "-DCMAKE_BUILD_TYPE=RelWithDebInfo", *FAST]
            self.call("cmake", "--preset", "release", *options)
        assert self.builds(), "the project itself does not build"
        self.binary = self.library()

    def call(self, *command: str | Path, **options) -> subprocess.CompletedProcess:
        limited = ["prlimit", f"--cpu={MOST_OF_A_TEST}", *command]
        return subprocess.run(limited, cwd=self.root, capture_output=True, check=False, **options)

    def builds(self, *target: str) -> bool:
        return self.call("cmake", "--build", self.built, *target).returncode == 0

    def library(self) -> bytes:
        return (self.built / "wheel.so").read_bytes()

    def suite(self, file: str) -> list[str]:
        """The files of the quick tests that run this file of the core."""
        module = file.split("/")[0]
        folders = [name for name in FOLDERS if module in OF_A_PART.get(name, {module})]
        return sorted(f"tests/{name}/{p.name}" for name in folders for p in (HERE.parent / name).glob("test_*.py"))

    def failing(self, tests: Sequence[str], usual: Iterable[str], *options: str) -> list[str]:
        """The tests that fail beside the usual ones, or the first file if its tests crash or hang."""
        left_out = [f"--deselect={test}" for test in usual]
        command = ["prlimit", f"--cpu={MOST}", sys.executable, "-m", "pytest", f"--timeout={MOST_OF_A_TEST}", *options]
        command += ["-q", "-p", "no:cacheprovider", "--no-header", "--tb=no", "-rfE", *left_out, *tests]
        environment = os.environ | {"WHEEL_BUILD": str(self.built)}
        done = subprocess.run(command, cwd=self.root, env=environment, capture_output=True, text=True, check=False)
        if done.returncode in (0, 5):  # 5: nothing to test
            return []
        lines = [line.split(" - ")[0].split(maxsplit=1) for line in done.stdout.splitlines()]
        return [words[1] for words in lines if words[:1] in (["FAILED"], ["ERROR"])] or [tests[0]]

    def killer(self, fault: Fault, usual: Iterable[str], noticed: Counter[str]) -> str:
        """The test that notices; empty: none. What noticed most is asked first."""
        source = self.root / "fmu-src" / fault.file
        text = source.read_text()
        source.write_text(fault.text)
        try:
            if not self.builds("--target", "wheel_fmu") or self.library() == self.binary:
                return NOTHING
            if not self.builds():
                return THE_BUILD
            others = sorted(set(self.suite(fault.file)) - {*fault.aimed}, key=lambda test: -noticed[test])
            first = [*fault.aimed] or others[:AT_FIRST]
            found = self.failing(first, usual, "-x") or self.failing([f for f in others if f not in first], usual, "-x")
            return next(iter(found), "")
        finally:
            source.write_text(text)


def usual_failures(copy: Copy, tests: Sequence[str]) -> list[str]:
    """What fails without a fault shows nothing."""
    usual: list[str] = []
    while failing := copy.failing(tests, usual):
        assert not set(failing) & set(usual), f"{failing} fail without any fault, even when they are left out"
        usual += failing
    return usual


def named(words: Sequence[str]) -> int:
    entries = tomllib.loads((HERE / "named.toml").read_text())["mutant"]
    chosen = [entry for entry in entries if not words or any(word in entry["name"] for word in words)]
    aimed = {entry["name"]: [f"tests/{name}" for name in entry["tests"]] for entry in chosen}
    copy, survived = Copy(0), 0
    usual = usual_failures(copy, sorted({test for tests in aimed.values() for test in tests}))
    for name, file, old, new in ((entry[key] for key in ("name", "file", "old", "new")) for entry in chosen):
        text = (CORE / file).read_text()
        assert text.count(old) == 1, f"{name}: {file} does not hold {old!r} once"
        fault = Fault(file, old, new, text.replace(old, new), aimed[name])
        killer = copy.killer(fault, usual, Counter())
        survived += killer in ("", NOTHING)
        print(f"{name}: {killer or 'SURVIVED'}", flush=True)
    return survived


def sample(count: int, seed: int) -> list[Fault]:
    """So many of all random faults, drawn without replacement."""
    from universalmutator.mutator import mutants_regexp

    every = []
    for path in sorted(path for path in CORE.rglob("*") if path.suffix in (".c", ".h", ".cpp", ".hpp")):
        lines, name = path.read_text().splitlines(keepends=True), str(path.relative_to(CORE))
        with redirect_stdout(StringIO()):
            made = mutants_regexp(lines, [str(HERE / "core.rules")], ignorePatterns=[])
        for number, line, *_ in made:
            text = "".join([*lines[: number - 1], line, *lines[number:]])
            every.append(Fault(name, *(" ".join(code.split()) for code in (lines[number - 1], line)), text))
    return random.Random(seed).sample(every, min(count, len(every)))


def write(judged: list[tuple[Fault, str]]) -> int:
    """The data of docs/testing.md; how many survivors have no reason."""
    with (HERE / "survivors.csv").open(newline="", encoding="utf-8") as file:
        why = {tuple(row[:3]): row[3] for row in csv.reader(file)}
    survivors = [(*fault[:3], why.get(fault[:3], "")) for fault, killer in judged if not killer]
    killed, equal = len(judged) - len(survivors), sum(why.startswith("equivalent") for *_, why in survivors)
    share, of_others = (100 * killed / max(1, count) for count in (len(judged), len(judged) - equal))
    figures = [
        ("count", len(judged), "", "random faults judged"),
        ("noticed", f"{share:.1f}", "%", "noticed by the quick tests"),
        ("noticed_of_others", f"{of_others:.1f}", "%", "noticed, without equivalent survivors"),
        ("survivors", len(survivors), "", "survivors, each with its reason"),
        ("equivalent", equal, "", "survivors that no test can notice"),
    ]
    tables = {"mutants_all": [("figure", "measured", "unit", "what"), *figures]}
    tables["mutants_survivors"] = [("file", "code", "change", "why"), *survivors]
    for name, rows in tables.items():
        with (DATA / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    return sum(not reason for *_, reason in survivors)


def randomly(count: int, seed: int) -> int:
    cores, copies, noticed = len(os.sched_getaffinity(0)), Queue[Copy](), Counter[str]()
    with ThreadPoolExecutor(cores) as pool:
        for copy in pool.map(Copy, range(cores)):
            copies.put(copy)
    usual = usual_failures(copy, sorted({*copy.suite("equations/"), *copy.suite("solver/")}))
    files = [p for name in (*FOLDERS, "support", "reference") for p in sorted((HERE.parent / name).rglob("*.py"))]
    tests = b"".join(file.read_bytes() for file in files)
    LOG.touch()
    with LOG.open(newline="", encoding="utf-8") as file:
        known = dict(csv.reader(file))

    def judge(fault: Fault) -> str:
        key = sha256(tests + fault.text.encode()).hexdigest()
        if key not in known:
            copy = copies.get()
            known[key] = copy.killer(fault, usual, noticed)
            copies.put(copy)
            with LOG.open("a", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerow([key, known[key]])
        noticed[known[key].split("::")[0]] += 1
        return known[key]

    judged: list[tuple[Fault, str]] = []
    drawn, most = sample(SPARE * count, seed), 2 * cores
    with ThreadPoolExecutor(cores) as pool:
        while drawn and len(judged) < count:
            batch, drawn = drawn[:most], drawn[most:]
            for fault, killer in zip(batch, pool.map(judge, batch), strict=True):
                if killer != NOTHING:
                    judged.append((fault, killer))
                    print(f"{fault.file}: {fault.code} -> {fault.change}: {killer or 'SURVIVED'}", flush=True)
            without = write(judged)
    survived = sum(not killer for _, killer in judged)
    print(f"{len(judged)} mutants, {survived} survived, {without} of these without a reason.")
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["named"]:
        sys.exit(named(sys.argv[2:]))
    sys.exit(randomly(*map(int, sys.argv[1:]), *(500, 1)[len(sys.argv) - 1 :]))
