"""Measures which lines and branches of fmu-src the tests reach. gcovr's page of them is build/coverage/index.html. Exit
status 0 only if the tests pass and reach 95 % of the lines."""

import os
from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT

NEEDS = ("test", "check")
FOLDERS = ("contract", "equations", "exchange", "orbit", "solver")
FILES = (
    *(f"physics/test_{name}.py" for name in ("brake", "slope", "symmetries_fmu", "zero_as_a_limit")),
    *(f"robustness/test_{name}.py" for name in ("allocations", "bounded_events", "silent_faults", "stability_law")),
)
# Limits of the paths and the size of a library without gcov, and a deadline that instrumented code may miss.
LEFT_OUT = (
    "contract/test_library.py"
    "::test_the_library_has_no_executable_stack_no_late_relocations_in_code_and_no_path_of_this_machine",
    "contract/test_evidence.py::test_the_manifest_names_every_file_and_no_other_and_all_is_below_a_megabyte",
    "robustness/test_bounded_events.py::test_random_scenes_with_many_transitions_end_soon",
)


def main(_given: Namespace) -> None:
    build("coverage")
    folder = ROOT / "build" / "coverage"
    for count in folder.rglob("*.gcda"):
        count.unlink()
    which = [f"tests/{name}" for name in (*FOLDERS, *FILES)] + [f"--deselect=tests/{name}" for name in LEFT_OUT]
    pytest = processes.python("pytest", "-q", "-n", str(os.cpu_count()), "-p", "no:cacheprovider", *which)
    processes.check(*pytest, env=os.environ | {"WHEEL_BUILD": str(folder), **processes.SAFE})
    page = folder / "index.html"
    lines = ["--filter", "fmu-src/.*", "--exclude-throw-branches", "--merge-lines", "--fail-under-line", "95"]
    where = ["--root", ".", "--object-directory", folder, "--html-details", page, "--print-summary"]
    processes.check("gcovr", *where, *lines)
    print(f"Line by line: {page}")
