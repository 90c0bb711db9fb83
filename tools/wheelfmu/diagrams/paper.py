"""Draw what `./scripts/run` simulated: the paper's six diagrams (Fig. 1-6), path and ground, energy, forces, slip.

    python -m wheelfmu.diagrams.paper FOLDER [argument of ./scripts/run]...

The motions are those of wheel.fmu with these arguments, without (s = 0) and with rolling resistance, read densely;
FOLDER/SCENE.error has how far they can be trusted. The paper's two scenes make paper_diagrams, paper_path_and_ground
and fig_1 ... fig_6; others make diagrams and diagram_NAME_SCENE, with the panels that have content, and leave those of
the paper in place. Of two scenes that look alike one is drawn. All as SVG and PNG. Fixed axes X, Y, Z, Z up; rad,
degrees beside.
"""

import re
import sys
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.textpath import TextPath

from wheelfmu.diagrams import panels, style
from wheelfmu.diagrams.reading import read
from wheelfmu.diagrams.scene import Scene
from wheelfmu.fmu.outputs import worded
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.presets import MOMENTS, doubt
from wheelfmu.fmu.start_values import PAPER_S, RUN, values
from wheelfmu.fmu.values import variables
from wheelfmu.truth.motion import Library

SETTINGS = variables("parameter", "input")
SOLVING = ("formulation", "method")  # the same motion by another system or solver
SAID = {"m", "r_0", "r", *MOMENTS, "g", "s"}  # in every caption: the wheel, the start; the title has s
SAID |= {f"{name}_start" for name in ("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")}
NO_BREAK = "\u00a0"  # a space at which no line ends
MARGIN = 2.0  # mm beside a caption
PITCH = 3.4  # mm from one line of a caption to the next
ALIKE = 0.01  # of a quantity's range, on average over time: in two columns such curves look alike
COMPARED = {"X_O": "m", "Y_O": "m", "X_C": "m", "Y_C": "m", "theta": "rad", "psi_dot": "rad/s", "phi_dot": "rad/s"}
COMPARED |= dict.fromkeys(("lambda_x", "lambda_y", "lambda_3"), "N")
FALL_BY_ROUNDING = "Rounding decides when and to which side an upright wheel tips; guided=true keeps it upright."


@dataclass(frozen=True)
class Panel:
    """One row of a sheet; height in mm in all; `draw` returns what the caption explains; `applies`: whether a scene has
    content for it; `figures`: its numbers in the paper, without and with friction."""

    name: str
    subject: str
    height: float
    draw: Callable[[Axes, Scene], list[str]]
    applies: Callable[[Scene], bool]
    figures: tuple[int, int] | None = None


def free(scene: Scene) -> bool:
    """Whether tilt or heading move by themselves."""
    return not scene.guided and not scene.straight


def curved(scene: Scene) -> bool:
    return bool(np.ptp(scene["psi"]) > 1e-6) or slides_across(scene)


def turns(scene: Scene) -> bool:
    """Whether its rates change by themselves."""
    return free(scene) and not scene.still


def travels(scene: Scene) -> bool:
    return bool(np.ptp(scene["X_O"]) > 1e-3 * scene.value("r_0"))


def tilts(scene: Scene) -> bool:
    return bool(np.ptp(scene["theta"]) > 1e-6)


def slides_across(scene: Scene) -> bool:
    return bool(abs(scene["slip_y"]).max() > 1e-9 * max(scene.slip.max(), 1e-9))


def slips(scene: Scene) -> bool:
    return bool(scene.slides.any())


def loses_or_gains(scene: Scene) -> bool:
    """Whether the energy changes by more than rounding and the solver's error."""
    return bool(np.ptp(scene["E"]) > 1e-6 * scene.value("m") * scene.value("g") * scene.value("r_0"))


def pushes(scene: Scene) -> bool:
    """Whether the ground's forces on a wheel that does not move by itself change, or come near their limit."""
    weight = scene.value("m") * scene.value("g")
    parts = np.array([scene[name] for name in ("lambda_x", "lambda_y", "lambda_3")])
    limited = scene.value("mu_max") > 0 and abs(parts[:2]).max() > 1e-6 * weight
    return not free(scene) and bool(limited or np.ptp(parts, axis=1).max() > 1e-6 * weight)


