"""A diagram shows what was run: nothing is cut off, captions list what is not the paper's, arcs are in the data."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from wheelfmu.diagrams import panels, paper, style
from wheelfmu.diagrams.scene import Scene

PICTURES = paper.pictures
PURPLE = to_rgb(style.PURPLE)
TIME = np.linspace(0.0, 10.0, 1001)
SWING = 1.0 + 0.3 * np.cos(3 * TIME)  # rad


def scene(s: float = 0.0, time: np.ndarray = TIME, **columns: np.ndarray | float) -> Scene:
    """A wheel that swings, with the paper's parameters but for those given."""
    rates = {"psi_dot": 2 / SWING**2, "phi_dot": -2 / SWING**3}
    motion = {"time": time, "theta": SWING, "X_O": SWING, "X_C": np.sin(TIME), "Y_C": TIME, "lambda_3": 200 * SWING}
    settings = {name: v.preset for name, v in paper.SETTINGS.items()} | {"s": s, "n_events": 0, "friction_mode": 1}
    settings |= {"contact_mode": 0, "slip_x": 0, "slip_y": 0}
    everything = settings | rates | motion | {"mu_required": SWING / 3} | columns
    return Scene(Path("scene.csv"), {name: np.broadcast_to(value, len(TIME)) for name, value in everything.items()})


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
    held = scene(0.03, friction_mode=modes, n_events=3, psi_dot=TIME)
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
    assert f"{name} = " in caption(other)
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


def test_a_guided_wheel_has_speeds_slip_ratio_forces_and_distance_in_the_place_of_what_stays() -> None:
    """Locked after 2 s, it stands after 8 s: 8 m/s falls evenly, the spin four times as fast."""
    v, rolling = np.maximum(8 - TIME, 0), np.maximum(8 - 4 * TIME, 0)
    course = {"X_O_dot": v, "Y_O_dot": 0, "psi": 0, "slip_x": v - rolling, "theta": np.pi / 2, "Y_O": 0}
    way = np.where(TIME < 8, 8 * TIME - TIME**2 / 2, 32)
    braked = scene(guided=1, contact_mode=v > 0, X_O=way, lambda_1=-20, lambda_x=-20, lambda_y=0, **course)
    drawn = [panel for panels in paper.panels_of([braked]) for panel in panels]
    assert [panel.name for panel in drawn] == ["speeds", "slip_ratio", "forces", "distance"]
    assert np.allclose(braked.rolling_speed, rolling) and np.isnan(braked.slip_ratio[TIME >= 8]).all()
    assert np.allclose(braked.slip_ratio[TIME < 8], (rolling / np.where(v > 0, v, 1) - 1)[TIME < 8])
    said = caption(braked, *drawn)
    assert "braking negative" in said and "guided = true" in said
    ax = style.figure_mm(80, 80).subplots()
    panels.draw_forces(ax, braked)
    assert [text.get_text() for text in ax.texts] == ["$N$", "along $e_1$"]  # none to the left
    across = scene(guided=1, contact_mode=1, slip_y=1.0, X_O=way, lambda_x=0, lambda_y=-20, **{**course, "slip_x": v})
    assert [panel.name for panel in paper.panels_of([across])[1]] == ["forces", "distance", "path"]
    assert paper.panels_of([scene()])[0] == paper.PAPERS  # the partner


def written(folder: Path, name: str, one: Scene, rows: int) -> None:
    columns = {n: values[:rows] for n, values in one.columns.items()}
    columns["time"] = np.arange(rows) * 0.01 if rows > 2 else np.zeros(rows)
    table, names = np.column_stack(list(columns.values())), ",".join(columns)
    np.savetxt(folder / f"{name}.csv", table, delimiter=",", header=names, comments="")
    (folder / f"{name}.log").write_text(
        "[WARNING] The wheel lifted off the ground at t = 0.5927504 s: the run ends there.\n"
    )


@pytest.mark.parametrize(("free", "friction"), [(1001, 2), (2, 1001)])
def test_of_two_scenes_the_one_that_moves_is_drawn_and_the_other_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, free: int, friction: int
) -> None:
    drawn = []
    monkeypatch.setattr(paper, "pictures", lambda scenes, out: drawn.extend(scenes) or PICTURES(scenes, out)[:1])
    written(tmp_path, "free", scene(), free)
    written(tmp_path, "friction", scene(0.03), friction)
    paper.main(tmp_path)
    still, moving = ("free", "friction") if free < friction else ("friction", "free")
    assert (
        f'The scene "{still}" has no motion to draw: the wheel lifted off the ground at t = 0.593 s.'
        in capsys.readouterr().err
    )
    assert [one.path.stem for one in drawn] == [moving] and (tmp_path / "diagrams.png").stat().st_size > 1e5
    (tmp_path / f"{moving}.csv").write_text((tmp_path / f"{still}.csv").read_text())
    with pytest.raises(SystemExit, match="^run: Neither scene has a motion to draw"):
        paper.main(tmp_path)


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
    return scene(contact_mode=SLIDES, slip_x=-0.3 * SLIDES, slip_y=0.4 * SLIDES, mu_max=0.45, mu_slide=0.4)


