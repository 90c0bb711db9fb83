"""Wheels and bodies that have names (examples/wheels.json, bodies.json), and the speeds, times and moments that follow
from a wheel's parameters. Standard library alone, as in values.py.
"""

import json
import math
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from .paths import ROOT
from .values import Fault, suggestion

EXAMPLES = ROOT / "examples"
WHEELS, BODIES = EXAMPLES / "wheels.json", EXAMPLES / "bodies.json"
MOMENTS = ("J_x", "J_y", "J_z")
UPRIGHT = {"psi_start": 0.0, "theta_start": math.pi / 2, "X_O_start": 0.0, "Y_O_start": 0.0}  # a vehicle's, along X
POINTS = 40  # rows in the fastest period of spin and nutation
HUB = 0.1  # of the radius: how far hub and spokes may be from the plane of a wheel with a thin tube, root mean square
ROUNDING = 1e-9  # of a moment: an excess that is no fault


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
