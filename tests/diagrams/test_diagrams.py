"""A diagram shows what was run: nothing is cut off, captions list what is not the paper's, arcs are in the data."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from wheelfmu.diagrams import panels, paper, style
from wheelfmu.diagrams.scene import Scene

PICTURES = paper.pictures
PURPLE = to_rgb(style.PURPLE)
TIME = np.linspace(0.0, 10.0, 1001)
SWING = 1.0 + 0.3 * np.cos(3 * TIME)  # rad


def scene(s: float = 0.0, time: np.ndarray = TIME, **given: np.ndarray | float) -> Scene:
    """A wheel that swings, with the paper's parameters but for those given; further fields of a scene too."""
    fields = {n: given.pop(n) for n in ("instants", "transitions", "ending") if n in given}
    settings = {n: v.preset for n, v in paper.SETTINGS.items()} | {"s": s}
    settings |= {n: given.pop(n) for n in [*given] if n in settings}
    motion = {"time": time, "theta": SWING, "X_O": SWING, "X_C": np.sin(TIME), "Y_C": TIME, "lambda_3": 200 * SWING}
    motion |= {"psi": TIME, "psi_dot": 2 / SWING**2, "phi_dot": -2 / SWING**3, "mu_required": SWING / 3}
    motion |= {"friction_mode": 1, "E": 50}
    motion |= dict.fromkeys(("Y_O", "lambda_x", "lambda_y", "slip_x", "slip_y", "contact_mode"), 0)
    columns = {n: np.broadcast_to(np.asarray(x, dtype=float), len(TIME)) for n, x in (motion | given).items()}
    return Scene("friction" if s else "free", columns, settings, **fields)


def caption(one: Scene, *drawn: paper.Panel) -> str:
    """Of a sheet with these panels, in one line."""
    remarks = [said for panel in drawn for said in panel.draw(style.figure_mm(80, 80).subplots(), one)]
    return " ".join(paper.caption([one], [remarks], 175.0, 7.5)).replace(paper.NO_BREAK, " ")


def test_nothing_is_cut_off_and_no_power_of_ten_stands_over_a_title(monkeypatch: pytest.MonkeyPatch) -> None:
    flat = scene(
        theta=1.2 + 1e-15 * np.sin(99 * TIME),
        X_O=3e5 + 1e-9 * TIME,
        phi_dot=-31234.5,
        psi_dot=1e-15 * TIME,
        X_C=TIME,
        Y_C=0,
    )
    fast = scene(s=0.03, theta=1.2 + 1e-3 * np.sin(300 * TIME), phi_dot=-60.0 + 1e-4 * np.sin(300 * TIME))
    coin = scene(0.001104, m=0.0085, J_x=3.556802865e-7, J_y=3.556802865e-7, J_z=7.0450390625e-7, phi_dot_start=-10.43)
    figures: list[Figure] = []
    monkeypatch.setattr(style, "save", lambda fig, stem: figures.append(fig) or [stem])
    style.use_style()
    for one in (flat, fast, coin):
        for scenes in ([one], [one, one]):
            paper.draw(Path("x"), scenes, paper.PAPERS + paper.OTHERS, False)
    for fig in figures:
        lines = [text.get_window_extent() for text in fig.texts]
        assert lines and all(fig.bbox.x0 < line.x0 and line.x1 < fig.bbox.x1 for line in lines)
        assert max(line.x1 for line in lines) > 0.8 * fig.bbox.x1  # the lines are filled
        for ax in fig.axes:
            outer = ax.get_tightbbox()
            if ax.get_xlabel() == "$X$ [m]":  # in one scale, also along an axis
                corners = ax.transData.transform([(0, 0), (1, 0), (0, 1)])
                assert np.ptp(corners[:, 0]) == pytest.approx(np.ptp(corners[:, 1]))
            assert fig.bbox.x0 <= outer.x0 and outer.x1 <= fig.bbox.x1
            assert not ax.yaxis.get_offset_text().get_text() and not ax.xaxis.get_offset_text().get_text()
        if len(fig.axes) < 10 and fig is not figures[-2]:  # one scene, flat or fast: neither noise nor 0 to 90 deg
            assert 1e-4 < np.ptp(fig.axes[1].get_ylim()) < 0.1
        fig.axes[0].set_position([0.01, 0.8, 0.5, 0.1])  # the partner
        assert fig.axes[0].get_tightbbox().x0 < fig.bbox.x0


