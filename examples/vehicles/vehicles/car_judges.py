"""The car's manoeuvres in closed form, a car whose wheels never slip, on stiff bushings; and what road tests report.

With m all masses, R the wheels' radius, m_t = m + 4 J_z / R^2 (four wheels), L the wheelbase and T the track:

    launch and braking   m_t a = (M_drive - s m g - brakes) / R; the rear axle gains (a I + m_B g (h_B - R) pitch) / L
    any bend             rear point on R = L / tan delta, so yaw rate = v tan(delta) / L at any speed: no understeer
    Ackermann            cot delta_outer - cot delta_inner = T / L
    steady circle        the outer wheels gain (a I + g roll (m_B (h_B - r) + 4 m_w r_0)) / T together

I = m_B h_B + 4 (m_w R + J_z / R): masses at their heights, and the wheels' spin that is sped up or turned. As the car
leans by the roll angle the masses move outwards from the wheels' centres, and the contact points inwards, by r_0 roll.

Characteristic values in the manner of ISO 4138 (constant steer angle, rising speed), ISO 7401 (step input), ISO 3888
(two changes of lane); steer angles are those of the bicycle's wheel, not of a steering wheel. A table has time, v,
omega, psi, roll, delta, a_y and beta, and the ground's forces on each wheel.
"""

import tomllib
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid

from .options import EXAMPLES, Manoeuvre, manoeuvres
from .vehicle import Table

# The layout, car/car.toml, and what follows from it; SI, from the chassis' centre of mass.
LAYOUT = tomllib.loads((EXAMPLES / "car" / "car.toml").read_text())
WHEELS: dict[str, dict[str, float | str]] = LAYOUT["wheel"]
NAMES = {wheel: str(of["name"]) for wheel, of in WHEELS.items()}
X_REAR = float(np.mean([w["x"] for w in WHEELS.values() if not w["steer"]]))  # rear point
WHEELBASE = float(np.mean([w["x"] for w in WHEELS.values() if w["steer"]])) - X_REAR
TRACK = float(np.ptp([w["y"] for w in WHEELS.values() if w["steer"]]))  # of the steered wheels
R_0, R, M_WHEEL, J_Z, G = 0.3, 0.35, 20.0, 1.8, 9.81  # the wheels' defaults
MASS = LAYOUT["chassis"]["m_B"] + M_WHEEL * len(WHEELS)
MANOEUVRES = manoeuvres("car")
STRAIGHT, CIRCLE, STEP, EIGHT, LANE, HILL, TOO_FAST, SPLIT = MANOEUVRES.values()
AXLES = {w["axle"]: [n for n, other in WHEELS.items() if other["axle"] == w["axle"]] for w in WHEELS.values()}
N, H_B, M_B = len(WHEELS), LAYOUT["chassis"]["h_B"], LAYOUT["chassis"]["m_B"]
M_T = MASS + N * J_Z / R**2
HEIGHTS = M_B * H_B + N * M_WHEEL * R  # kg m
INERTIA = HEIGHTS + N * J_Z / R  # kg m
LEANING = M_B * (H_B - (R - R_0)) + N * M_WHEEL * R_0  # kg m, about the contact points, per roll angle
LEFT, RIGHT = ([name for name, wheel in WHEELS.items() if side * wheel["y"] > 0] for side in (1, -1))
STRUTS = sum(w["k"] * w["y"] ** 2 for w in WHEELS.values())  # N m/rad, as the bars; wheels stand on the ground
BARS = sum(w["k_bar"] * (w["y"] - WHEELS[w["bar_to"]]["y"]) ** 2 for w in WHEELS.values() if "bar_to" in w)
# Roll angle per lateral acceleration, rad s2/m: the chassis leans outwards by its height, the contact inwards.
ROLL_GRADIENT = INERTIA / (STRUTS + BARS - G * LEANING)


class Finding(NamedTuple):
    """One quantity as measured in a run, and of rigid links and wheels that never slip, where that is known."""

    what: str
    unit: str
    measured: float
    exact: float | None = None

    def __str__(self) -> str:
        unit = "" if self.unit == "1" else f" {self.unit}"
        exact = "" if self.exact is None else f" (closed form: {self.exact:.4g})"
        return f"{self.what}: {self.measured:.4g}{unit}{exact}"


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


def load_moved(table: Table, axle: str, cause: str, at: np.ndarray, moment: float) -> Finding:
    """Mean normal force of an axle over some instants, above that at the start. `moment` [N m] moves load to the rear
    axle, together with that of the chassis' weight as it pitches about its hubs."""
    normal, pitch = force(table, AXLES[axle]), float(np.mean(table["pitch"][at]))
    exact = (moment - M_B * G * (H_B - R) * pitch) / WHEELBASE * (1 if axle == "rear" else -1)
    return Finding(f"load moved to the {axle} axle by the {cause}", "N", float(np.mean(normal[at]) - normal[0]), exact)


