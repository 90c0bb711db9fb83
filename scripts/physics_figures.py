#!/usr/bin/env python3
"""Draw the pictures of docs/physics.md and docs/brake_hold_steer.md from runs of wheel.fmu, and measure their figures.

Writes docs/figures/physics_*.png, docs/figures/brake_hold_steer.png and docs/results/data/physics.csv, from which the
pages take their numbers. Fixed axes X, Y, Z, Z up; carrier e1, e2, e3; SI, angles in degrees in the pictures.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from plotting import style
from plotting.runs import Fmu, Signals
from plotting.scene import Array

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ROOT / "docs" / "figures"
DATA = ROOT / "docs" / "results" / "data" / "physics.csv"
M, R_0, R, J_X, J_Z, G = 20, 0.3, 0.05, 0.9, 1.8, 9.81  # (27), (30), (31)
HEIGHT = R_0 + R  # m, of O when upright
UPRIGHT = np.pi / 2
CRITICAL = np.sqrt(M * G * R_0 * J_X / (J_Z * (J_Z + M * HEIGHT**2)))  # rad/s
TIPPING = np.sqrt(M * G * R_0 / (J_X + M * HEIGHT**2))  # 1/s, of a wheel that stands upright
HELD_COLOUR = {"color": style.BAND, "linewidth": 0, "zorder": 0}
figures: dict[str, tuple[str, float, str]] = {}


def measured(name: str, what: str, value: float, unit: str = "") -> float:
    figures[name] = (what, float(value), unit)
    return value


def pair(height: float = 58.0) -> tuple:
    """A figure with two panels side by side."""
    fig = style.figure_mm(style.PAGE, height + 22)
    return fig, style.axes_mm(fig, 15, 14, 68, height), style.axes_mm(fig, 108, 14, 68, height)


def title(ax, text: str) -> None:
    ax.set_title(text, fontsize=9, loc="left")


def bands(ax, run: Array) -> None:
    """A band wherever omega_z is held at zero."""
    held = np.flatnonzero(np.diff(np.concatenate([[0], run["friction_mode"] == 0, [0]])))
    for begin, end in zip(held[::2], held[1::2] - 1, strict=True):
        ax.axvspan(run["time"][begin], run["time"][end], **HELD_COLOUR)


def stays_up(fmu: Fmu) -> None:
    """Lean over time on both sides of the critical spin; the largest lean over the spin."""
    fig, left, right = pair()
    lean = np.radians(0.01)
    for share, colour in ((0.9, style.VERMILLION), (0.99, style.ORANGE), (1.01, style.SKY), (1.1, style.BLUE)):
        run = fmu.run(stop=6, theta_start=UPRIGHT - lean, phi_dot_start=-share * CRITICAL)
        left.semilogy(
            run["time"],
            np.degrees(abs(run["theta"] - UPRIGHT)),
            color=colour,
            label=f"{share:g} × critical",
        )
    left.set(xlabel="time $t$ [s]", ylabel="size of the lean [deg]", xlim=(0, 6), ylim=(3e-3, 3e3))
    left.legend(loc="upper left", ncols=2)
    title(left, "Start: a lean of 0.01°")
    spins = np.concatenate([np.linspace(1, 2.6, 33), CRITICAL * np.array([0.995, 1.005]), np.linspace(2.7, 4, 27)])
    for degrees, colour in ((15, style.GREEN), (0.01, style.BLUE)):
        runs = [fmu.run(stop=20, theta_start=UPRIGHT - np.radians(degrees), phi_dot_start=-s) for s in spins]
        largest = [np.degrees(abs(run["theta"] - UPRIGHT).max()) for run in runs]
        right.plot(spins, largest, color=colour, marker=".", markersize=2.5, label=f"start: {degrees}°")
    right.axvline(CRITICAL, color=style.GREY, linewidth=0.8)
    style.note(right, f"critical spin\n{CRITICAL:.4g} rad/s", (CRITICAL, 60), (4, 0), color=style.GREY)
    right.set(xlabel=r"spin $|\omega_z|$ at the start [rad/s]", ylabel="largest lean in 20 s [deg]", ylim=(0, 95))
    right.legend(loc="lower left")
    title(right, "Below the limit any lean grows, but nothing falls flat")
    save(fig, "physics_stays_up")
    measured("critical_spin", "critical spin of upright rolling", CRITICAL, "rad/s")


def held(fmu: Fmu) -> None:
    """A wheel that a brake holds at omega_z = 0 nods and turns and loses nothing."""
    theta, turn = np.radians(75), 4.0
    run = fmu.run(stop=2, h=2e-3, phi_dot_start=-turn * np.cos(theta), psi_dot_start=turn, M_brake=200)
    measured("held_loss", "energy lost by a held wheel", abs(np.ptp(run["E"])) / run["E"][0])
    fig, left, right = pair()
    left.plot(run["time"], np.degrees(run["theta"]), color=style.BLUE, label=r"angle $\theta$: it nods")
    left.plot(run["time"], run["psi_dot"] * 10, color=style.ORANGE, label=r"$10\,\dot\psi$ [rad/s]: it turns")
    left.plot(run["time"], run["E"], color=style.GREEN, label="energy $E$ [J]: constant")
    left.plot(run["time"], run["omega_z"], color=style.VERMILLION, label=r"$\omega_z$ [rad/s]: held at zero")
    left.set(xlabel="time $t$ [s]", ylabel=r"$\theta$ [deg]; others as named", xlim=(0, 2))
    left.margins(y=0.28)
    left.legend(loc="upper right", ncols=2)
    title(left, "A wheel held at $\\omega_z = 0$ by a strong brake")
    right.plot(run["X_C"], run["Y_C"], color=style.BLUE, label="contact point")
    right.plot(run["X_O"], run["Y_O"], color=style.VERMILLION, label="centre O, seen from above")
    right.set(xlabel="$X$ [m]", ylabel="$Y$ [m]", aspect="equal")
    right.set_adjustable("datalim")
    right.legend(loc="lower right")
    right.margins(0.36)
    title(right, "It pivots like a coin")
    save(fig, "physics_held")


def energy(fmu: Fmu) -> None:
    """What friction takes; on the right the weak slips of a long run."""
    fig, left, right = pair()
    run, free = fmu.run(s=0.03), fmu.run()
    bands(left, run)
    left.plot(free["time"], free["E"], color=style.GREY, label="without friction")
    left.plot(run["time"], run["E"], color=style.BLUE, label="$s = 0.03$ m")
    left.set(xlabel="time $t$ [s]", ylabel="energy $E$ [J]", xlim=(0, 10), ylim=(50, 80))
    left.legend(loc=(0.3, 0.56))
    title(left, "The paper's two scenes; bands: held at $\\omega_z = 0$")
    long = fmu.run(stop=150, h=0.05, s=0.03)
    late = long["time"] >= 10
    right.plot(long["time"][late], long["E"][late], color=style.BLUE)
    right.set(xlabel="time $t$ [s]", ylabel="energy $E$ [J]", xlim=(0, 150))
    title(right, "The slips go on, ever weaker")
    save(fig, "physics_energy")
    measured("energy_start", "energy at the start", run["E"][0], "J")
    measured("energy_end", "friction scene: energy at 10 s", run["E"][-1], "J")
    measured("energy_long", "friction scene: energy at 150 s", long["E"][-1], "J")
    measured("transitions", "friction scene: transitions in 10 s", run["n_events"][-1])
    measured("transitions_long", "friction scene: transitions in 150 s", long["n_events"][-1])
    measured("held_share", "friction scene: share of 10 s held", 100 * np.mean(run["friction_mode"] == 0), "%")
    for name, scene in (("free", free), ("friction", run)):
        measured(f"lowest_{name}", f"{name} scene: lowest theta", np.degrees(scene["theta"].min()), "deg")
        measured(f"grip_{name}", f"{name} scene: largest mu_required", scene["mu_required"].max())


def path(fmu: Fmu) -> None:
    """The path of the contact point without and with friction."""
    fig, left, right = pair(68)
    free, run = fmu.run(stop=60, h=5e-3), fmu.run(stop=10, h=5e-3, s=0.03)
    first = free["time"] <= 10
    left.plot(free["X_C"], free["Y_C"], color=style.SKY, linewidth=0.5, label="60 s")
    left.plot(free["X_C"][first], free["Y_C"][first], color=style.BLUE, label="first 10 s")
    title(left, "Without friction: equal arcs, turned and mirrored")
    stuck = np.where(run["friction_mode"] == 0, run["Y_C"], np.nan)
    right.plot(run["X_C"], run["Y_C"], color=style.BLUE, linewidth=0.8, label="rolling")
    right.plot(run["X_C"], stuck, color=style.VERMILLION, linewidth=1.8, label="held at $\\omega_z = 0$")
    title(right, "$s = 0.03$ m, 10 s: it settles into a circle")
    for ax, scene in ((left, free), (right, run)):
        ax.plot(scene["X_C"][0], scene["Y_C"][0], "o", color=style.INK, markersize=3, label="start")
        ax.set(xlabel="$X$ [m]", ylabel="$Y$ [m]", aspect="equal")
        ax.set_adjustable("datalim")
        ax.margins(0.2)
        ax.legend(loc="upper right" if scene is free else "lower right")
    save(fig, "physics_path")


def tipping(fmu: Fmu) -> None:
    """A wheel that stands exactly upright: rounding grows like cosh until it tips."""
    fig, left, right = pair()
    run = fmu.run(stop=12, h=5e-3, theta_start=UPRIGHT, phi_dot_start=0)
    lean = abs(run["theta"] - UPRIGHT)
    shown = lean > 0
    seed = np.cos(UPRIGHT)
    left.semilogy(run["time"][shown], lean[shown], color=style.BLUE, label="wheel.fmu")
    left.semilogy(
        run["time"],
        seed * np.cosh(TIPPING * run["time"]),
        "--",
        color=style.ORANGE,
        label=r"$6\cdot10^{-17}\cosh\kappa t$",
    )
    left.set(xlabel="time $t$ [s]", ylabel="size of the lean [rad]", xlim=(0, 10), ylim=(1e-17, 3))
    left.legend(loc="upper left")
    title(left, "At rest, theta_start = the number nearest to $\\pi/2$")
    for digits in range(2, 17, 2):
        fall = fmu.run(stop=20, h=0.05, theta_start=UPRIGHT - 10.0**-digits, phi_dot_start=0)
        right.plot(digits, fall["time"][-1], "o", color=style.BLUE, markersize=3.5)
    right.axhline(run["time"][-1], color=style.GREY, linewidth=0.8)
    style.note(right, "exactly upright", (2, run["time"][-1]), (0, 3), color=style.GREY)
    right.set(xlabel="lean at the start: $10^{-n}$ rad, $n$", ylabel="falls flat at [s]", ylim=(0, 11))
    title(right, "Each two digits less lean: the same delay")
    save(fig, "physics_tipping")
    measured("tips", "exactly upright at rest: falls flat at", run["time"][-1], "s")
    measured("tipping_rate", "growth rate of a standing wheel's lean", TIPPING, "1/s")
    rolling = fmu.run(stop=15, theta_start=UPRIGHT, phi_dot_start=-2)
    measured("tips_rolling", "exactly upright at 2 rad/s: largest lean in 15 s", abs(rolling["theta"] - UPRIGHT).max())
    tilted = fmu.run(stop=15, theta_start=UPRIGHT - 1e-9, phi_dot_start=-2)
    measured("tips_rolling_tilted", "1e-9 rad off", np.degrees(abs(tilted["theta"] - UPRIGHT).max()), "deg")


def brake_hold_steer(fmu: Fmu) -> None:
    """Left: three ways to slow an upright wheel down; right: a wheel on a suspension that is steered and stopped."""
    fig, left, right = pair()
    ramp = Signals({"time": [0, 0.999999, 1, 5], "load": [0, 0, 20, 20]})
    start = {"theta_start": UPRIGHT, "psi_start": 0.0, "phi_dot_start": -10.0, "stop": 5}
    ways = (
        ("M_brake = 20 N m from 1 s on", style.BLUE, fmu.run(signals=ramp.named(load="M_brake"), **start)),
        ("M_3 = 20 N m from 1 s on", style.VERMILLION, fmu.run(signals=ramp.named(load="M_3"), **start)),
        ("s = 0.03 m", style.GREEN, fmu.run(s=0.03, **start)),
    )
    for name, colour, run in ways:
        line = "--" if "M_3" in name else "-"
        left.plot(run["time"], -HEIGHT * run["omega_z"], line, color=colour, label=name)
    left.axhline(0, color=style.GREY, linewidth=0.6)
    left.set(xlabel="time $t$ [s]", ylabel="speed [m/s]", xlim=(0, 5))
    left.legend(loc="lower left")
    title(left, "A brake stops; a torque goes on")
    run = fmu.on_a_suspension()
    right.plot(run["time"], run["speed"], color=style.BLUE, label="speed [m/s]")
    right.plot(run["time"], np.degrees(run["psi"]) / 10, color=style.ORANGE, label="heading / 10 [deg]")
    right.plot(run["time"], np.degrees(run["lean"]), color=style.VERMILLION, label="lean to the right [deg]")
    right.plot(run["time"], run["M_1"] / 10, color=style.GREEN, label="$M_1$ / 10 [N m]")
    right.set(xlabel="time $t$ [s]", xlim=(0, run["time"][-1]), ylim=(-8.5, 14))
    right.legend(loc="upper right", ncols=2)
    title(right, "Held upright by $M_1$, steered by $M_2$, braked, held")
    save(fig, "brake_hold_steer")
    measured("steer_M_1", "steered at 90 deg/s and 3.5 m/s: M_1 that keeps the wheel upright", run["M_1"].min(), "N m")


def save(fig, name: str) -> None:
    fig.savefig(FIGURES / f"{name}.png", dpi=150, metadata={"Software": None})
    print(f"docs/figures/{name}.png")


def write_figures() -> None:
    DATA.parent.mkdir(parents=True, exist_ok=True)
    with DATA.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("figure", "what", "measured", "unit"))
        rows.writerows((name, what, repr(value), unit) for name, (what, value, unit) in figures.items())
    print(DATA.relative_to(ROOT))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", default=ROOT / "build" / "release" / "wheel.fmu", type=Path, help="the FMU to run")
    fmu = Fmu(parser.parse_args().fmu)
    style.use_style()
    for draw in (stays_up, held, energy, path, tipping, brake_hold_steer):
        draw(fmu)
    write_figures()
    return 0


if __name__ == "__main__":
    sys.exit(main())