def test_a_caption_names_the_marks_of_friction_where_they_are() -> None:
    """Bands and ticks over time, thick lines among the rates, none on the path."""
    modes = np.where(abs(TIME - 3) < 1, 0, np.where(TIME < 7, -1, 1))
    held = scene(0.03, friction_mode=modes, transitions=3, psi_dot=TIME)
    for panel in paper.PAPERS + paper.OTHERS:
        said, timed = caption(held, panel), panel.name in ("position", "tilt", "ground")
        assert ("Ticks at the top" in said) is timed and ("Orange at the top: held" in said) is timed
        assert ("Thick: held" in said) is (panel.name == "rates") and "3 transitions" in said


def test_swings_are_drawn_one_by_one_until_they_lie_too_close_and_then_as_two_lines() -> None:
    style.use_style()
    for swings, lines in ((40, 1), (150, 1), (400, 2)):
        time = np.linspace(0, 1, 40 * swings)
        ax = style.figure_mm(style.COLUMN, 60.0).subplots()
        said = panels._over_time(ax, time, (2 - time) * np.cos(2 * np.pi * swings * time))
        assert len(ax.lines) == lines and len(said) == lines - 1
    low, high = (line.get_ydata() for line in ax.lines)
    middle = ax.lines[0].get_xdata()
    assert abs(high - (2 - middle)).max() < 0.02 and abs(low + (2 - middle)).max() < 0.02


DOUBTED = [({"m": 12}, "J_z = 1.8 kg m2 is more than"), ({"r": 0.4}, "this torus intersects itself")]


@pytest.mark.parametrize(("values", "words"), DOUBTED)
def test_a_wheel_that_cannot_exist_is_drawn_with_a_warning(values: dict[str, float], words: str) -> None:
    (said,) = paper.warnings_of([scene(**values)])
    assert words in said
    remark = caption(scene(**values))
    assert "intersects itself" in remark or "no mass within this outline has these moments" in remark
    assert paper.warnings_of([scene()]) == []
    assert paper.unlike_paper(scene(s=0.02)) == []


DIFFERENT = {"Boolean": 1.0, "Integer": 2.0, "Real": 0.25}


@pytest.mark.parametrize("name", sorted({*paper.SETTINGS} - {"s", *paper.SOLVING}))
def test_a_caption_lists_whatever_is_not_the_papers(name: str) -> None:
    other = scene(0.03, **{name: DIFFERENT[paper.SETTINGS[name].type]})
    stated = "14.324°" if name in ("psi_start", "theta_start", "phi_start") else "= 0.25$"
    start = name.endswith("_start") and not name.startswith("slip")
    said, own = caption(other), caption(scene(0.03))
    assert (stated in said and stated not in own) if start else f"{name} = " in said
    assert not paper.is_paper([other, other])


@pytest.mark.parametrize("name", paper.SOLVING)
def test_the_papers_scenes_are_the_papers_by_whatever_system_or_method_and_the_caption_states_it(name: str) -> None:
    scenes = [scene(s, **{name: 3.0}) for s in (0.0, 0.03)]
    assert paper.is_paper(scenes) and f"Computed with {name} = 3" in caption(scenes[1])


