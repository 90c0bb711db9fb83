"""Values as a user types them, v=40km/h, slope=12%, m=12kg, in SI: for the command lines of all programs.

A value is taken as it is typed or refused: one number, a word or a whole number where the variable asks for one, within
the limits of modelDescription.xml, given once. Standard library alone, so that a command can refuse a typing error
before anything is installed.
"""

import argparse
import json
import math
import re
from collections.abc import Collection, Iterable, Mapping
from difflib import get_close_matches
from fractions import Fraction
from functools import cache
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
EXAMPLES = ROOT / "examples"
WHEELS, BODIES = EXAMPLES / "wheels.json", EXAMPLES / "bodies.json"
MOMENTS = ("J_x", "J_y", "J_z")
UPRIGHT = {"psi_start": 0.0, "theta_start": math.pi / 2, "X_O_start": 0.0, "Y_O_start": 0.0}  # a vehicle's, along X
POINTS = 40  # rows in the fastest period of spin and nutation
HUB = 0.1  # of the radius: how far hub and spokes may be from the plane of a wheel with a thin tube, root mean square
ROUNDING = 1e-9  # of a moment: an excess that is no fault


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


def variables(description: str | bytes, *causalities: str) -> dict[str, Variable]:
    """Those of a modelDescription.xml, in its order; all, or those of these causalities."""
    found = {}
    for row in ElementTree.fromstring(description).iter("ScalarVariable"):
        unit, start, low, high = (row[0].get(attribute, "") for attribute in ("unit", "start", "min", "max"))
        name, causality, text = row.get("name", ""), row.get("causality", "local"), row.get("description", "")
        rest = row.get("variability", ""), int(row.get("valueReference", "-1"))
        if causality in causalities or not causalities:
            found[name] = Variable(name, causality, row[0].tag, unit, start, low, high, text, *rest)
    return found


def wheels() -> dict[str, dict[str, Any]]:
    """The presets: name -> title, source, parameters in SI; `start`, of a preset case, is how the wheel moves."""
    return json.loads(WHEELS.read_text(encoding="utf-8"))


def preset(name: str) -> dict[str, float]:
    """The parameters of a preset, and the paper's spin and start in proportion to its radius."""
    if name not in wheels():
        meant = suggestion(name, {n: str(wheel["title"]) for n, wheel in wheels().items()})
        raise Fault(f'There is no wheel "{name}"; there are {", ".join(wheels())}.{meant}')
    body = {n: float(value) for n, value in wheels()[name]["parameters"].items()}
    return body | {"phi_dot_start": -2 * scale(body, s=-1), "X_O_start": -body["r_0"] * math.cos(5 * math.pi / 12)}


def thrown(name: str) -> dict[str, float]:
    """Road and start of a preset case, none of a wheel alone."""
    return {n: float(value) for n, value in wheels()[name].get("start", {}).items()}


def scale(body: Mapping[str, float], kg: int = 0, m: int = 0, s: int = 0) -> float:
    """A quantity of the dimension kg, m, s over that of the paper's wheel, m = 20 kg and R = r_0 + r = 0.35 m.

    Under the same gravity a wheel of the same shape then moves alike: times are in proportion to sqrt(R).
    """
    return (body["m"] / 20) ** kg * ((body["r_0"] + body["r"]) / 0.35) ** (m + s / 2)


def nutation(body: Mapping[str, float], spin: float) -> float:
    """The rate in rad/s at which a wheel of this spin nods: that of fast upright rolling; 0 on a wheel carrier."""
    m, r_0, r, J_x, J_y, J_z = (body[name] for name in ("m", "r_0", "r", *MOMENTS))
    J, R2 = min(J_x, J_y), (r_0 + r) ** 2
    free = not body.get("guided", 0.0)
    return free * abs(spin) * math.sqrt(J_z * (J_z + m * R2) / (J * (J + m * R2)))


def interval(own: Mapping[str, float], longest: float) -> float:
    """s between rows: 1, 2 or 5 of a power of ten, at most `longest`, with POINTS in the start's fastest period,
    of spin or nutation."""
    phi_dot, psi_dot = own["phi_dot_start"], own["psi_dot_start"]
    omega_z = phi_dot + psi_dot * math.cos(own["theta_start"])
    rate = max(abs(phi_dot), nutation(own, max(abs(omega_z), abs(psi_dot))), 1e-300)
    wanted = min(longest, 2 * math.pi / (POINTS * rate))
    power = 10.0 ** math.floor(math.log10(wanted) + 1e-9)
    return float(f"{max(k for k in (1, 2, 5) if k * power <= wanted * (1 + 1e-9)) * power:.1g}")


def spin(v: float, r_0: float, r: float, theta: float = math.pi / 2, psi_dot: float = 0.0) -> float:
    """phi_dot in rad/s of a wheel whose centre moves at v in m/s along e1; forward is negative."""
    return 0.0 - (v + psi_dot * r_0 * math.cos(theta)) / (r_0 + r * math.sin(theta))


@cache
def bodies() -> dict[str, dict[str, Any]]:
    """The bodies: name -> title, source, and J_x = J_y and J_z over m, as parts of the squares of lengths."""
    return json.loads(BODIES.read_text(encoding="utf-8"))


def moments(body: str, m: float = 20.0, r_0: float = 0.3, r: float = 0.05) -> dict[str, float]:
    """J_x, J_y, J_z in kg m2 of a body of this mass in kg and these radii in m; of the paper's, if not given."""
    if body not in bodies():
        meant = suggestion(body, {n: str(one["title"]) for n, one in bodies().items()})
        raise Fault(f'There is no body "{body}"; there are {", ".join(bodies())}.{meant}')
    lengths = {"r_0": r_0, "r": r, "R": r_0 + r}

    def moment(name: str) -> float:
        parts = bodies()[body][name].items()
        return m * sum(float(Fraction(part)) * (lengths[length] * lengths[length]) for length, part in parts)

    return {"J_x": moment("J_x"), "J_y": moment("J_x"), "J_z": moment("J_z")}


def doubt(body: Mapping[str, float]) -> str:
    """One sentence if no mass within the wheel's outline has its moments; else nothing.

    The outline is the convex hull of the torus. The mean square of the mass's distance from the wheel's plane,
    w = (J_x + J_y - J_z) / (2 m), is at most r^2, that from the axle, J_z / m, at most (r_0 + sqrt(r^2 - w))^2. Hub and
    spokes may be wider than a thin tube: up to sqrt(w) = HUB (r_0 + r).
    """
    m, r_0, r, J_x, J_y, J_z = (body[name] for name in ("m", "r_0", "r", *MOMENTS))
    across, slack, width = (J_x + J_y - J_z) / 2, ROUNDING * (J_x + J_y + J_z), max(r, HUB * (r_0 + r))
    about, beside = f"J_z = {J_z:.4g} kg m2 is more than", f"(J_x + J_y - J_z)/2 = {across:.4g} kg m2"
    if J_z > (most := m * (r_0 + r) ** 2) + slack:
        return f"{about} m (r_0 + r)^2 = {most:.4g} kg m2: no mass within the wheel's radius has this moment."
    if across > (most := m * width**2) + slack:
        limit = "m r^2" if width == r else f"m ({HUB:g} (r_0 + r))^2"
        return f"{beside} is more than {limit} = {most:.4g} kg m2: so far from its plane the wheel has no mass."
    most = m * (r_0 + math.sqrt(max(r * r - across / m, 0.0))) ** 2
    if across <= m * r * r and J_z > most + slack:
        return f"{about} {most:.4g} kg m2: no mass within the wheel's outline has it together with {beside}."
    return ""
