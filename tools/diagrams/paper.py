#!/usr/bin/env python3
"""Draw what `./scripts/run` simulated: the paper's six diagrams (Fig. 1-6), the path, and what the ground has to give.

Reads free.csv (s = 0) and friction.csv (s > 0), which hold all that was set as columns: titles and captions come from
there. The paper's two scenes make paper_diagrams, paper_path_and_ground and fig_1 ... fig_6; others make diagrams and
diagram_NAME_SCENE, and leave those of the paper in place. All as SVG and PNG. Fixed axes X, Y, Z, Z up; rad, degrees
beside.
"""

import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from diagrams import panels, style
from diagrams.scene import Scene, SceneError, read_scene
from diagrams.start_values import PAPER_S, ROOT, RUN, outputs, variables

RESULTS = ROOT / "results"
SETTINGS = variables("parameter", "input")
NO_BREAK = "\u00a0"  # a space at which no line ends
PITCH = 3.4  # mm from one line of a caption to the next


@dataclass(frozen=True)
class Panel:
    """One row of a sheet; `figures`: its numbers in the paper, without and with friction; height in mm."""

    name: str
    subject: str
    height: float
    draw: Callable[[Axes, Scene], None]
    figures: tuple[int, int] | None = None


PAPERS = (
    Panel("position", r"$X_O(t)$", 40.0, panels.draw_position, (1, 4)),
    Panel("tilt", r"$\theta(t)$", 40.0, panels.draw_tilt, (2, 5)),
    Panel("rates", r"$\dot\varphi(\dot\psi)$", 58.0, panels.draw_rates, (3, 6)),
)
OTHERS = (
    Panel("path", "Path of the contact point", 50.0, panels.draw_path),
    Panel("ground", r"$N(t)$ and required $\mu(t)$", 50.0, panels.draw_ground),
)


def unlike_paper(scene: Scene) -> list[str]:
    """All that was set otherwise than in (27)-(33), the start values of the description; the title has s."""
    own = {name: scene.value(name) for name in SETTINGS if name != "s"}
    said = [SETTINGS[name].said(value) for name, value in own.items() if abs(value - SETTINGS[name].preset) > 1e-12]
    rows = {"stop_time": scene.time[-1], "output_interval": scene.time[1] - scene.time[0]}
    if scene.ending:
        del rows["stop_time"]
    said += [RUN[name].said(value) for name, value in rows.items() if abs(value - RUN[name].preset) > 1e-9]
    return said + ["r > r_0, the torus intersects itself"] * (own["r"] > own["r_0"])


def is_paper(scenes: Sequence[Scene]) -> bool:
    """Whether the runs are the paper's."""
    return scenes[1].value("s") == PAPER_S and not any(scene.ending or unlike_paper(scene) for scene in scenes)


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


def events_of(scene: Scene) -> list[str]:
    """What friction and brake did, and the marks that are there."""
    phases, count = scene.stick_phases(), int(scene["n_events"][-1])
    if phases and not count:
        return [r"$\omega_z$ is held at zero all the time (stick)."]
    bands = [r"Bands, thick among the rates: stick ($\omega_z$ held at zero)."] if phases else []
    ticks = [r"Ticks at the top: $\omega_z$ changes sign."] if len(scene.reversals()) else []
    return [f"{count or 'No'} transition{'s' * (count != 1)} in {scene.time[-1]:.3g} s.", *bands, *ticks]


def remarks_of(scene: Scene, drawn: Sequence[Panel]) -> list[str]:
    """What has to be said of one scene below these panels, a sentence each."""
    rates = panels.draw_rates in [panel.draw for panel in drawn]
    over_time = any(panel.draw not in (panels.draw_rates, panels.draw_path) for panel in drawn)
    remarks = events_of(scene) if scene.resisted else []
    if rates and not scene.still:
        if scene.one_arc:
            remarks.append(r"The rates depend on $\theta$ alone: the wheel runs to and fro on one arc.")
        elif panels.narrow(scene):
            remarks.append("Inset: the same motion sheared, which opens the narrow bundle.")
    if over_time and panels.envelope(scene):
        remarks.append("Filled: the envelope of a fast nutation.")
    if panels.draw_ground in [panel.draw for panel in drawn] and panels.needed_friction(scene).max() == panels.MOST:
        remarks.append(rf"$\mu$ is drawn up to {panels.MOST:g}.")
    return remarks + [f"The wheel {scene.ending}, where the model ends."] * bool(scene.ending)


