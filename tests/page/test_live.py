"""The live page in headless Chromium: the wheel itself in WebAssembly, and the FMU beside it."""

import numpy as np
import pytest
from page.pages import column, do, start

from wheelfmu.fmu.driver import FMU2Wheel

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
  const list = changes.map(([t, name, value]) => ({t, name, value}));
  const {table, ended} = page.live.fmu.run({values, changes: list, stop: 10, record});
  return [record.map((name) => [...table.columns[name]]), ended];
}"""
CHANGES = "page.live.plan.changes.map(({t, name, value}) => [t, name, value])"


def by_fmu(fmu: FMU2Wheel, values: dict, changes: list) -> np.ndarray:
    """The same calls that the page makes, to the native library."""
    fmu.start(**values)
    rows = [fmu.get(*NAMES)]
    for k in range(1000):
        fmu.set(**{name: value for t, name, value in changes if round(t / STEP) == k})
        fmu.fmi2DoStep(fmu.component, k * STEP, STEP, 1)
        rows.append(fmu.get(*NAMES))
    return np.array(rows)


@pytest.mark.parametrize("scene", SCENES)
def test_the_wheel_in_the_page_has_the_bits_of_the_fmu(live, wheel, scene):
    values, changes = SCENES[scene]
    columns, ended = live.evaluate(RUN, [values, changes, list(NAMES)])
    assert ended is None
    assert np.array(columns).T.tobytes() == by_fmu(wheel(), values, changes).tobytes()
    other = by_fmu(wheel(), {**values, "phi_dot_start": np.nextafter(-2.0, 0)}, changes)
    assert np.array(columns).T.tobytes() != other.tobytes()


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
        energy[way] = column(live, "E")[[100, 120]]
        button.dispatch_event("pointerup", {"pointerId": 1})
    assert energy["forward"][1] > energy["forward"][0] == energy["back"][0] > energy["back"][1]


def test_an_impossible_start_is_refused_with_the_wheels_own_sentence(live):
    start(live)
    for r_0, words in ((-1, "r_0"), (0.3, "computed in")):
        live.evaluate("(r_0) => { page.live.setStart('r_0', r_0); page.live.frame(); }", r_0)
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
