"""Runs the tests of the product. Exit status 0 only if all passed.

./scripts/test          the product: equations, solver, motions, contract, benchmark, diagrams, examples
./scripts/test quick    the same without benchmark, diagrams and examples, to run after each change
./scripts/test all      every check and test, also of the lab. This adds formatting, lint and clang-tidy, the core as on
                        a processor without AVX2 and FMA, and the contract and a minute of fuzzing under the sanitizers
"""

import os
import platform
from argparse import Namespace
from subprocess import STDOUT, check_output

from wheelfmu.commands import processes
from wheelfmu.fmu.files import elapsed, step
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


def tests(workers: int, *words: str, on: tuple[str, ...] = (), build: str = "release", **variables: str) -> list[str]:
    """Words that run tests. Those of a group (xdist_group) run in turn in one process, and share what they prepare;
    groups begin in the order of tests/support/fixtures.py."""
    built = {"WHEEL_BUILD": str(ROOT / "build" / build), **processes.SAFE, **variables}
    pytest = processes.python("pytest", "-q", "-n", workers, "--dist", "loadgroup", "--no-loadscope-reorder", *words)
    return ["env", *(f"{name}={value}" for name, value in built.items()), *on, *pytest]


def under_sanitizers() -> list[str]:
    """Words that run the contract under sanitizers, by one process."""
    name = f"libclang_rt.asan-{platform.machine()}.so"
    runtime = check_output(["clang-19", f"-print-file-name={name}"], text=True).strip()
    memory = ["tests/contract", "tests/robustness/test_allocations.py"]
    return tests(1, "-m", "not local", *memory, build="asan", ASAN_OPTIONS="detect_leaks=0", LD_PRELOAD=runtime)


def main(given: Namespace) -> None:
    cores = os.cpu_count() or 1
    if given.which != "all":
        processes.check(*RELEASE)
        processes.check(*tests(cores, *(CORE if given.which == "quick" else PRODUCT)))
        print(f"The tests passed in {elapsed():.0f} s; ./scripts/test all runs every check.")
        return
    step("formatting and lint; the release build, warnings are errors")
    processes.side_by_side(RELEASE, processes.command("lint"))

    step("all tests; beside them fuzzing, the contract under sanitizers, clang-tidy, the core as without AVX2 and FMA")
    lab = [str(path.relative_to(ROOT)) for path in sorted((ROOT / "lab").glob("*/tests"))]
    everything = processes.start(*tests(cores + 1, "tests", *lab))
    other_machine = tests(cores, *CORE, on=("bash", "tests/other_machine"))
    with (ROOT / "build" / "beside.out").open("w+", errors="replace") as file:  # printed when all tests have ended
        beside = [processes.command("fuzz", 60), under_sanitizers(), processes.command("tidy"), other_machine]
        codes = [processes.status(*words, stdout=file, stderr=STDOUT) for words in beside]
        codes.append(processes.ended(everything))
        file.seek(0)
        print("\nUnder sanitizers, by clang-tidy, as without AVX2 and FMA:", file.read(), sep="\n", flush=True)
    if any(codes):
        raise processes.Failed(1)

    step("done")
    print("All checks and tests passed.")
