"""Copies of the project in which one fault is put in, built, and judged by the quick tests."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("contract", "physics", "orbit", "robustness", "solver", "exchange", "equations")  # what runs the core
# These folders call a part of the core alone, made of these modules; faults elsewhere cannot show there.
OF_A_PART = {"equations": {"equations"}, "solver": {"solver", "support"}}
LONGEST = 400  # s of processor time of all tests, several times what they take; and of one test:
LONGEST_TEST = 60  # s, and of one program of the build. What takes longer counts as a failure
THE_BUILD = "the build, which runs the paper's scenes"
NOTHING_TO_TEST = 5  # exit status of pytest
# Without link-time optimisation, which costs more than it tells; the bits are the same.
OPTIONS = ["-DCMAKE_BUILD_TYPE=RelWithDebInfo"] + [
    f"-DCMAKE_{language}_FLAGS_RELWITHDEBINFO=-O2 -DNDEBUG" for language in ("C", "CXX")
]


class Copy:
    """One copy, in build/mutants/NUMBER."""

    def __init__(self, number: int = 0):
        self.root = ROOT / "build" / "mutants" / str(number)
        self.build_folder = self.root / "build" / "release"
        self.said = ""  # by the last tests
        self._copy_sources()
        assert self.compiles() and self.packs(), "the project itself does not build"
        self.binary = self.digest()

    def _copy_sources(self) -> None:
        """Unchanged files keep their times, so that little is built again."""
        listed = subprocess.run(
            ["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True
        )
        for name in listed.stdout.splitlines():
            path, target = ROOT / name, self.root / name
            if path.is_file() and not (target.exists() and target.read_bytes() == path.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, target)
        if not (self.root / ".venv").exists():
            (self.root / ".venv").symlink_to(ROOT / ".venv")

    def compiles(self) -> bool:
        """The library alone."""
        if not (self.build_folder / "Makefile").exists():
            sundials = next((ROOT / "build" / "sundials").glob("*/vendor"), "")
            setting = [f"-DWHEEL_SUNDIALS_SOURCE={sundials}", *OPTIONS]
            self.call(["cmake", "--preset", "release", *setting])
        return self.call(["cmake", "--build", self.build_folder, "--target", "wheel_fmu"])

    def packs(self) -> bool:
        """The rest of the build, which runs the paper's scenes for the archive's evidence: a fault may fail there."""
        return self.call(["cmake", "--build", self.build_folder])

    def call(self, command: Sequence[str | Path]) -> bool:
        limited = ["prlimit", f"--cpu={LONGEST_TEST}", *command]
        return subprocess.run(limited, cwd=self.root, capture_output=True, check=False).returncode == 0

    def digest(self) -> str:
        return hashlib.sha256((self.build_folder / "wheel.so").read_bytes()).hexdigest()

    def source(self, name: str) -> Path:
        return self.root / "fmu-src" / name

    def suite(self, mutated: str = "") -> list[str]:
        """The files of the quick tests that run the core, or this file of it."""
        module = mutated.split("/")[0]
        folders = [name for name in FOLDERS if not mutated or module in OF_A_PART.get(name, {module})]
        paths = (path for folder in folders for path in (self.root / "tests" / folder).glob("test_*.py"))
        return sorted(str(path.relative_to(self.root)) for path in paths)

    def failures(self, tests: Sequence[str], left_out: Sequence[str] = (), *options: str) -> list[str]:
        """The tests that fail, or the first file if its tests crash or hang."""
        command = ["prlimit", f"--cpu={LONGEST}", sys.executable, "-m", "pytest", f"--timeout={LONGEST_TEST}"]
        command += ["-q", "-p", "no:cacheprovider", "--no-header", "--tb=no", "-rfE", "--durations=0"]
        command += [*options, *tests, *(option for test in left_out for option in ("--deselect", test))]
        environment = os.environ | {"WHEEL_BUILD": str(self.build_folder)}
        done = subprocess.run(command, cwd=self.root, env=environment, capture_output=True, text=True, check=False)
        self.said = done.stdout
        if done.returncode in (0, NOTHING_TO_TEST):
            return []
        lines = [line.split(" - ")[0].split(maxsplit=1) for line in done.stdout.splitlines()]
        failed = [words[1] for words in lines if words[:1] in (["FAILED"], ["ERROR"])]
        return failed or [tests[0]]

    def seconds(self) -> Counter[str]:
        """What each file of the last tests took."""
        taken = Counter[str]()
        for number, file in re.findall(r"^([\d.]+)s (?:call|setup) +([^:]+)::", self.said, re.MULTILINE):
            taken[file] += float(number)
        return taken

    def failure(self, tests: Sequence[str], left_out: Sequence[str] = ()) -> str:
        """The first test that fails; empty: none."""
        return next(iter(self.failures(tests, left_out, "-x")), "")
