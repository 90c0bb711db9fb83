"""The arguments of ./scripts/view, read before anything is built or installed."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from wheelfmu.fmu import outputs
from wheelfmu.fmu.values import Fault, Parser, variables

GIVEN = ("r_0", "r", "slope", "slope_direction")
MARK = b'<meta name="generator" content="wheel.fmu">'  # of every page


def is_page(path: Path) -> bool:
    """Whether a file is a page of this program, which may be replaced."""
    return MARK in path.read_bytes()


def arguments(words: Sequence[str] | None = None) -> argparse.Namespace:
    """The options; what cannot be meant ends the program with a sentence."""
    of = variables("parameter")
    parser = Parser(prog="./scripts/view", description="Writes an offline 3D page of results (lab/lesson/README.md).")
    add = parser.add_argument
    add("files", nargs="+", type=Path, metavar="FILE.csv", help="as `fmpy simulate --output-file` writes it")
    add("--output", "-o", type=Path, help="the page (default: the first file's name with .html)")
    add("--title", default="The wheel in motion", help="of the page (default: %(default)s)")
    add("--labels", nargs="+", default=[], help="names of the wheels on the page, in order")
    add("--r_0", type=of["r_0"].number_of, help="ring radius in m (default: from Z_O and theta)")
    add("--r", type=of["r"].number_of, help="tube radius in m (default: from Z_O and theta)")
    add("--slope", type=of["slope"].number_of, help="slope of the road: 8deg, 12%% (default: the file's, else level)")
    add("--slope_direction", type=of["slope_direction"].number_of, help="direction in which the road rises, from X")
    add("--overwrite", action="store_true", help="replace the page even if this command did not write it")
    given = parser.parse_args(words)
    if missing := [str(path) for path in given.files if not path.is_file()]:
        parser.error(f"{missing[0]} cannot be read: there is no such file")
    if (given.r_0 is None) != (given.r is None):
        parser.error("--r_0 and --r are given together or not at all")
    given.output = given.output or given.files[0].with_suffix(".html")
    try:
        outputs.check([given.output], given.files, is_page, overwrite=given.overwrite)
    except Fault as fault:
        parser.error(str(fault))
    return given
