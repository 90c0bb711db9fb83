"""Formatting and lint of C, C++, JavaScript, Python, CMake, shell, workflows; types; imports; spelling."""

from argparse import Namespace
from subprocess import check_output

from wheelfmu.commands.processes import check
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

NEEDS = ("check",)
OPTIONS = {"--fix": {"action": "store_true", "help": "formats"}}
CMAKE = ("--line-length", "120", "--indent", "2")


def files(*words: str) -> list[str]:
    """What git lists."""
    return [name for name in check_output(["git", *words], text=True).split("\0") if name]


def main(given: Namespace) -> None:
    if not (ROOT / ".git").exists():
        raise Fault("the files are those that git knows, and this folder is not a git checkout.")
    listed = "ls-files", "-coz", "--exclude-standard"
    clang = files(*listed, "*.c", "*.cpp", "*.h", "*.hpp", "*.js")
    cmake = files(*listed, "*CMakeLists.txt", "*.cmake")
    if given.fix:
        check("clang-format", "-i", *clang)
        check("gersemi", "-q", "-i", *CMAKE, *cmake)
        check("ruff", "check", "--no-cache", "--fix", "-q", ".")
        check("ruff", "format", "-q", ".")
        return
    check("clang-format", "--dry-run", "--Werror", *clang)
    check("gersemi", "--no-warn-about-unknown-commands", "--check", *CMAKE, *cmake)
    check(
        "ruff", "check", "--no-cache", "-q", "."
    )  # its cache misses a folder that becomes a package or ceases to be one
    check("ruff", "format", "--check", "-q", ".")
    check("lint-imports", "--no-cache", stdout=-3)
    check("mypy", "--no-error-summary")
    check("shellcheck", "-x", *files("grep", "-lIz", "--untracked", "^#!/usr/bin/env bash"))
    workflows = sorted((ROOT / ".github" / "workflows").iterdir())
    check("check-jsonschema", "--quiet", "--builtin-schema", "vendor.github-workflows", *workflows)
    check("codespell", *files(*listed))
