"""Sliders and the numbers beside them; preset bodies and wheels; the critical spin; held buttons; slides."""

from dataclasses import replace

import numpy as np
import pytest
from support.bounds import within

from wheelfmu.fmu.values import bodies, moments
from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.sliding import SLIDES

from .pages import change, column, seek, start, value

UPRIGHT = np.pi / 2
COIN = {"m": 0.0085, "r_0": 0.011775, "r": 0.0011, "J_x": 3.556802865e-7, "J_y": 3.556802865e-7, "J_z": 7.0450390625e-7}
BACKSPIN = {"theta_start": UPRIGHT, "phi_dot_start": 10.0, "slip_x_start": 5.5, "mu_max": 0.35, "mu_slide": 0.3}


def choose(page, name: str) -> None:
    """A preset body or wheel."""
    page.evaluate("document.querySelector('#wheel').open = true")
    page.locator("#ready").select_option(name)
    page.evaluate("page.live.frame()")


def write(page, name: str, text: str) -> None:
    """Types into the number of a quantity, and Enter."""
    page.evaluate("for (const part of document.querySelectorAll('#live details')) part.open = true")
    field = page.locator(f"#live [name={name}_number]")
    field.fill(text)
    field.press("Enter")
    page.evaluate("page.live.frame()")


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("phi_dot_start", "-2.6315", -2.6315),
        ("phi_dot_start", "-200", -200.0),  # beyond the slider
        ("theta_start", "61.23", np.radians(61.23)),
        ("s", "0.01234", 0.01234),
    ],
)
def test_any_number_within_the_limits_can_be_typed(live, name, text, expected):
    start(live)
    write(live, name, text)
    within(abs(value(live, name) / expected - 1), 1e-12, f"{name}, relative")
    assert float(live.locator(f"#live [name={name}_number]").input_value()) == pytest.approx(float(text), rel=1e-6)


@pytest.mark.parametrize(("name", "text"), [("theta_start", "500"), ("r_0", "-1"), ("mu_max", "10.1"), ("m", "")])
def test_a_number_beyond_the_limits_is_marked_stays_to_be_mended_and_changes_nothing(live, name, text):
    start(live)
    before = live.evaluate("page.live.plan")
    write(live, name, text)
    field = live.locator(f"#live [name={name}_number]")
    state = "({validity, validationMessage, value}) => [validity.valid, validationMessage > '', value]"
    assert field.evaluate(state) == [False, True, text] and live.evaluate("page.live.plan") == before
    field.press("Escape")
    change(live, **{name: 1.25})
    assert field.evaluate(state)[:2] == [True, False]


def test_a_number_keeps_its_keys_from_the_page_and_escape_leaves_it_as_it_was(live):
    shown = "[page.live.step, page.choice, page.player.speed, page.player.t, page.switches.show.force]"
    start(live)
    before = live.evaluate(shown)
    field = live.locator("#live [name=phi_dot_start_number]")
    field.focus()
    for key in ("1", "-", "+", "g", "n", "ArrowLeft", "Home", "Escape"):
        live.keyboard.press(key)
    assert live.evaluate(shown) == before
    assert field.input_value() == "-2" and value(live, "phi_dot_start") == -2


def test_on_its_carrier_a_wheel_keeps_heading_and_tilt(live):
    start(live, psi_dot_start=0.7)
    for guided in (True, False):
        live.locator("#guided").set_checked(guided)
        live.evaluate("page.live.frame()")
        ranges = [np.ptp(column(live, name)) for name in ("theta", "psi")]
        assert max(ranges) == 0 if guided else min(ranges) > 0.1
        hidden = [live.locator(place).is_hidden() for place in ("#live [name=psi_dot_start]", "#critical")]
        assert hidden == [guided, guided]


GUIDE = """() => {
  page.pose();
  const {guide, guideName, look} = page.stage.models[0];
  const tip = guide.up.clone().set(0, 0, 1).applyQuaternion(guide.quaternion).toArray();
  return [look.held, guide.visible && guideName.visible, tip];
}"""
SYMBOLS = "page.plots.all.filter(({figure}) => !figure.hidden).map(({kind}) => kind.symbol)"