def test_figure_numbers_and_file_names_of_the_paper_belong_to_its_two_scenes() -> None:
    def stems(*scenes: Scene) -> set[str]:
        return {stem.name for stem, *_ in paper.pictures(scenes, Path("results"))}

    of_paper, longer = stems(scene(), scene(0.03)), [scene(s, time=2 * TIME) for s in (0.0, 0.03)]
    assert {"paper_diagrams", *(f"fig_{n}" for n in range(1, 7))} < of_paper
    for others in (longer, [scene(), scene(0.02)], [scene(slope=0.1), scene(0.03, slope=0.1)]):
        assert "diagrams" in stems(*others) and not of_paper & stems(*others)
    assert "stop_time = 20 s" in " ".join(paper.unlike_paper(longer[0]))


def shown(*scenes: Scene) -> list[str]:
    return [panel.name for panel in paper.panels_of(scenes)]


def drawn(draw: Callable, one: Scene) -> Axes:
    ax = style.figure_mm(80, 80).subplots()
    draw(ax, one)
    return ax


def labels(draw: Callable, one: Scene) -> list[str]:
    return [text.get_text() for text in drawn(draw, one).texts]


def limit(one: Scene) -> np.ndarray:
    """Of the forces of friction, as drawn."""
    (dashed,) = (line.get_ydata() for line in drawn(panels.draw_forces, one).lines if line.get_linestyle() == "--")
    return dashed


def test_a_locked_wheel_has_position_energy_forces_with_their_limit_and_slip() -> None:
    """On its wheel carrier; 8 m/s falls evenly, the spin four times as fast; it stands after 8 s."""
    v, rolling = np.maximum(8 - TIME, 0), np.maximum(8 - 4 * TIME, 0)
    course = {"psi": 0, "slip_x": v - rolling, "theta": np.pi / 2, "psi_dot": 0, "phi_dot": -rolling / 0.35}
    way = np.where(TIME < 8, 8 * TIME - TIME**2 / 2, 32)
    force = {"mu_max": 0.1, "mu_slide": 0.1, "lambda_3": 200, "lambda_x": -20 * (v > 0)}
    one = scene(guided=1, contact_mode=v > 0, X_O=way, E=10 * v**2, **course, **force)
    assert shown(one) == ["position", "energy", "forces", "slip"]
    assert "guided = true" in caption(one, *paper.panels_of([one]))
    assert labels(panels.draw_forces, one) == [r"$\lambda_x$", "$N$"]  # none to the left
    assert limit(one) == pytest.approx(-20 * np.ones(len(TIME)))


def test_a_steered_wheel_that_slides_out_has_path_side_force_and_slip() -> None:
    turn = {"psi": 0.5 * TIME, "psi_dot": 0.5, "theta": np.pi / 2, "phi_dot": -20.0, "slip_y": 0.3 * TIME}
    one = scene(guided=1, mu_max=0.3, mu_slide=0.25, lambda_3=200, lambda_y=50, contact_mode=1, **turn)
    assert shown(one) == ["position", "path", "forces", "slip"]
    assert labels(panels.draw_forces, one) == [r"$\lambda_y$", "$N$"]
    assert limit(one) == pytest.approx(0.25 * 200 * np.ones(len(TIME)))  # mu_slide while it slides


def test_panels_without_content_are_left_out_and_forces_that_keep_their_values_stand_in_the_caption() -> None:
    """A vehicle's wheel straight ahead; partner: the paper's has all."""
    ahead = {"psi": 0.0, "theta": np.pi / 2, "psi_dot": 0.0, "phi_dot": -14.0, "lambda_3": 196.2, "mu_required": 0.01}
    rolls, slows = scene(X_O=5 * TIME, **ahead), scene(0.004, X_O=5 * TIME, E=50 - TIME, **ahead)
    assert shown(rolls) == ["position"] and shown(rolls, slows) == ["position", "energy"]
    assert r"Throughout $N = 196.2$ N, and rolling needs $\mu = 0.01$." in " ".join(
        paper.caption([rolls], [paper.kept(rolls, paper.panels_of([rolls]))], 400.0, 7.5)
    )
    assert shown(scene()) == ["position", "tilt", "rates", "path", "ground"] and paper.kept(scene(), paper.PAPERS) == []
    assert shown(scene(X_O=0.0)) == ["tilt", "rates", "path", "ground"]
    assert shown(scene(X_O=0.0, **ahead)) == ["position"]  # of a wheel that stands: an axis and its parameters


