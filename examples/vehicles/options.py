"""Parameters on the command line: name=value, with ms, s, deg, kN/m and the like after a number."""

from __future__ import annotations

import re
from difflib import get_close_matches
from math import pi

UNITS = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "m": 1.0, "mm": 1e-3, "deg": pi / 180, "rad": 1.0, "kg": 1.0,
         "N": 1.0, "kN": 1e3, "N/m": 1.0, "kN/m": 1e3, "Nm": 1.0, "m/s": 1.0, "km/h": 1 / 3.6}  # fmt: skip
_NUMBER = re.compile(r"([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)([a-zA-Z/]*)", re.IGNORECASE)


class Refused(Exception):  # noqa: N818 - one sentence for the user
    """The command line asks for something that does not exist."""


def number(name: str, text: str) -> float:
    """The value in SI units."""
    match = _NUMBER.fullmatch(text)
    if not match or match[2] not in UNITS:
        raise Refused(f"{name}={text} is not a number with one of the units {', '.join(filter(None, UNITS))}.")
    return float(match[1]) * UNITS[match[2]]


class Asked(Exception):  # noqa: N818 - the list of all options
    """The command line asks for help."""


def read(arguments: list[str], words: dict[str, tuple[str, ...]], numbers: set[str]) -> dict[str, str | float]:
    """The options by name: `words` take one of the values given, `numbers` a number."""
    if {"-h", "--help"} & set(arguments):
        choices = [f"  {name}={'|'.join(values)}" for name, values in words.items()]
        raise Asked("\n".join(["It takes:", *choices, f"  and numbers, such as h=1ms: {', '.join(sorted(numbers))}."]))
    given: dict[str, str | float] = {}
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals:
            raise Refused(f"{argument} is not name=value.")
        if name in words:
            if text not in words[name]:
                raise Refused(f"{name} is one of {', '.join(words[name])}, not {text}.")
            given[name] = text
        elif name in numbers:
            given[name] = number(name, text)
        else:
            near = get_close_matches(name, [*words, *numbers], 5, 0.3)
            raise Refused(
                f"There is no parameter {name} here; there are, for example, {', '.join(near or sorted(numbers)[:8])}."
            )
    return given