PAPERS = (
    Panel("position", r"$X_O(t)$", 57.0, panels.draw_position, travels, (1, 4)),
    Panel("tilt", r"$\theta(t)$", 57.0, panels.draw_tilt, tilts, (2, 5)),
    Panel("rates", r"$\dot\varphi(\dot\psi)$", 75.0, panels.draw_rates, turns, (3, 6)),
)
OTHERS = (
    Panel("path", "Path of the contact point", 67.0, panels.draw_path, curved),
    Panel("ground", r"$N(t)$ and required $\mu(t)$", 67.0, panels.draw_ground, free),
)
FURTHER = (  # of runs that are not the paper's
    Panel("energy", r"Energy $E(t)$", 57.0, panels.draw_energy, loses_or_gains),
    Panel("forces", "Forces of the ground", 57.0, panels.draw_forces, pushes),
    Panel("slip", "Slip at the contact", 57.0, panels.draw_slip, slips),
)


def set_otherwise(scene: Scene, names: Iterable[str]) -> list[str]:
    """What differs from the start values of the description."""
    own = {name: scene.value(name) for name in names}
    return [SETTINGS[name].said(value) for name, value in own.items() if abs(value - SETTINGS[name].preset) > 1e-12]


def unlike_paper(scene: Scene) -> list[str]:
    """All that was set otherwise than in (27)-(33), the start values of the description; the title has s."""
    names = [name for name in SETTINGS if name not in ("s", *SOLVING)]
    return [*set_otherwise(scene, names), *ended_otherwise(scene), *remarks_on(scene)]


def ended_otherwise(scene: Scene) -> list[str]:
    """Another length of the run than the description's."""
    stop = scene["time"][-1]
    other = not scene.ending and abs(stop - RUN["stop_time"].preset) > 1e-9
    return [RUN["stop_time"].said(stop)] * bool(other)


def remarks_on(scene: Scene) -> list[str]:
    """On a wheel that cannot exist."""
    own = {name: scene.value(name) for name in ("m", "r_0", "r", *MOMENTS)}
    said = ["r > r_0, the torus intersects itself"] * (own["r"] > own["r_0"])
    return said + ["no mass within this outline has these moments of inertia"] * bool(doubt(own))


def warnings_of(scenes: Sequence[Scene]) -> list[str]:
    """A wheel that cannot exist, which the model rolls all the same; a fall that rounding decides."""
    own = {name: scenes[0].value(name) for name in ("m", "r_0", "r", *MOMENTS)}
    found = ["r > r_0: this torus intersects itself."] * (own["r"] > own["r_0"])
    about = doubt(own)
    found += [FALL_BY_ROUNDING] * any(scene.by_rounding for scene in scenes)
    return found + [f"{about} Give J_x, J_y and J_z too; docs/recipes.md has formulas."] * bool(about)


def is_paper(scenes: Sequence[Scene]) -> bool:
    """Whether the runs are the paper's."""
    whole = len(scenes) == 2 and not any(scene.ending or unlike_paper(scene) for scene in scenes)
    return whole and scenes[1].value("s") == PAPER_S


def short(value: float) -> str:
    """Four digits, a power of ten as such."""
    mantissa, _, exponent = f"{value:.4g}".partition("e")
    return power(mantissa, exponent) if exponent else mantissa


def power(mantissa: str, exponent: str) -> str:
    return rf"{mantissa}\cdot 10^{{{int(exponent)}}}".removeprefix(r"1\cdot ")


def typeset(text: str) -> str:
    """Minus signs and powers of ten as such, outside of formulas."""

    def plain(part: str) -> str:
        part = re.sub(r"(?<![\w.])(-?[\d.]+)e([-+]\d+)", lambda found: f"${power(*found.groups())}$", part)
        return re.sub(r"(?<![\w.])-(?=\d)", "\N{MINUS SIGN}", part)

    return "".join(part if k % 2 else plain(part) for k, part in enumerate(re.split(r"(\$[^$]*\$)", text)))


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
    rates = [rf"$\dot{symbol} = {short(scene.value(f'{name}_dot_start'))}$" for name, symbol in angles]
    place = [rf"${axis}_O = {short(scene.value(f'{axis}_O_start'))}$" for axis in "XY"]
    return f"At $t = 0$: {', '.join(turned)}; {', '.join(rates)}{NO_BREAK}rad/s; {', '.join(place)}{NO_BREAK}m"


