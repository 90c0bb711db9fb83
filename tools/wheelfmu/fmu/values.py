"""Values as a user types them, v=40km/h, slope=12%, m=12kg, in SI: for the command lines of all programs.

A value is taken as it is typed or refused: one number, a word or a whole number where the variable asks for one, within
the limits of modelDescription.xml, given once. Standard library alone, so that a command can refuse a typing error
before anything is installed.
"""

import argparse
import math
import re
from collections.abc import Collection, Iterable, Mapping
from difflib import get_close_matches
from typing import Any, NamedTuple, NoReturn
from xml.etree import ElementTree

from .paths import ROOT

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
    "Nm/rad": {"kNm/rad": 1e3, "Nm/deg": 1 / DEGREE},
    "Nms/rad": {"kNms/rad": 1e3, "Nms/deg": 1 / DEGREE},
    "N/m": {"kN/m": 1e3, "N/mm": 1e3},
    **{unit: {f"k{unit}": 1e3} for unit in ("N", "Nm", "Ns/m")},
}


class Fault(argparse.ArgumentTypeError, ValueError):
    """A value that cannot be meant; the message is one sentence for the user."""


class Once(argparse.Action):
    """An option with a value, which may be given once."""

    def __call__(self, parser, namespace, values, option_string=None) -> None:  # noqa: ANN001 - as argparse calls it
        before = getattr(namespace, self.dest, self.default)
        if option_string and before is not self.default:
            raise argparse.ArgumentError(self, f"it is given twice, as {shown(before)} and as {shown(values)}")
        setattr(namespace, self.dest, values)


def shown(value: Any) -> str:
    """An option's value or values, as they are typed."""
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


class Parser(argparse.ArgumentParser):
    """Options are written out and given once; a fault is one sentence on stderr and exit status 2."""

    def __init__(self, **how: Any) -> None:
        super().__init__(allow_abbrev=False, **how)
        self.register("action", None, Once)

    def error(self, message: str) -> NoReturn:
        name = self.prog.rpartition("/")[2]
        sentence = message if message.endswith((".", "?")) else f"{message}."
        self.exit(2, f"{name}: {sentence} ./scripts/{name} --help explains it.\n")


def single(given: Iterable[tuple[str, Any]]) -> dict[str, Any]:
    """Pairs as a dictionary; Fault where a name comes twice."""
    found: dict[str, Any] = {}
    for name, value in given:
        if name in found:
            raise Fault(f"{name} is given twice, as {found[name]} and as {value}: leave one of the two out.")
        found[name] = value
    return found


def number(name: str, text: str, unit: str = "1") -> float:
    """The value in SI of a variable with this unit; a slope may be given in %."""
    value, given = parted(name, text)
    plain = _plain(unit)
    if given == "%" and name == "slope":
        return math.atan(value / 100)
    known = {"": 1.0, plain: 1.0, **UNITS.get(plain, {})}
    if given not in known:
        others = [*UNITS.get(plain, {}), *["%"] * (name == "slope")]
        takes = f"no unit but {' or '.join([unit, *others])}" if plain != "1" else "no unit"
        raise Fault(f'{name} = "{text}": it takes {takes}.')
    return value * known[given]


def parted(name: str, text: str) -> tuple[float, str]:
    """The number and the unit behind it, empty if there is none."""
    if "," in text:
        raise Fault(f'{name} = "{text}" is not one number: the decimal mark is a point, not a comma.')
    match = re.fullmatch(r"([-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+]?[0-9]+)?)\s*(.*)", text.strip(), re.IGNORECASE)
    if not match or not math.isfinite(float(match[1])):
        raise Fault(f'{name} = "{text}" is not a number.')
    return float(match[1]), _plain(match[2])


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
    raise Fault(f"{name} = {value:g}: it must be {' and '.join(limits) or 'finite'}{unit}.")


def suggestion(name: str, known: Mapping[str, str]) -> str:
    """` Do you mean ...?` for a name that is not there: those that begin with it, are near, or have it as a word of
    their description; else the nearest."""
    spelt = {n.lower(): n for n in known}
    near = [n for low, n in spelt.items() if low.startswith(f"{name.lower()}_")]
    near += [spelt[low] for low in get_close_matches(name.lower(), spelt, 3, 0.6)]
    word = re.compile(rf"\b{re.escape(name)}", re.IGNORECASE)
    if len(name) > 2:
        near += [n for n, about in known.items() if word.search(about)]
    near = near or [spelt[low] for low in get_close_matches(name.lower(), spelt, 1, 0.5)]
    return f" Do you mean {' or '.join([*dict.fromkeys(near)][:3])}?" if near else ""


