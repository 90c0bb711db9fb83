"""The picture of the connection: wheel.fmu, a suspension, a drive or driver, and the signals between them."""

from __future__ import annotations

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.patches import FancyBboxPatch

from diagrams import style

ARROW = {"arrowstyle": "-|>,head_width=0.18,head_length=0.36", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}


def _box(ax: Axes, x: float, y: float, w: float, h: float, title: str, text: str, color: str) -> None:
    look = {"boxstyle": "round,pad=0,rounding_size=2", "linewidth": 1.0, "edgecolor": color, "facecolor": "white"}
    ax.add_patch(FancyBboxPatch((x, y), w, h, **look))
    ax.text(x + w / 2, y + h - 5, title, ha="center", va="center", fontsize=10, color=color)
    ax.text(x + w / 2, y + (h - 7) / 2, text, ha="center", va="center", fontsize=8, linespacing=1.5)


def _arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str, color: str) -> None:
    ax.annotate("", end, start, arrowprops={**ARROW, "color": color})
    ax.text((start[0] + end[0]) / 2, start[1] + 1.6, text, ha="center", va="bottom", fontsize=8, linespacing=1.4)


def _signals(ax: Axes) -> None:
    """The arrows between the boxes."""
    pose = r"$X_O\;Y_O\;Z_O\;\dot X_O\;\dot Y_O\;\dot Z_O\;\psi\;\theta\;\dot\psi\;\dot\theta$"
    motion = r"$\dot\varphi\;\omega_z\;\psi\;\dot\psi\;\theta\;\dot\theta\;\;\lambda_x\;\lambda_y\;\lambda_3\;\tau$"
    _arrow(ax, (58, 70), (124, 70), r"$F_X\;F_Y\;F_Z$ at $O$;  $M_1$ camber, $M_2$ toe", style.BLUE)
    _arrow(ax, (124, 55), (58, 55), pose, style.INK)
    _arrow(ax, (58, 31), (124, 31), r"$M_3$ drive torque;  $M_\mathrm{brake}$ capacity of the brake", style.GREEN)
    _arrow(ax, (124, 16), (58, 16), motion, style.INK)
    when = "values and first derivatives at every communication point"
    ax.text(91, 40.5, when, ha="center", fontsize=7.5, color=style.GREY)


def draw(stem: Path) -> None:
    """stem.svg and stem.png."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 88)
    ax = style.axes_mm(fig, 0, 0, style.PAGE, 88)
    ax.set_xlim(0, style.PAGE)
    ax.set_ylim(0, 88)
    ax.axis("off")
    wheel = "torus wheel on the ground\nrolling without slip\nrolling friction $s$"
    _box(ax, 124, 4, 52, 76, "wheel.fmu", wheel, style.INK)
    _box(ax, 6, 48, 52, 32, "suspension", "springs, dampers, body\n(quarter_car.fmu)", style.BLUE)
    _box(ax, 6, 4, 52, 32, "drive, brake, driver", "controller, motor\n(balance.fmu)", style.GREEN)
    _signals(ax)
    style.save(fig, stem)


if __name__ == "__main__":
    draw(Path(__file__).resolve().parents[2] / "docs" / "figures" / "vehicle")
