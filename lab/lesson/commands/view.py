"""Writes a 3D page of any result of the FMU, one offline file: ./scripts/view FILE.csv... (lab/lesson/README.md)."""

from argparse import Namespace

from lab.lesson.options import arguments as reads  # noqa: F401 - by __main__

STAYS, NEEDS = True, ("lesson",)


def main(given: Namespace) -> None:
    from lab.lesson.writing import recorded

    recorded(given)
