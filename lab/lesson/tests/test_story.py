"""The story of the live page: every step is a scene, and what its text says holds for the scene's motion."""

import re

import numpy as np
import pytest

from .pages import SIZE, change, column, do, seek, value

STEPS = 11
UPRIGHT = np.pi / 2
ASK = """(k) => {
  Object.assign(page.live, {step: k - 1, open: true}).turn(0);
  page.live.frame();
}"""


@pytest.fixture
def story(live):
    """story(k): the page at step k, with what it asks answered; returns what its card says."""

    def at(k: int) -> str:
        live.evaluate(f"(k) => {{ ({ASK})(k); page.live.tell(); page.player.pause(); page.live.frame(); }}", k)
        assert live.locator("#live .count").inner_text() == f"{k} of {STEPS}"
        return live.locator("#story .text").inner_text()

    return at


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", text)]


def lean(page, wheel: int = 0) -> np.ndarray:
    """From upright, deg."""
    return np.degrees(abs(column(page, "theta", wheel) - UPRIGHT))


def test_the_wheel_rolls_with_its_spin_times_its_radius_and_tips_unless_it_is_pushed(live, story):
    spin, radius, speed, t, tipped = numbers(story(1).split("does not slide")[1])
    assert np.hypot(*(column(live, f"{name}_dot")[0] for name in ("X_O", "Y_O"))) == pytest.approx(speed, abs=5e-3)
    assert spin * radius == pytest.approx(speed, abs=0.02)
    assert np.interp(t, column(live, "time"), lean(live)) == pytest.approx(tipped, abs=0.5) and lean(live).max() > 20
    do(live, 0, M_3=-6)
    do(live, 1, M_3=0)
    assert lean(live).max() < 5


def test_a_leaning_wheel_turns_and_does_not_fall(live, story):
    start, most = numbers(story(2))[:2]
    assert lean(live)[0] == pytest.approx(start) and lean(live).max() == pytest.approx(most, abs=0.05) and most < 30
    assert np.ptp(column(live, "psi")) > np.pi  # it runs in a circle


TERMS = ("weight", "side", "gyro", "sum")
TURNS = """() => page.stage.models[0].turns.map(([name, {visible, userData: {head}}]) =>
  [name, visible ? Math.atan2(head.position.y, head.position.x) : 0])"""
BARS = """() => [...document.querySelectorAll('#balance .bar i')].map(({style}) =>
  (style.left === '50%' ? 1 : -1) * parseFloat(style.width))"""


def balance(page) -> dict[str, float]:
    """The moments about e1 as the card shows them, N m."""
    return {name: float(page.locator(f"#balance .{name} output").inner_text().replace("−", "-")) for name in TERMS}


def test_what_rights_it_is_shown_by_moments_about_e1_that_add_up_to_the_tilts_acceleration(live, story):
    """The acceleration is a difference quotient; a bar to the right and a turn from e2 to e3 right the wheel."""
    t, gyro, side, weight = numbers(story(3).split("leans most")[1])
    seek(live, t)
    told = {"weight": -weight, "side": side, "gyro": gyro, "sum": gyro + side - weight}
    assert balance(live) == pytest.approx(told, abs=0.11) and lean(live)[round(t / 0.01)] == lean(live)[:100].max()
    for row in (5, 20, 35, 60):
        seek(live, row * 0.01)
        shown = balance(live)
        rates = column(live, "theta_dot")
        assert shown["sum"] == pytest.approx(0.9 * (rates[row + 1] - rates[row - 1]) / 0.02, abs=0.17)
        assert shown["weight"] + shown["side"] + shown["gyro"] == pytest.approx(shown["sum"], abs=1e-9)
        N, theta = (column(live, name)[row] for name in ("lambda_3", "theta"))
        assert shown["weight"] == pytest.approx(-0.3 * N * np.cos(theta), abs=0.06)
        assert shown["side"] > 0 and shown["gyro"] > 0
        bars, turns = (live.evaluate(what) for what in (BARS, TURNS))
        for bar, (name, angle) in zip(bars, turns, strict=True):
            assert bar == pytest.approx(100 * shown[name] / (20 * 9.81 * 0.3), abs=0.2)
            assert angle * shown[name] > 0 or abs(shown[name]) < 4
    story(4)
    assert not live.locator("#balance").is_visible()