def resistance(manoeuvre: Manoeuvre) -> tuple[float, float]:
    """Moment of rolling friction about all axles, N m, and gravity down the slope, m/s2."""
    return manoeuvre["s"] * MASS * G * np.cos(manoeuvre["slope"]), G * np.sin(manoeuvre["slope"])


def launch(table: Table, manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Acceleration and load transfer in the last second of full torque."""
    t, off = table["time"], manoeuvre["t_off"]
    window = (t > off - 1) & (t < off)
    drag, grade = resistance(manoeuvre)
    a = (manoeuvre["M_0"] - drag - R * MASS * grade) / (R * M_T)
    yield Finding("acceleration of the launch", "m/s2", float(np.polyfit(t[window], table["v"][window], 1)[0]), a)
    yield load_moved(table, "rear", "launch", window, a * INERTIA + drag + grade * HEIGHTS)


def standing(table: Table, manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """A car that its brakes hold on a slope, just before the drive torque comes, and at the end of the run."""
    t, (_, grade) = table["time"], resistance(manoeuvre)
    window = (t > manoeuvre["t_on"] - 0.1) & (t < manoeuvre["t_on"])
    for at, when in ((window, "by the brakes"), (t > t[-1] - 0.1, "parked")):
        push = float(np.mean(force(table, list(WHEELS), 1)[at]))
        yield Finding(f"force of the road that holds the car, {when}", "N", push, MASS * grade)
        yield load_moved(table, "rear", f"slope, {when}", at, grade * HEIGHTS)


def rise(t: float | np.ndarray, begin: float, duration: float) -> float | np.ndarray:
    """From 0 to 1, with continuous second derivatives, as the driver's programmes."""
    z = np.minimum(np.maximum((t - begin) / duration, 0), 1)
    return z**3 * (10 - 15 * z + 6 * z**2)


def braking(table: Table, manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Instant and distance of the stop from the state at t_brake, and the load moved forwards."""
    t, begin, ramp = table["time"], manoeuvre["t_brake"], manoeuvre["ramp_M"]
    i, fine = int(np.searchsorted(t, begin - 1e-9)), np.linspace(begin, t[-1], 200001)
    drag, grade = resistance(manoeuvre)
    a = (rise(fine, begin, ramp) * manoeuvre["B_0"] + drag + R * MASS * grade) / (R * M_T)
    v = table["v"][i] - cumulative_trapezoid(a, fine, initial=0)
    end = int(np.argmax(v <= 0))
    full = (t > begin + ramp + 0.5 * (fine[end] - begin - ramp)) & (t < fine[end] - 0.05)
    spins = np.max([np.abs(table[f"{w}.omega_z"]) for w in WHEELS], axis=0)
    stopped, way = int(np.argmax((t > begin) & (spins == 0))), float(trapezoid(v[: end + 1], fine[: end + 1]))
    yield Finding("instant of the stop after the brakes come", "s", float(t[stopped] - begin), float(fine[end] - begin))
    yield Finding("stopping distance", "m", float(table["X"][-1] - table["X"][i]), way)
    if full.any():
        yield load_moved(table, "front", "brakes", full, drag + grade * HEIGHTS - a[-1] * INERTIA)


def bend(table: Table, _manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Steady state at the end of a run with a constant steer angle. Ackermann: cot delta_outer - cot delta_inner of the
    foremost steered wheels."""
    last = table["time"] > table["time"][-1] - 0.5
    delta, v, omega, roll = (float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "roll"))
    moved = float(np.mean((force(table, RIGHT) - force(table, LEFT))[last])) / 2
    x = max(w["x"] for w in WHEELS.values() if w["steer"])
    inner, outer = sorted((n for n in WHEELS if WHEELS[n]["x"] == x), key=lambda n: -WHEELS[n]["y"])
    turned = {n: float(np.mean((table[f"{n}.psi"] - table["psi"])[last])) for n in (inner, outer)}
    apart = 1 / np.tan(turned[outer]) - 1 / np.tan(turned[inner])
    across = (WHEELS[inner]["y"] - WHEELS[outer]["y"]) / (x - X_REAR)
    yield Finding("radius of the rear point's circle", "m", v / omega, WHEELBASE / np.tan(delta))
    yield Finding("Ackermann, from the wheels' headings", "1", apart, across)
    yield Finding("load moved outwards", "N", moved, (v * omega * INERTIA + G * LEANING * roll) / TRACK)


def closure(table: Table, _manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """The figure of eight after one lap: distance of the rear point from its start beside the way driven."""
    p, at = table["p"], table["X_R"] + 1j * table["Y_R"]
    way = float(np.abs(np.diff(at))[p[1:] <= 2 * np.pi].sum())
    gap = float(np.abs(np.interp(2 * np.pi, p, at) - at[0]))
    yield Finding("figure of eight: gap after one lap, and its length", "m", gap, way)


def circle(table: Table, _manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Gradients over lateral acceleration while the speed rises at a constant steer angle; the sideslip angle beside
    that of a rear axle without any."""
    steady = (table["time"] > 5.0) & (table["time"] < 22.0)
    a, omega, v, delta, beta, roll = (table[n][steady] for n in ("a_y", "omega", "v", "delta", "beta", "roll"))

    def gradient(of: str, unit: str, y: np.ndarray, exact: float = 0.0) -> Finding:
        return Finding(of, unit, float(np.polyfit(a, y, 1)[0]), exact)

    drift = float(np.arctan(-X_REAR * np.tan(delta[0]) / WHEELBASE))
    yield Finding("largest lateral acceleration", "m/s2", float(a.max()))
    yield gradient("understeer gradient", "rad s2/m", delta - np.arctan(WHEELBASE * (omega / v)))
    yield gradient("gradient of the curvature", "s2/m2", omega / v)
    yield Finding("sideslip angle where the speed is least", "rad", float(beta[0]), drift)
    yield gradient("gradient of the sideslip angle", "rad s2/m", beta)
    yield gradient("gradient of the roll angle", "rad s2/m", roll, ROLL_GRADIENT)


def _first(t: np.ndarray, x: np.ndarray, level: float) -> float:
    """When a rising signal first reaches a level, between samples by a straight line."""
    i = int(np.argmax(x >= level))
    return float(np.interp(level, x[i - 1 : i + 1], t[i - 1 : i + 1]))


def step(table: Table, _manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Response times from the instant at which the steering has gone half its way, overshoot and gains."""
    t, last = table["time"], table["time"] > table["time"][-1] - 0.5
    end = {name: float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "a_y", "roll")}
    half, tenth, most = (_first(t, table["delta"], share * end["delta"]) for share in (0.5, 0.1, 0.9))
    yaw = end["v"] * np.tan(end["delta"]) / WHEELBASE
    yield Finding("time of the steer angle from 10 to 90 %", "s", most - tenth)
    for name, what, unit, theory in (
        ("omega", "yaw rate", "1/s", yaw),
        ("a_y", "lateral acceleration", "m/s2/rad", end["v"] * yaw),
        ("roll", "roll angle", "1", ROLL_GRADIENT * end["v"] * yaw),
    ):
        x, level = table[name], end[name]
        yield Finding(f"gain of the {what}", unit, level / end["delta"], float(theory / end["delta"]))
        yield Finding(f"response time of the {what} (90 %)", "s", _first(t, x, 0.9 * level) - half)
        yield Finding(f"time to the peak of the {what}", "s", float(t[np.argmax(x)]) - half)
        yield Finding(f"overshoot of the {what}", "1", float(x.max()) / level - 1)


def lane(table: Table, _manoeuvre: Manoeuvre) -> Iterator[Finding]:
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


def split(table: Table, manoeuvre: Manoeuvre) -> Iterator[Finding]:
    """Straight braking while the right wheels slide, locked, and the left ones roll: m_t counts these two alone. What
    the brakes turn the car by, lateral forces hold, which the rolling wheels share as their course demands."""
    t, begin = table["time"], manoeuvre["t_brake"] + manoeuvre["ramp_M"]
    locked = np.all([table[f"{w}.omega_z"] == 0 for w in RIGHT], axis=0)
    window = (t > begin + 1) & locked & (table["v"] > 2)
    load, wheels = MASS * G / 2, J_Z / R**2 * len(LEFT)
    brakes = manoeuvre["B_0"] * sum(manoeuvre[f"brake_{w}"] for w in LEFT)
    slides, rolls = manoeuvre["mu_slide_right"] * load, (brakes + manoeuvre["s"] * load) / R
    a = (slides + rolls) / (MASS + wheels)
    across = sum(float(np.mean(table[f"{w}.lambda_2"][window])) * of["x"] for w, of in WHEELS.items())
    measured = -float(np.polyfit(t[window], table["v"][window], 1)[0])
    yield Finding("deceleration, the right wheels locked", "m/s2", measured, a)
    turning = (rolls - wheels * a - slides) * TRACK / 2
    yield Finding("yaw moment of the lateral forces", "N m", across, -turning)
    yield Finding("largest angle of the heading", "rad", float(np.abs(table["psi"]).max()))


JUDGES = {f.__name__: f for f in (launch, standing, braking, bend, closure, circle, step, lane, split)}


def judge(table: Table, manoeuvre: Manoeuvre) -> list[Finding]:
    """The findings of a manoeuvre's judges."""
    return [finding for name in manoeuvre.judges for finding in JUDGES[name](table, manoeuvre)]


def findings(table: Table, manoeuvre: Manoeuvre) -> list[str]:
    """Characteristic values of a manoeuvre, beside those of rigid links where these are known."""
    with np.errstate(all="ignore"):
        try:
            return [f"  {finding}" for finding in judge(table, manoeuvre)]
        except (ValueError, IndexError, TypeError, np.linalg.LinAlgError):
            return ["The closed forms do not apply to these parameters."]
