"""wheel.fmu beside published measurements: bicycle tyres that coast down on a drum, and disks that spin to rest.

The raw files of the drum carry no licence and stay outside; --rig FOLDER evaluates them (coast_down.py). Without it the
derived figures in docs/results/data/validation_rig.csv are the measurement. disks.csv: what others published on disks.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from support.motion import Library
from support.paths import ROOT

from . import coast_down, plots
from .coast_down import KEYS, LOAD
from .page import Report, Tables, part, read_tables
from .plots import Sheet

STEP = 0.1  # s, over which the drag is held
TUBE = 0.0125  # m, radius of a tyre of 25 mm
GRAVITY = 9.81  # m/s^2
DISK = {"m": 0.4, "r_0": 0.0375, "r": 0.0, "J_x": 0.4 * 0.0375**2 / 4, "J_y": 0.4 * 0.0375**2 / 4}
DISK |= {"J_z": 0.4 * 0.0375**2 / 2, "g": GRAVITY}  # a thin disk of the size of the toy, SI
DISK_TIME = 100.0  # s
LAWS = {"wheel.fmu, held": np.nan, "moment s N against the rolling": 1, "power ~ Ω²": 2, "air layer (Moffatt)": 4}


@part(10)
def rig(report: Report) -> None:
    """coefficients of rolling resistance out of the raw files, or those kept in docs/results/data"""
    if folder := report.options.get("rig"):
        aero, force = Path(folder) / "aero", Path(folder) / "force"
        runs, copies = coast_down.read(aero)
        rows, left_out = coast_down.evaluate(runs, copies)
        again, loads = coast_down.again(runs, copies, aero / "Repeats"), coast_down.loaded(runs, force)
    else:
        kept = read_tables(ROOT / "docs" / "results", "validation")
        rows, left_out, again, loads = (kept[name] for name in ("rig", "left_out", "again", "loads"))
    report.kept["rig"] = rows
    for name, table in {"rig": rows, "left_out": left_out, "again": again, "loads": loads}.items():
        report.table(name, table)
    repeat = coast_down.repeatability(rows) / rows.groupby("speed")["C"].mean()
    report.figures(runs=len(rows.drop_duplicates(KEYS)), left_out=len(left_out), tyres=rows["tyre"].nunique())
    report.figures(repeat=100 * repeat.max(), inertia=100 * (rows["C_inertia"].abs() / rows["C"]).max())
    means = again.groupby(KEYS)[["C", "C again"]].mean()
    report.figures(again=100 * (means["C again"] / means["C"] - 1).abs().max())
    forces = loads[loads["speed"] > loads["speed"].min()].groupby("load")["force"].mean()
    least, most = forces.index.min(), forces.index.max()
    exponent = np.log(forces[most] / forces[least]) / np.log(most / least)
    report.figures(load_least=least, load_most=most, load_exponent=exponent)
    report.figures(C_least=1e3 * forces[least] / least, C_most=1e3 * forces[most] / most)
    for name, sign in (("light", -1), ("heavy", 1)):
        tilted = rows.assign(C=rows["C"] + sign * rows["C_inertia"]).groupby(KEYS)["C"]
        report.figures(**{f"spread_{name}": 100 * tilted.agg(lambda C: (C / C.mean() - 1).abs().max()).median()})


def equivalent(run: pd.DataFrame, C: float) -> dict[str, float]:
    """The drum and its wheel as one upright wheel of the FMU: same rim speed, inertia at the rim, load, resistance.

    (J_z / R^2 + m) v' = -(s / R) N - drag(v): m = 1 kg of wheel, J_z the rest of M; N = m g - F_Z; s = C R.
    A thin ring's J_x = J_z / 2 keeps it upright down to the slowest speed.
    """
    R, mass = float(run["R"].iloc[0]), 1.0
    J_z = (float(run["M"].iloc[0]) - mass) * R**2
    size = {"r_0": R - TUBE, "r": TUBE, "m": mass, "J_z": J_z, "J_x": J_z / 2, "J_y": J_z / 2, "g": GRAVITY}
    return size | {"s": C * R, "theta_start": np.pi / 2, "psi_start": 0.0}


def coast(library: Library, run: pd.DataFrame, C: float) -> tuple[np.ndarray, np.ndarray]:
    """Time and speed of wheel.fmu from the fastest measured speed to the slowest; the drag is that without contact."""
    start, R = equivalent(run, C), float(run["R"].iloc[0])
    drag = np.polynomial.Polynomial.fit(run["speed"], run["drag"], 3)
    fastest, slowest = run["speed"].max(), run["speed"].min()
    times, speeds = [0.0], [fastest]
    with library.wheel() as wheel:
        push = {"F_Z": start["m"] * start["g"] - LOAD, "F_X": -drag(fastest)}
        wheel.start(phi_dot_start=-fastest / R, **start, **push)
        spin = wheel.reader(["omega_z"])
        while speeds[-1] > slowest:
            wheel.step(STEP)
            times.append(times[-1] + STEP)
            speeds.append(-R * spin()[0])
            wheel.set(F_X=-drag(speeds[-1]))
    return np.array(times), np.array(speeds)


@part(15)
def tyres(report: Report) -> None:
    """a constant s per tyre, and the coast-down of wheel.fmu with it"""
    rows, curves = [], []
    repeat = coast_down.repeatability(report.kept["rig"]).mean()
    for key, run in report.kept["rig"].groupby(KEYS):
        C = run["C"].mean()
        off = run["C"] / C - 1
        t, v = coast(report.library, run, C)
        duration = run["t"].max()
        at = np.interp(run["speed"], v[::-1], t[::-1])
        row = dict(zip(KEYS, key, strict=True))
        row |= {"1000 C": 1e3 * C, "±": 1e3 * np.hypot(run["C_inertia"].mean(), repeat)}
        row |= {"s [mm]": 1e3 * C * run["R"].iloc[0], "C off its mean [%]": 100 * off.abs().max()}
        row |= {"at 3 m/s [%]": 100 * off[run["speed"].idxmin()], "coast [s]": duration}
        row["wheel.fmu: coast [%]"] = 100 * (at.max() / duration - 1)
        row["worst speed [m/s]"] = np.abs(np.interp(run["t"], t, v) - run["speed"]).max()
        rows.append(row)
        few = np.unique(np.append(np.arange(0, len(t), 80), len(t) - 1))
        curves.append(pd.DataFrame({"t": t[few], "speed": v[few]}).assign(**dict(zip(KEYS, key, strict=True))))
    found = pd.DataFrame(rows)
    report.table("tyres", found)
    report.table("coasts", pd.concat(curves)[[*KEYS, "t", "speed"]])
    off, shape = found["C off its mean [%]"], found["wheel.fmu: coast [%]"].abs()
    report.figures(spread=off.max(), spread_median=off.median(), s_least=found["s [mm]"].min())
    report.figures(s_most=found["s [mm]"].max(), coast=shape.max(), coast_speed=found["worst speed [m/s]"].max())
    report.figures(slow_end=-found["at 3 m/s [%]"].min())


def turn_rate(inclination: float) -> float:
    """psi_dot of a thin disk whose centre rests: psi_dot^2 sin(theta) = m g R / J_x = 4 g / R."""
    return np.sqrt(4 * GRAVITY / (DISK["r_0"] * np.sin(inclination)))


def held_disk(library: Library, inclination: float, stop: float, s: float = 0.0) -> tuple[float, float]:
    """How far inclination and energy change, relative, of a disk that starts on the steady circle of psi_dot."""
    rate = turn_rate(inclination)
    start = {"theta_start": inclination, "psi_dot_start": rate, "phi_dot_start": -rate * np.cos(inclination)}
    found = library.simulate(np.linspace(0, stop, 201), 1e-10, s=s, keep_contact=True, **DISK, **start)
    assert found.end is None, found.ended
    theta, energy = found["theta"], found["E"]
    return float(np.ptp(theta) / inclination), float(np.ptp(energy) / energy[0])


@part(5)
def disks(report: Report) -> None:
    """Euler's disk: the steady circle, and the energy that the paper's friction takes"""
    report.table("disks", pd.read_csv(Path(__file__).with_name("disks.csv")))
    rows = []
    for degrees in (5, 10, 20, 40, 60):
        off, _ = held_disk(report.library, np.radians(degrees), 5.0)
        rows.append({"inclination [deg]": degrees, "ψ̇ [rad/s]": turn_rate(np.radians(degrees)), "it changes by": off})
    report.table("circle", rows)
    off, loss = held_disk(report.library, np.radians(10), DISK_TIME, s=1e-3 * DISK["r_0"])
    report.figures(circle=max(row["it changes by"] for row in rows), disk_loss=loss, disk_falls=off)


def views(tables: Tables) -> Tables:
    """Each tyre in one row, published disks, and the exponents that follow from a law of dissipation.

    With E = 3/2 m g R theta and psi_dot^2 theta = 4 g / R, a power ~ psi_dot^k gives theta ~ (t_0 - t)^(2 / (2 + k)).
    """
    by_tyre = [
        {
            "tyre": tyre,
            "psi": between(runs["psi"], 0),
            "runs": len(runs),
            "1000 C": between(runs["1000 C"], 2),
            "C off its mean [%]": runs["C off its mean [%]"].max(),
            "at 3 m/s [%]": runs["at 3 m/s [%]"].min(),
            "wheel.fmu: speed off [m/s]": runs["worst speed [m/s]"].max(),
        }
        for tyre, runs in tables["tyres"].groupby("tyre")
    ]
    disks = tables["disks"].drop(columns="seen")
    laws = [{"power": name, "inclination": fraction(2, k), "precession": fraction(-1, k)} for name, k in LAWS.items()]
    return tables | {"by_tyre": pd.DataFrame(by_tyre), "published": disks, "laws": pd.DataFrame(laws)}


def between(values: pd.Series, digits: int) -> str:
    return " to ".join(dict.fromkeys(f"{value:.{digits}f}" for value in (values.min(), values.max())))


def fraction(over: int, k: float) -> str:
    if np.isnan(k):
        return "constant"
    shared = 2 if over == 2 and k % 2 == 0 else 1
    return f"{over // shared}/{int(2 + k) // shared}".replace("-", "−")


def shown(tables: Tables, name: str, chosen: dict[str, object]) -> pd.DataFrame:
    frame = tables[name]
    return frame[np.logical_and.reduce([frame[key] == value for key, value in chosen.items()])]


def picture(tables: Tables) -> Sheet:
    """C over the speed with its uncertainty, and the measured coast-down beside the one of wheel.fmu."""
    sheet, (left, right) = plots.sheet(2, height=80)
    chosen = (("Michelin 4575r16", 40), ("Vittoria Corsa Open", 100), ("Michelin 44-406", 60), ("Grandprix", 140))
    repeat = coast_down.repeatability(tables["rig"])
    for (tyre, psi), colour in zip(chosen, plots.COLOURS, strict=False):
        sides = tables["tyres"].query("tyre == @tyre and psi == @psi")
        pick = {"tyre": tyre, "psi": psi, "direction": sides["direction"].iloc[-1]}
        run, curve = shown(tables, "rig", pick), shown(tables, "coasts", pick)
        error = np.hypot(run["C_inertia"], repeat.loc[run["speed"]].to_numpy())
        bars = {"color": colour, "fmt": "o", "ms": 3, "capsize": 2, "lw": 0.8, "label": f"{tyre}, {psi} psi"}
        left.errorbar(run["speed"], 1e3 * run["C"], 1e3 * error, **bars)
        left.axhline(1e3 * run["C"].mean(), color=colour, lw=0.8, ls="--")
        right.plot(curve["t"], curve["speed"], color=colour)
        right.plot(run["t"], run["speed"], "o", color=colour, ms=3.5, label=f"{tyre}, {psi} psi")
    left.set(ylim=(0, 6.5))
    left.legend(loc="upper center", ncols=2, fontsize=7)
    title = "Measured, and a constant s (dashed)"
    plots.label(left, "rim speed [m/s]", "rolling resistance $1000\\,C$", title)
    right.set(xlim=(0, None), ylim=(0, 22))
    plots.label(right, "time [s]", "rim speed [m/s]", "Coast-down: measured (dots), wheel.fmu (lines)")
    return sheet


PICTURES = {"tyres": picture}
