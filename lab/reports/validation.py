"""wheel.fmu beside published measurements: bicycle tyres that coast down on a drum.

The raw files of the drum carry no licence and stay outside. The measurement is docs/results/data/validation_rig.csv,
which was computed from them, and the tables beside it.
"""

from __future__ import annotations

import numpy as np
import pandas as pd

from wheelfmu.truth.motion import Library

from . import plots
from .page import Report, Tables, part, read_tables
from .plots import Sheet

LOAD = 557.4  # N, the rig's own value
KEYS = ["tyre", "psi", "direction"]
STEP = 0.1  # s, over which the drag is held
SHOWN = {"Michelin 4575r16": (40, "Left"), "Vittoria Corsa Open": (100, "Right"), "Michelin 44-406": (60, "Right")}
SHOWN |= {"Grandprix": (140, "Right")}
TUBE = 0.0125  # m, radius of a tyre of 25 mm
GRAVITY = 9.81  # m/s^2
RIG = ("rig", "runs_left_out", "trials_again", "loads")  # tables


def repeatability(rows: pd.DataFrame) -> pd.Series:
    """Standard deviation of one C per speed, out of the two directions of each tyre and pressure."""
    both = rows.pivot_table(index=["tyre", "psi", "speed"], columns="direction", values="C").dropna()
    apart = (both["Left"] - both["Right"]) ** 2 / 2
    return np.sqrt(apart.groupby("speed").mean())


@part(10)
def rig(report: Report) -> dict[str, object]:
    """coefficients of rolling resistance, as measured on the rig"""
    tables = read_tables("validation")
    rows, left_out, again, loads = (tables[name] for name in RIG)
    repeat = repeatability(rows) / rows.groupby("speed")["C"].mean()
    means = again.groupby(KEYS)[["C", "C again"]].mean()
    forces = loads[loads["speed"] > loads["speed"].min()].groupby("load")["force"].mean()
    (least, most), (weak, strong) = forces.index, forces
    found = {"runs": len(rows.drop_duplicates(KEYS)), "left_out": len(left_out)}
    found |= {"repeat": 100 * repeat.max(), "inertia": 100 * (rows["C_inertia"].abs() / rows["C"]).max()}
    found |= {"again": 100 * (means["C again"] / means["C"] - 1).abs().max(), "load_least": least, "load_most": most}
    found |= {"load_exponent": np.log(strong / weak) / np.log(most / least)}
    return found | {name: tables[name] for name in RIG}


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
def tyres(report: Report) -> dict[str, object]:
    """a constant s per tyre, and the coast-down of wheel.fmu with it"""
    rows, curves, rig = [], [], report.tables["rig"]
    repeat = repeatability(rig).mean()
    for key, run in rig.groupby(KEYS):
        about, C, duration = dict(zip(KEYS, key, strict=True)), run["C"].mean(), run["t"].max()
        off = 100 * (run["C"] / C - 1)
        t, v = coast(report.library, run, C)
        at, uncertain = np.interp(run["speed"], v[::-1], t[::-1]), np.hypot(run["C_inertia"].mean(), repeat)
        level = {"1000 C": 1e3 * C, "±": 1e3 * uncertain, "s [mm]": 1e3 * C * run["R"].iloc[0]}
        shape = {"largest deviation of C [%]": off.abs().max(), "at 3 m/s [%]": off[run["speed"].idxmin()]}
        of_fmu = {"coast [s]": duration, "error of the duration [%]": 100 * (at.max() / duration - 1)}
        worst = np.abs(np.interp(run["t"], t, v) - run["speed"]).max()
        rows.append(about | level | shape | of_fmu | {"largest speed error [m/s]": worst})
        few = np.unique(np.append(np.arange(0, len(t), 80), len(t) - 1))
        curves.append(pd.DataFrame({**about, "t": t[few], "speed": v[few]}))
    found = pd.DataFrame(rows)
    figures = {"slow_end": -found["at 3 m/s [%]"].min(), "coast": found["error of the duration [%]"].abs().max()}
    return {"by_run": found, "coasts": pd.concat(curves)} | figures


@tyres.picture("tyres")
def draw_tyres(tables: Tables) -> Sheet:
    """C over the speed with its uncertainty, and the measured coast-down beside the one of wheel.fmu."""
    sheet, (left, right) = plots.sheet("ab", 80)
    repeat = repeatability(tables["rig"])
    for (tyre, (psi, direction)), colour in zip(SHOWN.items(), plots.COLOURS, strict=False):
        one = f"tyre == {tyre!r} and psi == {psi} and direction == {direction!r}"
        run, curve = (tables[name].query(one) for name in ("rig", "coasts"))
        error = np.hypot(run["C_inertia"], repeat.loc[run["speed"]].to_numpy())
        bars = {"color": colour, "fmt": "o", "ms": 3, "capsize": 2, "lw": 0.8, "label": f"{tyre}, {psi} psi"}
        left.errorbar(run["speed"], 1e3 * run["C"], 1e3 * error, **bars)
        left.axhline(1e3 * run["C"].mean(), color=colour, lw=0.8, ls="--")
        right.plot(curve["t"], curve["speed"], color=colour)
        right.plot(run["t"], run["speed"], "o", color=colour, ms=3.5, label=f"{tyre}, {psi} psi")
    left.legend(loc="upper center", ncols=2, fontsize=7)
    title, y = "Measured, and a constant s (dashed)", "rolling resistance $1000\\,C$"
    plots.label(left, "rim speed [m/s]", y, title, ylim=(0, 6.5))
    title = "Coast-down: measured (dots), wheel.fmu (lines)"
    plots.label(right, "time [s]", "rim speed [m/s]", title, xlim=(0, None), ylim=(0, 22))
    return sheet