def test_what_rights_it_is_seen_from_behind_whichever_way_the_wheel_heads(live, story):
    story(3)
    for t in (0.0, 2.0):
        seek(live, t)
        psi, *centre = (column(live, name)[round(t / 0.01)] for name in ("psi", "X_O", "Y_O"))
        towards = centre - np.array(live.evaluate("[...page.stage.eye.position]")[:2])
        towards /= np.linalg.norm(towards)
        assert towards @ [np.cos(psi), np.sin(psi)] > 0.9
    story(2)
    assert live.evaluate("page.stage.place") == "beside"


def test_the_critical_spin_parts_two_wheels(live, story):
    limit, high, low = numbers(story(4))
    assert lean(live, 1).max() == pytest.approx(high, abs=0.05) and high < 10
    assert lean(live).max() == pytest.approx(low, abs=0.05) and low > 20
    assert column(live, "phi_dot")[0] == pytest.approx(-0.9 * limit, rel=1e-2)
    assert live.locator("#choice button").all_inner_texts()[2:] == ["10 % slower", "10 % faster"]


def test_without_friction_it_comes_down_to_one_tilt_in_every_swing(live, story):
    said = numbers(story(5))[1]
    theta = np.degrees(column(live, "theta"))
    lowest = theta[1:-1][(theta[1:-1] < theta[:-2]) & (theta[1:-1] < theta[2:])]
    assert len(lowest) >= 6 and lowest == pytest.approx(said, abs=0.1)


def test_friction_stops_the_spin_and_holds_it(live, story):
    first, _, count = numbers(story(6).split("At ")[1])
    assert first == pytest.approx(1.2255, abs=5e-3)  # s, the trusted table
    assert count == 37 == live.evaluate("page.wheels[0].phases.transitions.length")


def test_a_held_wheel_nods_and_turns_and_loses_no_energy(live, story):
    _, turned = numbers(story(7).split("orange mark")[1])[:2]
    begin, end = live.evaluate("page.wheels[0].phases.sticks[0]")
    t, energy = column(live, "time"), column(live, "E")
    held = (t >= begin) & (t <= end)
    assert (column(live, "omega_z")[held] == 0).all()
    assert np.ptp(column(live, "theta")[held]) > 0.01
    assert np.degrees(np.ptp(column(live, "psi")[held])) > 0.5 * turned > 1
    assert np.ptp(energy[held]) < 1e-6 * energy[0] < 0.1 < np.ptp(energy)


def test_a_motor_adds_energy_and_the_brake_takes_it(live, story):
    before, after, last = (float(joules) for joules in re.findall(r"([\d.]+) J", story(8)))
    energy, t = column(live, "E"), column(live, "time")
    at = [energy[np.argmin(abs(t - instant))] for instant in (1, 3, 7.5)]
    assert [before, after, last] == pytest.approx(at, abs=0.051)
    assert before < after > last


def test_a_locked_wheel_slides_as_far_as_its_speed_squared_over_the_friction(live, story):
    lock, _, _, slid = numbers(story(9).replace("ωz", "").split("/(2")[0].removesuffix("v²"))
    v, X = (np.hypot(*(column(live, f"{name}{rate}") for name in ("X_O", "Y_O"))) for rate in ("_dot", ""))
    assert v[0] == pytest.approx(7) and slid == pytest.approx(7**2 / (2 * 0.4 * 9.81), abs=0.05)
    assert lock == 0.5 and X[-1] - X[50] == pytest.approx(slid, abs=0.05)
    do(live, 0.5, M_brake=50)
    stops = np.hypot(*(column(live, name) for name in ("X_O", "Y_O")))[-1] - X[50]
    assert stops < slid - 0.2 and live.evaluate("page.wheels[0].phases.slides.length") == 0