def test_a_slide_is_marked_on_the_path_and_on_the_axes_of_time_between_loss_and_return_of_grip() -> None:
    style.use_style()
    for one in (slid(), scene()):
        expected = [1, 2, 4.5, 5] if one.slides.any() else []
        assert one.turns == pytest.approx(expected, abs=0.01)
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


def test_the_slip_has_a_panel_and_the_caption_its_size_where_a_scene_slides() -> None:
    def names(*scenes: Scene) -> set[str]:
        return {panel.name for _, _, drawn, _ in paper.pictures(scenes, Path("results")) for panel in drawn}

    assert "slip" in names(slid(), slid()) and "slip" not in names(scene(mu_max=0.45), scene(0.03))
    by_name = {panel.name: caption(slid(), panel) for panel in paper.PAPERS + paper.OTHERS}
    assert all("slides twice, at up to 0.5 m/s" in text for text in by_name.values())
    assert {name for name, text in by_name.items() if "thin lines" in text} == {"position", "tilt", "ground"}
    assert {name for name, text in by_name.items() if "Purple" not in text} == {"rates"}
    assert "never slides" in caption(scene(mu_max=0.45, mu_slide=0.4))
    assert "slides" not in caption(scene())


def test_a_caption_has_the_wheels_own_count_of_transitions() -> None:
    rough = {"s": 0.03, "mu_max": 0.45, "mu_slide": 0.4, "n_events": 43}
    for slides in ((TIME > 1) & (TIME < 2), TIME < 2, 0):
        assert "43 transitions in 10 s." in caption(scene(contact_mode=slides, **rough))
    assert "1 transition in 10 s." in caption(scene(0.03, n_events=1)) and "transition" not in caption(scene())


def test_a_sheet_explains_once_what_both_scenes_have_and_no_capital_follows_a_colon() -> None:
    scenes, panel = [slid(), replace(slid(), columns=slid().columns | {"s": np.full(len(TIME), 0.03)})], paper.PAPERS[0]
    remarks = [panel.draw(style.figure_mm(80, 80).subplots(), one) for one in scenes]
    said = " ".join(paper.caption(scenes, [remarks[0], [*remarks[1], "thick: held"]], 175.0, 7.5))
    assert said.count("Purple at the bottom: it slides") == 1 == said.count("Thick: held")
    assert said.index("Rolling friction: no transitions") < said.index("Thick") < said.index("Purple")
    assert "friction: it slides twice, at" in paper.paragraph(["it slides twice, at 1 m/s"], "No rolling friction")
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
        assert one.rest is None and len(one.moving["time"]) == len(TIME) and "stands" not in caption(one)


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


def test_a_jammed_wheel_is_drawn_without_the_force_beyond_the_jam(tmp_path: Path) -> None:
    one = scene(lambda_3=np.where(TIME < 10, 200 + 10 * TIME, 7e5), contact_mode=1)
    for words, most in (("jams (Painleve's paradox) with mu_slide = 1.8", 300), ("lies flat", 7e5)):
        there = Scene(tmp_path / "free.csv", one.columns)
        (tmp_path / "free.log").write_text(f"The wheel {words} at t = 10 s, theta = 1 rad: the run ends there.\n")
        ax = style.figure_mm(80, 80).subplots()
        panels.draw_ground(ax, there)
        assert np.nanmax(ax.lines[0].get_ydata()) == pytest.approx(most, rel=1e-3)


def test_the_parts_of_the_slip_have_labels_also_where_one_is_zero() -> None:
    for one in (slid(), scene(contact_mode=SLIDES, slip_x=0.3 * SLIDES), scene()):
        ax = style.figure_mm(80, 80).subplots()
        panels.draw_slip(ax, one)
        assert [text.get_text() for text in ax.texts] == ["along", "across"]


@pytest.mark.parametrize(("lean", "chance"), [(6e-17, True), (1e-9, False), (0.26, False)])
def test_a_fall_from_exactly_upright_hangs_on_rounding_and_caption_and_log_say_so(lean: float, chance: bool) -> None:
    fall = scene(theta=np.maximum(np.pi / 2 - lean * np.cosh(4.19 * TIME), 0.0))
    assert ("Rounding" in caption(fall)) is chance and len(paper.warnings_of([scene(), fall])) == chance
    pushed = scene(theta=np.pi / 2 - 0.1 * TIME**2)
    assert "Rounding" not in caption(pushed) + caption(scene(theta=np.pi / 2))