def test_a_steered_wheel_turns_in_its_fork_whose_moment_is_drawn(live):
    """The paper's wheel at 10 m/s, turned at 0.5 rad/s: M_guide_1 = (J_z + m R^2) omega_z psi_dot."""
    start(live, guided=1, theta_start=UPRIGHT, phi_dot_start=-10 / 0.35)
    live.evaluate("page.switches.flip('force', true)")
    assert live.evaluate(GUIDE)[:2] == [True, False]  # nothing to hold yet
    seek(live, 1)
    write(live, "psi_dot_guide", "0.5")
    seek(live, 2)
    held, drawn, tip = live.evaluate(GUIDE)
    moment = (1.8 + 20 * 0.35**2) * (-10 / 0.35) * 0.5
    assert column(live, "M_guide_1")[200] == pytest.approx(moment) == pytest.approx(-60.714, abs=1e-3)
    assert held and drawn and tip == pytest.approx([-1, 0, 0], abs=1e-6)
    assert np.ptp(column(live, "psi")) == pytest.approx(0.5 * 9) and column(live, "psi")[100] == UPRIGHT
    symbols = live.evaluate(SYMBOLS)
    assert "M_guide e_1, ┄ e_2" in symbols and "v, ┄ −R ω_z" in symbols and "ω_z" not in symbols
    live.locator("#guided").uncheck()
    seek(live, 2)
    assert live.evaluate("[page.live.trouble, page.live.plan.changes]") == [None, []]
    assert live.locator("#live [name=psi_dot_guide_number]").is_hidden() and "ω_z" in live.evaluate(SYMBOLS)
    assert live.evaluate(GUIDE)[:2] == [False, False]


def test_where_a_wheel_slides_upright_one_diagram_has_its_speed_and_that_of_rolling(live):
    start(live, **BACKSPIN)
    lines = live.evaluate("page.plots.curves.find(({kind}) => kind.symbol.startsWith('v')).lines[0].points")
    upright = column(live, "time") < 2  # then it tips
    _, speed, rolling = np.array(lines).T[:, upright]
    slip, omega = (column(live, name)[upright] for name in ("slip_x", "omega_z"))
    within(np.abs(speed - rolling - slip).max(), 1e-12, "v less the speed of rolling off the slip, m/s")
    within(np.abs(rolling + 0.35 * omega).max(), 1e-9, "speed of rolling off -R omega_z, m/s")
    assert slip[0] == 5.5 and slip[-1] == 0


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


LIMIT = critical_spin(PAPER)
SLOWED = {"theta_start": UPRIGHT, "phi_dot_start": -1.01 * LIMIT, "s": 0.03}


@pytest.mark.parametrize(
    ("values", "t", "words", "side"),
    [
        (SLOWED, 0, f"|ωz| = {{:.2f}} rad/s, above ωcrit = {LIMIT:.2f} rad/s", "above"),
        (SLOWED, 5, f"|ωz| = {{:.2f}} rad/s, below ωcrit = {LIMIT:.2f} rad/s", "below"),
        ({"theta_start": np.radians(28), "phi_dot_start": -3.0}, 0, "leans by 62°", "none"),
        (BACKSPIN, 0, "this one slides", "none"),
    ],
)
def test_the_present_spin_is_compared_with_the_critical_one_unless_the_wheel_leans_or_slides(
    live, values, t, words, side
):
    start(live, at=t, **values)
    said = live.locator("#critical")
    assert words.format(abs(column(live, "omega_z")[100 * t])) in said.inner_text()
    assert said.get_attribute("data-side") == side and ("stable" in said.inner_text()) is (side != "none")


def test_a_slide_leaves_marks_and_the_friction_that_rolling_needs_and_else_the_slip_are_shown(live):
    """The paper's wheel at 0.45 / 0.4 slides twice; the instants are those of its record, 0.02 s apart at most."""
    start(live, at=0.5, mu_max=0.45, mu_slide=0.4)
    spans = live.evaluate("page.wheels[0].phases.slides")
    within(np.abs(np.array(spans) - [[0.5708, 0.9550], [1.8742, 2.1902]]).max(), 0.02, "ends of the slides, s")
    assert live.locator("#bands .slide").count() == 2
    assert "slides" in live.locator("#legend").inner_text() and "held" not in live.locator("#legend").inner_text()
    said, label = live.locator("#grip-now"), live.locator(".label").first
    force = [column(live, f"lambda_{k}")[50] for k in (1, 2, 3)]
    assert f"μ = {np.hypot(*force[:2]) / force[2]:.3f} now, of μmax = 0.45" in said.inner_text()
    assert label.get_attribute("data-state") == "rolls"
    seek(live, 0.75)
    slip = [column(live, name)[75] for name in ("slip_x", "slip_y")]
    words = f"at {np.hypot(*slip):.2f} m/s ({slip[0]:.2f} along, {slip[1]:.2f} across)".replace("-", "−")
    assert words in said.inner_text() and "μslide = 0.4" in said.inner_text()
    assert label.get_attribute("data-state") == "slides"
    assert label.locator("span").inner_text() == f"slides at {np.hypot(*slip):.2f} m/s"