def title_of(scene: Scene) -> str:
    s = scene.value("s")
    return rf"Rolling resistance, $s = {short(s)}$ m" if s > 0 else r"No rolling resistance, $s = 0$"


def fate_of(scene: Scene) -> list[str]:
    """Clauses: its transitions, slides, rest or end, and how far the run can be trusted."""
    count, slides = scene.transitions, int((np.diff(scene.slides.astype(int), prepend=0) > 0).sum())
    can_slide = scene.value("mu_slide") > 0
    said = [f"{count or 'no'} transition{'s' * (count != 1)} in {scene['time'][-1]:.3g} s"]
    said *= scene.resisted or can_slide
    often = ("", "once", "twice")[slides] if slides < 3 else f"{slides} times"
    fastest = f"it slides {often}, at up to {scene.peak(scene.slip)[1]:.4g} m/s"
    said += [fastest if slides else "it never slides"] * can_slide
    said += [] if scene.rest is None else [f"it stands from {scene.rest:.4g} s on"]
    said += [f"the wheel {scene.ending}, where the run ends"] * bool(scene.ending)
    said += ["rounding alone tips it and decides time and side; guided=true keeps it upright"] * scene.by_rounding
    return said + [scene.trust] * bool(scene.trust) + [scene.alone] * bool(scene.alone)


def kept(scene: Scene, drawn: Sequence[Panel]) -> list[str]:
    """A clause with forces that keep their values, of which no panel is drawn."""
    if {"ground", "forces"} & {panel.name for panel in drawn} or free(scene) or pushes(scene):
        return []
    mu = scene["mu_required"][0]
    needs = rf", and rolling needs $\mu = {short(mu)}$" * bool(mu > 1e-9)
    return [rf"throughout $N = {short(scene['lambda_3'][0])}$ N{needs}"]


def paragraph(clauses: Sequence[str], subject: str = "") -> str:
    """Sentences, none without clauses: the first may follow a subject and a colon."""
    whole = [f"{clause[0].upper()}{clause[1:]}." for clause in clauses]
    whole[:1] = [f"{subject}: {clause}." for clause in clauses[:1]] if subject else whole[:1]
    return " ".join(whole)


def caption(scenes: Sequence[Scene], remarks: Sequence[Sequence[str]], width: float, size: float) -> list[str]:
    """The parameters, all else that is not the paper's, each scene's fate, and the remarks, those on all scenes once;
    lines of at most `width` mm."""
    texts = [f"Parameters: {wheel_of(scenes[-1])}. {start_of(scenes[-1])}."]
    names = [name for name in SETTINGS if name not in SAID | {*SOLVING}]
    if other := [*set_otherwise(scenes[-1], names), *ended_otherwise(scenes[-1]), *remarks_on(scenes[-1])]:
        texts.append(f"Further: {', '.join(said.replace(' ', NO_BREAK) for said in other)}.")
    if solving := set_otherwise(scenes[-1], SOLVING):
        texts.append(f"Computed with {', '.join(said.replace(' ', NO_BREAK) for said in solving)}.")
    shared = [one for one in dict.fromkeys(remarks[0]) if all(one in said for said in remarks)]
    for scene, said in zip(scenes, remarks, strict=True):
        own = [one for one in dict.fromkeys(said) if one not in shared]
        texts.append(paragraph([*fate_of(scene), *own], title_of(scene).split(",")[0] if len(scenes) > 1 else ""))
    return [line for text in [*texts, paragraph(shared)] if text for line in wrapped(typeset(text), width, size)]


@cache
def breadth(text: str, size: float) -> float:
    """Of a text of this size in points, with the room after its last letter, in mm."""
    ends = [TextPath((0, 0), one, size=size).get_extents().x1 for one in (f"{text}n", "n")]
    return (ends[0] - ends[1]) / 72 / style.MM


