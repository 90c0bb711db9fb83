#!/usr/bin/env python3
"""Draw what `./scripts/run` simulated: the paper's six diagrams (Fig. 1-6), the path, forces of the ground, slip.

A guided wheel has speeds, slip ratio, forces and distance in their place. Reads free.csv (s = 0) and friction.csv
(s > 0), which hold all that was set as columns: titles and captions come from there. The paper's two scenes make
paper_diagrams, paper_path_and_ground and fig_1 ... fig_6; others make diagrams and diagram_NAME_SCENE, and leave those
of the paper in place. All as SVG and PNG. Fixed axes X, Y, Z, Z up; rad, degrees beside.
"""

import re
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from multiprocessing import Pool
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.textpath import TextPath

from wheelfmu.diagrams import panels, style
from wheelfmu.diagrams.scene import Scene, SceneError, read_scene
from wheelfmu.diagrams.start_values import MOMENTS, PAPER_S, ROOT, RUN, doubt, variables

RESULTS = ROOT / "results"
SETTINGS = variables("parameter", "input")
SOLVING = ("formulation", "method")  # the same motion by another system or solver
NO_BREAK = "\u00a0"  # a space at which no line ends
MARGIN = 2.0  # mm beside a caption
PITCH = 3.4  # mm from one line of a caption to the next
FALL_BY_ROUNDING = "Rounding decides when and to which side an upright wheel tips; guided=true keeps it upright."


@dataclass(frozen=True)
class Panel:
    """One row of a sheet; height in mm in all; `draw` returns what the caption explains; `figures`: its numbers in
    the paper, without and with friction."""

    name: str
    subject: str
    height: float
    draw: Callable[[Axes, Scene], list[str]]
    figures: tuple[int, int] | None = None


PAPERS = (
    Panel("position", r"$X_O(t)$", 57.0, panels.draw_position, (1, 4)),
    Panel("tilt", r"$\theta(t)$", 57.0, panels.draw_tilt, (2, 5)),
    Panel("rates", r"$\dot\varphi(\dot\psi)$", 75.0, panels.draw_rates, (3, 6)),
)
OTHERS = (
    Panel("path", "Path of the contact point", 67.0, panels.draw_path),
    Panel("ground", r"$N(t)$ and required $\mu(t)$", 67.0, panels.draw_ground),
)
SLIDES = (Panel("slip", "Slip at the contact", 57.0, panels.draw_slip),)
# A guided wheel's tilt and heading stay: in their place what a vehicle's engineer reads.
SPEEDS = Panel("speeds", r"Speed $v$ and rolling speed $-R\,\omega_z$", 57.0, panels.draw_speeds)
RATIO = Panel("slip_ratio", "Slip ratio", 50.0, panels.draw_slip_ratio)
LOADS = (
    Panel("forces", "Forces of the ground", 57.0, panels.draw_forces),
    Panel("distance", "Distance travelled", 57.0, panels.draw_distance),
)


def set_otherwise(scene: Scene, names: Iterable[str]) -> list[str]:
    """What differs from the start values of the description."""
    own = {name: scene.value(name) for name in names}
    return [SETTINGS[name].said(value) for name, value in own.items() if abs(value - SETTINGS[name].preset) > 1e-12]


def unlike_paper(scene: Scene) -> list[str]:
    """All that was set otherwise than in (27)-(33), the start values of the description; the title has s."""
    own = {name: scene.value(name) for name in SETTINGS if name not in ("s", *SOLVING)}
    said = set_otherwise(scene, own)
    rows = {} if scene.ending else {"stop_time": scene["time"][-1]}
    rows["output_interval"] = scene["time"][1] - scene["time"][0]
    said += [RUN[name].said(value) for name, value in rows.items() if abs(value - RUN[name].preset) > 1e-9]
    said += ["r > r_0, the torus intersects itself"] * (own["r"] > own["r_0"])
    return said + ["no mass within this outline has these moments of inertia"] * bool(doubt(own))


def warnings_of(scenes: Sequence[Scene]) -> list[str]:
    """A wheel that cannot exist, which the model rolls all the same; a fall that rounding decides."""
    own = {name: scenes[0].value(name) for name in ("m", "r_0", "r", *MOMENTS)}
    found = ["r > r_0: this torus intersects itself."] * (own["r"] > own["r_0"])
    about = doubt(own)
    found += [FALL_BY_ROUNDING] * any(scene.by_rounding for scene in scenes)
    return found + [f"{about} Give J_x, J_y and J_z too, or a body that has them, such as body=torus."] * bool(about)


