"""Sliders and the numbers beside them; preset bodies and wheels; the critical spin; held buttons; slides."""

from dataclasses import replace

import numpy as np
import pytest
from page.pages import column, start
from support.bounds import beyond, within

from wheelfmu.fmu.values import bodies, doubt, moments
from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.sliding import SLIDES

COIN = {"m": 0.0085, "r_0": 0.011775, "r": 0.0011, "J_x": 3.556802865e-7, "J_y": 3.556802865e-7, "J_z": 7.0450390625e-7}


def choose(page, name: str) -> None:
    """A preset body or wheel."""
    page.evaluate("document.querySelector('#wheel').open = true")
    page.locator("#ready").select_option(name)
    page.evaluate("page.live.frame()")


def write(page, name: str, text: str) -> None:
    """What a reader types into the number of a quantity, and Enter."""
    page.evaluate("for (const part of document.querySelectorAll('#live details')) part.open = true")
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
        ("theta_start", "89.5°", np.radians(89.5)),
        ("slip_y_start", "−0.25", -0.25),
    ],
)
def test_any_number_within_the_limits_can_be_typed(live, name, text, value):
    start(live)
    write(live, name, text)
    within(abs(live.evaluate("(name) => page.live.present(name)", name) / value - 1), 1e-12, f"{name}, relative")
    shown = float(live.locator(f"#live [name={name}_number]").input_value())
    assert shown == pytest.approx(float(text.replace("−", "-").rstrip("°")), rel=1e-6)


def test_on_its_carrier_a_wheel_keeps_heading_and_tilt(live):
    start(live, psi_dot_start=0.7)
    beyond(np.ptp(column(live, "theta")), 0.1, "tilt of the free wheel, range in rad")
    live.locator("#guided").check()
    live.evaluate("page.live.frame()")
    assert np.ptp(column(live, "theta")) == 0 and np.ptp(column(live, "psi")) == 0
    assert live.locator("#live [name=psi_dot_start]").is_hidden() and live.locator("#critical").is_hidden()
    live.locator("#guided").uncheck()
    live.evaluate("page.live.frame()")
    beyond(np.ptp(column(live, "theta")), 0.1, "tilt without the carrier, range in rad")


GUIDE = """() => {
  const {guide, guideName, look} = page.stage.models[0];
  const tip = guide.up.clone().set(0, 0, 1).applyQuaternion(guide.quaternion).toArray();
  return [look.held, guide.visible && guideName.visible, tip];
}"""
SYMBOLS = "page.plots.all.filter(({figure}) => !figure.hidden).map(({kind}) => kind.symbol)"


def test_a_steered_wheel_turns_in_its_fork_whose_moment_is_drawn(live):
    """The paper's wheel at 10 m/s, turned at 0.5 rad/s: M_guide_1 = (J_z + m R^2) omega_z psi_dot."""
    start(live, guided=1, theta_start=np.pi / 2, phi_dot_start=-10 / 0.35)
    live.evaluate("page.switches.flip('force', true)")
    assert live.evaluate("page.pose() ?? " + f"({GUIDE})()")[:2] == [True, False]  # nothing to hold yet
    live.evaluate("page.player.seek(1); page.live.frame()")
    steer = live.locator("#live [name=psi_dot_guide_number]")
    steer.fill("0.5")
    steer.press("Enter")
    live.evaluate("page.live.frame(); page.player.seek(2)")
    held, drawn, tip = live.evaluate("page.pose() ?? " + f"({GUIDE})()")
    moment = (1.8 + 20 * 0.35**2) * (-10 / 0.35) * 0.5
    assert column(live, "M_guide_1")[200] == pytest.approx(moment) == pytest.approx(-60.714, abs=1e-3)
    assert held and drawn and tip == pytest.approx([-1, 0, 0], abs=1e-6)
    assert np.ptp(column(live, "psi")) == pytest.approx(0.5 * 9) and column(live, "psi")[100] == np.pi / 2
    symbols = live.evaluate(SYMBOLS)
    assert "M_guide e_1, ┄ e_2" in symbols and "v, ┄ −R ω_z" in symbols and "ω_z" not in symbols
    live.locator("#guided").uncheck()
    live.evaluate("page.live.frame(); page.player.seek(2)")
    assert live.evaluate("page.live.trouble") is None and live.evaluate("page.live.plan.changes") == []
    assert steer.is_hidden() and "ω_z" in live.evaluate(SYMBOLS)
    assert live.evaluate("page.pose() ?? " + f"({GUIDE})()")[:2] == [False, False]


