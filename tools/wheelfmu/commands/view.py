"""Writes a 3D page of any result of the FMU, one offline file: ./scripts/view FILE.csv... (docs/page.md)."""

from argparse import Namespace

PART, STAYS = "tools/wheelfmu/page", True


def reads(words: list[str]) -> Namespace:
    from wheelfmu.page import options

    return options.arguments(words)


def main(given: Namespace) -> None:
    from wheelfmu.page.__main__ import recorded

    recorded(given)
