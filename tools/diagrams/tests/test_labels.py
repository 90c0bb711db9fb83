"""What is written into a diagram covers neither its curve nor another text, and what ended a run is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diagrams import style
from diagrams.labels import Labels, dense, free_corner, inside
from diagrams.scene import SceneError, read_scene

T = np.linspace(0.0, 1.0, 400)
CURVES = {
    "rising": np.column_stack([T, T]),
    "falling": np.column_stack([T, -3 * T]),
    "bent": np.column_stack([T, (1 - T) ** 3]),
    "bundle": np.column_stack([T * np.cos(90 * T) ** 2, 4 * T * np.cos(90 * T) ** 2 + 0.2 * T]),
}


def axes():
    style.use_style()
    return style.axes_mm(style.figure_mm(style.COLUMN, 80.0), 14.0, 14.0, 62.0, 58.0)


@pytest.mark.parametrize("name", CURVES)
def test_texts_cover_neither_the_curve_nor_each_other(name: str) -> None:
    ax, curve = axes(), CURVES[name]
    ax.plot(*curve.T)
    ax.margins(0.2)
    ax.autoscale_view()
    labels = Labels(ax, curve)
    for row in (0, 130, 270, -1):
        labels.put("27.9°, lowest", tuple(curve[row]))
    extents = [text.get_window_extent() for text in ax.texts]
    assert len(extents) == 4
    assert not any(a.overlaps(b) for k, a in enumerate(extents) for b in extents[:k])
    points = dense(ax.transData.transform(curve))
    assert sum(inside(points, (box.x0, box.x1, box.y0, box.y1)) for box in extents) == 0
    assert inside(points, (*ax.bbox.intervalx, *ax.bbox.intervaly)) > 0.9 * len(points)  # the partner


@pytest.mark.parametrize("name", CURVES)
def test_an_inset_covers_nothing_of_the_curve(name: str) -> None:
    ax, curve = axes(), CURVES[name]
    ax.plot(*curve.T)
    left, bottom, width, height = free_corner(ax, *curve.T)
    points = dense(ax.transAxes.inverted().transform(ax.transData.transform(curve)), 0.005)
    assert inside(points, (left, left + width, bottom, bottom + height)) == 0
    assert inside(points, (0.0, 1.0, 0.0, 1.0)) > 0.9 * len(points)


def scene_of(folder: Path, last: float, said: str) -> Path:
    path = folder / "free.csv"
    path.write_text(f"time,theta\n0,1\n{last},1\n")
    path.with_suffix(".log").write_text(said)
    return path


def test_what_ended_a_run_is_told(tmp_path: Path) -> None:
    said = "[WARNING] The wheel fell flat at t = 0.5927504146949162 s: the model ends there.\n"
    path = scene_of(tmp_path, 0.59, said)
    assert read_scene(path, ("time", "theta")).ending == "fell flat at $t$ = 0.593 s"
    assert read_scene(scene_of(tmp_path, 10, ""), ("time", "theta")).ending == ""
    with pytest.raises(SceneError, match="no motion to draw: the wheel fell flat"):
        read_scene(scene_of(tmp_path, 0, said), ("time", "theta"))
