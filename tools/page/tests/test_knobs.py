"""Sliders and the numbers beside them, whose ranges follow the wheel; the critical spin; the clock's real time."""

import numpy as np
import pytest
from support.bounds import beyond, within
from support.closed_forms import critical_spin
from support.scenes import PAPER

from page.tests.pages import column, start

COIN = {"m": 0.0085, "r_0": 0.011775, "r": 0.0011, "J_x": 3.556802865e-7, "J_y": 3.556802865e-7, "J_z": 7.0450390625e-7}


def write(page, name: str, text: str) -> None:
    """What a reader types into the number of a quantity, and Enter."""
    page.evaluate("document.querySelector('#wheel').open = true")
    field = page.locator(f"#live [name={name}_number]")
    field.fill(text)
    field.press("Enter")
    page.evaluate("page.live.frame()")


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("phi_dot_start", "-2.6315", -2.6315),
        ("phi_dot_start", "-200", -200.0),  # beyond the slider
        ("theta_start", "61.23", np.radians(61.23)),
        ("m", "12.3456", 12.3456),
        ("s", "0.01234", 0.01234),
        ("r_0", "0", 1e-3),  # the nearest limit
    ],
)
def test_any_number_within_the_limits_can_be_typed(live, name, text, value):
    start(live)
    write(live, name, text)
    within(abs(live.evaluate("(name) => page.live.present(name)", name) / value - 1), 1e-12, f"{name}, relative")
    shown = float(live.locator(f"#live [name={name}_number]").input_value())
    assert shown == pytest.approx(float(text) or 1e-3, rel=1e-6)


def test_a_number_keeps_its_keys_from_the_page_and_escape_leaves_it_as_it_was(live):
    start(live)
    before = live.evaluate("[page.live.step, page.choice, page.player.speed, page.switches.show.force]")
    field = live.locator("#live [name=phi_dot_start_number]")
    field.focus()
    for key in ("1", "-", "+", "g", "n", "ArrowLeft", "Home"):
        live.keyboard.press(key)
    live.keyboard.press("Escape")
    assert live.evaluate("[page.live.step, page.choice, page.player.speed, page.switches.show.force]") == before
    assert field.input_value() == "-2" and live.evaluate("page.live.value('phi_dot_start')") == -2
    assert live.evaluate("page.player.t") == 0


OVERFLOWS = "all => all.filter((field) => field.scrollWidth > field.clientWidth).map(({value}) => value)"


def test_no_number_is_wider_than_its_field(live):
    start(live, **COIN, theta_start=np.radians(123.456), phi_dot_start=-1000 / 7, M_3=-1e-4 / 7)
    live.evaluate("document.querySelector('#wheel').open = true; page.live.frame()")
    fields = "#live .knob [type=number]"
    shown = dict(live.eval_on_selector_all(fields, "all => all.map(({name, value}) => [name, value])"))
    assert float(shown["J_z_number"]) == pytest.approx(COIN["J_z"], rel=1e-5)
    assert live.eval_on_selector_all(fields, OVERFLOWS) == []
    live.evaluate("document.querySelector('#live [name=J_z_number]').value = -7.0450390625e-7")
    assert live.eval_on_selector_all(fields, OVERFLOWS) == ["-7.0450390625e-7"]


def range_of(page, name: str) -> list[float]:
    return page.evaluate("(name) => { const {min, max, step} = document.querySelector(`#live [name=${name}]`); "
                         "return [min, max, step].map(Number); }", name)  # fmt: skip


def test_the_sliders_follow_the_wheel_and_reach_beyond_its_critical_spin(live):
    start(live)
    live.evaluate("page.live.frame()")
    assert range_of(live, "phi_dot_start") == [-12, 12, 0.05]
    paper = {name: range_of(live, name) for name in ("s", "M_3", "r")}
    assert (paper["s"], paper["M_3"][1], paper["r"][:2]) == ([0, 0.1, 0.0005], 8, [0, 0.3])
    start(live, **COIN)
    live.evaluate("page.live.frame()")
    critical = live.evaluate("import('#mechanics').then(({criticalSpin}) => criticalSpin(page.live.parameters()))")
    within(abs(critical / 15.31 - 1), 1e-3, "critical spin of the coin, relative")
    low, high, step = range_of(live, "phi_dot_start")
    assert -low == high > 4 * critical and 100 < high / step < 500
    coin = {name: range_of(live, name) for name in paper}
    assert coin["s"][1] == 0.004 and coin["M_3"][1] < 2e-4 and coin["r"][1] == COIN["r_0"]
    live.evaluate("page.live.setStart('phi_dot_start', 1.1 * -15.31); page.live.frame()")
    assert float(live.locator("#live [name=phi_dot_start]").input_value()) == pytest.approx(-16.841, abs=step)


def test_the_critical_spin_is_shown_and_on_which_side_the_present_spin_is(live):
    limit = critical_spin(PAPER)
    note = live.locator("#critical")
    for spin, side in ((1.01 * limit, "above"), (0.99 * limit, "below")):
        start(live, theta_start=np.pi / 2, phi_dot_start=-spin)
        live.evaluate("page.live.frame()")
        assert f"|ωz| = {spin:.2f} rad/s, {side} ωcrit = {limit:.2f} rad/s" in note.inner_text()
        assert note.get_attribute("data-side") == side
    start(live, theta_start=np.pi / 2, phi_dot_start=-1.01 * limit, s=0.03)
    live.evaluate("page.live.frame()")
    assert note.get_attribute("data-side") == "above"
    live.evaluate("page.player.seek(5); page.live.frame()")  # rolling friction slows it down
    assert note.get_attribute("data-side") == "below"
    assert abs(column(live, "omega_z")[500]) < limit


