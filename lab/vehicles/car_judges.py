"""The car's manoeuvres in closed form, a car whose wheels never slip, on stiff bushings; and what road tests report.

With m all masses, R the wheels' radius, m_t = m + 4 J_z / R^2 (four wheels), L the wheelbase and T the track:

    launch and braking   m_t a = (M_drive - s m g - brakes) / R; the rear axle gains (a I + m_B g (h_B - R) pitch) / L
    any bend             rear point on R = L / tan delta, so yaw rate = v tan(delta) / L at any speed: no understeer;
                         front axle m_f v omega, m_f L the first moment of all masses about the rear point
    braking in a bend    the kinetic energy of masses and wheels, each at its own speed, goes into the brakes
    Ackermann            cot delta_outer - cot delta_inner = T / L
    steady circle        the outer wheels gain (a I + g roll (m_B (h_B - r) + 4 m_w r_0)) / T together

I = m_B h_B + 4 (m_w R + J_z / R): masses at their heights, and the wheels' spin that is sped up or turned. As the car
leans by the roll angle the masses move outwards from the wheels' centres, and the contact points inwards, by r_0 roll.

Characteristic values in the manner of ISO 4138 (constant steer angle, rising speed), ISO 7401 (step input), ISO 3888
(two changes of lane); steer angles are those of the bicycle's wheel, not of a steering wheel. A table has time, v,
omega, psi, roll, delta, a_y and beta, and the ground's forces on each wheel.

A closed form is printed where it holds: for any values of the parameters that manoeuvres.toml lists, while no wheel
slides (but where it must) and no strut reaches its stop. A run beyond its bound has failed.
"""

import tomllib
import warnings
from collections.abc import Iterator
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid

from .options import EXAMPLES, Manoeuvre, manoeuvres
from .vehicle import Table, row_of_brake

LAYOUT = tomllib.loads((EXAMPLES / "car" / "car.toml").read_text())  # SI, from the chassis' centre of mass
WHEELS: dict[str, dict[str, float | str]] = LAYOUT["wheel"]
NAMES = {wheel: str(of["name"]) for wheel, of in WHEELS.items()}
R_0, R, M_WHEEL, J_X, J_Z, G = 0.3, 0.35, 20.0, 0.9, 1.8, 9.81  # the wheels' defaults
MANOEUVRES = manoeuvres("car")
STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST, SPLIT, CURVE = MANOEUVRES.values()
AXLES = {w["axle"]: [n for n, other in WHEELS.items() if other["axle"] == w["axle"]] for w in WHEELS.values()}
LEFT, RIGHT = ([name for name, wheel in WHEELS.items() if side * wheel["y"] > 0] for side in (1, -1))
KINEMATIC, LOADED = 0.02, 0.08  # bounds, relative: what links that yield change of paths and speeds, and of loads


def constants(manoeuvre: Manoeuvre) -> SimpleNamespace:
    """The car of a manoeuvre: its masses, lengths and stiffnesses, and what follows from them."""
    c = SimpleNamespace(**{name: manoeuvre[name] for name in ("m_B", "h_B", "J_3")}, g=G * np.cos(manoeuvre["slope"]))
    for name in ("x", "y", "k", "k_bar", "steer", "drive", "brake"):
        setattr(c, name, {w: manoeuvre[f"{name}_{w}"] for w in WHEELS})
    steered = [w for w in WHEELS if c.steer[w] > 0.5]
    c.x_rear = float(np.mean([c.x[w] for w in WHEELS if w not in steered]))  # rear point
    c.wheelbase = float(np.mean([c.x[w] for w in steered])) - c.x_rear
    c.track = float(np.ptp([c.y[w] for w in steered]))
    c.mass = c.m_B + M_WHEEL * len(WHEELS)
    c.m_t = c.mass + len(WHEELS) * J_Z / R**2
    c.heights = c.m_B * c.h_B + len(WHEELS) * M_WHEEL * R  # kg m
    c.inertia = c.heights + len(WHEELS) * J_Z / R  # kg m
    c.leaning = c.m_B * (c.h_B - (R - R_0)) + len(WHEELS) * M_WHEEL * R_0  # kg m, about the contacts, per roll angle
    struts = sum(c.k[w] * c.y[w] ** 2 for w in WHEELS)  # N m/rad, as the bars; wheels stand on the ground
    ends = {w: str(of["bar_to"]) for w, of in WHEELS.items() if "bar_to" in of}
    bars = sum(c.k_bar[w] * (c.y[w] - c.y[other]) ** 2 for w, other in ends.items())
    # Roll angle per lateral acceleration, rad s2/m: the chassis leans outwards by its height, the contact inwards.
    c.roll_gradient = c.inertia / (struts + bars - G * c.leaning)
    return c


