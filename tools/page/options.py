"""The arguments of ./scripts/view, read before anything is built or installed."""

import argparse
import math
import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "examples" / "python"))
from values import number  # noqa: E402

GIVEN = ("r_0", "r", "slope", "slope_direction")


def angle(text: str) -> float:
    """An angle, or a slope in %."""
    return number("slope", text, "rad")


def length(text: str) -> float:
    return number("length", text, "m")


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    """The options; what cannot be meant ends the program with a sentence."""
    parser = argparse.ArgumentParser(prog="scripts/view", description="An offline 3-D page of results (docs/page.md).")
    add = parser.add_argument
    add("files", nargs="+", type=Path, metavar="FILE.csv", help="as `fmpy simulate --output-file` writes it")
    add("--output", "-o", type=Path, help="the page (default: the first file's name with .html)")
    add("--title", default="The wheel in motion")
    add("--labels", nargs="+", default=[], help="what the bodies are called on the page, in their order")
    add("--r_0", type=length, help="ring radius in m (default: from Z_O and theta)")
    add("--r", type=length, help="tube radius in m (default: from Z_O and theta)")
    add("--slope", type=angle, help="of the road: 8deg, 12%% (default: the file's, else level)")
    add("--slope_direction", type=angle, help="in which the road rises, from X (default: the file's, else X)")
    add("--box", nargs=3, type=length, metavar=("L", "W", "H"), help="size of a car's body in m")
    given = parser.parse_args(words)
    if missing := [str(path) for path in given.files if not path.is_file()]:
        sys.exit(f"view: {missing[0]} cannot be read: there is no such file.")
    if (given.r_0 is None) != (given.r is None):
        sys.exit("view: --r_0 and --r are given together or not at all.")
    if given.r_0 is not None and not (given.r_0 > 0 and given.r >= 0):
        sys.exit(f"view: --r_0 {given.r_0:g} --r {given.r:g}: r_0 must be positive and r not negative.")
    if given.slope is not None and not 0 <= given.slope < math.pi / 2:
        sys.exit(f"view: --slope {given.slope:g} rad: from 0 to less than 90deg; --slope_direction points uphill.")
    given.output = given.output or given.files[0].with_suffix(".html")
    return given


if __name__ == "__main__":
    arguments()