def wrapped(text: str, width: float, size: float) -> list[str]:
    """Lines with as many words as have room; a formula is a part of one word."""
    lines: list[list[str]] = [[]]
    space = breadth(" ", size)
    for word in re.findall(r"(?:\$[^$]*\$|[^ $])+", text):
        if lines[-1] and sum(breadth(one, size) + space for one in [*lines[-1], word]) > width:
            lines.append([])
        lines[-1].append(word)
    return [" ".join(line) for line in lines]


def draw(stem: Path, scenes: Sequence[Scene], drawn: Sequence[Panel], paper: bool) -> list[Path]:
    """A sheet: of two scenes a row per panel, of one its panels in pairs; one panel alone is a journal column wide."""
    two, alone = len(scenes) > 1, len(scenes) == len(drawn) == 1
    cells = [(panel, k) for panel in drawn for k in range(len(scenes))]
    columns = 1 if alone else 2
    rows = [cells[k : k + columns] for k in range(0, len(cells), columns)]
    heights = [max(panel.height for panel, _ in row) for row in rows]
    fig = style.figure_mm(style.COLUMN if alone else style.PAGE, sum(heights) + 9.0 * (not alone))
    axes = fig.subplots(len(rows), columns, squeeze=False, height_ratios=heights)
    rates: list[tuple[Axes, Scene]] = []
    remarks = [kept(scene, drawn) for scene in scenes]
    for ax, (panel, k) in zip(axes.flat, cells, strict=False):
        scene = scenes[k]
        remarks[k] += panel.draw(ax, scene.moving)
        number = panel.figures[scene.value("s") > 0] if paper and panel.figures else 0
        title = rf"$\mathbf{{Fig.\,{number}}}$   {panel.subject}" if number else panel.subject
        ax.set_title(f"{title}, {title_of(scene).lower()}" if alone else title, loc="left", fontsize=9)
        if not alone and panel is drawn[0]:
            style.note(ax, title_of(scene), (0, 1), (0, 24), xycoords="axes fraction", fontsize=10.5)
        rates += [(ax, scene)] * (panel.draw is panels.draw_rates)
    for ax in axes.flat[len(cells) :]:
        ax.remove()
    for panel, (left, right) in zip(drawn, axes, strict=True) if two else ():
        if panel in FURTHER:
            limits = np.array([left.get_ylim(), right.get_ylim()])
            for ax in (left, right):
                ax.set_ylim(limits[:, 0].min(), limits[:, 1].max())
    (width, height), size = fig.get_size_inches(), 7.0 if alone else 7.5
    lines = caption(scenes, remarks, width / style.MM - 2 * MARGIN, size)
    foot = (3.0 + PITCH * len(lines)) * style.MM
    fig.set_size_inches(width, height + foot)
    layout = ConstrainedLayoutEngine(rect=(0, foot / (height + foot), 1, height / (height + foot)))
    fig.set_layout_engine(layout)
    layout.execute(fig)
    fig.set_layout_engine("none")  # the texts beside a curve need the places of the panels
    for ax in fig.axes:
        if ax.get_aspect() == 1:  # anew from the data: limits of another width would be kept if they are nearly right
            ax.autoscale_view()
            ax.apply_aspect()
    for ax, scene in rates:
        panels.write_rates(ax, scene.moving)
    for i, line in enumerate(reversed(lines)):
        place = MARGIN * style.MM, (1.8 + PITCH * i) * style.MM
        fig.text(*place, line, transform=fig.dpi_scale_trans, fontsize=size)
    return style.save(fig, stem)


def panels_of(scenes: Sequence[Scene]) -> tuple[Panel, ...]:
    """Of runs that are not the paper's: those with content in one of the scenes."""
    found = tuple(panel for panel in PAPERS + OTHERS + FURTHER if any(panel.applies(scene.moving) for scene in scenes))
    return found or PAPERS[:1]


