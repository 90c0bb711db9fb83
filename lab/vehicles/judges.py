"""The car's manoeuvres in closed form, of wheels that never slip, on stiff bushings.

With m all masses, R the wheels' radius, m_t = m + 4 J_z / R^2, L the wheelbase and T the track:

    launch and braking   m_t a = (M_drive - s m g cos(slope) - brakes) / R - m g sin(slope);
                         the rear axle gains (a I + m_B g (h_B - R) pitch) / L
    any bend             rear point on R = L / tan delta, so yaw rate = v tan(delta) / L at any speed: no understeer;
                         front axle m_f v omega, m_f L the first moment of all masses about the rear point
    Ackermann            cot delta_outer - cot delta_inner = T / L
    steady circle        the outer wheels gain (a I + g roll (m_B (h_B - r) + 4 m_w r_0)) / T together

I = m_B h_B + 4 (m_w R + J_z / R): masses at their heights, and the wheels' spin that is sped up or turned. As the car
leans by the roll angle the masses move outwards from the wheels' centres, and the contact points inwards, by r_0 roll.
"""

from collections.abc import Iterator
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid, trapezoid

from .car import Table
from .manoeuvres import J_Z, M_WHEEL, R_0, WHEELS, G, Manoeuvre, R

AXLES = {"front": WHEELS[:2], "rear": WHEELS[2:]}
LEFT, RIGHT = ("fl", "rl"), ("fr", "rr")


class Finding(NamedTuple):
    """One quantity as measured in a run, and in closed form."""

    what: str
    unit: str
    measured: float
    exact: float

    def __str__(self) -> str:
        return f"{self.what}: {self.measured:.4g} {self.unit}".removesuffix(" 1") + f" (closed form: {self.exact:.4g})"


def car(run: Manoeuvre) -> SimpleNamespace:
    """The car of a manoeuvre: its masses and lengths, and what follows from them."""
    c = SimpleNamespace(**{name: run[name] for name in ("m_B", "h_B", "J_3")}, g=G * np.cos(run["slope"]))
    for name in ("x", "y", "drive", "brake"):
        setattr(c, name, {w: run[f"{name}_{w}"] for w in WHEELS})
    c.x_rear = (c.x["rl"] + c.x["rr"]) / 2  # rear point
    c.wheelbase = (c.x["fl"] + c.x["fr"]) / 2 - c.x_rear
    c.track = c.y["fl"] - c.y["fr"]
    c.mass = c.m_B + 4 * M_WHEEL
    c.m_t = c.mass + 4 * J_Z / R**2
    c.heights = c.m_B * c.h_B + 4 * M_WHEEL * R  # kg m
    c.inertia = c.heights + 4 * J_Z / R  # kg m
    c.leaning = c.m_B * (c.h_B - (R - R_0)) + 4 * M_WHEEL * R_0  # kg m, about the contacts, per roll angle
    c.drag = run["s"] * c.mass * c.g  # N m, of rolling resistance about all axles
    c.grade = G * np.sin(run["slope"]) * np.cos(run["slope_direction"])  # m/s2
    return c


def force(table: Table, wheels: tuple[str, ...], k: int = 3) -> np.ndarray:
    """Force of the ground on some wheels together, along X, Y or the normal."""
    return np.sum([table[f"{w}.lambda_{k}"] for w in wheels], axis=0)


def load_moved(table: Table, c: SimpleNamespace, axle: str, cause: str, at: np.ndarray, moment: float) -> Finding:
    """Mean normal force of an axle over some instants, above that at the start. `moment` [N m] moves load to the rear
    axle, together with that of the chassis' weight as it pitches about its hubs."""
    normal, pitch = force(table, AXLES[axle]), float(np.mean(table["pitch"][at]))
    exact = (moment - c.m_B * c.g * (c.h_B - R) * pitch) / c.wheelbase * (1 if axle == "rear" else -1)
    moved = float(np.mean(normal[at]) - normal[0])
    return Finding(f"load moved to the {axle} axle by the {cause}", "N", moved, exact)


