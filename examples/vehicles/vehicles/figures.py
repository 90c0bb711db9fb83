"""Figures of the two coupled runs, in the project's style. Fixed axes X, Y; degrees for theta."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from diagrams import style

from .drawing import draw_errors
from .driven import Drive
from .errors import Errors


def draw_drive(drive: Drive, path: Path) -> None:
    """The path of the wheel's centre, its tilt and the controller's moments; alone and controlled."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 84)
    ground = style.axes_mm(fig, 14, 12, 66, 66)
    for table, color, label in (
        (drive.alone, style.VERMILLION, "alone"),
        (drive.controlled, style.BLUE, "with controller"),
    ):
        ground.plot(table["X_O"], table["Y_O"], color=color, label=label)
    ground.set_aspect("equal", adjustable="datalim")
    ground.legend(loc="upper left")
    ground.set(xlabel=r"$X_O$ [m]", ylabel=r"$Y_O$ [m]")
    tilt = style.axes_mm(fig, 100, 50, 78, 28)
    tilt.plot(drive.alone["time"], np.degrees(drive.alone["theta"]), color=style.VERMILLION)
    tilt.plot(drive.controlled["time"], np.degrees(drive.controlled["theta"]), color=style.BLUE)
    tilt.axhline(90, color=style.GREY, linewidth=0.5)
    tilt.set_yticks([0, 45, 90, 135, 180])
    tilt.set_ylabel(r"$\theta$ [deg]")
    moments = style.axes_mm(fig, 100, 12, 78, 28)
    for name, color in (("M_1", style.GREEN), ("M_3", style.PURPLE)):
        moments.plot(drive.controlled["time"], drive.controlled[name], color=color, label=f"${name}$")
    moments.legend(loc="best", ncols=2)
    moments.set(xlabel="time [s]", ylabel="moment [N m]")
    style.save_png(fig, path)


def draw_launch(table: dict[str, np.ndarray], found: Errors, path: Path) -> None:
    """Forces of the launch, and the error against the communication step."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 84)
    speed = style.axes_mm(fig, 16, 50, 66, 28)
    speed.plot(table["time"], -0.35 * table["omega_z"], color=style.BLUE, label="wheel, $-(r_0 + r)\\,\\omega_z$")
    speed.legend(loc="upper left")
    speed.set_ylabel("speed [m/s]")
    force = style.axes_mm(fig, 16, 12, 66, 28)
    for name, color in (("lambda_3", style.INK), ("F_X", style.GREEN)):
        force.plot(table["time"], table[name] / 1000, color=color, label={"lambda_3": "$N$", "F_X": "$F_X$"}[name])
    force.legend(loc="center right", ncols=2)
    force.set(xlabel="time [s]", ylabel="force [kN]")
    draw_errors(style.axes_mm(fig, 104, 12, 74, 66), found, {"loc": "center left", "bbox_to_anchor": (0.02, 0.32)})
    style.save_png(fig, path)
