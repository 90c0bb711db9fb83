"""The lesson: the text of every step holds for its motion, questions keep their secret, and values act as they say."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from support.bounds import within

from wheelfmu.fmu.presets import bodies, moments
from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER

from .pages import change, column, do, numbers, open_step, parameters, seek, start

STEPS, FREE = 11, 11
ASKING = (2, 4, 5, 10)
PLAY = (
    "(t) => { page.player.play(); page.lesson.frame(); page.player.pause(); page.player.seek(t); page.lesson.frame(); }"
)


def lean(page, wheel: int = 0) -> np.ndarray:
    """From upright, deg."""
    return abs(90 - np.degrees(column(page, "theta", wheel)))


def between(page, begin: float, end: float) -> np.ndarray:
    """Rows of this span."""
    t = column(page, "time")
    return (t >= begin) & (t <= end)


def test_the_wheel_rolls_with_its_spin_times_its_radius_and_tips_unless_it_is_pushed(live):
    spin, radius, speed, t, tipped, most = numbers(open_step(live, 1).split("slide there")[1])
    assert column(live, "v_x")[0] == pytest.approx(speed, abs=5e-3) and spin * radius == pytest.approx(speed, abs=0.01)
    assert np.interp(t, column(live, "time"), lean(live)) == pytest.approx(tipped, abs=0.5)
    assert lean(live).max() == pytest.approx(most, abs=0.05) and most > 20
    do(live, 0, M_3=-6)
    do(live, 1, M_3=0)
    assert lean(live).max() < 5


def test_a_leaning_wheel_turns_towards_its_lean_and_does_not_fall(live):
    most = numbers(open_step(live, 2))[-1]
    assert lean(live)[0] == pytest.approx(15) and lean(live).max() == pytest.approx(most, abs=0.05) and most < 30
    assert np.ptp(column(live, "psi")) > np.pi and column(live, "psi_dot")[1:50].min() > 0
    change(live, spin=0)
    assert lean(live).max() > 89.9  # as the step says of a wheel without any


def test_the_bars_of_the_third_step_meet_at_the_critical_spin_of_the_fourth(live):
    tips, rights = map(float, re.findall(r"= ([\d.]+)", open_step(live, 3)))
    limit, high, low = numbers(open_step(live, 4).split("ωcrit")[1])
    assert limit == pytest.approx(critical_spin(PAPER), abs=5e-3) == pytest.approx(np.sqrt(tips / rights), abs=0.02)
    assert lean(live, 1).max() == pytest.approx(high, abs=0.05) and high < 10
    assert lean(live).max() == pytest.approx(low, abs=0.05) and low > 20
    spins = [-column(live, "omega_z", k)[0] / critical_spin(PAPER) for k in (0, 1)]
    assert spins == pytest.approx([0.9, 1.1], abs=1e-3)


def test_without_friction_it_comes_down_to_one_lean_in_every_swing(live):
    said = numbers(open_step(live, 5))[0]
    leans = lean(live)
    lowest = leans[1:-1][(leans[1:-1] > leans[:-2]) & (leans[1:-1] > leans[2:])]
    assert len(lowest) >= 6 and lowest == pytest.approx(said, abs=0.1) and leans.min() == pytest.approx(15)


def test_friction_stops_the_spin_and_holds_it(live):
    first, _, count = numbers(open_step(live, 6).split("At ")[1])
    assert first == pytest.approx(1.2255, abs=5e-3) and count == 37  # the trusted table


def test_a_held_wheel_nods_and_turns_and_loses_no_energy(live, simulate):
    lasted, turned = numbers(open_step(live, 7).split("first time")[1])[:2]
    start_values = live.evaluate("page.lesson.plan.values")
    rows = simulate(
        start_values=start_values, stop_time=4, output_interval=1e-3, output=["omega_z", "psi", "E", "theta"]
    )
    held = np.flatnonzero(rows["omega_z"] == 0)
    first = held[: np.argmax(np.diff(held) > 1) + 1]
    assert 1e-3 * len(first) == pytest.approx(lasted, abs=6e-3)
    assert np.degrees(np.ptp(rows["psi"][first])) == pytest.approx(turned, abs=1) and turned > 10
    assert np.ptp(rows["theta"][first]) > 0.01 and np.ptp(rows["E"][first]) < 1e-6 * rows["E"][0]
    assert np.ptp(rows["E"]) > 1  # and where it is not held it loses some


def test_a_motor_adds_energy_and_the_brake_takes_it(live):
    before, after, last = (float(joules) for joules in re.findall(r"([\d.]+) J", open_step(live, 8)))
    energy = np.interp([1, 3, 7.5], column(live, "time"), column(live, "E"))
    assert [before, after, last] == pytest.approx(list(energy), abs=0.051) and before < after > last
    for begin, end in ((0, 1), (3, 6), (7.5, 10)):
        assert np.ptp(column(live, "E")[between(live, begin + 0.005, end)]) < 1e-6 * before


def test_a_locked_wheel_slides_with_a_deceleration_of_its_own(live):
    loses, later, slid, rate = (float(x) for x in re.findall(r"([\d.]+) (?:s\b|m,|m/s²)", open_step(live, 9)))
    t, slip, v = (column(live, name) for name in ("time", "slip_x", "v_x"))
    assert t[np.argmax(slip > 0)] == pytest.approx(loses, abs=0.011)
    assert t[np.argmax(column(live, "omega_z") == 0)] - loses == pytest.approx(later, abs=0.02)
    assert rate == pytest.approx(0.85 * 0.45 * 9.81, abs=5e-3)
    within(abs(np.diff(v[slip > 0.5]) / np.diff(t[slip > 0.5]) + rate).max(), 0.01, "deceleration off that, m/s²")
    way = np.hypot(np.ptp(column(live, "X_O")[t >= loses]), np.ptp(column(live, "Y_O")[t >= loses]))
    assert way == pytest.approx(slid, abs=0.06)


def test_thrown_with_backspin_it_slides_grips_and_comes_back(live):
    """The closed form of docs/physics.md."""
    v, turn, slip, grips, back = (float(x) for x in re.findall(r"([\d.]+) (?:m/s|s\b)", open_step(live, 10)))
    assert [v, turn, slip] == [2, 3.5, 5.5]
    growth = 0.85 * 0.35 * 9.81 * (1 + 20 * 0.35**2 / 1.8)
    assert grips == pytest.approx(slip / growth, abs=0.01)
    assert back == pytest.approx(0.85 * 0.35 * 9.81 * slip / growth - v, abs=6e-3)
    assert column(live, "v_x")[-1] == pytest.approx(-back, abs=6e-3)


def stops(page) -> float:
    """When it stands still, s."""
    return column(page, "time")[np.argmax(column(page, "v_x") < 1e-6)]


ATTEMPTS = {
    6: ({"s": 0.015}, lambda page: page.evaluate("page.wheels[0].phases.sticks[0][0]") > 1.3),
    10: ({"spin": -4}, lambda page: column(page, "v_x")[-1] > 0.1 and column(page, "slip_x")[-1] == 0),
    4: ({"lean": 8}, lambda page: lean(page, 1).max() > 20),
    9: ({"brake": 50}, lambda page: stops(page) < 2.47 and page.evaluate("page.wheels[0].phases.slides.length") == 0),
}


@pytest.mark.parametrize("step", ATTEMPTS)
def test_an_attempt_has_the_outcome_that_the_step_promises(live, step):
    chosen, outcome = ATTEMPTS[step]
    open_step(live, step)
    assert not outcome(live)
    change(live, **chosen)
    assert outcome(live)


def test_every_step_has_one_or_two_diagrams_and_one_to_three_controls_and_free_play_has_all(live):
    for k in range(1, STEPS):
        open_step(live, k)
        assert live.locator(".plot:visible").count() in (1, 2), k
        shown = live.locator("#controls .knob:visible").count() + live.locator("#push:visible").count()
        assert 1 <= shown <= 3, k
    open_step(live, FREE)
    controls = live.locator("#controls .knob:visible").evaluate_all(
        "all => all.map((x) => x.innerText.split(/\\s/)[0])"
    )
    assert controls == ["body", "lean", "spin", "resistance", "grip", "steer"]
    assert live.locator(".push:visible").all_inner_texts() == ["◀ push back", "brake", "push forward ▶"]


def test_a_step_keeps_nothing_of_the_one_before(live):
    """Arrows, axes, speed of the clock, view, fork, second wheel and pushes."""
    state = """() => [page.pictures, page.switches.show.axes, page.player.speed, page.player.t, page.stage.place,
      page.wheels.map(({label, parameters}) => [label, parameters.guided]), page.lesson.plan, page.plots.key]"""
    fresh = {}
    for k in range(1, STEPS + 1):
        open_step(live, k)
        fresh[k] = live.evaluate(state)
    for before in (3, 4, 7, 9):
        for k in (1, 5, 8, FREE):
            open_step(live, before, {})
            do(live, 0.5, M_3=-3)
            open_step(live, k)
            assert live.evaluate(state) == fresh[k]
    open_step(live, FREE, {"body": "coin"})
    open_step(live, 4)  # of two wheels, after one of another look
    assert live.evaluate(state) == fresh[4]
    assert fresh[9][5] == [["The wheel", 1]] and fresh[3][2] == 0.25  # what there is to keep


@pytest.mark.parametrize("step", ASKING)
def test_a_step_that_asks_shows_nothing_of_the_answer_until_it_plays(live, step):
    """Neither curve, axes, portrait, arrows, path on the ground nor words."""
    said = open_step(live, step)
    live.evaluate("page.player.play()")  # the step before plays
    asked = open_step(live, step, asks=True)
    answers = re.findall(r"\d+\.\d+", said)
    assert asked != said and answers and answers[-1] not in asked
    hidden = """[page.player.playing, page.pictures.length, page.pose() ?? page.stage.models[0].whole.visible,
      page.plots.all.every(({secret, figure}) => secret || figure.hidden)]"""
    assert live.evaluate(hidden) == [False, 0, False, True]
    ranges = """page.plots.all.filter(({figure}) => !figure.hidden).map(({ranges, kind: {form}, secret}) =>
      ranges && form !== 'circle' ? ranges[1] : null)"""
    before = live.evaluate(ranges)
    other = {"spin": -8} if step == 10 else {"lean": 30} if step == 4 else {"spin": 4}
    act = "(other) => { page.lesson.chosen = {...page.lesson.chosen, ...other}; page.lesson.run(); page.renew(); }"
    live.evaluate(act, other)
    assert live.evaluate(ranges) == before or step in (4, 10)  # another answer, and the same axes
    live.evaluate(PLAY, 0.1)
    assert live.evaluate(hidden)[2:] == [True, False]
    assert live.locator("#story .text").inner_text() == said  # nothing was guessed: nothing to wait for


FATES = [(4, 4, "Only the slower one."), (10, 3, "It comes back.")]


@pytest.mark.parametrize(("step", "count", "true"), FATES)
def test_a_picked_fate_is_judged_once_the_motion_has_shown_it(live, step, count, true):
    for k in range(count):
        open_step(live, step, asks=True)
        buttons = live.locator("#story .guess button")
        assert buttons.count() == count
        name = buttons.nth(k).inner_text()
        buttons.nth(k).focus()
        live.keyboard.press("Enter")
        assert live.evaluate("document.activeElement.id") == "play"  # the focus is not lost with the buttons
        live.evaluate(PLAY, 0.1)
        verdict = live.locator("#story .verdict")
        assert not verdict.is_visible()
        live.evaluate(PLAY, 7)
        assert verdict.inner_text() == (f"As you guessed: {true}" if name == true else f"Not so: {true}")


BEND = [(60 + 22 * i, 60 + 35 * np.sin(i)) for i in range(11)]  # CSS pixels, eleven points of a curve


def sketch(page) -> np.ndarray:
    return np.array(page.evaluate("page.plots.tilt.sketch"))


def places(page, points) -> np.ndarray:
    """Time and lean of places of the canvas."""
    (low, high), (width, height), end = page.evaluate(
        "(({ranges, sizes, player}) => [ranges[1], sizes, player.end])(page.plots.tilt)"
    )
    return np.array([[end * (x - 48) / width, low + (1 - (y - 10) / height) * (high - low)] for x, y in points])


def draw(page, points, by: str = "mouse") -> None:
    """A stroke in the diagram of the lean."""
    canvas = page.locator(".plot canvas").first
    box = canvas.bounding_box()
    if by == "finger":
        canvas.evaluate("(x) => { x.setPointerCapture = () => {}; }")
    for k, (x, y) in enumerate(points):
        there = (box["x"] + x, box["y"] + y)
        if by == "finger":
            touch = {"pointerType": "touch", "pointerId": 1, "buttons": 1, "clientX": there[0], "clientY": there[1]}
            canvas.dispatch_event("pointermove" if k else "pointerdown", touch)
            continue
        page.mouse.move(*there)
        if k == 0:
            page.mouse.down()
    page.mouse.up()


@pytest.mark.parametrize(("step", "by"), [(2, "mouse"), (5, "finger")])
def test_a_drawn_curve_bends_as_it_was_drawn_and_is_compared_with_the_true_one(live, step, by):
    """All eleven points of a stroke stay; what was drawn is judged by its mean distance."""
    open_step(live, step, asks=True)
    draw(live, BEND, by)
    drawn = sketch(live)
    assert live.evaluate("page.player.t") == 0  # drawing does not seek
    wanted = places(live, BEND)
    assert len(drawn) == 12 and drawn[1:] == pytest.approx(wanted, abs=0.5) and np.ptp(wanted[:, 1]) > 20
    live.evaluate(PLAY, 6)
    t = column(live, "time")
    inside = t <= drawn[-1, 0]
    off = abs(np.interp(t, *drawn.T) - lean(live))[inside].mean()
    assert numbers(live.locator("#story .verdict").inner_text()) == [pytest.approx(off, abs=0.06)]
    low, high = live.evaluate("page.plots.tilt.ranges[1]")
    assert low < drawn[:, 1].min() and max(lean(live).max(), drawn[:, 1].max()) < high
    open_step(live, 1)
    assert live.evaluate("page.plots.tilt.sketch") is None


def test_a_second_stroke_replaces_what_it_passes_and_no_more(live):
    open_step(live, 2, asks=True)
    second = [(128, 30), (150, 32), (172, 30)]
    draw(live, BEND)
    draw(live, second)
    drawn, again = sketch(live), places(live, second)
    kept = places(live, [point for point in BEND if not 127 < point[0] < 173])
    assert drawn[1:] == pytest.approx(np.array(sorted([*kept.tolist(), *again.tolist()])), abs=0.5)


def test_a_guess_can_be_drawn_by_arrow_keys(live):
    open_step(live, 2, asks=True)
    live.locator(".plot canvas").first.focus()
    for key in ("ArrowDown", "ArrowRight", "ArrowUp", "ArrowUp", "ArrowLeft", "ArrowUp"):
        live.keyboard.press(key)
    wanted = [[0, 15], [0.25, 5], [0.5, 5], [0.75, 15], [1, 25]]
    assert sketch(live) == pytest.approx(np.array(wanted)) and live.evaluate("page.player.t") == 0


def test_keys_and_buttons_lead_on_and_back(live):
    shown, back, on = "page.lesson.step + 1", live.locator("#live [name=back]"), live.locator("#live [name=next]")
    open_step(live, 1)
    live.evaluate("document.activeElement.blur()")
    assert back.is_disabled()
    for key, step in (("n", 2), ("n", 3), ("b", 2)):
        live.keyboard.press(key)
        assert live.evaluate(shown) == step
    live.locator("#steps").select_option("10")
    assert live.evaluate(shown) == FREE and on.is_disabled()
    live.evaluate("page.player.pause()")


# Free play


@pytest.mark.parametrize("body", ["tyre", "coin", "disc", "hoop"])
def test_a_body_has_the_moments_of_its_kind_and_ranges_that_fit_it(live, body):
    start(live, body=body)
    wheel = parameters(live)
    if body == "disc":
        known = {"m": 20, "r_0": 0.3, "r": 0.05} | moments("disc", m=20, r_0=0.3, r=0.05)
        assert "disc" in bodies()
    else:
        known = {
            "tyre": {"m": 20, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_z": 1.8},
            "coin": {"m": 0.0085, "r_0": 0.011775, "r": 0.0011},
            "hoop": {"J_z": wheel["m"] * (wheel["r_0"] + wheel["r"]) ** 2},
        }[body]
    assert {name: wheel[name] for name in known} == pytest.approx(known, rel=0.05)
    high = float(live.locator("#slider_spin").get_attribute("max"))
    limit = critical_spin(SimpleNamespace(**wheel))
    assert 3 * limit < high < 12 * limit
    assert live.evaluate("page.stage.models[0].look.kind") == {"tyre": "wheel"}.get(body, body)


def test_a_chosen_motion_is_that_of_the_fmu_to_the_bit(live, wheel):
    names = ["theta", "omega_z", "X_O", "Y_O", "lambda_3", "slip_x", "E"]

    def motion(values: dict[str, float]) -> dict[str, np.ndarray]:
        fmu = wheel()
        fmu.start(**values)
        rows = [fmu.get(*names)]
        for k in range(1000):
            assert fmu.ask("DoStep", k * 0.01, 0.01, 1) == 0
            rows.append(fmu.get(*names))
        return dict(zip(names, np.transpose(rows), strict=True))

    for chosen in ({}, {"s": 0.02, "lean": 10}, {"mu": 0.4, "spin": 3}, {"body": "disc", "spin": 5}):
        start(live, **chosen)
        values = live.evaluate("page.lesson.plan.values")
        rows = motion(values)
        assert {n: rows[n].tobytes() == column(live, n).tobytes() for n in names} == dict.fromkeys(names, True)
    values["phi_dot_start"] = np.nextafter(values["phi_dot_start"], 0)
    rows = motion(values)
    assert rows["theta"].tobytes() != column(live, "theta").tobytes()


def test_a_steered_wheel_turns_in_its_fork_whose_moment_the_fmu_gives(live):
    """M_guide_1 = (J_z + m R²) ω_z ψ̇ upright."""
    start(live, lean=0, spin=10 / 0.35, steer=0.5)
    k = 200
    assert column(live, "M_guide_1")[k] == pytest.approx(-60.714, abs=1e-3)
    assert np.ptp(column(live, "psi")) == pytest.approx(0.5 * 9) and column(live, "psi")[100] == np.pi / 2
    assert live.evaluate("page.stage.models[0].look.held") and live.locator(".plot.bars:visible").count() == 0
    change(live, steer=0)
    assert not live.evaluate("page.stage.models[0].look.held") and live.locator(".plot.bars:visible").count() == 1


def test_a_push_lasts_as_long_as_its_key_is_held_and_leaves_the_past_alone(live):
    start(live, at=1)
    before = column(live, "theta")
    live.locator(".push").first.focus()
    live.keyboard.down(" ")
    live.wait_for_function("page.player.t > 1.1")
    live.keyboard.up(" ")
    live.evaluate("page.player.pause(); page.lesson.frame()")
    (begin, *pushed), (end, *released) = live.evaluate(
        "page.lesson.plan.changes.map(({t, name, value}) => [t, name, value])"
    )
    assert (pushed, released) == (["M_3", 6], ["M_3", 0]) and end > begin == pytest.approx(1.0)
    same = before == column(live, "theta")
    assert same[:101].all() and not same[200:].any()


@pytest.mark.parametrize("spin", [2.0, -3.0])
def test_a_push_accelerates_the_wheel_along_e1_or_against_it(live, spin):
    """By the torque over the inertia about the contact; forward slows down a wheel that rolls back."""
    for way, sign in (("forward", 1), ("back", -1)):
        start(live, at=1, lean=0, spin=spin)
        button = live.locator(".push", has_text=way)
        button.dispatch_event("pointerdown", {"pointerId": 0})
        live.evaluate("page.player.pause(); page.lesson.frame()")
        before, after = np.interp([1, 1.2], column(live, "time"), column(live, "v_x"))
        assert after - before == pytest.approx(sign * 0.2 * 6 * 0.35 / (1.8 + 20 * 0.35**2))
        button.dispatch_event("pointerup", {"pointerId": 0})
        live.evaluate("page.lesson.frame()")


def test_a_button_leads_back_to_the_steps_own_start(live):
    open_step(live, 5)
    again = live.locator("#again")
    assert again.is_hidden()
    own = column(live, "theta")
    change(live, spin=4)
    again.click()
    live.evaluate("page.player.pause(); page.lesson.forget(); page.lesson.frame()")
    assert again.is_hidden() and (column(live, "theta") == own).all()


def field(page, name: str):
    return page.locator(f"#live [name={name}_number]")


def test_a_number_beyond_the_limits_is_marked_stays_to_be_mended_and_changes_nothing(live):
    start(live)
    before, spin = live.evaluate("page.lesson.plan"), field(live, "spin")
    state = "({validity, validationMessage, value}) => [validity.valid, validationMessage > '', value]"
    for text in ("2000", ""):
        spin.fill(text)
        spin.press("Enter")
        assert spin.evaluate(state) == [False, True, text]
        live.evaluate("page.lesson.frame()")
        assert live.evaluate("page.lesson.plan") == before
    spin.press("Escape")
    spin.fill("3.25")
    spin.press("Enter")
    live.evaluate("page.lesson.frame()")
    assert spin.evaluate(state)[:2] == [True, False] and column(live, "phi_dot")[0] == -3.25


def test_a_number_keeps_its_keys_from_the_page_and_escape_leaves_it_as_it_was(live):
    shown = "[page.lesson.step, page.choice, page.player.speed, page.player.t]"
    start(live)
    before, spin = live.evaluate(shown), field(live, "spin")
    spin.focus()
    for key in ("1", "-", "+", "b", "ArrowLeft", "Home", "Escape"):
        live.keyboard.press(key)
    assert live.evaluate(shown) == before and spin.input_value() == "2"


# The address


def follow(page, text: str) -> None:
    page.evaluate("(text) => { location.hash = text; }", text)
    # Within the same frame the page may have put the number of the step in front.
    arrived = r"[page.lesson.link.text, page.lesson.link.text.replace(/^step=\d+&/, '')].includes(text)"
    page.wait_for_function(f"(text) => {arrived} || page.lesson.refusal", arg=text)


def test_an_address_keeps_step_start_and_chosen_values(live):
    for text, step, spin in (("step=3&spin=4.5", 3, -4.5), ("body=coin&spin=40&mu=0.5", FREE, -40)):
        follow(live, text)
        live.evaluate("page.player.pause(); page.lesson.frame()")
        assert live.evaluate("page.lesson.step + 1") == step and column(live, "phi_dot")[0] == spin
        assert live.evaluate("page.lesson.link.write()").endswith(text)
    follow(live, "step=3")
    change(live, spin=5)
    live.wait_for_function("location.hash === '#step=3&spin=5'")


def test_steps_are_places_to_which_the_browser_goes_back(live):
    follow(live, "step=1")
    next_twice = "for (const _ of [1, 2]) document.querySelector('#live [name=next]').click()"
    for step, acts in ((2, f"{next_twice}; page.player.pause();"), (1, "")):  # and back within the same frame
        live.evaluate(f"{acts} history.back()")
        live.wait_for_function("(step) => page.lesson.step === step - 1", arg=step)


WRONG = {
    "no number": ("spin=abc", "spin = abc is no number"),
    "beyond the limits": ("s=-1", "s = -1 is not between 0 and 100"),
    "an unknown name": ("speed=3", "has no speed to set"),
    "not of this step": ("step=2&s=0.1", "step 2 has no s to set"),
    "a name of the language": ("__proto__=3", "has no __proto__ to set"),
    "a script": ("spin=<img src=x onerror=alert(1)>", "spin = <img src=x onerror=a is no number"),
    "no such body": ("body=ball", "there is no body ball"),
    "no such step": ("step=99", "there is no step 99"),
}
READ = "(text) => import('#address').then(({read}) => read(text, page.lesson.steps)).catch(({message}) => message)"


@pytest.mark.parametrize("fault", WRONG)
def test_a_wrong_address_is_refused_with_one_sentence(live, fault):
    text, sentence = WRONG[fault]
    message = live.evaluate(READ, text)
    assert sentence in message and "\n" not in message and message.endswith(".") and len(message) < 150


def test_a_wrong_address_gives_the_first_step_and_says_why(live):
    follow(live, "step=3")
    live.evaluate("location.hash = 's=<b>'")
    live.wait_for_function("!document.querySelector('#refusal').hidden")
    message = live.locator("#refusal").inner_text()
    assert message.startswith("This address cannot be shown: s = <b> is no number.")
    assert live.evaluate("[page.lesson.step, page.lesson.trouble]") == [0, None]
    live.locator("#live [name=next]").click()
    live.wait_for_function("document.querySelector('#refusal').hidden")
    live.evaluate("page.player.pause()")
    seek(live, 0)
