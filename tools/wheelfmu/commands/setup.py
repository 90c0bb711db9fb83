"""Installs what commands need. As root it installs Debian packages with apt-get, otherwise it lists them. It puts
Python packages into the folder .venv, in the versions of requirements.lock. Other commands set themselves up."""

from argparse import Namespace
from functools import partial

from wheelfmu.fmu.paths import LAB
from wheelfmu.fmu.values import one_of

WORDS = ["test", "all", "check", "tidy", "asan", "browser", "release", "platforms", *LAB]
ABOUT = f"a group besides what ./scripts/run needs: {', '.join(WORDS)} (all: ./scripts/test all; check: linters)"


OPTIONS = {"words": {"nargs": "*", "metavar": "WORD", "type": partial(one_of, WORDS), "help": ABOUT}}


def needs(given: Namespace) -> list[str]:
    return given.words


def main(_given: Namespace) -> None:
    """All is installed before a command begins."""