def test_of_two_scenes_that_look_alike_one_is_drawn_and_its_caption_says_so() -> None:
    fall = {"theta": 1.3 * np.cos(TIME / 10), "phi_dot_start": 0.0}
    both = [scene(**fall), scene(0.03, **fall | {"theta": fall["theta"] + 1e-3 * np.sin(TIME)})]
    wanted = PICTURES(both, Path("results"))
    assert {tuple(one.name for one in scenes) for _, scenes, *_ in wanted} == {("friction",)}
    assert "Without rolling resistance the diagrams look alike." in caption(wanted[0][1][0])
    apart = [both[0], scene(0.03, **fall | {"theta": 1.3 * np.cos(TIME / 8)})]
    assert PICTURES(apart, Path("results"))[0][1] == apart


def test_the_largest_value_and_the_instant_of_rest_are_those_between_the_rows() -> None:
    """Partner: the rows themselves, of which none is at the top."""
    hump = np.cos(TIME - 2.345)[TIME < 5]
    assert scene().peak(hump) == pytest.approx((2.345, 1), abs=1e-9) and hump.max() < 1 - 1e-5
    tent = 5 - abs(TIME - 4.0)
    assert scene(instants=(4.0,)).peak(tent) == pytest.approx((4, 5), abs=1e-12) and scene().peak(TIME) == (10, 10)
    stops = scene(theta=np.pi / 2, psi_dot=0.0, phi_dot=np.minimum(TIME - 2.1237, 0), instants=(2.1237,))
    assert stops.rest == 2.1237 and "It stands from 2.124 s on." in caption(stops)


def test_a_coefficient_of_friction_beyond_every_road_and_that_of_a_slide_leave_a_gap() -> None:
    needs = {"mu_required": np.where(TIME > 8, 5.0, TIME / 10), "contact_mode": abs(TIME - 3) < 1}
    one = scene(mu_max=0.5, mu_slide=0.4, **needs)
    fig = style.figure_mm(80, 80)
    said = panels.draw_ground(fig.subplots(), one)
    (curve,) = (line.get_ydata() for line in fig.axes[1].lines if len(line.get_ydata()) == len(TIME))
    assert (np.isnan(curve) == ((abs(TIME - 3) < 1) | (TIME > 8))).all() and np.nanmax(curve) < 0.81
    assert said[-1] == r"$\mu$ above 2 is left out"
    assert [text.get_text() for text in fig.axes[1].texts] == [r"$\mu_\mathrm{max}$", r"$\mu_\mathrm{slide}$"]


@pytest.mark.parametrize("free", [True, False])
def test_of_two_scenes_the_one_that_moves_is_drawn_and_the_other_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, free: bool
) -> None:
    drawn, still = [], "friction" if free else "free"
    monkeypatch.setattr(paper, "pictures", lambda scenes, out: drawn.extend(scenes) or PICTURES(scenes, out)[:1])
    ends = {"ending": "lifted off the road at $t$ = 0.5928 s"}
    both = [replace(scene(s), columns={n: x[:1] for n, x in scene(s).columns.items()}, **ends) for s in (0.0, 0.03)]
    both[not free] = scene(0.03 * (not free))
    monkeypatch.setattr(paper, "scenes_of", lambda *_: both)
    paper.main(tmp_path, {})
    why = "has no motion to draw: the wheel lifted off the road at t = 0.5928 s."
    assert f'The scene "{still}" {why}' in capsys.readouterr().err
    assert [one.name for one in drawn] == [both[not free].name] and (tmp_path / "diagrams.png").stat().st_size > 1e5
    both[not free] = both[free]
    with pytest.raises(SystemExit, match="^run: Neither scene has a motion to draw"):
        paper.main(tmp_path, {})


