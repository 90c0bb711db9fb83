"""Values as a user types them, v=40km/h, slope=12%, m=12kg, in SI: for the command lines of all examples.

Standard library alone, so that a command can refuse a typing error before anything is installed.
"""

import json
import math
import re
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

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
WHEELS = Path(__file__).resolve().parents[1] / "wheels.json"


class Fault(ValueError):
    """A value that cannot be meant; the message is one sentence for the user."""


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
    match = re.fullmatch(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(.*)", text.strip(), re.IGNORECASE)
    if not match:
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
    """` Do you mean ...?` for a name that is not there: near names, and those whose description has it as a word."""
    near = get_close_matches(name, known, 3, 0.6)
    word = re.compile(rf"\b{re.escape(name)}", re.IGNORECASE)
    if len(name) > 2:
        near += [n for n, about in known.items() if word.search(about) and n not in near]
    return f" Do you mean {' or '.join(near[:3])}?" if near else ""


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

    def value_of(self, text: str) -> str:
        """The value in SI as text for FMPy; Fault outside of the limits that the description sets."""
        if self.type == "Boolean":
            if text not in ("true", "false"):
                raise Fault(f'{self.name} = "{text}" must be true or false.')
            return text
        value = number(self.name, text, self.unit or "1")
        if self.name == "slope" and value < 0:
            raise Fault("slope must be at least 0: slope_direction=180deg turns uphill into downhill.")
        above = self.description.endswith("above 0") or ", above 0;" in self.description
        low, high = float(self.low or "-inf"), float(self.high or "inf")
        limited(self.name, value, self.unit, low, high, above=above)
        if self.type == "Integer" and value != int(value):
            raise Fault(f"{self.name} = {value:g} must be a whole number.")
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


def variables(description: str | bytes, *causalities: str) -> dict[str, Variable]:
    """Those of a modelDescription.xml, in its order; all, or those of these causalities."""
    found = {}
    for row in ElementTree.fromstring(description).iter("ScalarVariable"):
        texts = [row[0].get(attribute, "") for attribute in ("unit", "start", "min", "max")]
        known = (row.get("name", ""), row.get("causality", "local"), row[0].tag, *texts, row.get("description", ""))
        if known[1] in causalities or not causalities:
            found[known[0]] = Variable(*known, row.get("variability", ""), int(row.get("valueReference", "-1")))
    return found


def wheels() -> dict[str, dict[str, object]]:
    """The ready wheels: name -> title, source, parameters in SI."""
    return json.loads(WHEELS.read_text(encoding="utf-8"))


def ready(name: str) -> dict[str, float]:
    """The parameters of a ready wheel, and the paper's spin in proportion to its radius."""
    if name not in wheels():
        meant = suggestion(name, {n: str(wheel["title"]) for n, wheel in wheels().items()})
        raise Fault(f'There is no wheel "{name}"; there are {", ".join(wheels())}.{meant}')
    body = {n: float(value) for n, value in wheels()[name]["parameters"].items()}
    return body | {"phi_dot_start": -2 * scale(body, s=-1)}


def scale(body: Mapping[str, float], kg: int = 0, m: int = 0, s: int = 0) -> float:
    """A quantity of the dimension kg, m, s over that of the paper's wheel, m = 20 kg and R = r_0 + r = 0.35 m.

    Under the same gravity a wheel of the same shape then moves alike: times are in proportion to sqrt(R).
    """
    return (body["m"] / 20) ** kg * ((body["r_0"] + body["r"]) / 0.35) ** (m + s / 2)
