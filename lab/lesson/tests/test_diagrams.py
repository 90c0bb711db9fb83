"""The diagrams: curves over time, phase portrait, angular velocities, path from above."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from .pages import opened, start, window_of

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
    within(absolute_error(found["friction"], wanted), bound, f"points of {name}")
    beyond(absolute_error(found["free"], wanted), 1, f"points of {name} off the other wheel's")


def test_the_path_from_above_has_one_scale(recorded):
    recorded.evaluate("page.plots.portrait.choose('path')")
    (left, right), (low, high), (width, height) = recorded.evaluate(
        "(({ranges, sizes}) => [...ranges, sizes])(page.plots.portrait)"
    )
    assert (right - left) / width == pytest.approx((high - low) / height)


WRITTEN = """() => {
  const pen = CanvasRenderingContext2D.prototype;
  const write = pen.fillText;
  const found = [];
  pen.fillText = function (text, x, y, most = Infinity) {
    const width = Math.min(most, this.measureText(text).width);
    found.push([text, x - {right: width, center: width / 2}[this.textAlign] || x]);
    write.call(this, text, x, y);
  };
  page.plots.prepare();
  pen.fillText = write;
  return found;
}"""


def test_no_number_at_an_axis_is_cut_off_and_minus_is_no_hyphen(live):
    start(live, phi_dot_start=-120)
    texts = live.evaluate(WRITTEN)
    assert min(left for _, left in texts) >= 0
    assert any(text.startswith("−12") for text, _ in texts) and not any("-" in text for text, _ in texts)


def test_the_spin_of_a_wheel_without_any_has_no_more_digits_than_that_of_one_with_some(live):
    shown = []
    for spin in (0, -1, -1e-5):
        start(live, phi_dot_start=spin)
        shown.append(len(live.evaluate("page.plots.curves[1].values.textContent")))
    none, some, little = shown
    assert none <= some < little


def test_the_portrait_of_a_wheel_that_keeps_its_tilt_has_round_numbers(live):
    start(live, theta_start=np.pi / 2, phi_dot_start=-20)
    live.evaluate("page.plots.portrait.choose('phase')")
    assert live.evaluate("page.plots.portrait.marks.map(([, text]) => text)") == ["−1.0", "−0.5", "0.0", "0.5", "1.0"]


def test_the_critical_spin_is_a_line_in_the_diagram_of_the_spin_where_it_is_seen(live):
    for spin, seen in ((-2.0, True), (-9.0, False)):
        start(live, phi_dot_start=spin)
        assert ("crit" in [text for text, _ in live.evaluate(WRITTEN)]) is seen


@pytest.mark.parametrize("width", [1400, 1024, 768])
def test_title_and_values_of_a_diagram_do_not_overlap(browser, recorded_file, width):
    with opened(window_of(browser, viewport={"width": width, "height": 900}), recorded_file) as page:
        page.evaluate("page.player.seek(0.3); page.draw()")
        assert page.evaluate(OVERLAPS) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width


OVERLAPS = """() => [...document.querySelectorAll('figcaption')].filter((caption) => {
  const boxes = [...caption.querySelectorAll('b, .unit, .segments, output span')].map((x) => x.getBoundingClientRect());
  return boxes.some((a, i) => boxes.some((b, j) => i < j && a.width && b.width && a.left < b.right - 1 &&
      b.left < a.right - 1 && a.top < b.bottom - 6 && b.top < a.bottom - 6)) ||
      boxes.some(({right}) => right > innerWidth);
}).map(({textContent}) => textContent)"""


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