def launch(table: Table, run: Manoeuvre) -> Iterator[Finding]:
    """Acceleration and load transfer in the last second of full torque."""
    t, c = table["time"], car(run)
    window = (t > run["t_off"] - 1) & (t < run["t_off"])
    a = (run["M_0"] * sum(c.drive.values()) - c.drag - R * c.mass * c.grade) / (R * c.m_t)
    measured = float(np.polyfit(t[window], table["v"][window], 1)[0])
    yield Finding("acceleration of the launch", "m/s2", measured, a)
    yield load_moved(table, c, "rear", "launch", window, a * c.inertia + c.drag + c.grade * c.heights)


def rise(t: float | np.ndarray, begin: float, duration: float) -> float | np.ndarray:
    """From 0 to 1, with continuous second derivatives, as the driver's programmes."""
    z = np.minimum(np.maximum((t - begin) / duration, 0), 1)
    return z**3 * (10 - 15 * z + 6 * z**2)


def braking(table: Table, run: Manoeuvre) -> Iterator[Finding]:
    """A straight stop, and the load moved forwards once the brakes are fully on and the chassis no longer pitches."""
    t, c, begin, ramp = table["time"], car(run), run["t_brake"], run["ramp_M"]
    brakes, resists = run["B_0"] * sum(c.brake.values()), c.drag + R * c.mass * c.grade
    after, fine = t >= begin - 1e-9, np.linspace(begin, t[-1], 200001)
    slowing = (rise(fine, begin, ramp) * brakes + resists) / R / c.m_t
    speed = np.maximum(table["v"][after][0] - cumulative_trapezoid(slowing, fine, initial=0), 0)
    stands = float(t[np.argmax(after & (np.max([np.abs(table[f"{w}.omega_z"]) for w in WHEELS], axis=0) == 0))])
    end = float(fine[np.argmin(speed)])
    yield Finding("instant of the stop after the brakes come", "s", stands - begin, end - begin)
    way = float(trapezoid(table["v"][after], t[after]))
    yield Finding("stopping distance", "m", way, float(trapezoid(speed, fine)))
    full = (t > (begin + ramp + stands) / 2) & (t < stands - 0.05)
    moment = c.drag + c.grade * c.heights - (brakes + resists) / (R * c.m_t) * c.inertia
    yield load_moved(table, c, "front", "brakes", full, moment)


def bend(table: Table, run: Manoeuvre) -> Iterator[Finding]:
    """Steady state in the last half second of a run with a constant steer angle."""
    c, last = car(run), table["time"] > table["time"][-1] - 0.5
    delta, v, omega, roll = (float(np.mean(table[name][last])) for name in ("delta", "v", "omega", "roll"))
    outer, inner = (RIGHT, LEFT) if delta > 0 else (LEFT, RIGHT)
    moved = float(np.mean((force(table, outer) - force(table, inner))[last])) / 2
    turned = {w: float(np.mean((table[f"{w}.psi"] - table["psi"])[last])) for w in AXLES["front"]}
    apart = 1 / np.tan(turned["fr"]) - 1 / np.tan(turned["fl"])
    exact = abs(v * omega * c.inertia + G * c.leaning * roll) / c.track
    yield Finding("radius of the rear point's circle", "m", v / omega, c.wheelbase / np.tan(delta))
    yield Finding("Ackermann, from the wheels' headings", "1", apart, c.track / c.wheelbase)
    yield Finding("load moved outwards", "N", moved, exact)
    ahead = -c.m_B * c.x_rear + M_WHEEL * sum(c.x[w] - c.x_rear for w in WHEELS)  # kg m, of the rear point
    front = v * omega * ahead / c.wheelbase
    for axle, exact in (("front", front), ("rear", c.mass * v * omega - front)):
        along, left = (force(table, AXLES[axle], k) for k in (1, 2))
        across = float(np.mean((left * np.cos(table["psi"]) - along * np.sin(table["psi"]))[last]))
        yield Finding(f"lateral force of the {axle} axle", "N", across, exact)


JUDGES = {"straight": (launch, braking), "circle": (bend,), "step": (bend,)}


def judge(name: str, table: Table, run: Manoeuvre) -> list[Finding]:
    """The closed forms of a manoeuvre."""
    return [finding for one in JUDGES.get(name, ()) for finding in one(table, run)]
