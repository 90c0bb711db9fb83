"""Values as a user types them, v=40km/h, slope=12%, m=12kg, in SI: for the command lines of all examples.

Standard library alone, so that a command can refuse a typing error before anything is installed.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path

DEGREE = math.pi / 180
# Unit of a variable -> other units that may follow the number, in that unit. Dots and ^ may be left out: Nm, kgm2.
UNITS = {
    "kg": {"g": 1e-3, "t": 1e3},
    "kgm2": {"gcm2": 1e-7},
    "m": {"mm": 1e-3, "cm": 1e-2, "km": 1e3},
    "m/s": {"km/h": 1 / 3.6},
    "s": {"ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "rad": {"deg": DEGREE, "°": DEGREE},
    "rad/s": {"deg/s": DEGREE, "deg": DEGREE, "rpm": 2 * math.pi / 60},
    "N": {"kN": 1e3},
    "Nm": {"kNm": 1e3},
    "N/m": {"kN/m": 1e3, "N/mm": 1e3},
    "Ns/m": {"kNs/m": 1e3},
}
WHEELS = Path(__file__).resolve().parents[1] / "wheels.json"


class Fault(Exception):
    """A value that cannot be meant; the message is one sentence for the user."""


def number(name: str, text: str, unit: str = "1") -> float:
    """The value in SI of a variable with this unit; a slope may be given in %."""
    match = re.fullmatch(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(.*)", text.strip(), re.IGNORECASE)
    if not match:
        raise Fault(f'{name} = "{text}" is not a number.')
    value, given, plain = float(match[1]), _plain(match[2]), _plain(unit)
    if given == "%" and name == "slope":
        return math.atan(value / 100)
    known = {"": 1.0, plain: 1.0, **UNITS.get(plain, {})}
    if given not in known:
        others = [*UNITS.get(plain, {}), *["%"] * (name == "slope")]
        takes = f"no unit but {' or '.join([unit, *others])}" if plain != "1" else "no unit"
        raise Fault(f'{name} = "{text}": it takes {takes}.')
    return value * known[given]


def _plain(unit: str) -> str:
    return unit.replace(".", "").replace("^", "").replace(" ", "").replace("²", "2")


def limited(
    name: str, value: float, unit: str = "", low: float = -math.inf, high: float = math.inf, *, above: bool = False
) -> float:
    """The value, if it lies from low (or above low) to high and is finite."""
    if math.isfinite(value) and (low < value if above else low <= value) and value <= high:
        return value
    limits = [f"{'above' if above else 'at least'} {low:g}"] * math.isfinite(low)
    limits += [f"at most {high:g}"] * math.isfinite(high)
    unit = "" if unit == "1" else f" {unit}".rstrip()
    raise Fault(f"{name} = {value:g}{unit} must be {' and '.join(limits) or 'finite'}.")


def suggestion(name: str, known: Mapping[str, str]) -> str:
    """` Do you mean ...?` for a name that is not there: near names, and those whose description has it as a word."""
    near = get_close_matches(name, known, 3, 0.6)
    word = re.compile(rf"\b{re.escape(name)}", re.IGNORECASE)
    if len(name) > 2:
        near += [n for n, about in known.items() if word.search(about) and n not in near]
    return f" Do you mean {' or '.join(near[:3])}?" if near else ""


def wheels() -> dict[str, dict[str, object]]:
    """The ready wheels: name -> title, source, parameters in SI."""
    return json.loads(WHEELS.read_text(encoding="utf-8"))
