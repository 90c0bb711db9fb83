"""The pictures and figures of docs/physics.md and docs/brake_hold_steer.md, which are written by hand, from wheel.fmu.

Fixed axes X, Y, Z, Z up; carrier e1, e2, e3; SI, angles in degrees in the pictures.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from wheelfmu.truth.closed_forms import critical_spin, fall_time
from wheelfmu.truth.misprints import rolled
from wheelfmu.truth.motion import Run
from wheelfmu.truth.paper_transcription import THETA
from wheelfmu.truth.reference import Wheel
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import jamming

from . import plots
from .page import Report, Row, part
from .plots import label, style

HEIGHT = PAPER.r_0 + PAPER.r  # m, of O when upright
UPRIGHT = np.pi / 2
CRITICAL = critical_spin(PAPER)  # rad/s
TIPPING = np.sqrt(PAPER.m * PAPER.g * PAPER.r_0 / (PAPER.J_x + PAPER.m * HEIGHT**2))  # 1/s, of a wheel that stands
Values = dict[str, Any]  # of the FMU's variables
FRICTION: Values = {"s": 0.03}  # m
TIME, ENERGY = "time $t$ [s]", "energy $E$ [J]"


def run(report: Report, stop: float = 10.0, h: float = 0.01, inputs: Schedule | None = None, **start: Any) -> Run:
    return report.library.simulate(np.arange(round(stop / h) + 1) * h, inputs=inputs, **start)


def lean(found: Run) -> np.ndarray:
    return np.abs(found["theta"] - UPRIGHT)


@contextmanager
def picture(report: Report, name: str, layout: str = "ab", height: float = 70.0) -> Iterator[list[Axes]]:
    sheet, axes = plots.sheet(layout, height)
    yield axes
    style.save_png(sheet, report.folder.parent / "figures" / f"{name}.png", plots.DPI)


@part(20)
def stays_up(report: Report) -> Row:
    """when a rolling wheel stays up: lean over time beside the critical spin, largest lean over the spin"""
    start = UPRIGHT - np.radians(0.01)
    spins = np.concatenate([np.linspace(1, 2.6, 33), CRITICAL * np.array([0.995, 1.005]), np.linspace(2.7, 4, 27)])
    with picture(report, "physics_stays_up") as (left, right):
        for share, colour in ((0.9, style.VERMILLION), (0.99, style.ORANGE), (1.01, style.SKY), (1.1, style.BLUE)):
            found = run(report, 6, theta_start=start, phi_dot_start=-share * CRITICAL)
            left.plot(found.t, np.degrees(lean(found)), color=colour, label=f"{share:g} × critical")
        title = "Start: a lean of 0.01°"
        label(left, TIME, "size of the lean [deg]", title, "y", "upper left", 2, xlim=(0, 6), ylim=(3e-3, 3e3))
        for degrees, colour in ((15, style.GREEN), (0.01, style.BLUE)):
            starts = ({"theta_start": UPRIGHT - np.radians(degrees), "phi_dot_start": -spin} for spin in spins)
            largest = [np.degrees(lean(run(report, 20, **start)).max()) for start in starts]
            right.plot(spins, largest, ".-", color=colour, ms=2.5, label=f"start: {degrees}°")
        right.axvline(CRITICAL, color=style.GREY, lw=0.8)
        style.note(right, f"critical spin\n{CRITICAL:.4g} rad/s", (CRITICAL, 60), (4, 0), color=style.GREY)
        title, x = "Below the limit any lean grows, but no wheel lies flat", r"initial spin $|\omega_z|$ [rad/s]"
        label(right, x, "largest lean in 20 s [deg]", title, legend="lower left", ylim=(0, 95))
    fast = run(report, 4, 2e-3, theta_start=start, phi_dot_start=-20.0)
    turns = np.flatnonzero(np.diff(np.sign(fast["theta_dot"])))  # two in each period
    return {"critical_spin": CRITICAL, "nutation": (len(turns) - 1) / 2 / (fast.t[turns[-1]] - fast.t[turns[0]])}


@part(1)
def held(report: Report) -> Row:
    """a wheel that a brake holds at omega_z = 0 nods and turns and loses nothing"""
    theta, turn = np.radians(75), 4.0
    start: Values = {"theta_start": theta, "phi_dot_start": -turn * np.cos(theta), "psi_dot_start": turn}
    found = run(report, 2, 2e-3, Schedule(((0.0, {"M_brake": 200.0}),)), **start)
    curves = {
        (r"$\theta$ [deg]", "it nods"): np.degrees(found["theta"]),
        (r"$\dot\psi$ [rad/s]", "it turns"): found["psi_dot"],
        (ENERGY, "it loses nothing"): found["E"],
    }
    with picture(report, "physics_held", "ad;bd;cd", 30.0) as (first, right, *further):
        for ax, ((name, title), values) in zip((first, *further), curves.items(), strict=True):
            ax.plot(found.t, values, color=style.BLUE)
            label(ax, "", name, title, xlim=(0, 2), ylim=(0, 1.15 * values.max()))
        ax.set_xlabel(TIME)
        ax.figure.suptitle("A wheel held at $\\omega_z = 0$ by a strong brake", fontsize=9.5)
        right.plot(found["X_C"], found["Y_C"], color=style.BLUE, label="contact point")
        right.plot(found["X_O"], found["Y_O"], color=style.VERMILLION, label="centre O, seen from above")
        from_above(right, "it pivots like a coin", "upper left")
    return {}


def from_above(ax: Axes, title: str, legend: str) -> None:
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.2)
    label(ax, "$X$ [m]", "$Y$ [m]", title, legend=legend)


@part(2)
def energy(report: Report) -> Row:
    """what rolling resistance takes, and the weak releases of a long run"""
    rough, free, long = run(report, 10, 1e-3, **FRICTION), run(report, 10, 1e-3), run(report, 150, 0.05, **FRICTION)
    sticks = rough["friction_mode"] == 0
    with picture(report, "physics_energy") as (left, right):
        edges = np.concatenate([rough.t[:1], (rough.t[:-1] + rough.t[1:]) / 2, rough.t[-1:]])
        style.strip(left, edges, sticks, style.colour("held"), top=True)
        left.plot(free.t, free["E"], color=style.GREY, label="$s = 0$")
        left.plot(rough.t, rough["E"], color=style.BLUE, label="$s = 0.03$ m")
        title = "The paper's two scenes; at the top: held at $\\omega_z = 0$"
        label(left, TIME, ENERGY, title, legend=(0.3, 0.56), xlim=(0, 10), ylim=(50, 80))
        right.plot(long.t[long.t >= 10], long["E"][long.t >= 10], color=style.BLUE)
        label(right, TIME, ENERGY, "The releases go on, ever weaker", xlim=(0, 150))
    figures = {"energy_start": rough["E"][0], "energy_end": rough["E"][-1], "energy_long": long["E"][-1]}
    figures |= {"transitions": rough.counters["n_events"], "transitions_long": long.counters["n_events"]}
    figures |= {"lowest_free": np.degrees(free["theta"].min()), "grip_free": free["mu_required"].max()}
    figures |= {"lowest_friction": np.degrees(rough["theta"].min()), "grip_friction": rough["mu_required"].max()}
    return figures | {"held_share": 100 * np.mean(sticks)}


MISPRINTS = {  # as printed: name in the transcription, colour, duration in s
    "corrected": ((), style.INK, 10.0),
    "(5)": (("U_theta",), style.VERMILLION, 10.0),
    "(9)": (("Q_theta",), style.GREEN, 10.0),
    "(16), sign": (("F_beta",), style.BLUE, 1.0),
    "(16), bracket": (("F_beta_bracket",), style.ORANGE, 10.0),
}


@part(30)
def misprints(report: Report) -> Row:
    """what each misprint of the paper does to its free wheel, by the numpy transcription of its equations"""
    found = {name: rolled(duration, *printed) for name, (printed, _, duration) in MISPRINTS.items()}
    with picture(report, "errata_motion", "abc", 62.0) as (tilt, height, energy):
        for name, (t, y, E) in found.items():
            colour, first = MISPRINTS[name][1], name == "corrected"
            look = {"color": colour, "lw": 2.2 if first else 1.0, "alpha": 0.4 if first else 1.0, "label": name}
            for ax, values in ((tilt, np.degrees(y[:, THETA])), (height, y[:, 2]), (energy, E)):
                ax.plot(t, values, **look)
                if t[-1] < MISPRINTS[name][2] - 0.1:
                    ax.plot(t[-1], values[-1], "x", color=colour, ms=5)
        label(tilt, TIME, r"$\theta$ [deg]", "Angle between axle and vertical", xlim=(0, 10))
        label(height, TIME, "$Z_O$ [m]", "Height of O; ×: at the ground", xlim=(0, 10), ylim=(0, None))
        label(energy, TIME, ENERGY, "Energy", xlim=(0, 10))
        plots.legend_below(tilt.figure, [tilt], 5)
    least = np.degrees(found["(16), bracket"][1][:, THETA].min())
    grown = found["(9)"][2].max() / found["(9)"][2][0]
    ground = {f"misprint_{n}": found[name][0][-1] for n, name in (("5", "(5)"), ("16", "(16), sign"))}
    return ground | {"misprint_9": grown, "misprint_16_bracket": least}


@part(2)
def path(report: Report) -> Row:
    """the path of the contact point without and with rolling resistance"""
    free, rough = run(report, 60, 5e-3), run(report, 10, 5e-3, **FRICTION)
    first, stuck = free.t <= 10, np.where(rough["friction_mode"] == 0, rough["Y_C"], np.nan)
    with picture(report, "physics_path", height=80) as (left, right):
        left.plot(free["X_C"], free["Y_C"], color=style.SKY, lw=0.5, label="60 s")
        left.plot(free["X_C"][first], free["Y_C"][first], color=style.BLUE, label="first 10 s")
        right.plot(rough["X_C"], rough["Y_C"], color=style.BLUE, lw=0.8, label="rolling")
        right.plot(rough["X_C"], stuck, color=style.colour("held"), lw=1.8, label="held at $\\omega_z = 0$")
        for ax, scene in ((left, free), (right, rough)):
            ax.plot(scene["X_C"][0], scene["Y_C"][0], "o", color=style.INK, ms=3, label="start")
        from_above(left, "$s = 0$: equal arcs, turned and mirrored", "upper right")
        from_above(right, "$s = 0.03$ m, 10 s: it settles into a circle", "lower right")
    return {}


@part(1)
def tipping(report: Report) -> Row:
    """a wheel that stands exactly upright: rounding grows like cosh until it tips"""
    rest: Values = {"theta_start": UPRIGHT, "phi_dot_start": 0.0}
    found = run(report, 12, 5e-3, **rest)
    with picture(report, "physics_tipping", "a") as (ax,):
        ax.plot(found.t, np.where(lean(found) > 0, lean(found), np.nan), color=style.BLUE, label="wheel.fmu")
        growth = np.cos(UPRIGHT) * np.cosh(TIPPING * found.t)
        ax.plot(found.t, growth, "--", color=style.ORANGE, label=r"$6\cdot10^{-17}\cosh\nu t$")
        title = "At rest, theta_start = the number nearest to $\\pi/2$"
        label(ax, TIME, "size of the lean [rad]", title, "y", "upper left", xlim=(0, 10), ylim=(1e-17, 3))
    tilted = lean(run(report, 15, theta_start=UPRIGHT - 1e-9, phi_dot_start=-2.0)).max()
    by_method = [run(report, 12, 5e-3, method=method, **rest).t[-1] for method in (2, 3, 4)]
    tips = {"tips": found.t[-1], "tips_first": min(by_method), "tips_last": max(by_method)}
    tips |= {"tips_exact": fall_time(PAPER, UPRIGHT), "tips_leaning": fall_time(PAPER, UPRIGHT - np.radians(1))}
    return tips | {"tipping_rate": TIPPING, "tips_rolling_tilted": np.degrees(tilted)}


CONTACT = re.compile(r"t = (\S+) s: the wheel (?:starts to slide|stops sliding)\.")
DISC = Wheel(m=1.0, r_0=1.0, r=0.0, J_x=0.25, J_y=0.25, J_z=0.5)  # thin, homogeneous
WET: Values = {"mu_max": 0.45, "mu_slide": 0.4}
SLIPPERY: Values = {"mu_max": 0.3, "mu_slide": 0.25}


@part(5)
def slides(report: Report) -> Row:
    """the paper's free wheel on a wet and on a slippery road: where it slides, its slip, the energy that is left"""
    wet, slippery = (run(report, 10, 1e-3, **road) for road in (WET, SLIPPERY))
    instants = [float(found[1]) for found in map(CONTACT.match, wet.messages) if found]
    energy = {"wet": wet["E"][-1], "slippery": slippery["E"][-1]}
    first = report.library.simulate([0.0, instants[0] + 1e-6], **WET)
    psi, along, across = (first[name][-1] for name in ("psi", "slip_x", "slip_y"))
    e_1 = np.array([np.cos(psi), np.sin(psi)])
    X, Y = (along * e_1 + across * np.array([-e_1[1], e_1[0]])) / np.hypot(along, across)
    with picture(report, "physics_slides") as (left, right):
        left.plot(wet["X_C"], wet["Y_C"], color=style.BLUE, lw=0.7)
        slides = np.where(wet["contact_mode"] == 1, wet["Y_C"], np.nan)
        left.plot(wet["X_C"], slides, color=style.colour("slide"), lw=1.8, label="it slides")
        from_above(left, "0.45 and 0.4: it slides twice", "upper left")
        for found, colour, text in ((slippery, style.VERMILLION, "0.3 and 0.25"), (wet, style.BLUE, "0.45 and 0.4")):
            right.plot(found.t, np.hypot(found["slip_x"], found["slip_y"]), color=colour, label=text)
        title = "On a slippery road it slides in every swing"
        label(right, TIME, "slip [m/s]", title, legend="upper right", xlim=(0, 10))
    ways = dict(zip(("slide_1", "grip_1", "slide_2", "grip_2"), instants, strict=True))
    count = int((np.diff(slippery["contact_mode"]) == 1).sum())
    most = float(np.hypot(wet["slip_x"], wet["slip_y"]).max())
    left_over = {f"energy_{road}": value for road, value in energy.items()}
    jams = {"jam_paper": least_jamming(PAPER), "jam_disc": least_jamming(DISC)}
    return ways | {"slide_X": X, "slide_Y": Y, "slip": most, "slides_slippery": count} | left_over | jams


