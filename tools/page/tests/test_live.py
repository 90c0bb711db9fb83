"""The live page in headless Chromium: the wheel itself in WebAssembly, and the FMU beside it."""

from __future__ import annotations

import re

import numpy as np
import pytest
from support.bounds import beyond, within
from support.driver import FMU2Wheel

from page.tests.pages import column, preset

NAMES = ("X_O", "Y_O", "psi", "theta", "phi", "omega_z", "lambda_3", "E")
STEP = 0.01  # s
SCENES = {
    "free": ({}, []),
    "friction": ({"s": 0.03}, []),
    "thin disc": ({"r": 0.0, "psi_dot_start": 1.0}, []),
    "slope": ({"slope": 0.05, "slope_direction": 0.5, "s": 0.01}, []),
    "pushed": ({"s": 0.01}, [(1.0, "M_3", -3.0), (2.0, "M_3", 0.0), (4.0, "s", 0.05)]),
}
RUN = """([values, changes, record]) => {
  const { table, ended } = page.live.fmu.run({
    values, changes: changes.map(([t, name, value]) => ({ t, name, value })), stop: 10, step: 0.01, record,
  });
  return [record.map((name) => [...table.columns[name]]), ended];
}"""


def by_fmu(fmu: FMU2Wheel, values: dict, changes: list) -> np.ndarray:
    """The same calls that the page makes, to the native library."""
    fmu.start(**values)
    rows = [fmu.get(*NAMES)]
    for k in range(1000):
        for _, name, value in [change for change in changes if round(change[0] / STEP) == k]:
            fmu.set(**{name: value})
        fmu.fmi2DoStep(fmu.component, k * STEP, STEP, 1)
        rows.append(fmu.get(*NAMES))
    return np.array(rows)


@pytest.mark.parametrize("scene", SCENES)
def test_the_wheel_in_the_page_has_the_bits_of_the_fmu(live, wheel, scene):
    values, changes = SCENES[scene]
    columns, ended = live.evaluate(RUN, [values, changes, list(NAMES)])
    assert ended is None
    expected = by_fmu(wheel(), values, changes)
    assert np.array(columns).T.tobytes() == expected.tobytes()
    other = by_fmu(wheel(), {**values, "phi_dot_start": np.nextafter(-2.0, 0)}, changes)
    assert other.tobytes() != expected.tobytes()


def test_dragging_s_changes_the_motion_from_now_on_and_not_before(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.player.seek(3)")
    before = column(live, "theta")
    slider = live.locator("#live [name=s]")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    live.mouse.move(box["x"] + 3, box["y"] + box["height"] / 2)
    live.mouse.down()
    live.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + box["height"] / 2, steps=4)
    live.mouse.up()
    live.wait_for_function("page.live.changes.length > 0 && !page.live.wanted")
    after = column(live, "theta")
    assert 0.02 < float(live.evaluate("page.live.present('s')")) < 0.06
    assert (before[:301] == after[:301]).all()
    assert abs(before - after)[400:].max() > 0.1