NO_ARC = {
    "it drifts": {"psi_dot": 2 / SWING**2 + 0.1 * TIME},
    "it falls once": {"theta": 1.0 - TIME / 20},
    "fro is another way than to": {"psi_dot": 2 / SWING**2 + 0.5 * np.sin(3 * TIME)},
}


@pytest.mark.parametrize("why", NO_ARC)
def test_the_rates_lie_on_one_arc_only_where_the_data_say_so(why: str) -> None:
    assert scene().one_arc
    assert not scene(**NO_ARC[why]).one_arc


SLIDES = (TIME > 1) & (TIME < 2) | (TIME > 4.5) & (TIME < 5)


def slid() -> Scene:
    road = {"mu_max": 0.45, "mu_slide": 0.4, "contact_mode": SLIDES}
    return scene(instants=(1.0, 2.0, 4.5, 5.0), slip_x=-0.3 * SLIDES, slip_y=0.4 * SLIDES, **road)


def test_a_slide_is_marked_on_the_path_and_on_the_axes_of_time_between_loss_and_return_of_grip() -> None:
    style.use_style()
    for one in (slid(), scene()):
        expected = [1, 2, 4.5, 5] if one.slides.any() else []
        assert one.turns.tolist() == expected
        path, tilt = style.figure_mm(80, 160).subplots(2)
        panels.draw_path(path, one)
        panels.draw_tilt(tilt, one)
        thick = next(line for line in path.lines if line.get_color() == style.PURPLE)
        shown = thick.get_ydata()[np.isfinite(thick.get_ydata())]  # Y_C = t
        if not one.slides.any():
            assert not len(shown) and not any(tuple(of.get_color()[0][:3]) == PURPLE for of in tilt.collections)
            continue
        apart = np.flatnonzero(np.diff(shown) > 0.1)
        ends = [shown[0], shown[apart[0]], shown[apart[0] + 1], shown[-1]]
        assert len(apart) == 1 and ends == pytest.approx(expected, abs=0.02)
        (lines,) = (of for of in tilt.collections if tuple(of.get_color()[0][:3]) == PURPLE)
        assert [segment[0][0] for segment in lines.get_segments()] == pytest.approx(expected, abs=0.01)


def test_where_a_scene_slides_the_slip_has_a_panel_and_the_captions_explain_its_marks() -> None:
    def names(*scenes: Scene) -> set[str]:
        return {panel.name for _, _, drawn, _ in paper.pictures(scenes, Path("results")) for panel in drawn}

    assert "slip" in names(slid(), slid()) and "slip" not in names(scene(mu_max=0.45), scene(0.03))
    by_name = {panel.name: caption(slid(), panel) for panel in paper.PAPERS + paper.OTHERS}
    assert {name for name, text in by_name.items() if "thin lines" in text} == {"position", "tilt", "ground"}
    assert {name for name, text in by_name.items() if "Purple" not in text} == {"rates"}


def test_a_caption_has_the_fate_of_its_wheel_and_no_other() -> None:
    """The wheel's own count of transitions, whatever is seen of its slides."""
    rough = {"s": 0.03, "mu_max": 0.45, "mu_slide": 0.4, "transitions": 43}
    counted = [scene(contact_mode=slides, **rough) for slides in ((TIME > 1) & (TIME < 2), TIME < 2, 0)]
    assert all("43 transitions in 10 s." in caption(one) for one in counted)
    assert "1 transition in 10 s." in caption(scene(0.03, transitions=1))
    assert "slides twice, at up to 0.5 m/s" in caption(slid())
    assert "never slides" in caption(scene(mu_max=0.45, mu_slide=0.4))
    assert not re.search("slides|transition|stands|Rounding", caption(scene()))