def one_of(names: Collection[str], typed: str, kind: str = "") -> str:
    """A name as it is typed; Fault if there is none such."""
    if typed not in names:
        meant = suggestion(typed, dict.fromkeys(names, ""))
        raise Fault(f'there is no {kind}{" " * bool(kind)}"{typed}"; there are {", ".join(names)}.{meant}')
    return typed


class Variable(NamedTuple):
    """A variable of wheel.fmu, by the texts of its description."""

    name: str
    causality: str
    type: str
    unit: str
    start: str
    low: str
    high: str
    description: str
    variability: str = "fixed"
    reference: int = -1

    @property
    def preset(self) -> float:
        """The start value; 1 is true."""
        return float(self.start == "true") if self.type == "Boolean" else float(self.start)

    @property
    def words(self) -> dict[str, float]:
        """Those that stand for its values, none of a number; the numbers are taken too."""
        if self.type == "Boolean":
            return {"false": 0.0, "true": 1.0}
        named = re.findall(r"\b(\d) ([a-z]\w*)", self.description) if self.type == "Integer" else ()
        return {word: float(number) for number, word in named}

    def number_of(self, text: str) -> float:
        """The value in SI, that of a word too; Fault outside of the limits that the description sets."""
        words = self.words
        if (word := text.strip().lower()) in words:
            return words[word]
        if words and not re.fullmatch(r"[-+.,0-9]+", text.strip()):
            raise self._no_word(f'"{text}"')
        value = number(self.name, text, self.unit or "1")
        try:
            return self.checked(value)
        except Fault as fault:
            bare = self.unit == "rad" and not parted(self.name, text)[1]
            if not bare or not float(self.low or "-inf") <= value * DEGREE <= float(self.high or "inf"):
                raise
            raise Fault(f"{fault} Do you mean {text.strip()}deg?") from None

    def checked(self, value: float) -> float:
        """A value in SI; Fault where the variable cannot have it."""
        if self.words and value not in self.words.values():
            raise self._no_word(f"{value:g}")
        if self.name == "slope" and value < 0:
            raise Fault("slope must be at least 0: slope_direction=180deg turns uphill into downhill.")
        above = self.description.endswith("above 0") or ", above 0;" in self.description
        limited(self.name, value, self.unit, float(self.low or "-inf"), float(self.high or "inf"), above=above)
        if self.type == "Integer" and value != int(value):
            raise Fault(f"{self.name} = {value:g} must be a whole number.")
        return value

    def _no_word(self, given: str) -> Fault:
        bare = self.type == "Boolean"
        listed = (word if bare else f"{number:g} ({word})" for word, number in self.words.items())
        return Fault(f"{self.name} = {given} is not one of {', '.join(listed)}.")

    def value_of(self, text: str) -> str:
        """The value in SI as text for FMPy."""
        value = self.number_of(text)
        if self.type == "Boolean":
            return "true" if value else "false"
        return repr(int(value)) if value == int(value) else repr(value)

    def said(self, value: float) -> str:
        """`slope = 8 deg`, `friction_law = 2 (regularized)`."""
        if self.type == "Boolean":
            return f"{self.name} = {'true' if value else 'false'}"
        if self.type == "Integer":
            words = self.description.partition(f"{value:g} ")[2]
            return f"{self.name} = {value:g}" + (f" ({words.split()[0].strip(',;')})" if words else "")
        if self.unit == "rad":
            return f"{self.name} = {value / DEGREE:.6g} deg"
        return f"{self.name} = {value:.6g} {'' if self.unit == '1' else self.unit.replace('.', ' ')}".rstrip()


def variables(*causalities: str, description: str | bytes = b"") -> dict[str, Variable]:
    """Those of a modelDescription.xml, of the project's if none is given; all, or those of these causalities."""
    found = {}
    tree = ElementTree.fromstring(description or (ROOT / "modelDescription.xml").read_bytes())
    for row in tree.iter("ScalarVariable"):
        unit, start, low, high = (row[0].get(attribute, "") for attribute in ("unit", "start", "min", "max"))
        name, causality, text = row.get("name", ""), row.get("causality", "local"), row.get("description", "")
        rest = row.get("variability", ""), int(row.get("valueReference", "-1"))
        if causality in causalities or not causalities:
            found[name] = Variable(name, causality, row[0].tag, unit, start, low, high, text, *rest)
    return found