def caption(scenes: Sequence[Scene], drawn: Sequence[Panel], columns: int) -> list[str]:
    """The parameters, all that is not the paper's, and what the marks mean."""
    texts = [f"Torus wheel: {wheel_of(scenes[-1])}. {start_of(scenes[-1])}."]
    if other := unlike_paper(scenes[-1]):
        texts.append(f"Unlike the paper: {', '.join(said.replace(' ', NO_BREAK) for said in other)}.")
    for scene in scenes:
        name = [f"{title_of(scene).split(',')[0].capitalize()}:"] if len(scenes) > 1 else []
        remarks = remarks_of(scene, drawn)
        texts += [" ".join(name + remarks)] if remarks else []
    return [line for text in texts for line in wrapped(text, columns)]


def wrapped(text: str, columns: int) -> list[str]:
    """Lines with as many words as have room; a formula is one word, as wide as its letters."""
    lines = [""]
    for word in re.findall(r"(?:\$[^$]*\$|[^ $])+", text):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and len(re.sub(r"\\[a-z]+|[${}_^\\]", "", longer)) > columns:
            lines.append(word)
        else:
            lines[-1] = longer
    return lines


def heading(panel: Panel, scene: Scene, paper: bool) -> str:
    """Number, for the paper's scenes alone, and subject."""
    number = panel.figures[scene.value("s") > 0] if paper and panel.figures else 0
    return rf"$\mathbf{{Fig.\,{number}}}$   {panel.subject}" if number else panel.subject


def draw(stem: Path, scenes: Sequence[Scene], drawn: Sequence[Panel], paper: bool) -> list[Path]:
    """A sheet: a row per panel, a column per scene; one panel of one scene is a journal column wide."""
    sheet = len(scenes) > 1
    lines = caption(scenes, drawn, 150 if sheet else 72)
    head, foot = (9.0 if sheet else 1.0), 3.0 + PITCH * len(lines)
    height = head + foot + sum(panel.height + 17.0 for panel in drawn)
    fig = style.figure_mm(style.PAGE if sheet else style.COLUMN, height)
    rect = (0, foot / height, 1, 1 - (foot + head) / height)
    fig.set_layout_engine("constrained", rect=rect, hspace=0.03, wspace=0.04)
    axes = fig.subplots(len(drawn), len(scenes), squeeze=False, height_ratios=[panel.height for panel in drawn])
    rows = zip(axes, drawn, strict=True)
    cells = [(ax, panel, scene) for row, panel in rows for ax, scene in zip(row, scenes, strict=True)]
    for ax, panel, scene in cells:
        panel.draw(ax, scene)
        title = heading(panel, scene, paper) + ("" if sheet else f", {title_of(scene)}")
        ax.set_title(title, loc="left", fontsize=9)
    fig.get_layout_engine().execute(fig)
    fig.set_layout_engine("none")  # what follows needs the places of the panels
    for ax, panel, scene in cells:
        if sheet and panel is drawn[0]:
            left, title = ax.get_position().x0 * style.PAGE, title_of(scene)
            style.text_mm(fig, left, height - 6.0, title[0].upper() + title[1:], fontsize=10.5)
        if panel.draw is panels.draw_rates:
            panels.write_rates(ax, scene)
    for i, line in enumerate(reversed(lines)):
        style.text_mm(fig, 2.0, 1.8 + PITCH * i, line, fontsize=7.5 if sheet else 7.0)
    return style.save(fig, stem)


def draw_all(scenes: Sequence[Scene], out: Path) -> list[Path]:
    """The sheets, then each panel of each scene; the names show whether the scenes are the paper's."""
    paper = is_paper(scenes)
    sheets = {"paper_diagrams": PAPERS, "paper_path_and_ground": OTHERS} if paper else {"diagrams": PAPERS + OTHERS}
    written = [path for name, drawn in sheets.items() for path in draw(out / name, scenes, drawn, paper)]
    for friction, scene in enumerate(scenes):
        for panel in PAPERS + OTHERS * (not paper):
            name = f"diagram_{panel.name}_{('free', 'friction')[friction]}"
            written += draw(out / (f"fig_{panel.figures[friction]}" if paper else name), [scene], [panel], paper)
    return written


def main() -> int:
    """Draw everything; a fault of the input is one sentence on stderr and exit status 1."""
    style.use_style()
    try:
        scenes = [read_scene(RESULTS / f"{name}.csv", ("time", *outputs())) for name in ("free", "friction")]
    except SceneError as fault:
        print(f"run: {fault}", file=sys.stderr)
        return 1
    if scenes[0].value("r") > scenes[0].value("r_0"):
        print("run: r > r_0: this torus intersects itself; the model rolls it all the same.", file=sys.stderr)
    print("\n".join(str(path) for path in draw_all(scenes, RESULTS)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