def test_a_sheet_explains_once_what_both_scenes_have_and_no_capital_follows_a_colon() -> None:
    scenes, panel = [slid(), replace(slid(), settings=slid().settings | {"s": 0.03})], paper.PAPERS[0]
    remarks = [panel.draw(style.figure_mm(80, 80).subplots(), one) for one in scenes]
    said = " ".join(paper.caption(scenes, [remarks[0], [*remarks[1], "thick: held"]], 175.0, 7.5))
    assert said.count("Purple at the bottom: it slides") == 1 == said.count("Thick: held")
    assert said.index("Rolling resistance: no transitions") < said.index("Thick") < said.index("Purple")
    assert "resistance: it slides twice, at" in paper.paragraph(["it slides twice, at 1 m/s"], "No rolling resistance")
    assert not re.search(r": [A-Z]", said)


def test_a_wheel_that_stands_is_drawn_until_a_little_after_it_has_come_to_rest() -> None:
    spin = np.minimum(TIME - 3, 0)
    stopped = {"theta": np.pi / 2, "psi_dot": 0.0, "phi_dot": spin, "X_O": spin}
    for moves, rest in (({}, 3), ({"theta": np.pi / 2 - np.maximum(4 - TIME, 0)}, 4), ({"contact_mode": TIME < 5}, 5)):
        one = scene(**stopped | moves)
        assert one.rest == pytest.approx(rest, abs=0.02)
        assert one.moving["time"][-1] == pytest.approx(1.1 * rest, abs=0.03)
        assert f"It stands from {one.rest:.3g} s on." in caption(one) and "stop_time" not in caption(one)
    for one in (scene(), scene(**stopped | {"phi_dot": 0.0}), scene(**stopped | {"contact_mode": 1})):
        assert one.rest is None and len(one.moving["time"]) == len(TIME)


@pytest.mark.parametrize("half", [0.001, 0.04, 0.2, 0.3, 0.6, 1.2])
def test_degrees_are_marked_at_round_values(half: float) -> None:
    """One digit after which zeros follow; 15, 30 ... where the whole quadrant is shown."""
    style.use_style()
    fig = style.figure_mm(style.COLUMN, 60.0)
    ax = fig.subplots()
    panels.draw_tilt(ax, scene(theta=1.375 + half * np.cos(TIME)))
    fig.canvas.draw()
    (degrees,) = ax.child_axes
    ticks = degrees.get_yticks()
    step = ticks[1] - ticks[0]
    digit = step / 10 ** np.floor(np.log10(step) + 1e-9)
    assert round(digit, 9) in ((1.5, 3) if half > 0.27 else (1, 2, 5)) and abs(ticks / step % 1).max() < 1e-6


def test_a_jammed_wheel_is_drawn_without_the_force_beyond_the_jam() -> None:
    one = scene(lambda_3=np.where(TIME < 10, 200 + 10 * TIME, 7e5), contact_mode=1)
    for words, most in (("jams (Painleve's paradox) with mu_slide = 1.8", 300), ("lies flat", 7e5)):
        there = replace(one, ending=f"{words} at $t$ = 10 s")
        assert np.nanmax(drawn(panels.draw_ground, there).lines[0].get_ydata()) == pytest.approx(most, rel=1e-3)


def test_the_parts_of_the_slip_have_labels_also_where_one_is_zero() -> None:
    for one in (slid(), scene(contact_mode=SLIDES, slip_x=0.3 * SLIDES), scene()):
        assert labels(panels.draw_slip, one) == ["along, $u_x$", "across, $u_y$"]


@pytest.mark.parametrize(("lean", "chance"), [(6e-17, True), (1e-9, False), (0.26, False)])
def test_a_fall_from_exactly_upright_hangs_on_rounding_and_caption_and_log_say_so(lean: float, chance: bool) -> None:
    fall = scene(theta=np.maximum(np.pi / 2 - lean * np.cosh(4.19 * TIME), 0.0))
    assert ("Rounding" in caption(fall)) is chance and len(paper.warnings_of([scene(), fall])) == chance
    pushed = scene(theta=np.pi / 2 - 0.1 * TIME**2)
    assert "Rounding" not in caption(pushed) + caption(scene(theta=np.pi / 2))
