"""The story of the live page: every step is a scene, and what its text says holds for the scene's motion."""

import re

import numpy as np
import pytest
from page.pages import SIZE, column

STEPS = 10
UPRIGHT = np.pi / 2
OPEN = "(k) => { Object.assign(page.live, {step: k - 1, open: true}).turn(0); page.player.pause(); }"


@pytest.fixture
def story(live):
    """story(k): the page at step k; returns what its card says."""

    def at(k: int) -> str:
        live.evaluate(OPEN, k)
        assert live.locator("#story .count").inner_text() == f"{k} of {STEPS}"
        return live.locator("#story .text").inner_text()

    return at


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", text)]


def lean(page, wheel: int = 0) -> np.ndarray:
    """From upright, deg."""
    return np.degrees(abs(column(page, "theta", wheel) - UPRIGHT))


def test_the_wheel_rolls_straight_on_and_keeps_its_speed(live, story):
    spin, radius, speed = numbers(story(1).split("straight on")[1])
    path = np.hypot(*(column(live, name)[-1] - column(live, name)[0] for name in ("X_O", "Y_O")))
    assert path == pytest.approx(10 * speed) == pytest.approx(10 * spin * radius)


def test_a_leaning_wheel_turns_and_does_not_fall(live, story):
    start, most = numbers(story(2))[:2]
    assert lean(live)[0] == pytest.approx(start) and lean(live).max() == pytest.approx(most, abs=0.05) and most < 30
    assert np.ptp(column(live, "psi")) > np.pi  # it runs in a circle


def test_what_rights_it_is_drawn_with_the_terms_of_the_equation(live, story):
    """The terms add up to J_x times the rate of omega_2, a difference quotient; the arrow lies along their moment."""
    assert numbers(story(3))[2] == pytest.approx(max(column(live, "psi_dot") * np.sin(column(live, "theta"))), abs=5e-3)
    turning = column(live, "psi_dot") * np.sin(column(live, "theta"))
    for row in (5, 20, 60):
        live.evaluate("(t) => { page.player.seek(t); page.live.frame(); page.pose(); }", row * 0.01)
        text = live.locator("#terms p").last.inner_text().replace("−", "-").replace(" - ", " + -")
        total, gyro, ground = (float(part.split()[0]) for part in re.split(r" = | \+ ", text))
        assert total == pytest.approx(0.9 * (turning[row + 1] - turning[row - 1]) / 0.02, abs=0.03)
        assert total == pytest.approx(gyro + ground, abs=0.011) and abs(gyro) > 0.5 > abs(ground)
        e_1, e_2 = live.evaluate(ARROW)
        assert e_2 * gyro > 0 and e_1 > 0
    story(4)
    assert not live.locator("#terms").is_visible()


ARROW = """() => {
  const {moment} = page.stage.models[0];
  return moment.up.clone().set(0, 0, 1).applyQuaternion(moment.quaternion).toArray().slice(0, 2);
}"""


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
    _, turned = numbers(story(7).split("orange band")[1])[:2]
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


def test_thrown_with_backspin_it_slides_grips_and_comes_back(live, story):
    """The closed form of docs/physics.md; the slip is drawn as long as it slides."""
    story(5)
    forward, spin, grips, back = numbers(story(9))[:4]
    growth = 0.3 * 9.81 * (1 + 20 * 0.35**2 / 1.8)
    t = (forward + 0.35 * spin) / growth
    assert (grips, back) == (pytest.approx(t, abs=0.05), pytest.approx(0.3 * 9.81 * t - forward, abs=0.005))
    assert "fell" not in str(live.evaluate("page.wheels[0].ended"))
    for at, length in ((0.0, 1.0), (0.4, (5.5 - growth * 0.4) / 5.5), (1.0, 0.0)):
        live.evaluate("(t) => { page.player.seek(t); page.live.frame(); page.draw(); }", at)
        drawn = live.evaluate(SLIP)
        assert drawn == pytest.approx([0, 1.1 * 0.35 * length], abs=2e-3)  # e1 points along Y
        assert live.locator("#grip-now").get_attribute("data-state") == ("slides" if length else "rolls")


def test_what_it_does_now_can_be_read_beside_every_step_on_a_small_screen(live, story):
    """Also while it slides; partner: a lower window."""
    shown = "() => [...document.querySelectorAll('#critical, #grip-now')].map((p) => p.getBoundingClientRect().bottom)"
    for height in (800, 560):
        live.set_viewport_size({"width": 1280, "height": height})
        below = []
        for k in range(1, STEPS + 1):
            story(k)
            live.evaluate("() => { page.live.frame(); document.querySelector('#live').scrollTop = 0; }")
            below.append(
                max(live.evaluate(shown))
                - live.evaluate("document.querySelector('#live').getBoundingClientRect().bottom")
            )
        assert (max(below) < 0) is (height == 800), below
    live.set_viewport_size(SIZE)


SLIP = """() => {
  const {slip} = page.stage.models[0];
  const {shaft, head} = slip.userData;
  const tip = slip.up.clone().set(0, 0, 1).applyQuaternion(slip.quaternion);
  return tip.multiplyScalar(slip.visible ? head.position.z + 0.5 * slip.userData.headLength * head.scale.z : 0)
      .toArray().slice(0, 2);
}"""


def test_without_spin_it_lies_flat_and_the_run_ends(live, story):
    assert numbers(story(10))[0] == pytest.approx(column(live, "time")[-1], abs=5e-3)
    assert column(live, "theta")[-1] < 1e-6
    live.evaluate("page.player.seek(10); page.draw()")
    assert live.locator(".label").get_attribute("data-state") == "ended"
    label = live.locator(".label span").inner_text()
    assert "flat" in label and "0.592" in label


def test_keys_and_buttons_lead_on_and_back(live, story):
    count, back, on = (live.locator(f"#story {place}") for place in (".count", "[name=back]", "[name=next]"))
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
    live.evaluate("page.live.setStart('slope', 0.35); page.live.frame()")
    assert live.evaluate(faint)[0] and "ended" not in live.locator("#story .text").inner_text()
    assert f"{live.evaluate('page.wheels[0].table.end'):.4g} s computed" in live.locator("#message").inner_text()
    live.get_by_role("button", name="Back to the story's wheel").click()
    assert live.evaluate(faint)[0] is False and live.evaluate("page.live.value('slope')") == 0