class Finding(NamedTuple):
    """One quantity as measured in a run, and of rigid links and wheels that never slip, where that is known; `share` of
    it, and no less than of `least`, is the bound of the difference."""

    what: str
    unit: str
    measured: float
    exact: float | None = None
    share: float = KINEMATIC
    least: float = 0.0

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        exact = "" if self.exact is None else f" (closed form: {self.exact:.4g})"
        return f"{self.what}: {self.measured:.4g}{unit}{exact}"

    @property
    def fault(self) -> str:
        """A difference beyond the bound, in words; empty where there is none."""
        if self.exact is None or abs(self.measured - self.exact) <= self.share * max(abs(self.exact), self.least):
            return ""
        return f"the {self.what} deviates from its closed form by more than {100 * self.share:g} %"


def force(table: Table, wheels: list[str], k: int = 3) -> np.ndarray:
    """Force of the ground on some wheels together, along X, Y or the normal."""
    return np.sum([table[f"{w}.lambda_{k}"] for w in wheels], axis=0)


def friction(table: Table) -> dict[str, np.ndarray]:
    """Horizontal over normal force of each axle's wheels together: wheels that never slip are redundant across, and
    only the bushings decide which of them carries the lateral force."""
    forces = {axle: [force(table, wheels, k) for k in (1, 2, 3)] for axle, wheels in AXLES.items()}
    return {axle: np.hypot(along, across) / normal for axle, (along, across, normal) in forces.items()}


def demand(table: Table) -> dict[str, float]:
    """Largest friction coefficient that each axle requires: the road on which the manoeuvre would be possible."""
    return {axle: float(np.nanmax(mu)) for axle, mu in friction(table).items()}


def per_axle(asked: dict[str, float]) -> str:
    """In words."""
    return ", ".join(f"{axle} {mu:.2f}" for axle, mu in asked.items())


def load_moved(table: Table, c: SimpleNamespace, axle: str, cause: str, at: np.ndarray, moment: float) -> Finding:
    """Mean normal force of an axle over some instants, above that at the start. `moment` [N m] moves load to the rear
    axle, together with that of the chassis' weight as it pitches about its hubs."""
    normal, pitch = force(table, AXLES[axle]), float(np.mean(table["pitch"][at]))
    exact = (moment - c.m_B * c.g * (c.h_B - R) * pitch) / c.wheelbase * (1 if axle == "rear" else -1)
    moved = float(np.mean(normal[at]) - normal[0])
    return Finding(f"load moved to the {axle} axle by the {cause}", "N", moved, exact, LOADED, 0.03 * c.mass * G)


def resistance(manoeuvre: Manoeuvre, c: SimpleNamespace) -> tuple[float, float]:
    """Moment of rolling friction about all axles, N m, and gravity down the slope, m/s2."""
    return manoeuvre["s"] * c.mass * c.g, G * np.sin(manoeuvre["slope"]) * np.cos(manoeuvre["slope_direction"])


def pulling(table: Table, manoeuvre: Manoeuvre) -> np.ndarray:
    """The last second of full torque."""
    return (table["time"] > manoeuvre["t_off"] - 1) & (table["time"] < manoeuvre["t_off"])