def test_where_a_wheel_slides_upright_one_diagram_has_its_speed_and_that_of_rolling(live):
    start(live, theta_start=np.pi / 2, phi_dot_start=10.0, slip_x_start=5.5, mu_max=0.35, mu_slide=0.3)
    lines = live.evaluate("page.plots.curves.find(({kind}) => kind.symbol.startsWith('v')).lines[0].points")
    _, speed, rolling = np.array(lines).T
    slip = column(live, "slip_x")
    upright = column(live, "time") < 2  # then it tips
    within(np.abs(speed - rolling - slip)[upright].max(), 1e-12, "v less the speed of rolling off the slip, m/s")
    within(
        np.abs(rolling + 0.35 * column(live, "omega_z"))[upright].max(), 1e-9, "speed of rolling off -R omega_z, m/s"
    )
    assert slip[0] == 5.5 and slip[np.argmin(abs(column(live, "time") - 2))] == 0


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("theta_start", "500", "500° is not between 0° and 180°."),
        ("r_0", "-1", "-1 is not between 0 and 100 m."),
        ("mu_max", "-1", "-1 is not between 0 and 10."),
        ("theta_start", "abc", "abc is no number."),
        ("theta_start", "89,5", "89,5 is no number: decimals follow a point, 89.5."),
        ("s", "0.01 mm", "0.01 mm is no number."),
        ("m", "", "Nothing is no number."),
    ],
)
def test_what_cannot_be_meant_is_answered_beside_its_field_and_changes_nothing(live, name, text, sentence):
    start(live)
    before = live.evaluate("page.live.plan")
    write(live, name, text)
    field = live.locator(f"#live [name={name}_number]")
    answer = field.locator("xpath=../p")
    assert (answer.inner_text(), field.input_value()) == (sentence, text)
    assert live.evaluate("page.live.plan") == before and field.get_attribute("aria-invalid") == "true"
    live.evaluate("([name, value]) => page.live.setStart(name, value)", [name, 1.25])
    live.evaluate("page.live.frame()")
    assert not answer.is_visible() and field.get_attribute("aria-invalid") == "false"


def test_a_number_keeps_its_keys_from_the_page_and_escape_leaves_it_as_it_was(live):
    shown = "[page.live.step, page.choice, page.player.speed, page.player.t, page.switches.show.force]"
    start(live)
    before = live.evaluate(shown)
    field = live.locator("#live [name=phi_dot_start_number]")
    field.focus()
    for key in ("1", "-", "+", "g", "n", "ArrowLeft", "Home"):
        live.keyboard.press(key)
    live.keyboard.press("Escape")
    assert live.evaluate(shown) == before
    assert field.input_value() == "-2" and live.evaluate("page.live.value('phi_dot_start')") == -2


RANGES = "[...document.querySelectorAll('#live [type=range]')].map((x) => [x.name, [x.min, x.max, x.step].map(Number)])"


def test_the_sliders_follow_the_wheel_and_reach_beyond_its_critical_spin(live):
    start(live)
    paper = dict(live.evaluate(RANGES))
    assert [paper[name] for name in ("phi_dot_start", "s")] == [[-12, 12, 0.05], [0, 0.1, 0.0005]]
    start(live, **COIN)
    coin = dict(live.evaluate(RANGES))
    low, high, step = coin["phi_dot_start"]
    assert -low == high > 4 * 15.31 and 100 < high / step < 500  # rad/s, the coin's critical spin
    assert coin["s"][1] == 0.004 and coin["M_3"][1] < 2e-4 and coin["r"][1] == COIN["r_0"]


