"""Checks format, style, types, imports and spelling of all files that git knows."""

from argparse import Namespace
from fnmatch import fnmatch
from subprocess import PIPE, check_output
from typing import Any

from wheelfmu.commands.processes import Failed, check, start
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

NEEDS = ("check",)
OPTIONS = {
    "--fix": {"action": "store_true", "help": "formats the files, and mends what ruff can, instead"},
    "files": {"nargs": "*", "metavar": "FILE", "help": "these alone, without types and imports; a pattern of git"},
}
GERSEMI = ("gersemi", "--line-length", "120", "--indent", "2")
RUFF = ("ruff", "check", "-q", "--no-cache")  # its cache misses a folder that becomes a package or ceases to be one
ELSEWHERE: dict[str, Any] = {"cwd": ROOT / "tools"}  # a module in the current folder would hide a package of its name


def main(given: Namespace) -> None:
    if not (ROOT / ".git").exists():
        raise Fault("the files are those that git knows, and this folder is not a git checkout.")
    found = check_output(["git", "ls-files", "-coz", "--exclude-standard", "--", *given.files], text=True)
    listed = [name for name in found.split("\0") if (ROOT / name).is_file()]

    def on(patterns: str, *words: str) -> None:
        """Runs a program on the files of these names, if there are any."""
        if named := [name for name in listed if any(fnmatch(name, pattern) for pattern in patterns.split())]:
            check(*words, *named)

    clang, cmake, python = "*.c *.cpp *.h *.hpp *.js", "*CMakeLists.txt *.cmake", "*.py *.ipynb"
    if given.fix:
        on(clang, "clang-format", "-i")
        on(cmake, *GERSEMI, "-q", "-i")
        on(python, *RUFF, "--fix")
        on(python, "ruff", "format", "-q")
        return
    on(clang, "clang-format", "--dry-run", "--Werror")
    on(cmake, *GERSEMI, "--no-warn-about-unknown-commands", "--check")
    on(python, *RUFF)
    on(python, "ruff", "format", "--check", "-q")
    if shell := [name for name in listed if (ROOT / name).read_bytes().startswith(b"#!/usr/bin/env bash\n")]:
        check("shellcheck", "-x", *shell)
    on(".github/workflows/*", "check-jsonschema", "--quiet", "--builtin-schema", "vendor.github-workflows")
    on("*", "codespell")
    if not given.files:
        imports = start("lint-imports", "--no-cache", "../pyproject.toml", stdout=PIPE, text=True, **ELSEWHERE)
        if said := imports.communicate()[0] * bool(imports.returncode):
            print(said)
            raise Failed(1)
        lab = ["../lab"] * (ROOT / "lab").exists()
        check("mypy", "--no-error-summary", "--config-file", "../pyproject.toml", ".", *lab, "../examples", **ELSEWHERE)
