"""Command line of the pages: `recorded` for result files, `live` for the wheel itself."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from page import document
from page.bodies import Body, ViewError, read_bodies
from page.document import Choice


def main() -> int:
    """Write a page; a fault of the input is one sentence on stderr and exit status 1."""
    arguments = parse()
    try:
        size = live(arguments) if arguments.kind == "live" else recorded(arguments)
    except ViewError as fault:
        print(f"view: {fault}", file=sys.stderr)
        return 1
    print(f"{arguments.output} ({size / 1e6:.1f} MB): open it in a browser.")
    return 0


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/view", description=__doc__)
    kinds = parser.add_subparsers(dest="kind", required=True)
    shown = kinds.add_parser(
        "recorded", prog="scripts/view", description="An offline 3-D page of results (docs/page.md)."
    )
    shown.add_argument(
        "files", nargs="+", type=Path, metavar="FILE.csv", help="as `fmpy simulate --output-file` writes it"
    )
    shown.add_argument("--output", "-o", type=Path, help="the page (default: the first file's name with .html)")
    shown.add_argument("--title", default="The wheel in motion")
    shown.add_argument("--labels", nargs="+", default=[], help="what the bodies are called on the page, in their order")
    shown.add_argument("--r_0", type=float, help="ring radius in m (default: from Z_O and theta)")
    shown.add_argument("--r", type=float, help="tube radius in m (default: from Z_O and theta)")
    shown.add_argument("--box", nargs=3, type=float, metavar=("L", "W", "H"), help="size of a car's body in m")
    page = kinds.add_parser("live", prog="scripts/page", description="The page that holds the wheel itself.")
    page.add_argument("--wasm", type=Path, required=True)
    page.add_argument("--description", type=Path, required=True)
    page.add_argument("--output", "-o", type=Path, required=True)
    arguments = parser.parse_args()
    if arguments.output is None:
        arguments.output = arguments.files[0].with_suffix(".html")
    return arguments


def recorded(arguments: argparse.Namespace) -> int:
    if (arguments.r_0 is None) != (arguments.r is None):
        raise ViewError("--r_0 and --r are given together or not at all.")
    shape = None if arguments.r_0 is None else (arguments.r_0, arguments.r)
    if shape and not (shape[0] > 0 and shape[1] >= 0):
        raise ViewError(f"--r_0 {shape[0]:g} --r {shape[1]:g}: r_0 must be positive and r not negative.")
    files = [read_bodies(path, shape, tuple(arguments.box) if arguments.box else None) for path in arguments.files]
    bodies = unlike([body for file in files for body in file])
    bodies, every = document.thinned(bodies)
    if every > 1:
        print(f"Every {every}th row is kept, so that the page stays below {document.PAGE_LIMIT / 1e6:g} MB.")
    labels = {body.name: label for body, label in zip(bodies, arguments.labels, strict=False)}
    return document.write(arguments.output, arguments.title, bodies, labels, choices(bodies, labels))


def unlike(bodies: list[Body]) -> list[Body]:
    """Bodies with names of their own: the second `wheel` is called `wheel 2`."""
    seen: dict[str, int] = {}
    named = []
    for body in bodies:
        seen[body.name] = seen.get(body.name, 0) + 1
        number = seen[body.name]
        named.append(body if number == 1 else document.replace(body, name=f"{body.name} {number}"))
    return named


def choices(bodies: list[Body], labels: dict[str, str]) -> list[Choice]:
    """What one can look at: wheels side by side, all together, and each wheel alone."""
    names = [body.name for body in bodies]
    wheels = [body.name for body in bodies if body.size is None]
    alone = [Choice(labels.get(name, name), [[name]]) for name in wheels]
    if len(names) == 1:
        return [Choice(labels.get(names[0], names[0]), [names])]
    together = [Choice("Together", [names])]
    if len(wheels) == len(names) <= 3:
        return [Choice("Side by side", [[name] for name in names]), *together, *alone]
    return [*together, *(alone if len(alone) <= 8 else [])]


def live(arguments: argparse.Namespace) -> int:
    from page import live_wheel

    source = live_wheel.source(arguments.wasm, arguments.description)
    return document.write(arguments.output, "The wheel, live", [], {}, [Choice("This wheel", [["live"]])], live=source)


if __name__ == "__main__":
    sys.exit(main())
