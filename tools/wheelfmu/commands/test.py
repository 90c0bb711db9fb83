"""Runs the tests of the product. Exit status 0 only if all passed.

./scripts/test          the product: equations, solver, motions, contract, benchmark, diagrams, examples
./scripts/test quick    the same without benchmark, diagrams and examples, to run after each change
./scripts/test all      every check and test, also of the lab. This adds formatting, lint and clang-tidy, the core as on
                        a processor without AVX2 and FMA, and the contract and a minute of fuzzing under the sanitizers
"""

import os
import platform
import sys
from argparse import Namespace
from subprocess import STDOUT, check_output

from wheelfmu.commands import processes
from wheelfmu.fmu.outputs import elapsed, step
from wheelfmu.fmu.paths import ROOT

OPTIONS = {"which": {"nargs": "?", "choices": ["quick", "all"], "help": "see above"}}
CORE = [
    f"tests/{name}"
    for name in ["contract", "equations", "exchange", "orbit", "physics", "reference", "robustness", "solver"]
]
PRODUCT = [*CORE, "tests/benchmark", "tests/diagrams", "tests/examples"]
RELEASE = processes.command("build", "release", "-DCMAKE_COMPILE_WARNING_AS_ERROR=ON")


def needs(given: Namespace) -> list[str]:
    """Everything that any step needs is installed before the first."""
    return ["all" if given.which == "all" else "test"]


def tests(*words: str, on: tuple[str, ...] = (), workers: int = 0, build: str = "release", **env: str) -> None:
    """Tests of one group (xdist_group) run in turn in one process, and share what they prepare."""
    count = str((os.cpu_count() or 1) + workers)
    pytest = processes.python("pytest", "-q", "-n", count, "--dist", "loadgroup", *words)
    built = {"WHEEL_BUILD": str(ROOT / "build" / build), **processes.SAFE}
    processes.check(*on, *pytest, env=os.environ | built | env)


def main(given: Namespace) -> None:
    if given.which != "all":
        processes.check(*RELEASE)
        tests(*(CORE if given.which == "quick" else PRODUCT))
        print(f"The tests passed in {elapsed():.0f} s; ./scripts/test all runs every check.")
        return
    step("formatting and lint; builds, warnings are errors: release, sanitizers with the fuzzer; clang-tidy")
    processes.side_by_side(processes.command("build", "asan"), RELEASE)
    processes.side_by_side(processes.command("tidy"), processes.command("lint"))

    step("all tests, and beside them a minute of fuzzing")
    fuzzed = ROOT / "build" / "fuzz.out"
    with fuzzed.open("w") as file:
        fuzzing = processes.start(*processes.command("fuzz", 60), stdout=file, stderr=STDOUT)
        tests("tests", *[str(path.relative_to(ROOT)) for path in sorted((ROOT / "lab").glob("*/tests"))], workers=1)
        code = fuzzing.wait()
    print(fuzzed.read_text(errors="replace"), end="", file=sys.stderr if code else sys.stdout)
    if code:
        raise processes.Failed(1)

    step("the tests of the core as on a processor without AVX2 and FMA")
    tests(*CORE, on=("bash", "tests/other_machine"))

    step("the contract under address and undefined-behaviour sanitizers")
    name = f"libclang_rt.asan-{platform.machine()}.so"
    runtime = check_output(["clang-19", f"-print-file-name={name}"], text=True).strip()
    memory = ["tests/contract", "tests/robustness/test_allocations.py"]
    tests("-m", "not local", *memory, build="asan", ASAN_OPTIONS="detect_leaks=0", LD_PRELOAD=runtime)

    step("done")
    print("All checks and tests passed.")