def least_jamming(wheel: Wheel) -> float:
    """The least friction coefficient at which the wheel can jam, over all leans."""
    return min(jamming(wheel, theta) for theta in np.linspace(0.1, UPRIGHT - 0.1, 2001))


@part(3)
def brake_hold_steer(report: Report) -> Row:
    """three means to slow an upright wheel down; a wheel on a suspension that is steered and stopped"""
    brake, torque = (Schedule(((0.0, {}), (1.0, {name: 20.0}))) for name in ("M_brake", "M_3"))
    ways: dict[str, tuple[str, str, Values]] = {
        "M_brake = 20 N m from 1 s on": (style.BLUE, "-", {"inputs": brake}),
        "M_3 = 20 N m from 1 s on": (style.VERMILLION, "--", {"inputs": torque}),
        "s = 0.03 m": (style.GREEN, "-", FRICTION),
    }
    steered = on_a_suspension(report)
    with picture(report, "brake_hold_steer", "ab;ac;ad;ae", 24.0) as (left, *right):
        for name, (colour, line, way) in ways.items():
            found = run(report, 5, theta_start=UPRIGHT, psi_start=0.0, phi_dot_start=-10.0, **way)
            left.plot(found.t, -HEIGHT * found["omega_z"], line, color=colour, label=name)
        left.axhline(0, color=style.GREY, lw=0.6)
        label(left, TIME, "speed [m/s]", "A brake stops; a torque goes on", legend="lower left", xlim=(0, 5))
        for ax, (name, values) in zip(right, steered.items(), strict=True):
            ax.plot(steered.index, values, color=style.BLUE)
            label(ax, "", name, xlim=(0, 6))
            ax.margins(y=0.15)
        right[0].set_title("Held upright by $M_1$, steered by $M_2$, braked, held", fontsize=9, loc="left")
        for ax in right[:-1]:
            ax.tick_params(labelbottom=False)
        right[-1].set_xlabel(TIME)
    return {"steer_M_1": steered["$M_1$ [N m]"].min()}


