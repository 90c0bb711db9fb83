"""Writes the pages: of result files, and of the wheel itself."""

import argparse
from collections import Counter
from dataclasses import replace
from itertools import zip_longest
from pathlib import Path

from lab.lesson import document, options
from lab.lesson.bodies import Body, read_bodies
from wheelfmu.fmu.outputs import check
from wheelfmu.fmu.values import Fault

PLACES = {"fl": "front left", "fr": "front right", "rl": "rear left", "rr": "rear right"}


def live(wasm: Path, output: Path, *, overwrite: bool = False) -> None:
    check([output], [wasm], options.is_page, overwrite=overwrite)
    written(output, document.write(output, "The rolling wheel, a lesson", [], wasm=wasm))


def recorded(given: argparse.Namespace) -> None:
    parameters = {name: getattr(given, name) for name in options.GIVEN if getattr(given, name) is not None}
    bodies = [body for path in given.files for body in read_bodies(path, parameters)]
    bodies, every = document.thinned(named(bodies, given.labels))
    if every > 1:
        print(f"One row in {every} is kept, so that the page stays below {document.PAGE_LIMIT / 1e6:g} MB.")
    written(given.output, document.write(given.output, given.title, bodies, len(given.files)))


def written(output: Path, size: int) -> None:
    print(f"{output} ({size / 1e6:.1f} MB): open it in a browser.")


def named(bodies: list[Body], labels: list[str]) -> list[Body]:
    """Bodies with distinct names, the second `wheel` as `wheel 2`; called by label, place on a car, or name."""
    if len(labels) > len(bodies):
        count = f"{len(bodies)} {'wheel' if len(bodies) == 1 else 'wheels'}"
        raise Fault(f"--labels names {len(labels)} wheels, but the files hold {count}.")
    seen: Counter[str] = Counter()
    found = []
    for body, label in zip_longest(bodies, labels):
        seen[body.name] += 1
        name = body.name if seen[body.name] == 1 else f"{body.name} {seen[body.name]}"
        found.append(replace(body, name=name, label=label or PLACES.get(name.removeprefix("wheel_"), name)))
    return found
