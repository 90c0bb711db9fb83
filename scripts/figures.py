#!/usr/bin/env python3
"""Draw the paper's six diagrams (Fig. 1-6) from the two scenes that `fmpy simulate` wrote.

Reads free.csv (s = 0) and friction.csv (s = 0.03 m); writes the sheet paper_diagrams and the
single files fig_1 ... fig_6, each as SVG and PNG. Fixed axes X, Y, Z, Z up; rad, degrees beside.
"""

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from plotting import panels, style
from plotting.scene import Scene, SceneError, read_scene

ROOT = Path(__file__).resolve().parent.parent
SIGNALS = ("time", "X_O", "theta", "phi_dot", "psi_dot")
PITCH = 3.4  # mm from one line of a caption to the next

# The numbers of (27)-(33).
WHEEL = (
    r"$m = 20$ kg, $r_0 = 0.3$ m, $r = 0.05$ m, "
    r"$J_x = J_y = 0.9$ kg$\,$m$^2$, $J_z = 1.8$ kg$\,$m$^2$"
)
START = (
    r"At $t = 0$: $\psi = \pi/2$, $\theta = 5\pi/12$, $\varphi = 0$, "
    r"$\dot\psi = \dot\theta = 0$, $\dot\varphi = -2$ rad/s"
)
TITLES = {False: r"no rolling friction, $s = 0$", True: r"rolling friction, $s = 0.03$ m"}


@dataclass(frozen=True)
class Diagram:
    """One of the paper's figures."""

    number: int
    friction: bool
    draw: Callable[[Axes, Scene, bool], None]
    subject: str
    over_time: bool
    remark: str


ARC = "$\\theta$ is written along the arc; the rates depend on it alone."
EVENTS = "{n} transitions. Bands: stick ($\\omega_z = 0$). Ticks: $\\omega_z$ changes sign."
SPIRAL = (
    "Thick: stick ($\\omega_z = 0$), within the {n} transitions. Dot: start; square: end.\n"
    "Inset: the same motion sheared, which opens the narrow bundle."
)
POSITION = (panels.draw_position, r"$X_O(t)$", True)
TILT = (panels.draw_tilt, r"$\theta(t)$", True)
RATES = (panels.draw_rates, r"$\dot\varphi(\dot\psi)$", False)

DIAGRAMS = (
    Diagram(1, False, *POSITION, ""),
    Diagram(2, False, *TILT, ""),
    Diagram(3, False, *RATES, ARC),
    Diagram(4, True, *POSITION, EVENTS),
    Diagram(5, True, *TILT, EVENTS),
    Diagram(6, True, *RATES, SPIRAL),
)


def draw_single(diagram: Diagram, scene: Scene, stem: Path) -> list[Path]:
    """One diagram, one journal column wide, with its caption."""
    remark = diagram.remark.format(n=scene.n_transitions) if diagram.friction else diagram.remark
    lines = [f"{WHEEL}.", f"{START}.", *remark.splitlines()]
    height = 46.0 if diagram.over_time else 62.0
    foot = 13.0 + PITCH * len(lines)
    fig = style.figure_mm(style.COLUMN, foot + height + 8.0)
    ax = style.axes_mm(fig, 13.5, foot, 63.0, height)
    diagram.draw(ax, scene, diagram.friction)
    title = f"{heading(diagram)}, {TITLES[diagram.friction]}"
    style.text_mm(fig, 2.0, foot + height + 4.0, title, fontsize=9)
    write_caption(fig, lines)
    return style.save(fig, stem)


def heading(diagram: Diagram) -> str:
    """Number and subject."""
    return rf"$\mathbf{{Fig.\,{diagram.number}}}$   {diagram.subject}"


def write_caption(fig: Figure, lines: list[str]) -> None:
    """Lines of equal pitch, up from the figure's lower edge, whatever their heights."""
    for i, line in enumerate(reversed(lines)):
        style.text_mm(fig, 2.0, 1.8 + PITCH * i, line, fontsize=7.5)


def draw_sheet(scenes: dict[bool, Scene], stem: Path) -> list[Path]:
    """All six diagrams on one page: the free wheel on the left, with friction on the right."""
    fig = style.figure_mm(style.PAGE, 219.0)
    rows = ((163.0, 40.0), (105.0, 40.0), (28.0, 58.0))  # bottom and height in mm
    for diagram in DIAGRAMS:
        bottom, height = rows[(diagram.number - 1) % 3]
        left = 108.0 if diagram.friction else 14.0
        ax = style.axes_mm(fig, left, bottom, 62.0, height)
        diagram.draw(ax, scenes[diagram.friction], diagram.friction)
        style.text_mm(fig, left - 12.0, bottom + height + 2.6, heading(diagram), fontsize=9)
    for friction, left in ((False, 2.0), (True, 96.0)):
        title = TITLES[friction]
        style.text_mm(fig, left, 213.0, title[0].upper() + title[1:], fontsize=10.5)
    write_caption(fig, sheet_caption(scenes[True]))
    return style.save(fig, stem)


def sheet_caption(friction: Scene) -> list[str]:
    """The parameters and what the marks mean."""
    count = f"{friction.n_transitions} transitions in {friction.time[-1]:g} s"
    events = (
        f"Fig. 4–6: {count}. Bands, thick in Fig. 6: stick ($\\omega_z$ held at zero). "
        "Ticks at the top: $\\omega_z$ changes sign."
    )
    rates = (
        "Fig. 3: the rates depend on $\\theta$ alone, so the wheel runs to and fro on one arc. "
        "Inset of Fig. 6: the same motion sheared, which opens the narrow bundle."
    )
    return [f"Torus wheel: {WHEEL}. {START}.", events, rates]


def main() -> int:
    """Draw everything; a fault of the input is one sentence on stderr and exit status 1."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    results = ROOT / "results"
    parser.add_argument("--results", type=Path, default=results, help="where the CSV files are")
    parser.add_argument("--out", type=Path, help="where the figures go (default: the same)")
    arguments = parser.parse_args()
    out = arguments.out or arguments.results
    style.use_style()
    try:
        scenes = {
            False: read_scene(arguments.results / "free.csv", SIGNALS),
            True: read_scene(arguments.results / "friction.csv", SIGNALS, ("friction_mode", "omega_z")),
        }
    except SceneError as fault:
        print(f"figures: {fault}", file=sys.stderr)
        return 1
    written = draw_sheet(scenes, out / "paper_diagrams")
    for diagram in DIAGRAMS:
        written += draw_single(diagram, scenes[diagram.friction], out / f"fig_{diagram.number}")
    print("\n".join(str(path) for path in written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