def alike(one: Scene, other: Scene) -> bool:
    """Whether two scenes cannot be told apart in two columns of diagrams."""
    ends = one["time"][-1], other["time"][-1]
    if bool(one.ending) != bool(other.ending) or abs(ends[0] - ends[1]) > ALIKE * max(ends):
        return False
    at, (m, r_0, g) = np.linspace(0.0, min(ends), 2000), (one.value(name) for name in ("m", "r_0", "g"))
    scales = {"m": r_0, "rad": 1.0, "rad/s": np.sqrt(g / r_0), "N": m * g}
    for name, unit in COMPARED.items():
        a, b = (np.interp(at, scene["time"], scene[name]) for scene in (one, other))
        if abs(a - b).mean() > ALIKE * max(np.ptp(a), np.ptp(b)) + 1e-6 * scales[unit]:
            return False
    return True


def pictures(scenes: Sequence[Scene], out: Path) -> list[tuple]:
    """Arguments of draw for sheets, then each panel of each scene; names show whether the scenes are the paper's."""
    paper = is_paper(scenes)
    if not paper and len(scenes) == 2 and alike(*scenes):
        scenes = [replace(scenes[1], alone="without rolling resistance the diagrams look alike")]
    every = PAPERS if paper else panels_of(scenes)
    sheets = {"paper_diagrams": PAPERS, "paper_path_and_ground": OTHERS} if paper else {"diagrams": every}
    wanted: list[tuple] = [(out / name, scenes, drawn, paper) for name, drawn in sheets.items()]
    for scene in scenes:
        friction = int(scene.value("s") > 0)
        for panel in every:
            name = f"diagram_{panel.name}_{('free', 'friction')[friction]}"
            if paper and panel.figures:
                name = f"fig_{panel.figures[friction]}"
            wanted.append((out / name, [scene], [panel], paper))
    return wanted


def scenes_of(folder: Path, given: dict[str, str], fmu: Path) -> list[Scene]:
    """Both motions of ./scripts/run, with the words of diagrams.races in the folder."""
    given = {name: text for name, text in given.items() if name != "error"}
    stop = float(given.pop("stop_time", RUN["stop_time"].start))
    given.pop("output_interval", "")
    start = {"s": PAPER_S} | {name: SETTINGS[name].number_of(text) for name, text in given.items()}
    library = Library.unpacked(fmu)
    scenes = [read(library, "free", start | {"s": 0.0}, stop), read(library, "friction", start, stop)]
    library.remove()
    trusted = {scene.name: folder / f"{scene.name}.error" for scene in scenes}
    words = {name: file.read_text(encoding="utf-8").splitlines()[1] for name, file in trusted.items() if file.exists()}
    return [replace(scene, trust=words.get(scene.name, "")) for scene in scenes]


def main(folder: Path, given: dict[str, str], fmu: Path = ROOT / "wheel.fmu") -> None:
    """Draw everything into a folder, or the one scene that has a motion, and print a line of the pictures; else one
    line on stderr and exit status 1."""
    style.use_style()
    both = scenes_of(folder, given, fmu)
    scenes = [scene for scene in both if np.ptp(scene["time"]) > 0]
    if not scenes:
        sys.exit("run: Neither scene has a motion to draw.")
    wanted = pictures(scenes, folder)
    with ProcessPoolExecutor() as processes:  # each ends by itself: none leaves a semaphore
        drawn = [*processes.map(draw, *zip(*wanted, strict=True))]
    sheets = sum(len(panels) > 1 or len(shown) > 1 for _, shown, panels, _ in wanted)
    names = [png.name for _, png in drawn]
    ends = [*names[sheets:][:1], *names[sheets:][-1:]]
    print(f"{', '.join(names[:sheets])}, and panel by panel {' to '.join(ends)}; each also as .svg.")
    for warning in [*warnings_of(scenes), *(still(scene) for scene in both if np.ptp(scene["time"]) <= 0)]:
        print(f"run: warning: {warning}", file=sys.stderr)


def still(scene: Scene) -> str:
    why = (scene.ending or "stands at one instant").replace("$", "")
    return f'The scene "{scene.name}" has no motion to draw: the wheel {why}.'


if __name__ == "__main__":
    with worded("run"):
        main(Path(sys.argv[1]), values(sys.argv[2:]))
