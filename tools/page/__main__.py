"""Command line of the pages: `recorded` for result files, `live` for the wheel itself."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from page import description, document, options
from page.bodies import Body, ViewError, read_bodies
from page.document import Choice

PLACES = {"fl": "front left", "fr": "front right", "rl": "rear left", "rr": "rear right"}


def main() -> int:
    """Write a page; a fault of the input is one sentence on stderr and exit status 1."""
    kind, *words = sys.argv[1:]
    arguments = live_arguments(words) if kind == "live" else options.arguments(words)
    try:
        size = live(arguments) if kind == "live" else recorded(arguments)
    except ViewError as fault:
        print(f"view: {fault}", file=sys.stderr)
        return 1
    print(f"{arguments.output} ({size / 1e6:.1f} MB): open it in a browser.")
    return 0


def live_arguments(words: list[str]) -> argparse.Namespace:
    """What ./scripts/page gives."""
    parser = argparse.ArgumentParser(prog="scripts/page", description="The page that holds the wheel itself.")
    parser.add_argument("--wasm", type=Path, required=True)
    parser.add_argument("--output", "-o", type=Path, required=True)
    return parser.parse_args(words)


def recorded(arguments: argparse.Namespace) -> int:
    given = {name: getattr(arguments, name) for name in options.GIVEN if getattr(arguments, name) is not None}
    files = [read_bodies(path, given, arguments.box) for path in arguments.files]
    bodies = unlike([body for file in files for body in file])
    bodies, every = document.thinned(bodies)
    if every > 1:
        print(f"Every {every}th row is kept, so that the page stays below {document.PAGE_LIMIT / 1e6:g} MB.")
    labels = labels_of(bodies, arguments.labels)
    return document.write(arguments.output, arguments.title, bodies, labels, choices(bodies, labels, len(files)))


def unlike(bodies: list[Body]) -> list[Body]:
    """Bodies with names of their own: the second `wheel` is called `wheel 2`."""
    seen: dict[str, int] = {}
    named = []
    for body in bodies:
        seen[body.name] = seen.get(body.name, 0) + 1
        number = seen[body.name]
        named.append(body if number == 1 else document.replace(body, name=f"{body.name} {number}"))
    return named


def labels_of(bodies: list[Body], given: list[str]) -> dict[str, str]:
    """What each body is called: as given, in their order, else by its place on a car, else by its name."""
    if len(given) > len(bodies):
        count = f"{len(bodies)} {'body' if len(bodies) == 1 else 'bodies'}"
        raise ViewError(f"--labels names {len(given)} bodies, but the files hold {count}.")
    places = {body.name: PLACES.get(body.name.removeprefix("wheel_"), body.name) for body in bodies}
    return places | {body.name: label for body, label in zip(bodies, given, strict=False)}


def choices(bodies: list[Body], labels: dict[str, str], files: int) -> list[Choice]:
    """What one can look at: all together, wheels of several files side by side, and each wheel alone."""
    names = [body.name for body in bodies]
    wheels = [body.name for body in bodies if body.size is None]
    alone = [Choice(labels.get(name, name), [[name]]) for name in wheels]
    if len(names) == 1:
        return [Choice(labels.get(names[0], names[0]), [names])]
    together = [Choice("Together", [names])]
    if len(wheels) == len(names) <= 3:
        beside = [Choice("Side by side", [[name] for name in names])]
        return [*together, *beside, *alone] if files == 1 else [*beside, *together, *alone]
    return [*together, *(alone if len(alone) <= 8 else [])]


def live(arguments: argparse.Namespace) -> int:
    choice = Choice("This wheel", [["live"]])
    return document.write(arguments.output, "The wheel, live", [], {}, [choice], live=description.live(arguments.wasm))


if __name__ == "__main__":
    sys.exit(main())