def test_a_ready_wheel_says_which_spin_and_friction_it_has_set(live):
    start(live, s=0.02)
    live.evaluate("document.querySelector('#wheel').open = true")
    live.locator("#ready").select_option("wheel:coin")
    live.evaluate("page.live.frame()")
    note = live.locator("#scaled").inner_text()
    assert "φ̇ is −10.4 rad/s" in note and "s is 0.0011 m" in note
    assert live.evaluate("[page.live.value('phi_dot_start'), page.live.value('s')]") == [-10.4, 0.0011]
    live.evaluate("page.live.setStart('phi_dot_start', -9); page.live.frame()")
    assert not live.locator("#scaled").is_visible()


def test_a_motion_of_the_story_has_its_name_until_it_is_another(live):
    names = "page.choices.map(({label}) => label)"
    live.evaluate("page.live.turn(0); page.live.apply(page.live.steps[2].state, 2); page.player.pause()")
    assert {"10 % slower", "10 % faster"} <= set(live.evaluate(names))
    live.evaluate("page.live.setStart('phi_dot_start', -3); page.live.frame()")
    assert "10 % slower" not in live.evaluate(names) and {"This wheel", "10 % faster"} <= set(live.evaluate(names))
    assert live.locator(".label b").all_inner_texts() == ["This wheel", "10 % faster"]
    assert live.locator("#choice [aria-checked=true]").count() == 1


SLOW = """async (pause) => {
  const {player} = page;
  const wait = (ms) => { const end = performance.now() + ms; while (performance.now() < end); };
  player.set({t: 0, speed: 1});
  player.play();
  page.tick(performance.now());
  const [begin, t] = [performance.now(), player.t];
  for (let k = 0; k < 3; ++k) { wait(pause); page.tick(performance.now()); }
  player.pause();
  return [(performance.now() - begin) / 1000, player.t - t];
}"""


@pytest.mark.parametrize("pause", [10, 400])
def test_the_clock_keeps_real_time_however_long_a_picture_takes(either, pause):
    seconds, shown = either.evaluate(SLOW, pause)
    within(abs(seconds - shown), 0.02, "clock off real time, s")
    beyond(seconds, 0.0025 * pause, "time of three pictures, s")


def test_a_brake_lasts_as_long_as_it_is_held_however_late_the_page_draws(live):
    """Pressed at 0.2 s and released at 1.7 s of the events' own time, both seen by the page after 2 s."""
    start(live)
    live.evaluate("""() => {
      const button = [...document.querySelectorAll('.push')].find(({textContent}) => textContent === 'brake');
      page.player.play();
      page.ticked = 1000;
      const send = (kind, timeStamp) => button[`on${kind}`]({timeStamp, pointerId: 0});
      send('pointerdown', 1200);
      send('pointerup', 2700);
      page.player.pause();
      page.ticked = undefined;
    }""")
    (begin, *_), (end, *_) = live.evaluate("page.live.plan.changes.map(({t, name, value}) => [t, name, value])")
    assert (begin, end) == (pytest.approx(0.2), pytest.approx(1.7))


def test_a_page_out_of_sight_stands_still(either):
    away = """(shown) => {
      page.player.set({t: 0});
      page.player.play();
      page.ticked = performance.now() - 2000;
      if (!shown) document.dispatchEvent(new Event('visibilitychange'));
      page.tick(performance.now());
      page.player.pause();
      return page.player.t;
    }"""
    within(either.evaluate(away, False), 0.1, "time of the page out of sight, s")
    beyond(either.evaluate(away, True), 1.9, "time of a page in sight, s")


def test_a_wheel_that_slides_leaves_marks_and_a_band_and_names_what_it_does(live):
    """The paper's wheel at 0.45 / 0.4 slides twice; the instants are those of its record, 0.02 s apart at most."""
    start(live, mu_max=0.45, mu_slide=0.4)
    spans = live.evaluate("page.wheels[0].phases.slides")
    within(np.abs(np.array(spans) - [[0.5708, 0.9550], [1.8742, 2.1902]]).max(), 0.02, "instants, s")
    assert live.locator("#bands .slide").count() == 2
    states = []
    for t in (0.7, 1.2):
        live.evaluate("(t) => page.player.seek(t)", t)
        live.wait_for_function("!page.stage.dirty")
        states.append(live.locator(".label").first.get_attribute("data-state"))
    assert states == ["slides", "rolls"]
    start(live, mu_max=0.45)
    assert live.evaluate("page.wheels[0].phases.slides") == []


def test_the_ready_case_backspin_slides_grips_and_comes_back(live):
    start(live)
    live.locator("#ready").select_option("wheel:backspin")
    live.evaluate("page.live.frame()")
    (begin, end), *others = live.evaluate("page.wheels[0].phases.slides")
    assert begin == 0 and 0.9 < end < 1.2 and not others
    X_O = column(live, "X_O")
    assert max(X_O) > X_O[-1] and X_O[-1] < X_O[0]
    start(live)