def test_the_critical_spin_is_shown_and_on_which_side_the_present_spin_is(live):
    limit = critical_spin(PAPER)
    start(live, theta_start=np.pi / 2, phi_dot_start=-1.01 * limit, s=0.03)
    omega = abs(column(live, "omega_z"))
    for t, spin, side in ((0, 1.01 * limit, "above"), (5, omega[500], "below")):  # rolling friction slows it down
        live.evaluate("(t) => { page.player.seek(t); page.live.frame(); }", t)
        said = live.locator("#critical").inner_text()
        assert f"|ωz| = {spin:.2f} rad/s, {side} ωcrit = {limit:.2f} rad/s" in said
    assert omega[500] < limit


APART = {
    "leans by 62°": {"theta_start": np.radians(28), "phi_dot_start": -3.0},
    "slides": {"theta_start": np.pi / 2, "phi_dot_start": 10.0, "slip_x_start": 5.5, "mu_max": 0.35, "mu_slide": 0.3},
}


@pytest.mark.parametrize("words", APART)
def test_the_critical_spin_is_no_measure_of_a_wheel_that_leans_or_slides(live, words):
    start(live, **APART[words])
    said = live.locator("#critical")
    assert words in said.inner_text() and said.get_attribute("data-side") == "none"
    assert "stable" not in said.inner_text()


def test_the_friction_that_rolling_needs_is_shown_beside_the_grip_and_else_the_slip(live):
    start(live, at=0.5, mu_max=0.45, mu_slide=0.4)
    force = [column(live, f"lambda_{k}")[50] for k in (1, 2, 3)]
    said = live.locator("#grip-now")
    assert f"μ = {np.hypot(*force[:2]) / force[2]:.3f} now, of μmax = 0.45" in said.inner_text()
    live.evaluate("page.player.seek(0.75); page.live.frame(); page.draw()")
    slip = [column(live, name)[75] for name in ("slip_x", "slip_y")]
    words = f"at {np.hypot(*slip):.2f} m/s ({slip[0]:.2f} along, {slip[1]:.2f} across)".replace("-", "−")
    assert words in said.inner_text() and "μslide = 0.4" in said.inner_text()
    assert live.locator(".label span").inner_text() == f"slides at {np.hypot(*slip):.2f} m/s"
    assert "slides" in live.locator("#legend").inner_text() and "held" not in live.locator("#legend").inner_text()


def test_the_force_of_a_jam_which_grows_without_bound_is_no_number(live):
    """Painlevé's paradox; the same wheel beyond the jam lies flat, with its last normal force."""
    start(live, theta_start=1.2, phi_dot_start=0.0, mu_max=2.0, mu_slide=1.6, slip_y_start=3.0)
    live.evaluate("page.player.seek(10); page.draw()")
    force = live.locator(".plot output").nth(3)
    assert "lies flat" in live.evaluate("page.wheels[0].ended") and float(force.inner_text()) > 0
    start(live, **SLIDES["jams"].start)
    assert "jams" in live.evaluate("page.wheels[0].ended") and column(live, "lambda_3")[-1] > 1e5
    live.evaluate("page.player.seek(10); page.draw()")
    assert force.inner_text() == "–" and live.evaluate("page.plots.curves[3].ranges[1][1]") < 1e3
    live.evaluate("page.player.seek(0)")


def test_a_fall_that_hangs_on_rounding_says_so(live):
    start(live, theta_start=np.pi / 2, phi_dot_start=0.0)
    assert "Rounding" in live.locator("#doubt").inner_text()
    start(live, theta_start=np.pi / 2 - 1e-9, phi_dot_start=0.0)
    assert not live.locator("#doubt").is_visible()