def test_thrown_with_backspin_it_slides_grips_and_comes_back(live, story):
    """The closed form of docs/physics.md; the slip is drawn as long as it slides."""
    story(5)
    forward, spin, grips, back = numbers(story(10).split("At ")[0])[:2] + numbers(story(10).split("At ")[1])
    growth = 0.3 * 9.81 * (1 + 20 * 0.35**2 / 1.8)
    t = (forward + 0.35 * spin) / growth
    assert (grips, back) == (pytest.approx(t, abs=0.05), pytest.approx(0.3 * 9.81 * t - forward, abs=0.005))
    assert "fell" not in str(live.evaluate("page.wheels[0].ended"))
    for at, length in ((0.0, 1.0), (0.4, (5.5 - growth * 0.4) / 5.5), (1.0, 0.0)):
        seek(live, at)
        drawn = live.evaluate(SLIP)
        assert drawn == pytest.approx([0, 1.1 * 0.35 * length], abs=2e-3)  # e1 points along Y
        assert live.locator("#grip-now").get_attribute("data-state") == ("slides" if length else "rolls")


BELOW = """() => {
  document.querySelector('#live').scrollTop = 0;
  const bottoms = [...document.querySelectorAll('#critical, #grip-now, #start .knob')]
      .map((part) => part.getBoundingClientRect().bottom);
  return Math.max(...bottoms) - document.querySelector('#live').getBoundingClientRect().bottom;
}"""


def test_what_it_does_now_and_the_sliders_of_its_start_are_in_sight_beside_every_step_on_a_small_screen(live, story):
    """Also while it slides; partner: a lower window."""
    live.set_viewport_size({"width": 1366, "height": 768})
    below = {k: story(k) and live.evaluate(BELOW) for k in range(1, STEPS + 1)}
    assert max(below.values()) < 0, below
    live.set_viewport_size({"width": 1366, "height": 560})
    assert live.evaluate(BELOW) > 0
    live.set_viewport_size(SIZE)


SLIP = """() => {
  const {slip} = page.stage.models[0];
  const {shaft, head} = slip.userData;
  const tip = slip.up.clone().set(0, 0, 1).applyQuaternion(slip.quaternion);
  return tip.multiplyScalar(slip.visible ? head.position.z + 0.5 * slip.userData.headLength * head.scale.z : 0)
      .toArray().slice(0, 2);
}"""


def test_without_spin_it_lies_flat_and_the_run_ends(live, story):
    assert numbers(story(11))[0] == pytest.approx(column(live, "time")[-1], abs=5e-3)
    assert column(live, "theta")[-1] < 1e-6
    seek(live, 10)
    assert live.locator(".label").get_attribute("data-state") == "ended"
    label = live.locator(".label span").inner_text()
    assert "flat" in label and "0.592" in label


def test_keys_and_buttons_lead_on_and_back(live, story):
    count, back, on = (live.locator(f"#live {place}") for place in (".count", "[name=back]", "[name=next]"))
    story(1)
    live.evaluate("document.activeElement.blur()")
    for key, step in (("n", 2), ("b", 1), ("b", 1)):
        live.keyboard.press(key)
        assert count.inner_text() == f"{step} of {STEPS}"
    assert back.is_disabled()
    on.evaluate("(button, n) => { for (; n > 0; --n) button.click(); }", STEPS - 1)
    assert count.inner_text() == f"{STEPS} of {STEPS}"
    assert on.is_disabled()


def test_beside_another_motion_the_text_is_faint_and_leads_back(live, story):
    story(6)
    faint = """[new Set([...document.querySelectorAll('#story .text, #story .try')].map((part) =>
      getComputedStyle(part).color)).size > 1, page.live.link.write()]"""
    assert live.evaluate(faint) == [False, "step=6"]
    change(live, slope=0.35)
    assert live.evaluate(faint)[0] and "ended" not in live.locator("#story .text").inner_text()
    assert f"{live.evaluate('page.wheels[0].table.end'):.4g} s computed" in live.locator("#message").inner_text()
    live.locator("#live [name=story]").click()
    assert live.evaluate(faint)[0] is False and value(live, "slope") == 0


