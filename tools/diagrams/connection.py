"""The picture of the connection: wheel.fmu, a suspension, a drive or driver, and the signals between them."""

from __future__ import annotations

from pathlib import Path

from matplotlib.patches import FancyBboxPatch

from diagrams import style

ARROW = {"arrowstyle": "-|>,head_width=0.18,head_length=0.36", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}


LOOK = {"boxstyle": "round,pad=0,rounding_size=2", "linewidth": 1.0, "facecolor": "white"}
# Left, bottom, width and height in mm; title, text and colour.
BOXES = (
    (124, 4, 52, 76, "wheel.fmu", "torus wheel on the ground\nrolling without slip\nrolling friction $s$", style.INK),
    (6, 48, 52, 32, "suspension", "springs, dampers, body\n(quarter_car.fmu)", style.BLUE),
    (6, 4, 52, 32, "drive, brake, driver", "controller, motor\n(balance.fmu)", style.GREEN),
)
# Start and end in X, and height in mm; signals and colour.
SIGNALS = (
    (58, 124, 70, r"$F_X\;F_Y\;F_Z$ at $O$;  $M_1$ camber, $M_2$ toe", style.BLUE),
    (124, 58, 55, r"$X_O\;Y_O\;Z_O\;\dot X_O\;\dot Y_O\;\dot Z_O\;\psi\;\theta\;\dot\psi\;\dot\theta$", style.INK),
    (58, 124, 31, r"$M_3$ drive torque;  $M_\mathrm{brake}$ capacity of the brake", style.GREEN),
    (
        124,
        58,
        16,
        r"$\dot\varphi\;\omega_z\;\psi\;\dot\psi\;\theta\;\dot\theta\;\;\lambda_x\;\lambda_y\;\lambda_3\;\tau$",
        style.INK,
    ),
)


def draw(stem: Path) -> None:
    """stem.svg and stem.png."""
    style.use_style()
    fig = style.figure_mm(style.PAGE, 88)
    ax = style.axes_mm(fig, 0, 0, style.PAGE, 88)
    ax.set_xlim(0, style.PAGE)
    ax.set_ylim(0, 88)
    ax.axis("off")
    for x, y, w, h, title, text, color in BOXES:
        ax.add_patch(FancyBboxPatch((x, y), w, h, edgecolor=color, **LOOK))
        ax.text(x + w / 2, y + h - 5, title, ha="center", va="center", fontsize=10, color=color)
        ax.text(x + w / 2, y + (h - 7) / 2, text, ha="center", va="center", fontsize=8, linespacing=1.5)
    for start, end, y, text, color in SIGNALS:
        ax.annotate("", (end, y), (start, y), arrowprops={**ARROW, "color": color})
        ax.text((start + end) / 2, y + 1.6, text, ha="center", va="bottom", fontsize=8, linespacing=1.4)
    when = "values and first derivatives at every communication point"
    ax.text(91, 40.5, when, ha="center", fontsize=7.5, color=style.GREY)
    style.save(fig, stem)


if __name__ == "__main__":
    draw(Path(__file__).resolve().parents[2] / "docs" / "figures" / "vehicle")