def test_a_ready_wheel_says_which_spin_and_friction_it_has_set(live):
    start(live, s=0.02)
    choose(live, "wheel:coin")
    note, preset = live.locator("#scaled").inner_text(), live.locator("#ready")
    assert preset.input_value() == "wheel:coin" and "Council Regulation" in preset.get_attribute("title")
    assert "φ̇ is −10.4 rad/s" in note and "s is 0.0011 m" in note
    assert live.evaluate("[page.live.value('phi_dot_start'), page.live.value('s')]") == [-10.4, 0.0011]
    live.evaluate("page.live.setStart('m', 0.009); page.live.frame()")
    assert not live.locator("#scaled").is_visible() and preset.input_value() == ""


def test_a_brake_lasts_as_long_as_it_is_held_however_late_the_page_draws(live):
    """Pressed at 0.2 s and released at 1.7 s of the events' own time, both seen by the page after 2 s."""
    start(live)
    live.evaluate("""() => {
      const button = [...document.querySelectorAll('.push')].find(({textContent}) => textContent === 'brake');
      page.player.play();
      page.ticked = 1000;
      button.onpointerdown({timeStamp: 1200});
      button.onpointerup({timeStamp: 2700});
      page.player.pause();
      page.ticked = undefined;
    }""")
    changes = live.evaluate("page.live.plan.changes.map(({t, name, value}) => [t, name, value])")
    assert changes == [[pytest.approx(0.2), "M_brake", 6], [pytest.approx(1.7), "M_brake", 0]]


SLOW = """() => new Promise((done) => {
  const seen = [];
  page.draw = () => {
    for (const end = performance.now() + 150; performance.now() < end;);
    if (seen.push([document.timeline.currentTime / 1000, page.player.t]) < 4) return;
    delete page.draw;
    page.player.pause();
    done(seen);
  };
  page.player.play();
})"""


def test_the_clock_keeps_real_time_however_long_a_picture_takes(either):
    real, shown = np.diff(either.evaluate(SLOW), axis=0).T
    within(abs(real - shown).max(), 1e-9, "clock off real time from picture to picture, s")
    beyond(real.min(), 0.1, "time of a picture, s")


def test_a_wheel_that_slides_leaves_marks_and_a_band_and_names_what_it_does(live):
    """The paper's wheel at 0.45 / 0.4 slides twice; the instants are those of its record, 0.02 s apart at most."""
    start(live, mu_max=0.45, mu_slide=0.4)
    spans = live.evaluate("page.wheels[0].phases.slides")
    within(np.abs(np.array(spans) - [[0.5708, 0.9550], [1.8742, 2.1902]]).max(), 0.02, "ends of the slides, s")
    assert live.locator("#bands .slide").count() == 2
    for t, state in ((0.7, "slides"), (1.2, "rolls")):
        live.evaluate("(t) => { page.player.seek(t); page.draw(); }", t)
        assert live.locator(".label").first.get_attribute("data-state") == state


def test_the_ready_case_backspin_slides_grips_and_comes_back(live):
    start(live)
    choose(live, "wheel:backspin")
    (begin, end), *others = live.evaluate("page.wheels[0].phases.slides")
    assert begin == 0 and 0.9 < end < 1.2 and not others
    X_O = column(live, "X_O")
    assert max(X_O) > X_O[-1] and X_O[-1] < X_O[0]
    choose(live, "wheel:coin")
    assert live.evaluate("['slip_x_start', 'mu_max', 'theta_start'].map((name) => page.live.value(name))") == [
        0, 0, pytest.approx(5 * np.pi / 12)]  # fmt: skip
    assert live.evaluate("page.live.value('X_O_start')") == pytest.approx(-0.011775 * np.cos(5 * np.pi / 12))


SAME = """async ([sizes, wheels]) => {
  const {bodies, doubtOf, momentsOf} = await import('#mechanics');
  const found = Object.keys(bodies).map((name) => sizes.map((size) => momentsOf(name, size)));
  return [found, wheels.map((wheel) => doubtOf(wheel) !== null)];
}"""


