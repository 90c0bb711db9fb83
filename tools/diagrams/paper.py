#!/usr/bin/env python3
"""Draw the paper's six diagrams (Fig. 1-6) from the two scenes that `./scripts/run` simulated, the paper's or others.

Reads free.csv (s = 0) and friction.csv (s > 0), which hold the run's parameters as columns: titles and captions come
from there. Writes the sheet paper_diagrams (named diagrams where the values are not the paper's) and the single files
fig_1 ... fig_6, each as SVG and PNG. Fixed axes X, Y, Z, Z up; rad, degrees beside.
"""

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from diagrams import panels, style
from diagrams.scene import Scene, SceneError, read_scene

ROOT = Path(__file__).resolve().parents[2]
PAPER = {  # (27)-(33)
    **{"m": 20, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_y": 0.9, "J_z": 1.8, "g": 9.81},
    **{"psi_start": np.pi / 2, "theta_start": 5 * np.pi / 12, "phi_start": 0},
    **{"psi_dot_start": 0, "theta_dot_start": 0, "phi_dot_start": -2},
}
PAPER_S = 0.03  # m, (29)
SIGNALS = ("time", "X_O", "theta", "phi_dot", "psi_dot", "s", *PAPER)
PITCH = 3.4  # mm from one line of a caption to the next


@dataclass(frozen=True)
class Diagram:
    """One of the paper's figures."""

    number: int
    friction: bool
    draw: Callable[[Axes, Scene, bool], None]
    subject: str
    over_time: bool


POSITION = (panels.draw_position, r"$X_O(t)$", True)
TILT = (panels.draw_tilt, r"$\theta(t)$", True)
RATES = (panels.draw_rates, r"$\dot\varphi(\dot\psi)$", False)
DIAGRAMS = (
    Diagram(1, False, *POSITION),
    Diagram(2, False, *TILT),
    Diagram(3, False, *RATES),
    Diagram(4, True, *POSITION),
    Diagram(5, True, *TILT),
    Diagram(6, True, *RATES),
)


def is_paper(scenes: dict[bool, Scene]) -> bool:
    """Whether the runs are the paper's."""
    same = all(abs(scenes[True].value(name) - value) < 1e-12 for name, value in PAPER.items())
    return same and scenes[True].value("s") == PAPER_S and scenes[True].time[-1] == 10


def short(value: float) -> str:
    """Four digits, a power of ten as such."""
    mantissa, _, exponent = f"{value:.4g}".partition("e")
    return rf"{mantissa}\cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def wheel_of(scene: Scene) -> str:
    """The constants of (27)-(31) as the run had them."""
    m, r_0, r, J_x, J_y, J_z, g = (short(scene.value(name)) for name in ("m", "r_0", "r", "J_x", "J_y", "J_z", "g"))
    across = rf"$J_x = J_y = {J_x}$" if J_x == J_y else rf"$J_x = {J_x}$, $J_y = {J_y}$"
    gravity = "" if g == "9.81" else rf", $g = {g}$ m/s$^2$"
    return rf"$m = {m}$ kg, $r_0 = {r_0}$ m, $r = {r}$ m, {across}, $J_z = {J_z}$ kg$\,$m$^2${gravity}"


def start_of(scene: Scene) -> str:
    """The start, (32) and (33), as the run had it."""
    angles = (("psi", r"\psi"), ("theta", r"\theta"), ("phi", r"\varphi"))
    places = [rf"${symbol} = {np.degrees(scene.value(f'{name}_start')):.5g}°$" for name, symbol in angles]
    rates = [rf"$\dot{symbol} = {scene.value(f'{name}_dot_start'):.4g}$" for name, symbol in angles]
    return f"At $t = 0$: {', '.join(places)}; {', '.join(rates)} rad/s"


def title_of(scene: Scene) -> str:
    s = scene.value("s")
    return rf"rolling friction, $s = {s:.4g}$ m" if s > 0 else r"no rolling friction, $s = 0$"


def heading(diagram: Diagram, paper: bool) -> str:
    """Number and subject; for values that are not the paper's, the figure that it corresponds to."""
    return rf"{'' if paper else 'as '}$\mathbf{{Fig.\,{diagram.number}}}$   {diagram.subject}"


def arc_remark(scene: Scene) -> str:
    """Of Fig. 3, if there is an arc."""
    arc = r"the rates depend on $\theta$ alone, so the wheel runs to and fro on one arc."
    return arc if panels.one_arc(scene) else ""


def events_remark(scene: Scene, marks: str, ticks: bool = True) -> str:
    """What the friction did, and the marks that are there."""
    if scene.stick_phases() and not scene.n_transitions:
        return r"$\omega_z$ is held at zero all the time (stick)."
    count = f"{scene.n_transitions or 'no'} transition{'s' * (scene.n_transitions != 1)} in {scene.time[-1]:.3g} s."
    bands = rf" {marks}: stick ($\omega_z$ held at zero)." if scene.stick_phases() else ""
    return count + bands + (r" Ticks at the top: $\omega_z$ changes sign." if ticks and scene.reversals() else "")


def inset_remark(scene: Scene) -> str:
    return "the same motion sheared, which opens the narrow bundle." if panels.narrow(scene) else ""


def remarks_of(diagram: Diagram, scene: Scene) -> list[str]:
    """What stands below a single diagram."""
    remarks = [arc_remark(scene)] if diagram.number == 3 else []
    if diagram.friction:
        over_time = diagram.over_time
        remarks.append(events_remark(scene, "Bands" if over_time else "Thick", over_time))
    if diagram.number == 6 and not panels.still(scene):
        inset = inset_remark(scene)
        remarks += ["Dot: start; square: end.", inset and f"Inset: {inset}"]
    remarks.append(scene.ending and f"The wheel {scene.ending}, where the model ends.")
    return [remark[0].upper() + remark[1:] for remark in remarks if remark]


def draw_single(diagram: Diagram, scene: Scene, paper: bool, stem: Path) -> list[Path]:
    """One diagram, one journal column wide, with its caption."""
    lines = [f"{wheel_of(scene)}.", f"{start_of(scene)}.", *remarks_of(diagram, scene)]
    height = 46.0 if diagram.over_time else 62.0
    foot = 13.0 + PITCH * len(lines)
    fig = style.figure_mm(style.COLUMN, foot + height + 8.0)
    ax = style.axes_mm(fig, 13.5, foot, 63.0, height)
    diagram.draw(ax, scene, diagram.friction)
    style.text_mm(fig, 2.0, foot + height + 4.0, f"{heading(diagram, paper)}, {title_of(scene)}", fontsize=9)
    write_caption(fig, lines, 7.0)
    return style.save(fig, stem)


def write_caption(fig: Figure, lines: list[str], size: float = 7.5) -> None:
    """Lines of equal pitch, up from the figure's lower edge, whatever their heights."""
    for i, line in enumerate(reversed(lines)):
        style.text_mm(fig, 2.0, 1.8 + PITCH * i, line, fontsize=size)


def draw_sheet(scenes: dict[bool, Scene], paper: bool, stem: Path) -> list[Path]:
    """All six diagrams on one page: the free wheel on the left, with friction on the right."""
    fig = style.figure_mm(style.PAGE, 219.0)
    rows = ((163.0, 40.0), (105.0, 40.0), (28.0, 58.0))  # bottom and height in mm
    for diagram in DIAGRAMS:
        bottom, height = rows[(diagram.number - 1) % 3]
        left = 108.0 if diagram.friction else 14.0
        ax = style.axes_mm(fig, left, bottom, 62.0, height)
        diagram.draw(ax, scenes[diagram.friction], diagram.friction)
        style.text_mm(fig, left - 12.0, bottom + height + 2.6, heading(diagram, paper), fontsize=9)
    for friction, left in ((False, 2.0), (True, 96.0)):
        scene = scenes[friction]
        title = title_of(scene)
        style.text_mm(fig, left, 213.0, title[0].upper() + title[1:], fontsize=10.5)
        ending = f"The wheel {scene.ending}, where the model ends." if scene.ending else ""
        style.text_mm(fig, left, 209.3, ending, fontsize=8, color=style.VERMILLION)
    write_caption(fig, sheet_caption(scenes))
    return style.save(fig, stem)


def sheet_caption(scenes: dict[bool, Scene]) -> list[str]:
    """The parameters and what the marks mean."""
    friction, arc, inset = scenes[True], arc_remark(scenes[False]), inset_remark(scenes[True])
    rates = [f"Fig. 3: {arc}" if arc else "", f"Inset of Fig. 6: {inset}" if inset else ""]
    lines = [f"Torus wheel: {wheel_of(friction)}. {start_of(friction)}."]
    lines += [f"Fig. 4–6: {events_remark(friction, 'Bands, thick in Fig. 6')}", " ".join(filter(None, rates))]
    return list(filter(None, lines))


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
            True: read_scene(arguments.results / "friction.csv", (*SIGNALS, "friction_mode")),
        }
    except SceneError as fault:
        print(f"run: {fault}", file=sys.stderr)
        return 1
    paper = is_paper(scenes)
    written = draw_sheet(scenes, paper, out / ("paper_diagrams" if paper else "diagrams"))
    for diagram in DIAGRAMS:
        written += draw_single(diagram, scenes[diagram.friction], paper, out / f"fig_{diagram.number}")
    print("\n".join(str(path) for path in written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
