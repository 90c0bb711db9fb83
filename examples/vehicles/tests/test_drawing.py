"""Pictures of a vehicle's run: what differs by rounding is a line, and no power of ten stands over the legend."""

import numpy as np
import pytest
from vehicles.drawing import LEAST, draw_panel

from diagrams import style

TIME = np.linspace(0.0, 4.0, 101)
CURVES = {"rounding": 3e-15 * np.sin(9 * TIME), "large": 4e7 * TIME, "small": 5e-3 * TIME}


@pytest.mark.parametrize("name", CURVES)
def test_an_axis_has_its_numbers_in_full_and_is_no_narrower_than_its_unit_allows(name: str) -> None:
    style.use_style()
    fig = style.figure_mm(style.PAGE, 60.0)
    ax, value = fig.subplots(), CURVES[name]
    draw_panel(ax, {"time": TIME, "v": value, "rigid.v": 0 * value}, "speed [m/s]", "v: coupled", "rigid.v", names={})
    fig.draw_without_rendering()
    assert ax.yaxis.get_offset_text().get_text() == "" and ax.get_legend()
    low, high = ax.get_ylim()
    assert high - low >= 2 * LEAST and low <= value.min() < value.max() <= high
    ax.ticklabel_format(axis="y", style="sci", scilimits=(0, 0))  # the partner
    ax.autoscale(axis="y")
    fig.draw_without_rendering()
    assert ax.yaxis.get_offset_text().get_text() != ""
