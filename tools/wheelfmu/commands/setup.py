"""Installs the prerequisites of commands: Debian packages (as root by apt-get; otherwise it lists them) and .venv
with the Python packages of requirements.lock. Two at once wait for each other. Without a word it installs what
./scripts/run needs."""

from argparse import Namespace

WORDS = [
    "check",
    "tidy",
    "asan",
    "browser",
    "test",
    "vehicles",
    "study",
    "control",
    "report",
    "site",
    "page",
    "notebook",
    "release",
]
ABOUT = "also what these commands need; check: linters and pytest; test: all that ./scripts/test needs, and more"
OPTIONS = {"words": {"nargs": "*", "metavar": "WORD", "choices": [*WORDS, []], "help": ABOUT}}


def needs(given: Namespace) -> list[str]:
    return given.words


def main(_given: Namespace) -> None:
    """All is installed before a command begins."""
