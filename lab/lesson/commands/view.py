"""Writes a 3D page of any result of the FMU, one offline file: ./scripts/view FILE.csv... (lab/lesson/README.md)."""

from argparse import Namespace

STAYS, NEEDS = True, ("lesson",)


def reads(words: list[str]) -> Namespace:
    from lab.lesson import options

    return options.arguments(words)


def main(given: Namespace) -> None:
    from lab.lesson.__main__ import recorded

    recorded(given)