def test_moments_and_doubts_of_the_page_are_those_of_the_commands(live):
    rng = np.random.default_rng(1)
    sizes = [{"m": m, "r_0": r_0, "r": r} for m, r_0, r in rng.uniform([0.01, 0.1, 0], [30, 0.6, 0.1], (40, 3))]
    largest = [[size["m"] * (size["r_0"] + size["r"]) ** 2] for size in sizes]
    j = (rng.uniform(0, 1.2, (40, 3)) * largest).tolist()
    wheels = [size | dict(zip(("J_x", "J_y", "J_z"), row, strict=True)) for size, row in zip(sizes, j, strict=True)]
    wheels += [size | moments(name, **size) for size in sizes[:10] for name in bodies()]
    found, doubts = live.evaluate(SAME, [sizes, wheels])
    assert found == [[moments(name, **size) for size in sizes] for name in bodies()]
    assert doubts == [bool(doubt(wheel)) for wheel in wheels]
    assert 5 < sum(doubts) < len(doubts) - 5


J = "['J_x', 'J_y', 'J_z'].map((name) => page.live.value(name))"


def test_the_moments_of_a_body_follow_mass_and_radii_until_one_is_set(live):
    start(live)
    choose(live, "body:torus")
    for name, value in (("m", 12.0), ("r_0", 0.25)):
        live.evaluate("([name, value]) => { page.live.setStart(name, value); page.live.frame(); }", [name, value])
    torus = moments("torus", m=12.0, r_0=0.25)
    assert live.evaluate(J) == [*torus.values()] and live.locator("#ready").input_value() == "body:torus"
    assert live.evaluate("page.live.trouble") is None
    live.evaluate("page.live.setStart('J_x', 0.5); page.live.setStart('m', 13); page.live.frame()")
    assert live.evaluate(J) == [0.5, 0.5, torus["J_z"]] and live.locator("#ready").input_value() == ""


@pytest.mark.parametrize(("plan", "words"), [({"m": 12}, "more than m (r0 + r)² = 1.47 kg m²"), ({}, None)])
def test_a_wheel_that_cannot_exist_is_remarked(live, plan, words):
    start(live, **plan)
    remark = live.locator("#doubt")
    assert remark.is_visible() is (words is not None) and (not words or words in remark.inner_text())
    choose(live, "body:torus")
    assert not remark.is_visible()


LOOK = "page.stage.models[0].look.kind"


@pytest.mark.parametrize(
    ("preset", "kind"),
    [("wheel:coin", "coin"), ("wheel:backspin", "hoop"), ("body:disc", "disc"), ("wheel:bicycle_wheel", "wheel")],
)
def test_a_body_is_drawn_as_it_is(live, preset, kind):
    start(live)
    assert live.evaluate(LOOK) == "wheel"
    choose(live, preset)
    assert live.evaluate(LOOK) == kind


def test_small_energies_and_forces_are_in_thousandths(live):
    start(live)
    units = "page.plots.all.map(({unit: {textContent}}) => textContent)"
    assert {"N", "J"} <= set(live.evaluate(units))
    choose(live, "wheel:coin")
    assert {"mN", "mJ"} <= set(live.evaluate(units))
    shown = float(live.locator(".plot:not([hidden]) output").nth(3).inner_text())
    assert shown == pytest.approx(1000 * column(live, "E")[0], abs=0.051)


def test_the_critical_spin_of_the_page_is_that_of_the_closed_form(live):
    rng = np.random.default_rng(2)
    names = ("m", "g", "r_0", "r", "J_x", "J_z")
    wheels = [dict(zip(names, row, strict=True)) for row in rng.uniform(0.05, 2.0, (40, 6)).tolist()]
    found = live.evaluate("async (wheels) => wheels.map((await import('#mechanics')).criticalSpin)", wheels)
    expected = [critical_spin(replace(PAPER, **wheel)) for wheel in wheels]
    within(np.abs(np.divide(found, expected) - 1).max(), 1e-14, "critical spin, relative")
