"""Command line of the pages: `recorded` for result files, `live` for the wheel itself."""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

from page import description, document, options
from page.bodies import Body, ViewError, read_bodies

PLACES = {"fl": "front left", "fr": "front right", "rl": "rear left", "rr": "rear right"}


def main() -> int:
    """Write a page; a fault of the input is one sentence on stderr and exit status 1."""
    kind, *words = sys.argv[1:]
    try:
        output, size = live(words) if kind == "live" else recorded(options.arguments(words))
    except ViewError as fault:
        print(f"view: {fault}", file=sys.stderr)
        return 1
    print(f"{output} ({size / 1e6:.1f} MB): open it in a browser.")
    return 0


def live(words: list[str]) -> tuple[Path, int]:
    parser = argparse.ArgumentParser(prog="scripts/page", description="The page that holds the wheel itself.")
    parser.add_argument("--wasm", type=Path, required=True)
    parser.add_argument("--output", "-o", type=Path, required=True)
    given = parser.parse_args(words)
    return given.output, document.write(given.output, "The wheel, live", [], live=description.live(given.wasm))


def recorded(given: argparse.Namespace) -> tuple[Path, int]:
    parameters = {name: getattr(given, name) for name in options.GIVEN if getattr(given, name) is not None}
    bodies = [body for path in given.files for body in read_bodies(path, parameters, given.box)]
    bodies, every = document.thinned(named(bodies, given.labels))
    if every > 1:
        print(f"Every {every}th row is kept, so that the page stays below {document.PAGE_LIMIT / 1e6:g} MB.")
    return given.output, document.write(given.output, given.title, bodies, len(given.files))


def named(bodies: list[Body], labels: list[str]) -> list[Body]:
    """Bodies with names of their own, the second `wheel` as `wheel 2`; called by label, place on a car, or name."""
    if len(labels) > len(bodies):
        count = f"{len(bodies)} {'body' if len(bodies) == 1 else 'bodies'}"
        raise ViewError(f"--labels names {len(labels)} bodies, but the files hold {count}.")
    seen: Counter[str] = Counter()
    found = []
    for body, label in zip_longest(bodies, labels):
        seen[body.name] += 1
        name = body.name if seen[body.name] == 1 else f"{body.name} {seen[body.name]}"
        found.append(replace(body, name=name, label=label or PLACES.get(name.removeprefix("wheel_"), name)))
    return found


if __name__ == "__main__":
    sys.exit(main())