def test_the_force_of_a_jam_which_grows_without_bound_is_no_number(live):
    """Painlevé's paradox; the same wheel beyond the jam lies flat, with its last normal force."""
    start(live, at=10, theta_start=1.2, phi_dot_start=0.0, mu_max=2.0, mu_slide=1.6, slip_y_start=3.0)
    force = live.locator(".plot output").nth(3)
    assert "lies flat" in live.evaluate("page.wheels[0].ended") and float(force.inner_text()) > 0
    start(live, at=10, **SLIDES["jams"].start)
    assert "jams" in live.evaluate("page.wheels[0].ended") and column(live, "lambda_3")[-1] > 1e5
    assert force.inner_text() == "–" and live.evaluate("page.plots.curves[3].ranges[1][1]") < 1e3


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, ""),
        ({"theta_start": UPRIGHT, "phi_dot_start": 0.0}, "Rounding"),
        ({"theta_start": UPRIGHT - 1e-9, "phi_dot_start": 0.0}, ""),
    ],
)
def test_a_fall_that_hangs_on_rounding_is_remarked(live, values, words):
    start(live, **values)
    remark = live.locator("#doubt")
    assert remark.is_visible() is bool(words) and words in remark.inner_text()


def test_a_preset_wheel_starts_as_fast_for_its_size_and_a_case_as_it_is_thrown(live):
    start(live, s=0.02)
    choose(live, "wheel:backspin")
    (begin, end), *others = live.evaluate("page.wheels[0].phases.slides")
    assert begin == 0 and 0.9 < end < 1.2 and not others
    X_O = column(live, "X_O")
    assert max(X_O) > X_O[-1] and X_O[-1] < X_O[0]
    choose(live, "wheel:coin")
    preset = live.locator("#ready")
    assert preset.input_value() == "wheel:coin" and "Council Regulation" in preset.get_attribute("title")
    assert [value(live, name) for name in ("phi_dot_start", "s", "slip_x_start", "mu_max")] == [-10.4, 0.0011, 0, 0]
    assert value(live, "X_O_start") == pytest.approx(-0.011775 * np.cos(5 * np.pi / 12))
    change(live, m=0.009)
    assert preset.input_value() == ""
    start(live)
    choose(live, "wheel:coin")
    assert value(live, "s") == 0  # as it was


LOOKS = {"wheel:coin": "coin", "wheel:backspin": "hoop", "body:disc": "disc", "wheel:bicycle_wheel": "wheel"}


def test_a_body_is_drawn_as_it_is_and_small_energies_have_their_digits(live):
    for preset, kind in LOOKS.items():
        start(live)
        look = "page.stage.models[0].look.kind"
        assert live.evaluate(look) == "wheel"
        choose(live, preset)
        assert live.evaluate(look) == kind
        shown = live.evaluate("page.draw() ?? page.plots.curves.at(-1).values.textContent")
        assert float(shown) == pytest.approx(column(live, "E")[0], rel=0.01)


J = "['J_x', 'J_y', 'J_z'].map((name) => page.live.value(name))"


def test_the_moments_of_a_body_follow_mass_and_radii_until_one_is_set(live):
    start(live)
    choose(live, "body:torus")
    change(live, m=12.0, r_0=0.25)
    torus = moments("torus", m=12.0, r_0=0.25)
    assert live.evaluate(J) == [*torus.values()] and live.locator("#ready").input_value() == "body:torus"
    assert live.evaluate("page.live.trouble") is None
    change(live, J_x=0.5, m=13)
    assert live.evaluate(J) == [0.5, 0.5, torus["J_z"]] and live.locator("#ready").input_value() == ""


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


SAME = """async ([sizes, wheels]) => {
  const {bodies, criticalSpin, momentsOf} = await import('#mechanics');
  return [Object.keys(bodies).map((name) => sizes.map((size) => momentsOf(name, size))), wheels.map(criticalSpin)];
}"""


def test_moments_and_critical_spins_of_the_page_are_those_of_the_commands(live):
    random = np.random.default_rng(1).uniform([0.01, 0.1, 0], [30, 0.6, 0.1], (40, 3))
    sizes = [{"m": m, "r_0": r_0, "r": r} for m, r_0, r in random.tolist()]
    wheels = [size | moments(name, **size) | {"g": 1.6} for size in sizes for name in bodies()]
    found, spins = live.evaluate(SAME, [sizes, wheels])
    assert found == [[moments(name, **size) for size in sizes] for name in bodies()]
    expected = [critical_spin(replace(PAPER, **wheel)) for wheel in wheels]
    within(np.abs(np.divide(spins, expected) - 1).max(), 1e-14, "critical spin, relative")
