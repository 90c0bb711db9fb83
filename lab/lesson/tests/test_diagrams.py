"""The diagrams: curves over time, phase portrait, path from above."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from .pages import change, column, open_step, opened, start, window_of

POINTS = """() => {
  const {lines, wheels} = page.plots.all.at(-1);  // those of the rows
  return lines.map(({times, points}, k) => points.filter((_, i) => wheels[k].table.time.includes(times[i])));
}"""


def test_the_phase_portrait_is_the_rate_over_the_tilt(live):
    open_step(live, 5)
    (points,) = map(np.array, live.evaluate(POINTS))
    wanted = np.degrees([column(live, name) for name in ("theta", "theta_dot")]).T
    within(absolute_error(points, wanted), 1e-9, "points of the phase portrait, deg and deg/s")
    beyond(np.ptp(points, axis=0).min(), 30, "its extent, deg and deg/s")


def test_the_path_from_above_is_that_of_the_contact_point_in_one_scale(recorded, simulate):
    free, friction = map(np.array, recorded.evaluate(POINTS))
    rows = simulate(output_interval=0.01, output=["X_C", "Y_C"], start_values={"s": 0.03})
    wanted = np.column_stack([rows["X_C"], rows["Y_C"]])
    within(absolute_error(friction, wanted), 64 * EPSILON, "points of the path, m")
    beyond(absolute_error(free, wanted), 1, "points of the path off the other wheel's, m")
    (left, right), (low, high), (width, height) = recorded.evaluate(
        "(({ranges, sizes}) => [...ranges, sizes])(page.plots.all.at(-1))"
    )
    assert (right - left) / width == pytest.approx((high - low) / height)


WRITTEN = """() => {
  const pen = CanvasRenderingContext2D.prototype;
  const write = pen.fillText;
  const found = [];
  pen.fillText = function (text, x, y, most = Infinity) {
    const width = Math.min(most, this.measureText(text).width);
    found.push([text, x - {right: width, center: width / 2}[this.textAlign] || x, x, y, this.textBaseline]);
    write.call(this, text, x, y);
  };
  page.plots.prepare();
  pen.fillText = write;
  return found;
}"""


def test_no_number_at_an_axis_is_cut_off_and_minus_is_no_hyphen(live):
    open_step(live, 6, {"spin": 120})
    texts = live.evaluate(WRITTEN)
    assert min(left for _, left, *_ in texts) >= 0
    assert any(text.startswith("−") for text, *_ in texts) and not any("-" in text for text, *_ in texts)


def test_the_spin_of_a_wheel_without_any_has_no_more_digits_than_that_of_one_with_some(live):
    shown = []
    for spin in (0, 1, 1e-5):
        open_step(live, 6, {"spin": spin, "s": 0})
        shown.append(len(live.evaluate("page.plots.all[0].values.textContent")))
    none, some, little = shown
    assert none <= some < little


def test_the_critical_spin_is_a_line_where_it_is_seen_and_the_wheel_nearly_upright_and_its_name_stands_above(live):
    for lean, spin, seen in ((2, 2.5, True), (2, 9, False), (60, 2.5, False)):
        open_step(live, 8, {"spin": spin})
        live.evaluate("(lean) => { page.lesson.chosen.lean = lean; page.lesson.run(); page.renew(); }", lean)
        names = [(y, base) for text, _, _, y, base in live.evaluate(WRITTEN) if text == "crit"]
        assert bool(names) is seen
        level = live.evaluate("(({y}) => y)({y: page.plots.all[1].y(2.6315)})")
        assert all(base == "bottom" and y < level for y, base in names)


@pytest.mark.parametrize("width", [1400, 1024, 768])
def test_title_and_values_of_a_diagram_do_not_overlap(browser, recorded_file, width):
    with opened(window_of(browser, viewport={"width": width, "height": 900}), recorded_file) as page:
        page.evaluate("page.player.seek(0.3); page.draw()")
        assert page.evaluate(OVERLAPS) == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width


OVERLAPS = """() => [...document.querySelectorAll('figcaption')].filter((caption) => {
  const boxes = [...caption.querySelectorAll('.name, .unit, .values span')].map((x) => x.getBoundingClientRect());
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
    t, expected = recorded.evaluate("[page.player.t, page.plots.all[0].timeAt(100)]")
    assert 0.5 < t < 9.5 and t == pytest.approx(expected)


LANES = """() => [...document.querySelectorAll('#bands i')].map((band) => {
  const {top, bottom} = band.getBoundingClientRect();
  return [band.className, top, bottom];
})"""


def test_neither_held_nor_sliding_hides_the_other(live):
    """Both last at once while a locked wheel slides; in the diagrams as at the clock slides lie above."""
    open_step(live, 9)
    (_, above, edge), (_, top, _) = sorted(live.evaluate(LANES), reverse=False, key=lambda lane: lane[0] != "slide")
    assert above < edge <= top
    lanes = live.evaluate("""() => {
      const pen = CanvasRenderingContext2D.prototype;
      const fill = pen.fillRect;
      const found = [];
      pen.fillRect = function (x, y, width, height) {
        if (height === 4) found.push(y);
        fill.call(this, x, y, width, height);
      };
      page.plots.all.find(({kind}) => kind.form === 'time').prepare('fitted');
      pen.fillRect = fill;
      return [...new Set(found)];
    }""")
    assert len(lanes) == 2 and abs(lanes[0] - lanes[1]) == 4


def test_while_a_button_is_held_the_diagrams_keep_their_axes(live):
    axes = "[[page.player.start, page.player.end], ...page.plots.all.map(({ranges}) => ranges[1])]"
    open_step(live, 8)
    live.evaluate("page.player.seek(1); page.lesson.frame()")
    before = live.evaluate(axes)
    button = live.locator(".push", has_text="forward")
    # In one piece: pressed, the button plays, and what is past may widen an axis.
    button.evaluate("""(button) => {
      button.dispatchEvent(new PointerEvent('pointerdown', {pointerId: 0}));
      page.player.pause();
      page.lesson.frame();
    }""")
    assert live.evaluate("page.wheels[0].table.columns.E.at(-1)") > before[1][1]  # the future leaves the frame
    assert live.evaluate(axes) == before
    button.dispatch_event("pointerup", {"pointerId": 0})
    live.evaluate("page.lesson.frame()")
    assert all(low <= a and high >= b for (low, high), (a, b) in zip(live.evaluate(axes), before, strict=True))
    change(live, spin=9)
    assert live.evaluate(axes) != before
    start(live)