PLAY = "(t) => { page.player.play(); page.live.frame(); page.player.pause(); page.player.seek(t); page.live.frame(); }"


@pytest.mark.parametrize("step", [2, 4, 5, 10])
def test_a_step_that_asks_hides_the_future_until_it_plays(live, story, step):
    said = story(step)
    live.evaluate("page.player.play()")  # the step before plays
    live.evaluate(ASK, step)
    hidden = "[page.plots.all.every(({secret}) => secret), page.pose() ?? page.stage.models[0].whole.visible]"
    assert live.evaluate("page.player.playing") is False and live.evaluate(hidden) == [True, False]
    asked = live.locator("#story .text").inner_text()
    assert asked != said and not set(numbers(said)[-1:]) & set(numbers(asked))
    live.evaluate(PLAY, 0.1)
    assert live.evaluate(hidden) == [False, True]
    assert live.locator("#story .text").inner_text() == said  # nothing was guessed: nothing to wait for


@pytest.mark.parametrize(("step", "true"), [(4, "Only the faster one stays up."), (10, "It comes back.")])
def test_a_picked_fate_is_judged_once_the_motion_has_shown_it(live, story, step, true):
    for k in range(3):
        live.evaluate(ASK, step)
        buttons = live.locator("#story .guess button")
        assert buttons.count() == 3
        name = buttons.nth(k).inner_text()
        buttons.nth(k).click()
        live.evaluate(PLAY, 0.1)
        verdict = live.locator("#story .verdict")
        assert not verdict.is_visible()
        live.evaluate(PLAY, 3.5)
        assert verdict.inner_text() == (f"As you guessed: {true}" if name == true else f"Not so: {true}")


@pytest.mark.parametrize("step", [2, 5])
def test_a_drawn_tilt_stays_beside_the_true_one_with_its_mean_error(live, story, step):
    live.evaluate(ASK, step)
    canvas = live.locator(".plot canvas").first
    box = canvas.bounding_box()
    live.mouse.move(box["x"] + 60, box["y"] + 50)
    live.mouse.down()
    for x in (90, 120, 150, box["width"] - 12):
        live.mouse.move(box["x"] + x, box["y"] + 50)
    live.mouse.up()
    assert live.evaluate("page.player.t") == 0  # drawing does not seek
    sketch = np.array(live.evaluate("page.plots.curves[0].sketch"))
    level = sketch[-1, 1]
    assert (np.diff(sketch[:, 0]) > 0).all() and 20 < level < 90
    live.evaluate(PLAY, 6)
    t, theta = column(live, "time"), np.degrees(column(live, "theta"))
    inside = t <= sketch[-1, 0]
    off = abs(np.interp(t, *sketch.T) - theta)[inside].mean()
    assert numbers(live.locator("#story .verdict").inner_text()) == [pytest.approx(off, abs=0.06)]
    low, high = live.evaluate("page.plots.curves[0].ranges[1]")
    assert low < min(theta.min(), level) and max(theta.max(), level) < high
    story(1)
    assert live.evaluate("page.plots.curves[0].sketch") is None


def test_a_guess_can_be_drawn_by_arrow_keys(live, story):
    live.evaluate(ASK, 2)
    live.locator(".plot canvas").first.focus()
    for key in ("ArrowDown", "ArrowRight", "ArrowUp", "ArrowUp", "ArrowLeft"):
        live.keyboard.press(key)
    drawn = live.evaluate("page.plots.curves[0].sketch")
    assert drawn == [pytest.approx(point) for point in ([0, 75], [0.25, 65], [0.5, 65], [0.75, 75])]
    assert live.evaluate("page.player.t") == 0


def test_a_scene_is_no_secret_though_the_story_had_asked(live):
    live.evaluate(ASK, 2)
    live.locator("#live [name=scenes]").click()
    live.locator("#presets button").first.click()
    live.evaluate("page.player.pause(); page.live.frame()")
    assert live.evaluate("[page.live.guess, page.plots.all.some(({secret}) => secret)]") == [None, False]
    assert live.locator("#critical").is_visible() and "asks" not in live.locator("body").get_attribute("class")
