"""The live page in headless Chromium: what the reader does to the wheel, and how it goes on."""

import numpy as np
import pytest

from .pages import change, column, do, start

STEP = 0.01  # s
CHANGES = "page.live.plan.changes.map(({t, name, value}) => [t, name, value])"


def test_dragging_s_changes_the_motion_from_now_on_and_not_before(live):
    start(live, at=3)
    before = column(live, "theta")
    slider = live.locator("#live [name=s]")
    width, height = (slider.bounding_box()[edge] for edge in ("width", "height"))
    slider.hover(position={"x": 3, "y": height / 2})
    live.mouse.down()
    slider.hover(position={"x": 0.4 * width, "y": height / 2})
    live.mouse.up()
    live.wait_for_function("page.live.plan.changes.length > 0 && !page.live.wanted")
    assert 0.02 < live.evaluate("page.live.present('s')") < 0.06
    same = before == column(live, "theta")
    assert same[:301].all() and not same[400:].any()


def test_a_change_drops_what_was_planned_for_later(live):
    start(live)
    do(live, 2, M_3=-2)
    pushed = column(live, "omega_z")
    do(live, 1, M_3=0)
    assert live.evaluate(CHANGES) == [[1, "M_3", 0]] and (column(live, "omega_z") != pushed).any()


def test_a_push_lasts_as_long_as_the_key_is_held(live):
    start(live, at=1)
    live.locator(".push").first.focus()
    live.keyboard.down(" ")
    live.wait_for_function("page.player.t > 1.1")
    live.keyboard.up(" ")
    (begin, *pushed), (end, *released) = live.evaluate(CHANGES)
    assert (pushed, released) == (["M_3", 6], ["M_3", 0])
    assert end > begin == pytest.approx(1.0)


@pytest.mark.parametrize("spin", [-2.0, 3.0])
def test_forward_is_the_way_the_wheel_rolls_and_back_is_against_it(live, spin):
    energy = {}
    for way in ("forward", "back"):
        start(live, at=1, theta_start=np.pi / 2, phi_dot_start=spin)
        button = live.locator(".push", has_text=way)
        button.dispatch_event("pointerdown", {"pointerId": 1})
        live.evaluate("page.player.pause(); page.live.compute()")
        energy[way] = np.interp([1, 1.2], column(live, "time"), column(live, "E"))
        button.dispatch_event("pointerup", {"pointerId": 1})
    assert energy["forward"][0] == pytest.approx(energy["back"][0])
    assert energy["forward"][1] > energy["forward"][0] > energy["back"][1]


def test_an_impossible_start_is_refused_with_the_wheels_own_sentence(live):
    start(live)
    for r_0, words in ((-1, "r0 = -1"), (0.3, "computed in")):
        change(live, r_0=r_0)
        assert words in live.locator("#message").inner_text()


def test_every_scene_runs_to_its_end(live):
    live.locator("#live [name=scenes]").click()
    for button in live.locator("#presets button").all():
        button.click()
        assert live.evaluate("page.live.frame() ?? page.live.trouble ?? page.wheels[0].ended") is None
        assert live.evaluate("page.wheels[0].table.end - page.live.plan.stop") == pytest.approx(0)
        assert button.get_attribute("aria-checked") == "true"


def test_a_kept_motion_stays_beside_the_next(live):
    start(live)
    kept = column(live, "E")
    live.locator("#keep").click()
    do(live, 0, s=0.03)
    assert live.evaluate("page.views.length") == 2
    assert (column(live, "E", wheel=1) == kept).all() and column(live, "E")[-1] < 0.9 * kept[-1]
    live.locator("#keep").click()
    assert live.evaluate("page.wheels.length") == 1


def test_a_fast_wheel_has_forty_rows_to_each_nutation_and_its_link_the_same(live):
    """A motorcycle's wheel at 60 km/h: 14 Hz; the paper's wheel keeps its rows every 0.01 s."""
    start(live)
    assert np.diff(column(live, "time")).max() == pytest.approx(STEP)
    parameters = {"m": 11.34, "r_0": 0.23, "r": 0.064, "J_x": 0.3, "J_y": 0.3, "J_z": 0.6}
    start(live, theta_start=np.radians(80), phi_dot_start=-60 / 3.6 / 0.294, **parameters)
    rate = column(live, "theta_dot")
    turns = np.flatnonzero(rate[:-1] * rate[1:] < 0)
    assert 2 * np.diff(turns).min() >= 40
    assert 2 * np.diff(column(live, "time")[turns]).mean() == pytest.approx(1 / 14, rel=0.1)


CELL = """([x, y]) => {
  const canvas = document.querySelector('#fates canvas');
  const {left, top, width, height} = canvas.getBoundingClientRect();
  canvas.dispatchEvent(new PointerEvent('pointermove', {clientX: left + x * width, clientY: top + y * height}));
  page.player.pause();
  page.live.frame();
}"""


def test_the_pointer_over_the_map_of_fates_plays_the_wheel_of_that_lean_and_spin(live):
    start(live)
    live.locator("#live [name=scenes]").click()
    live.evaluate("page.live.frame()")
    for x, y in ((0.25, 0.5), (0.9, 0.9)):
        live.evaluate(CELL, [x, y])
        lean, spin = (live.evaluate(f"page.live.value('{name}')") for name in ("theta_start", "phi_dot_start"))
        assert 90 - np.degrees(lean) == pytest.approx(56 * (1 - y), abs=2.1)
        assert -spin == pytest.approx(2 * x * 2.6315, abs=0.11)
    live.locator("#live [name=story]").click()
    assert live.locator("#fates").is_hidden()


FATES = """async () => {
  const {fateOf} = await import('#fates');
  return [[-0.5, 80], [-5, 88], [0, 60]].map(([phi_dot_start, theta]) =>
    fateOf(page.live.fmu, {phi_dot_start, theta_start: theta * Math.PI / 180}));
}"""


def test_the_fate_of_a_wheel_is_its_largest_lean_or_that_it_lies_flat(live):
    deep, upright, flat = live.evaluate(FATES)
    assert 60 < deep < 90 and 2 < upright < 4 and flat == 90