def on_a_suspension(report: Report, h: float = 1e-3, stop: float = 6.0) -> pd.DataFrame:
    """A wheel that M_1 holds upright, that M_2 turns to a heading of 90 degrees, and that is braked from 3 s on.

    A spring and damper about e1 stand for the suspension, another pair about e2 for the steering; first order in h.
    """
    rows = []
    with report.library.wheel() as wheel:
        wheel.start(theta_start=UPRIGHT, psi_start=0.0, phi_dot_start=-10.0)
        read = wheel.reader(["psi", "theta", "psi_dot", "theta_dot", "omega_z"])
        for t in np.arange(0, stop, h):
            psi, theta, psi_dot, theta_dot, omega_z = read()
            tilt, wanted = theta - UPRIGHT, np.radians(90) * np.clip(t - 1, 0, 1)
            M_1, M_2 = -3000 * tilt - 100 * theta_dot, 300 * (wanted - psi) - 40 * psi_dot
            rows.append((t, -HEIGHT * omega_z, np.degrees(psi), np.degrees(tilt), M_1))
            wheel.set(M_1=M_1, M_2=M_2, M_brake=30.0 * (t >= 3))
            wheel.step(h)
    names = ("time", "speed [m/s]", r"$\psi$ [deg]", "lean [deg]", "$M_1$ [N m]")
    return pd.DataFrame(rows, columns=names).set_index("time")