def launch(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """Acceleration and load transfer in the last second of full torque."""
    t, window, (drag, grade) = table["time"], pulling(table, manoeuvre), resistance(manoeuvre, c)
    a = (manoeuvre["M_0"] * sum(c.drive.values()) - drag - R * c.mass * grade) / (R * c.m_t)
    measured = float(np.polyfit(t[window], table["v"][window], 1)[0])
    yield Finding("acceleration of the launch", "m/s2", measured, a, KINEMATIC, 0.5)
    yield load_moved(table, c, "rear", "launch", window, a * c.inertia + drag + grade * c.heights)


def before_drive(table: Table, manoeuvre: Manoeuvre) -> np.ndarray:
    """The last tenth of a second before the drive torque comes."""
    return (table["time"] > manoeuvre["t_on"] - 0.1) & (table["time"] < manoeuvre["t_on"])


def standing(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """A car that its brakes hold on a slope, just before the drive torque comes, and at the end of the run."""
    t, (_, grade) = table["time"], resistance(manoeuvre, c)
    for at, when in ((before_drive(table, manoeuvre), "by the brakes"), (t > t[-1] - 0.1, "parked")):
        push = float(np.mean(force(table, list(WHEELS), 1)[at]))
        weight = c.mass * grade
        yield Finding(f"force of the road that holds the car, {when}", "N", push, weight, KINEMATIC, 0.03 * c.mass * G)
        yield load_moved(table, c, "rear", f"slope, {when}", at, grade * c.heights)


def rise(t: float | np.ndarray, begin: float, duration: float) -> float | np.ndarray:
    """From 0 to 1, with continuous second derivatives, as the driver's programmes."""
    z = np.minimum(np.maximum((t - begin) / duration, 0), 1)
    return z**3 * (10 - 15 * z + 6 * z**2)


def stopped(table: Table, begin: float) -> int:
    """The row at which all wheels first stand after an instant; 0 where they never do."""
    spins = np.max([np.abs(table[f"{w}.omega_z"]) for w in WHEELS], axis=0)
    return int(np.argmax((table["time"] > begin) & (spins == 0)))


def slowed(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace, kappa: float) -> tuple[np.ndarray, np.ndarray]:
    """Instants from t_brake on, and the rear point's deceleration at them on a circle of this curvature: power of the
    brakes, drag and grade = rate of the kinetic energy, each wheel at its own speed."""
    begin = manoeuvre["t_brake"]
    ratio = {w: float(np.hypot(1 - kappa * c.y[w], kappa * (c.x[w] - c.x_rear))) for w in WHEELS}  # speed over v
    moved = sum(M_WHEEL * of**2 + J_X * kappa**2 + J_Z * (of / R) ** 2 for of in ratio.values())
    moved += c.m_B * (1 + (kappa * c.x_rear) ** 2) + c.J_3 * kappa**2
    brakes = manoeuvre["B_0"] * sum(c.brake[w] * ratio[w] for w in WHEELS)
    (drag, grade), fine = resistance(manoeuvre, c), np.linspace(begin, table["time"][-1], 200001)
    a = (rise(fine, begin, manoeuvre["ramp_M"]) * brakes + drag + R * c.mass * grade) / (R * moved)
    return fine, a


def stop(table: Table, manoeuvre: Manoeuvre, fine: np.ndarray, a: np.ndarray) -> Iterator[Finding]:
    """Instant and distance of the stop from the state at t_brake, under the deceleration a at the instants `fine`."""
    t, begin, i = table["time"], manoeuvre["t_brake"], row_of_brake(table, manoeuvre)
    v = table["v"][i] - cumulative_trapezoid(a, fine, initial=0)
    end = int(np.argmax(v <= 0))
    way, later = float(trapezoid(v[: end + 1], fine[: end + 1])), float(t[stopped(table, begin)] - begin)
    yield Finding("instant of the stop after the brakes come", "s", later, float(fine[end] - begin), KINEMATIC, 1.0)
    yield Finding("stopping distance", "m", float(trapezoid(table["v"][i:], t[i:])), way, KINEMATIC, 2.0)


def braking(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """A straight stop, and the load moved forwards."""
    fine, a = slowed(table, manoeuvre, c, 0.0)
    yield from stop(table, manoeuvre, fine, a)
    t, begin = table["time"], manoeuvre["t_brake"] + manoeuvre["ramp_M"]
    end, (drag, grade) = t[stopped(table, begin)], resistance(manoeuvre, c)
    full = (t > begin + 0.5 * (end - begin)) & (t < end - 0.05)
    if np.count_nonzero(full) * (t[1] - t[0]) > 0.4:  # s: the chassis has ceased to pitch
        moment = drag + grade * c.heights - a[-1] * c.inertia
        yield load_moved(table, c, "front", "brakes", full, moment)


def curved(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """A stop on a circle; the car keeps it."""
    i = row_of_brake(table, manoeuvre)
    kappa = float(np.tan(table["delta"][i]) / c.wheelbase)  # 1/m, of the rear point's path: by the steer angle
    yield from stop(table, manoeuvre, *slowed(table, manoeuvre, c, kappa))
    way, turned = float(trapezoid(table["v"][i:], table["time"][i:])), float(table["psi"][-1] - table["psi"][i])
    yield Finding("angle turned while it stops", "rad", turned, kappa * way)


def settled(table: Table) -> np.ndarray:
    """The last half second of a run."""
    return table["time"] > table["time"][-1] - 0.5


def bend(table: Table, _manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """Steady state at the end of a run with a constant steer angle. Ackermann: cot delta_outer - cot delta_inner of the
    foremost steered wheels."""
    last = settled(table)
    delta, v, omega, roll = (float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "roll"))
    moved = float(np.mean((force(table, RIGHT) - force(table, LEFT))[last])) / 2
    x = max(c.x[w] for w in WHEELS if c.steer[w] > 0.5)
    inner, outer = sorted((w for w in WHEELS if c.x[w] == x), key=lambda w: -c.y[w])
    turned = {w: float(np.mean((table[f"{w}.psi"] - table["psi"])[last])) for w in (inner, outer)}
    apart = 1 / np.tan(turned[outer]) - 1 / np.tan(turned[inner])
    across, exact = (c.y[inner] - c.y[outer]) / (x - c.x_rear), (v * omega * c.inertia + G * c.leaning * roll) / c.track
    yield Finding("radius of the rear point's circle", "m", v / omega, c.wheelbase / np.tan(delta))
    yield Finding("Ackermann, from the wheels' headings", "1", apart, across)
    yield Finding("load moved outwards", "N", moved, exact, LOADED, 0.03 * c.mass * G)
    ahead = -c.m_B * c.x_rear + M_WHEEL * sum(c.x[w] - c.x_rear for w in WHEELS)  # kg m, of the rear point
    front = v * omega * ahead / c.wheelbase
    for axle, exact in (("front", front), ("rear", c.mass * v * omega - front)):
        along, left = (force(table, AXLES[axle], k) for k in (1, 2))
        across = float(np.mean((left * np.cos(table["psi"]) - along * np.sin(table["psi"]))[last]))
        yield Finding(f"lateral force of the {axle} axle", "N", across, exact, KINEMATIC, 0.03 * c.mass * G)


def closure(table: Table, _manoeuvre: Manoeuvre, _c: SimpleNamespace) -> Iterator[Finding]:
    """The figure of eight after one lap: distance of the rear point from its start, and the distance driven."""
    p, at = table["p"], table["X_R"] + 1j * table["Y_R"]
    gap = float(np.abs(np.interp(2 * np.pi, p, at) - at[0]))
    yield Finding("figure of eight: gap after one lap", "m", gap)
    yield Finding("figure of eight: its length", "m", float(np.abs(np.diff(at))[p[1:] <= 2 * np.pi].sum()))


def circle(table: Table, _manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """Gradients over lateral acceleration while the speed rises at a constant steer angle; the sideslip angle beside
    that of a rear axle without any. A passenger car's gradients are some 100 times the bounds of those that are 0."""
    steady = (table["time"] > 5.0) & (table["time"] < 22.0)
    a, omega, v, delta, beta, roll = (table[n][steady] for n in ("a_y", "omega", "v", "delta", "beta", "roll"))

    def gradient(of: str, unit: str, y: np.ndarray, exact: float = 0.0, share: float = KINEMATIC) -> Finding:
        return Finding(of, unit, float(np.polyfit(a, y, 1)[0]), exact, share, 0.01)

    drift = float(np.arctan(-c.x_rear * np.tan(delta[0]) / c.wheelbase))
    yield Finding("largest lateral acceleration", "m/s2", float(a.max()))
    yield gradient("understeer gradient", "rad s2/m", delta - np.arctan(c.wheelbase * (omega / v)))
    yield gradient("gradient of the curvature", "s2/m2", omega / v)
    yield Finding("sideslip angle where the speed is least", "rad", float(beta[0]), drift)
    yield gradient("gradient of the sideslip angle", "rad s2/m", beta)
    yield gradient("gradient of the roll angle", "rad s2/m", roll, c.roll_gradient, LOADED)


def _first(t: np.ndarray, x: np.ndarray, level: float) -> float:
    """When a rising signal first reaches a level, between samples by a straight line."""
    i = int(np.argmax(x >= level))
    return float(np.interp(level, x[i - 1 : i + 1], t[i - 1 : i + 1]))


def step(table: Table, _manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """Response times from the instant at which the steering is half done, overshoot and gains."""
    t, last = table["time"], settled(table)
    end = {name: float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "a_y", "roll")}
    half, tenth, most = (_first(t, table["delta"], share * end["delta"]) for share in (0.5, 0.1, 0.9))
    yaw = end["v"] * np.tan(end["delta"]) / c.wheelbase
    yield Finding("time of the steer angle from 10 to 90 %", "s", most - tenth)
    for name, what, unit, theory in (
        ("omega", "yaw rate", "1/s", yaw),
        ("a_y", "lateral acceleration", "m/s2/rad", end["v"] * yaw),
        ("roll", "roll angle", "1", c.roll_gradient * end["v"] * yaw),
    ):
        x, level = table[name], end[name]
        share = LOADED if name == "roll" else KINEMATIC
        yield Finding(f"gain of the {what}", unit, level / end["delta"], float(theory / end["delta"]), share)
        yield Finding(f"response time of the {what} (90 %)", "s", _first(t, x, 0.9 * level) - half)
        yield Finding(f"time to the peak of the {what}", "s", float(t[np.argmax(x)]) - half)
        yield Finding(f"overshoot of the {what}", "1", float(x.max()) / level - 1)


def lane(table: Table, _manoeuvre: Manoeuvre, _c: SimpleNamespace) -> Iterator[Finding]:
    """How hard the change of lanes is, and where it asks most of the road."""
    most, axle, at = max((float(np.nanmax(mu)), axle, int(np.nanargmax(mu))) for axle, mu in friction(table).items())
    largest = (("lateral acceleration", "m/s2", "a_y"), ("yaw rate", "rad/s", "omega"), ("roll angle", "rad", "roll"))
    yield from (Finding(f"largest {what}", unit, float(np.abs(table[name]).max())) for what, unit, name in largest)
    yield Finding(f"largest friction required, at the {axle} axle", "1", most)
    yield Finding("where: rear point, X", "m", float(table["X_R"][at]))
    yield Finding("when", "s", float(table["time"][at]))


def slid(table: Table) -> dict[str, float]:
    """How long each wheel slides, s; of those that do."""
    t = table["time"]
    moves = {w: (table[f"{w}.slip_x"] != 0) | (table[f"{w}.slip_y"] != 0) for w in WHEELS}
    return {w: float(np.gradient(t)[at].sum()) for w, at in moves.items() if at.any()}


def sliding_on_the_right(table: Table, manoeuvre: Manoeuvre) -> np.ndarray:
    """The instants a second and more after the full brakes at which the right wheels are locked and the car moves."""
    locked = np.all([table[f"{w}.omega_z"] == 0 for w in RIGHT], axis=0)
    return (table["time"] > manoeuvre["t_brake"] + manoeuvre["ramp_M"] + 1) & locked & (table["v"] > 2)


def split(table: Table, manoeuvre: Manoeuvre, c: SimpleNamespace) -> Iterator[Finding]:
    """Straight braking while the right wheels slide, locked, and the left ones roll: m_t counts these two alone. What
    the brakes turn the car by, lateral forces hold, which the rolling wheels share as their course demands."""
    t, window, (_, grade) = table["time"], sliding_on_the_right(table, manoeuvre), resistance(manoeuvre, c)
    load, wheels = c.mass * c.g / 2, J_Z / R**2 * len(LEFT)
    brakes = manoeuvre["B_0"] * sum(c.brake[w] for w in LEFT)
    slippery = manoeuvre["mu_slide_right"] or manoeuvre["mu_slide"]
    slides, rolls = slippery * load, (brakes + manoeuvre["s"] * load) / R
    a = (slides + rolls + c.mass * grade) / (c.mass + wheels)
    across = sum(float(np.mean(table[f"{w}.lambda_2"][window])) * c.x[w] for w in WHEELS)
    measured = -float(np.polyfit(t[window], table["v"][window], 1)[0])
    turning = (rolls - wheels * a - slides) * c.track / 2
    yield Finding("deceleration, the right wheels locked", "m/s2", measured, a, KINEMATIC, 1.0)
    moment = 0.03 * c.mass * G * c.track / 2
    yield Finding("yaw moment of the lateral forces", "N m", across, -turning, LOADED, moment)
    yield Finding("largest angle of the heading", "rad", float(np.abs(table["psi"]).max()))


JUDGES = {f.__name__: f for f in (launch, standing, braking, curved, bend, closure, circle, step, lane, split)}


def steady(table: Table) -> bool:
    """Whether the last half second is a steady turn: columns keep their values to a fiftieth of their largest."""
    at = settled(table)
    return all(np.ptp(table[n][at]) <= 0.02 * np.abs(table[n]).max() for n in ("delta", "v", "omega", "roll"))


def locks(table: Table, run: Manoeuvre) -> bool:
    """Whether the right wheels slide, locked, for half a second and more, and the left ones never."""
    rows = np.count_nonzero(sliding_on_the_right(table, run))
    return {*slid(table)} == {*RIGHT} and rows * (table["time"][1] - table["time"][0]) > 0.5


def broken(name: str, table: Table, run: Manoeuvre) -> str:
    """Why a judge's closed forms do not hold, in words; empty where they do."""
    reasons = {
        run.beyond: True,
        "a wheel slides": name != "split" and bool(slid(table)),
        "the right wheels do not lock, or a left one slides": name == "split" and not locks(table, run),
        "a strut reaches its stop": max(np.abs(table[f"d_{w}"]).max() for w in WHEELS) >= run["travel"],
        "it is not steady at the end": name in ("bend", "step") and not steady(table),
    }
    return next((words for words, holds in reasons.items() if words and holds), "")


def judge(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """The findings of a manoeuvre's judges; closed forms where they hold."""
    return [finding for name in manoeuvre.judges for finding in judged(name, table, manoeuvre)[0]]


def judged(name: str, table: Table, manoeuvre: Manoeuvre) -> tuple[list[Finding], str]:
    """The findings of one judge, and why they have no closed form."""
    why = broken(name, table, manoeuvre)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("error")
        try:
            found = list(JUDGES[name](table, manoeuvre, constants(manoeuvre)))
        except (ValueError, IndexError, TypeError, np.linalg.LinAlgError, Warning):
            return [], why or "the run is too short for it"
    return [finding._replace(exact=None) for finding in found] if why else found, why


def findings(table: Table, manoeuvre: Manoeuvre) -> tuple[list[str], list[str]]:
    """Characteristic values of a manoeuvre in words, beside the closed forms that hold; what is beyond a bound."""
    lines, faults = [], []
    for name in manoeuvre.judges:
        found, why = judged(name, table, manoeuvre)
        lines += [f"  {finding}" for finding in found if np.isfinite(finding.measured)]
        lines += [f"  No closed form ({name}): {why}."] * bool(why)
        faults += filter(None, (finding.fault for finding in found))
    return lines, faults