def is_paper(scenes: Sequence[Scene]) -> bool:
    """Whether the runs are the paper's."""
    whole = len(scenes) == 2 and not any(scene.ending or unlike_paper(scene) for scene in scenes)
    return whole and scenes[1].value("s") == PAPER_S


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
    turned = [rf"${symbol} = {np.degrees(scene.value(f'{name}_start')):.5g}°$" for name, symbol in angles]
    rates = [rf"$\dot{symbol} = {scene.value(f'{name}_dot_start'):.4g}$" for name, symbol in angles]
    place = [rf"${axis}_O = {scene.value(f'{axis}_O_start'):.4g}$" for axis in "XY"]
    return f"At $t = 0$: {', '.join(turned)}; {', '.join(rates)}{NO_BREAK}rad/s; {', '.join(place)}{NO_BREAK}m"


def title_of(scene: Scene) -> str:
    s = scene.value("s")
    return rf"Rolling friction, $s = {s:.4g}$ m" if s > 0 else r"No rolling friction, $s = 0$"


def fate_of(scene: Scene) -> list[str]:
    """Clauses: its transitions, slides, rest or end, and how far the run can be trusted."""
    count, slides = scene.transitions, int((np.diff(scene.slides.astype(int), prepend=0) > 0).sum())
    can_slide = scene.value("mu_slide") > 0
    said = [f"{count or 'no'} transition{'s' * (count != 1)} in {scene['time'][-1]:.3g} s"]
    said *= scene.resisted or can_slide
    often = ("", "once", "twice")[slides] if slides < 3 else f"{slides} times"
    fastest = f"it slides {often}, at up to {scene.slip.max():.3g} m/s"
    said += [fastest if slides else "it never slides"] * can_slide
    said += [] if scene.rest is None else [f"it stands from {scene.rest:.3g} s on"]
    said += [f"the wheel {scene.ending}, where the run ends"] * bool(scene.ending)
    said += ["rounding alone tips it and decides time and side; guided=true keeps it upright"] * scene.by_rounding
    return said + [scene.trust] * bool(scene.trust)


def paragraph(clauses: Sequence[str], subject: str = "") -> str:
    """Sentences, none without clauses: the first may follow a subject and a colon."""
    whole = [f"{clause[0].upper()}{clause[1:]}." for clause in clauses]
    whole[:1] = [f"{subject}: {clause}." for clause in clauses[:1]] if subject else whole[:1]
    return " ".join(whole)


def caption(scenes: Sequence[Scene], remarks: Sequence[Sequence[str]], width: float, size: float) -> list[str]:
    """The parameters, all that is not the paper's, each scene's fate, and the remarks, those on all scenes once; lines
    of at most `width` mm."""
    texts = [f"Parameters: {wheel_of(scenes[-1])}. {start_of(scenes[-1])}."]
    if other := unlike_paper(scenes[-1]):
        texts.append(f"Unlike the paper: {', '.join(said.replace(' ', NO_BREAK) for said in other)}.")
    if solving := set_otherwise(scenes[-1], SOLVING):
        texts.append(f"Computed with {', '.join(said.replace(' ', NO_BREAK) for said in solving)}.")
    shared = [one for one in dict.fromkeys(remarks[0]) if all(one in said for said in remarks)]
    for scene, said in zip(scenes, remarks, strict=True):
        own = [one for one in dict.fromkeys(said) if one not in shared]
        texts.append(paragraph([*fate_of(scene), *own], title_of(scene).split(",")[0] if len(scenes) > 1 else ""))
    return [line for text in [*texts, paragraph(shared)] if text for line in wrapped(text, width, size)]


@cache
def breadth(text: str, size: float) -> float:
    """Of a text of this size in points, with the room after its last letter, in mm."""
    ends = [TextPath((0, 0), one, size=size).get_extents().x1 for one in (f"{text}n", "n")]
    return (ends[0] - ends[1]) / 72 / style.MM


def wrapped(text: str, width: float, size: float) -> list[str]:
    """Lines with as many words as have room; a formula is a part of one word."""
    lines, space = [[]], breadth(" ", size)
    for word in re.findall(r"(?:\$[^$]*\$|[^ $])+", text):
        if lines[-1] and sum(breadth(one, size) + space for one in [*lines[-1], word]) > width:
            lines.append([])
        lines[-1].append(word)
    return [" ".join(line) for line in lines]