def test_the_future_after_a_push_is_that_of_a_run_with_that_input(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.player.seek(2); page.live.setNow('M_3', -2); page.live.compute()")
    pushed = column(live, "omega_z")
    columns, _ = live.evaluate(RUN, [{}, [[2.0, "M_3", -2.0]], ["omega_z"]])
    assert (pushed == columns[0]).all()
    live.evaluate("page.player.seek(1); page.live.setNow('M_3', 0); page.live.compute()")
    assert (column(live, "omega_z") != pushed).any()  # what was planned for later is dropped
    assert len(set(live.evaluate("page.live.changes.map(({ value }) => value)"))) == 1


def test_a_push_lasts_as_long_as_the_button_is_held(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.player.seek(1)")
    live.locator(".push").first.scroll_into_view_if_needed()
    box = live.locator(".push").first.bounding_box()
    live.mouse.move(box["x"] + 20, box["y"] + 20)
    live.mouse.down()
    live.wait_for_function("page.player.t > 1.1")
    live.mouse.up()
    live.evaluate("page.player.pause()")
    changes = live.evaluate("page.live.changes.map(({ t, name, value }) => [t, name, value])")
    assert [change[1:] for change in changes] == [["M_3", 6], ["M_3", 0]]
    assert changes[1][0] > changes[0][0] == pytest.approx(1.0)


def test_the_brake_stops_a_wheel_and_holds_it_as_long_as_the_button_is_held(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.live.setStart('theta_start', Math.PI / 2); page.live.compute(); page.player.seek(1)")
    button = live.get_by_role("button", name="brake", exact=True)
    button.dispatch_event("pointerdown", {"pointerId": 1})
    live.evaluate("page.player.pause(); page.live.compute()")
    omega, t = column(live, "omega_z"), column(live, "time")
    assert (omega[t <= 1] == -2).all()
    stop = 1 + 2 * (1.8 + 20 * 0.35**2) / 6  # s: (J_z + m R^2) omega_z / M_brake after it is pressed
    assert (omega[t > stop] == 0).all()
    assert live.evaluate("page.wheels[0].phases.sticks") == [pytest.approx([stop, 10])]
    button.dispatch_event("pointerup", {"pointerId": 1})
    changes = live.evaluate("page.live.changes.map(({ name, value }) => [name, value])")
    assert changes[-1] == ["M_brake", 0]


def test_a_wheel_let_go_falls_and_the_page_says_so(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.live.setStart('phi_dot_start', 0); page.live.compute(); page.player.seek(10)")
    live.evaluate("page.draw()")
    told = live.locator(".label span").inner_text()
    assert "flat" in told and "0.592" in told
    assert max(len(number) for number in re.findall(r"[\d.]+", told)) <= 8
    assert live.evaluate("page.player.end") == pytest.approx(0.59, abs=0.01)
    assert live.evaluate("page.wheels[0].phases.sticks") == []  # no friction holds it, omega_z is zero by itself


def test_an_impossible_start_is_refused_with_the_wheels_own_sentence(live):
    preset(live, "Paper, no friction")
    live.evaluate("page.live.setStart('r_0', -1); page.live.frame()")
    assert "r_0" in live.locator("#message").inner_text()
    preset(live, "Paper, no friction")
    live.evaluate("page.live.frame()")
    assert "computed in" in live.locator("#message").inner_text()


def test_a_tenth_of_the_spin_decides_whether_upright_rolling_is_stable(live):
    lean = {}
    for label in ("Just stable", "Just unstable"):
        preset(live, label)
        lean[label] = np.degrees(abs(column(live, "theta") - np.pi / 2).max())
    within(lean["Just stable"], 10, "largest lean above the critical spin, deg")
    beyond(lean["Just unstable"], 20, "largest lean below the critical spin, deg")


def test_every_preset_runs_to_its_end(live):
    live.locator("#live [name=scenes]").click()
    for button in live.locator("#presets button").all():
        button.click()
        assert live.evaluate("page.live.trouble ?? page.wheels[0].ended") is None
        assert live.evaluate("page.wheels[0].table.end") == pytest.approx(10)
    live.evaluate("page.player.pause()")


def test_a_kept_motion_stays_beside_the_next(live):
    preset(live, "Paper, no friction")
    live.locator("#keep").click()
    preset(live, "Paper, s = 0.03 m")
    assert live.evaluate("page.views.length") == 2
    kept, new = (live.evaluate(f"page.wheels[{i}].table.columns.E.at(-1)") for i in (1, 0))
    assert kept == pytest.approx(75.117, abs=1e-2)
    assert new < 60
    live.locator("#keep").click()
    assert live.evaluate("page.wheels.length") == 1


@pytest.mark.parametrize("spin", [-2.0, 3.0])
def test_forward_is_the_way_the_wheel_rolls_and_back_is_against_it(live, spin):
    energy = {}
    for way in ("forward", "back"):
        preset(live, "Paper, no friction")
        live.evaluate(
            """(spin) => {
              page.live.setStart('theta_start', Math.PI / 2);
              page.live.setStart('phi_dot_start', spin);
              page.live.compute();
              page.player.seek(1);
            }""",
            spin,
        )
        button = live.locator(".push", has_text=way)
        button.dispatch_event("pointerdown", {"pointerId": 1})
        live.evaluate("page.player.pause(); page.live.compute()")
        energy[way] = column(live, "E")[[100, 120]]
        button.dispatch_event("pointerup", {"pointerId": 1})
    assert energy["forward"][1] > energy["forward"][0] == energy["back"][0] > energy["back"][1]


@pytest.mark.parametrize("diagram", ["phase", "spin", "path"])
def test_while_a_button_is_held_the_diagrams_keep_their_axes(live, diagram):
    axes = """() => [[page.player.start, page.player.end],
      ...page.plots.curves.map(({ ranges }) => ranges[1]), ...page.plots.portrait.ranges]"""
    preset(live, "Paper, no friction")
    live.evaluate("(name) => { page.plots.portrait.choose(name); page.player.seek(1); }", diagram)
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
    preset(live, "Driven")
    assert live.evaluate(axes) != before


def test_every_button_has_a_tooltip_and_the_help_names_it(live):
    buttons = "button, summary, input[type=range], #toggles label"
    titles = live.eval_on_selector_all(
        buttons, "all => all.map((x) => x.title || x.closest('label')?.title || x.textContent)"
    )
    untold = live.eval_on_selector_all(
        buttons, "all => all.filter((x) => !x.title && !x.closest('label')?.title).map((x) => x.outerHTML)"
    )
    assert len(titles) > 30 and untold == []
    diagrams = live.eval_on_selector_all(".plot canvas", "all => all.map((x) => x.ariaLabel)")
    assert len(set(diagrams)) == 5 and all(len(name) > 20 for name in diagrams)  # for screen readers
    live.locator("[popovertarget=help]").click()
    text = live.locator("#help").inner_text()
    names = "Follow,Path,Axes,Force,Push forward,push back,brake,Keep this motion,Scenes,Story,Take with you"
    names += ",colours,play,Values,The wheel itself"
    assert [name for name in names.split(",") if name not in text] == []
    live.locator("[popovertarget=help]").click()


@pytest.mark.parametrize("way", ["Escape", "a click elsewhere"])
def test_a_card_closes(live, way):
    live.evaluate("document.querySelector('#help').showPopover()")
    if way == "Escape":
        live.keyboard.press("Escape")
    else:
        live.locator("h1").click()
    assert not live.evaluate("document.querySelector('#help').matches(':popover-open')")


def test_on_a_slope_the_ground_tilts_and_the_wheel_rolls_down(live):
    preset(live, "Paper, no friction")
    slope, uphill = 0.2, 2.0  # rad
    heading = np.pi + uphill  # straight down
    live.evaluate(
        """([slope, uphill, heading]) => {
          const upright = {psi_start: heading, theta_start: Math.PI / 2, phi_dot_start: 0};
          const start = {slope, slope_direction: uphill, ...upright};
          for (const [name, value] of Object.entries(start)) page.live.setStart(name, value);
          page.live.compute();
          page.draw();
        }""",
        [slope, uphill, heading],
    )
    turn = "(v) => page.stage.camera.position.clone().set(...v).applyQuaternion(page.stage.road.quaternion).toArray()"
    up = [np.sin(slope) * np.cos(uphill), np.sin(slope) * np.sin(uphill), np.cos(slope)]
    assert live.evaluate(turn, up) == pytest.approx([0, 0, 1])
    t = column(live, "time")
    distance = np.hypot(column(live, "X_O") - column(live, "X_O")[0], column(live, "Y_O") - column(live, "Y_O")[0])
    downhill = 9.81 * np.sin(slope) / (1 + 1.8 / (20 * 0.35**2))  # m/s2, g sin(slope) / (1 + J_z / (m R^2))
    early = t < 2  # a wheel that starts at rest is unstable: rounding grows
    assert distance[early] == pytest.approx(downhill * t[early] ** 2 / 2, abs=1e-6)
    height = live.evaluate(turn, [column(live, "X_O")[200], column(live, "Y_O")[200], 0])[2]
    assert height == pytest.approx(-distance[200] * np.sin(slope), abs=0.02)
    preset(live, "Paper, no friction")
    live.evaluate("page.draw()")
    assert live.evaluate(turn, up) == pytest.approx(up)


@pytest.mark.parametrize("size", [(1280, 800), (1366, 768), (390, 844)])
def test_push_and_brake_stand_in_sight_beside_play(live, size):
    live.set_viewport_size({"width": size[0], "height": size[1]})
    boxes = [live.locator(place).bounding_box() for place in ("#play", *(f".push >> nth={k}" for k in range(3)))]
    live.set_viewport_size({"width": 900, "height": 640})
    for box, other in zip(boxes, boxes[1:], strict=False):
        assert 0 <= box["x"] < other["x"] < size[0] - other["width"]
        assert abs(box["y"] - other["y"]) < 20 and other["y"] + other["height"] <= size[1]


def test_after_a_click_the_space_bar_plays_and_by_keyboard_it_presses_the_button(live):
    preset(live, "Paper, no friction")
    live.keyboard.press(" ")
    assert live.evaluate("page.player.playing")
    live.wait_for_function("/&?t=\\d/.test(location.hash)")  # the address follows while it plays
    live.evaluate("page.player.pause(); document.querySelector('#theme').focus()")
    theme = live.locator("#theme").get_attribute("title")
    live.keyboard.press(" ")
    assert live.locator("#theme").get_attribute("title") != theme and not live.evaluate("page.player.playing")
    live.locator("#theme").click()
    live.locator("#theme").click()


def test_another_wheel_fills_the_scene_and_its_values_are_listed(live):
    preset(live, "Paper, s = 0.03 m")
    disc = {"m": 0.0085, "r_0": 0.0118, "r": 0.001, "J_x": 3.5e-7, "J_y": 3.5e-7, "J_z": 7e-7}
    live.evaluate("(parts) => { page.live.setWheel(parts); page.live.compute(); page.draw(); }", disc)
    assert live.evaluate("page.live.trouble ?? page.stage.scale") == pytest.approx(0.35 / 0.0128)
    assert live.evaluate("page.live.value('s')") == pytest.approx(0.03 * 0.0128 / 0.35, rel=1e-2)
    live.locator("[popovertarget=values]").click()
    live.wait_for_selector("#values tr")
    rows = dict(row.split("\t")[:2] for row in live.locator("#values tr").all_inner_texts()[1:])
    live.locator("[popovertarget=values]").click()
    assert {name: float(rows[name]) for name in disc} == disc
    assert live.evaluate("page.live.link.write()").startswith("s=0.0011&m=0.0085&r_0=0.0118&r=0.001&J_x=3.5e-7")
    slider = live.locator("#live [name=m]")
    assert float(slider.input_value()) == pytest.approx(np.log10(disc["m"]), abs=0.01)
    preset(live, "Paper, no friction")
    assert live.evaluate("page.stage.scale") == 1
