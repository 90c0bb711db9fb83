"""Checks format, style, types, imports, spelling and links of all files that git knows."""

import re
from argparse import Namespace
from fnmatch import fnmatch
from subprocess import PIPE, check_output
from typing import Any

from wheelfmu.commands.processes import Failed, check, start
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

NEEDS = ("check",)
OPTIONS = {
    "--fix": {"action": "store_true", "help": "format the files and mend what ruff can, instead of checking"},
    "files": {"nargs": "*", "metavar": "FILE", "help": "check these or a pattern of git, without types, imports"},
}
GERSEMI = ("gersemi", "--line-length", "120", "--indent", "2")
RUFF = ("ruff", "check", "-q", "--no-cache")  # its cache misses a folder that becomes a package or ceases to be one
LINKS = ("lychee", "-qq", "--offline", "--include-fragments")  # files and headings; the web is not asked
ELSEWHERE: dict[str, Any] = {"cwd": ROOT / "tools"}  # a module in the current folder would hide a package of its name


def absent(listed: list[str]) -> list[str]:
    """Folders that documents name and that may be missing: of the lab, without which all else works, and dist, which
    a release fills."""
    texts = [(ROOT / name).read_text(encoding="utf-8") for name in listed if name.endswith(".md")]
    named = {folder for text in texts for folder in re.findall(r"\b(lab/\w+|dist)/", text)}
    return sorted(folder for folder in named if not (ROOT / folder).exists())


def imports(*configurations: str) -> None:
    for path in configurations:
        done = start("lint-imports", "--no-cache", path, stdout=PIPE, text=True, **ELSEWHERE)
        if said := done.communicate()[0] * bool(done.returncode):
            print(said)
            raise Failed(1)


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
    on("*.md", *LINKS, *(f"--exclude=/{folder}/" for folder in absent(listed)))
    if not given.files:
        lab = ["../lab"] * (ROOT / "lab").exists()
        imports("../pyproject.toml", *(f"{folder}/importlinter.toml" for folder in lab))
        check("mypy", "--no-error-summary", "--config-file", "../pyproject.toml", ".", *lab, "../examples", **ELSEWHERE)