def draw(stem: Path, scenes: Sequence[Scene], drawn: Sequence[Panel], paper: bool) -> list[Path]:
    """A sheet: a row per panel, a column per scene; one panel of one scene is a journal column wide."""
    sheet, heights = len(scenes) > 1, [panel.height for panel in drawn]
    fig = style.figure_mm(style.PAGE if sheet else style.COLUMN, sum(heights) + 9.0 * sheet)
    axes = fig.subplots(len(drawn), len(scenes), squeeze=False, height_ratios=heights)
    rates, remarks = [], [[] for _ in scenes]
    for row, panel in zip(axes, drawn, strict=True):
        for ax, scene, said in zip(row, scenes, remarks, strict=True):
            said += panel.draw(ax, scene.moving)
            number = panel.figures[scene.value("s") > 0] if paper and panel.figures else 0
            title = rf"$\mathbf{{Fig.\,{number}}}$   {panel.subject}" if number else panel.subject
            ax.set_title(title if sheet else f"{title}, {title_of(scene).lower()}", loc="left", fontsize=9)
            if sheet and panel is drawn[0]:
                style.note(ax, title_of(scene), (0, 1), (0, 24), xycoords="axes fraction", fontsize=10.5)
            rates += [(ax, scene)] * (panel.draw is panels.draw_rates)
    (width, height), size = fig.get_size_inches(), 7.5 if sheet else 7.0
    lines = caption(scenes, remarks, width / style.MM - 2 * MARGIN, size)
    foot = (3.0 + PITCH * len(lines)) * style.MM
    fig.set_size_inches(width, height + foot)
    fig.set_layout_engine("constrained", rect=(0, foot / (height + foot), 1, height / (height + foot)))
    fig.get_layout_engine().execute(fig)
    fig.set_layout_engine("none")  # the texts beside a curve need the places of the panels
    for ax, scene in rates:
        panels.write_rates(ax, scene.moving)
    for i, line in enumerate(reversed(lines)):
        place = MARGIN * style.MM, (1.8 + PITCH * i) * style.MM
        fig.text(*place, line, transform=fig.dpi_scale_trans, fontsize=size)
    return style.save(fig, stem)


def panels_of(scenes: Sequence[Scene]) -> tuple[tuple[Panel, ...], tuple[Panel, ...]]:
    """Of runs that are not the paper's: the first ones, and those that follow on the same sheet."""
    slides = any(scene.slides.any() for scene in scenes)
    across = any(abs(scene["slip_y"]).max() > 1e-9 * scene.slip.max() for scene in scenes)
    if not scenes[0].guided:
        return PAPERS, OTHERS + SLIDES * slides
    return (SPEEDS, *[RATIO] * slides), LOADS + OTHERS[:1] * across


def pictures(scenes: Sequence[Scene], out: Path) -> list[tuple]:
    """Arguments of draw for sheets, then each panel of each scene; names show whether the scenes are the paper's."""
    paper = is_paper(scenes)
    first, others = panels_of(scenes)
    sheets = {"paper_diagrams": PAPERS, "paper_path_and_ground": OTHERS} if paper else {"diagrams": first + others}
    wanted = [(out / name, scenes, drawn, paper) for name, drawn in sheets.items()]
    for scene in scenes:
        friction = int(scene.value("s") > 0)
        for panel in first + others * (not paper):
            name = f"diagram_{panel.name}_{('free', 'friction')[friction]}"
            wanted.append((out / (f"fig_{panel.figures[friction]}" if paper else name), [scene], [panel], paper))
    return wanted


def main(folder: Path = RESULTS) -> None:
    """Draw everything in a folder, or the one scene that has a motion, and print a line of the pictures; else one line
    on stderr and exit status 1."""
    style.use_style()
    scenes, faults = [], []
    for name in ("free", "friction"):
        try:
            scenes.append(read_scene(folder / f"{name}.csv"))
        except SceneError as fault:
            faults.append(str(fault))
    try:
        if not scenes:
            raise SceneError("Neither scene has a motion to draw.")
        with Pool() as processes:
            drawn = processes.starmap(draw, wanted := pictures(scenes, folder), chunksize=1)
        sheets = sum(len(panels) > 1 for _, _, panels, _ in wanted)
        names = [png.name for _, png in drawn]
        ends = [*names[sheets:][:1], *names[sheets:][-1:]]
        print(f"{', '.join(names[:sheets])}, and panel by panel {' to '.join(ends)}; each also as .svg.")
        for warning in [*warnings_of(scenes), *faults]:
            print(f"run: warning: {warning}", file=sys.stderr)
    except SceneError as fault:
        sys.exit(f"run: {fault}")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
