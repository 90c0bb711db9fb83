"""The diagrams: curves over time, phase portrait, angular velocities, path from above."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from page.tests.pages import start

POINTS = """(name) => {
  document.querySelector(`.portrait [name=${name}]`).click();
  const {lines, wheels} = page.plots.portrait;  // those of the rows
  return lines.map(({times, points}, k) => points.filter((_, i) => wheels[k].table.time.includes(times[i])));
}"""


def points(page, name: str) -> dict[str, np.ndarray]:
    return dict(zip(("free", "friction"), map(np.array, page.evaluate(POINTS, name)), strict=True))


def expected(rows: np.ndarray) -> dict[str, list[np.ndarray]]:
    """Both coordinates of each portrait: deg, deg/s; rad/s along e2 and e3; m."""
    along_e2 = rows["psi_dot"] * np.sin(rows["theta"])
    along_e3 = rows["phi_dot"] + rows["psi_dot"] * np.cos(rows["theta"])
    tilt = [np.degrees(rows["theta"]), np.degrees(rows["theta_dot"])]
    return {"phase": tilt, "spin": [along_e2, along_e3], "path": [rows["X_C"], rows["Y_C"]]}


@pytest.mark.parametrize(("name", "bound"), [("phase", 1e-9), ("spin", 512 * EPSILON), ("path", 64 * EPSILON)])
def test_a_button_chooses_rates_over_tilt_or_along_e3_over_e2_or_the_path_of_the_contact_point(
    recorded, simulate, name, bound
):
    names = ("psi_dot", "phi_dot", "theta_dot", "theta", "X_C", "Y_C")
    found = points(recorded, name)
    assert recorded.locator(".portrait [aria-checked=true]").get_attribute("name") == name
    wanted = np.column_stack(expected(simulate(output_interval=0.01, output=names, start_values={"s": 0.03}))[name])
    within(absolute_error(found["friction"], wanted), bound, "points off")
    beyond(absolute_error(found["free"], wanted), 1, "points of the other wheel off")


def test_the_path_from_above_has_one_scale(recorded):
    recorded.evaluate("page.plots.portrait.choose('path')")
    (left, right), (low, high), (width, height) = recorded.evaluate(
        "(({ranges, sizes}) => [...ranges, sizes])(page.plots.portrait)"
    )
    assert (right - left) / width == pytest.approx((high - low) / height)


@pytest.mark.parametrize(("t", "state"), [(1.15, "rolls"), (1.26, "sticks")])
def test_the_label_says_whether_the_wheel_sticks(recorded, t, state):
    recorded.evaluate("(t) => { page.choose(3); page.player.seek(t); page.draw(); }", t)
    assert recorded.locator(".label").get_attribute("data-state") == state


def test_a_click_into_a_diagram_goes_there(recorded):
    recorded.locator(".plot canvas").first.click(position={"x": 100, "y": 40})
    t, expected = recorded.evaluate("[page.player.t, page.plots.curves[0].timeAt(100)]")
    assert 0.5 < t < 9.5 and t == pytest.approx(expected)


@pytest.mark.parametrize("diagram", ["phase", "spin", "path"])
def test_while_a_button_is_held_the_diagrams_keep_their_axes(live, diagram):
    axes = """() => [[page.player.start, page.player.end],
      ...page.plots.curves.map(({ranges}) => ranges[1]), ...page.plots.portrait.ranges]"""
    start(live, at=1)
    live.evaluate("(name) => page.plots.portrait.choose(name)", diagram)
    before = live.evaluate(axes)
    button = live.locator(".push", has_text="forward")
    # In one piece: pressed, the button plays, and what is past may widen an axis.
    button.evaluate("""(button) => {
      button.dispatchEvent(new PointerEvent("pointerdown", {pointerId: 1}));
      page.player.pause();
      page.live.compute();
    }""")
    assert live.evaluate("page.wheels[0].table.columns.E.at(-1)") > before[4][1]  # the future leaves the frame
    assert live.evaluate(axes) == before
    button.dispatch_event("pointerup", {"pointerId": 1})
    live.evaluate("page.live.compute()")
    assert all(low <= a and high >= b for (low, high), (a, b) in zip(live.evaluate(axes), before, strict=True))
    start(live, phi_dot_start=-9)
    assert live.evaluate(axes) != before
