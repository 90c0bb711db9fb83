"""What both pages share: keys, mouse, cards, tooltips, and their layout on a screen and on a phone."""

import numpy as np
import pytest
from playwright.sync_api import BrowserContext
from support.bounds import beyond, within

from .pages import open_step, opened, seek, window_of

CAMERA = "[...page.stage.camera.position]"


def test_keys_move_the_time_and_switch_what_is_shown(either):
    either.evaluate("page.player.seek(2); document.activeElement.blur()")
    for key in ("ArrowRight", "Shift+ArrowRight"):
        either.keyboard.press(key)
    assert either.evaluate("page.player.t") == pytest.approx(2.55)
    either.keyboard.press("Home")
    assert either.evaluate("page.player.t") == 0
    either.keyboard.press(" ")
    either.wait_for_function("page.player.t > 0.05")
    either.keyboard.press(" ")
    assert not either.evaluate("page.player.playing")
    for shown in (True, False):
        either.keyboard.press("?")
        assert either.locator("#help").is_visible() is shown


def test_a_key_shows_and_hides_the_force_of_the_ground(recorded):
    for shown in (True, False):
        recorded.keyboard.press("g")
        assert recorded.evaluate("page.pose() ?? page.stage.models[0].arrows.get('F').group.visible") is shown


def test_keys_of_buttons_that_the_lesson_hides_do_nothing(live):
    open_step(live, 2)
    for key in ("a", "g"):
        live.keyboard.press(key)
    assert not live.evaluate("page.switches.show.axes || page.switches.show.force")


def test_a_number_chooses_what_is_shown(recorded):
    for key, names in (("3", ["free"]), ("1", ["free", "friction"])):
        recorded.keyboard.press(key)
        assert recorded.evaluate("page.shown.map(({name}) => name)") == names


@pytest.mark.parametrize("by", ["mouse", "keyboard"])
def test_the_mouse_and_arrow_keys_turn_the_view(either, by):
    before = either.evaluate(CAMERA)
    either.evaluate("page.player.seek(0.25)")
    if by == "mouse":
        either.hover("#stage", position={"x": 100, "y": 100})
        either.mouse.down()
        either.hover("#stage", position={"x": 220, "y": 120})
        either.mouse.up()
    else:
        either.locator("#stage").focus()
        either.keyboard.press("ArrowLeft")
    moved = f"(before) => {CAMERA}.some((x, i) => Math.abs(x - before[i]) > 0.02)"  # it comes to rest by and by
    either.wait_for_function(moved, arg=before)
    assert either.evaluate("page.player.t") == 0.25
    either.keyboard.press("r")


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


TOOLTIPS = """all => all.map((x) => [x.title || x.closest('label')?.title || '', x.outerHTML])"""


def test_every_button_has_a_tooltip_and_every_diagram_a_name(either):
    tooltips = either.eval_on_selector_all("button, summary, input[type=range], #toggles label", TOOLTIPS)
    assert len(tooltips) > 12 and [button for title, button in tooltips if not title] == []
    diagrams = either.eval_on_selector_all(".plot:not([hidden]) canvas", "all => all.map((x) => x.ariaLabel)")
    assert len(set(diagrams)) == len(diagrams) > 0 and all(len(name) > 20 for name in diagrams)  # for screen readers


@pytest.fixture(scope="module")
def phone(browser) -> BrowserContext:
    return window_of(browser, viewport={"width": 360, "height": 740}, has_touch=True, is_mobile=True)


SMALL = """() => [...document.querySelectorAll('button, select, summary, #toggles label, #live input')]
  .filter((part) => !['checkbox', 'radio'].includes(part.type) && part.checkVisibility())
  .filter((part) => part.getBoundingClientRect().height < 43.5)
  .map(({outerHTML}) => outerHTML.slice(0, 80))"""


@pytest.mark.parametrize("kind", ["recorded", "live"])
def test_a_phone_shows_everything_without_scrolling_sideways_and_as_high_as_a_finger(phone, request, kind):
    with opened(phone, request.getfixturevalue(f"{kind}_file")) as page:
        for step in range(1, 12 if kind == "live" else 2):
            if kind == "live":
                open_step(page, step)
            assert page.evaluate("document.documentElement.scrollWidth") <= 360, step
        edges = page.evaluate("page.stage.rectangles.map(({y}) => y)")
        assert len(set(edges)) == len(edges)  # above each other
        assert page.evaluate(SMALL) == []
        page.evaluate("page.player.pause(); page.player.seek(0)")
        page.locator("#play").tap()
        page.wait_for_function("page.player.t > 0.05")


CUT_OFF = """() => [...document.querySelectorAll('[popover]')].map((card) => {
  card.showPopover();
  const cut = card.scrollWidth - card.clientWidth;
  card.hidePopover();
  return cut;
})"""


def test_on_a_phone_a_card_cuts_nothing_off(phone, live_file):
    with opened(phone, live_file, "step=4") as page:
        assert page.evaluate(CUT_OFF) == [0, 0]  # px
        page.add_style_tag(content="#help dl { width: 600px }")
        assert max(page.evaluate(CUT_OFF)) > 10


def test_on_a_phone_on_its_side_scene_clock_and_words_are_in_sight_together(browser, live_file):
    size = {"width": 844, "height": 390}
    with opened(window_of(browser, viewport=size, has_touch=True, is_mobile=True), live_file, "step=4") as page:
        for place in ("#scene", "#play", "#time", "#live [name=next]", "#story h2"):
            box = page.locator(place).bounding_box()
            assert box["y"] >= 0 and box["y"] + box["height"] <= 390 and box["x"] + box["width"] <= 844, place
        assert page.locator("#scene").bounding_box()["height"] > 250
        assert page.locator("#time").bounding_box()["width"] > 200
        assert page.evaluate(SMALL) == [] and page.evaluate("document.documentElement.scrollWidth") <= 844


COVERS = """() => [...document.querySelectorAll('#labels .label, #legend, #live')].map((card) => {
  const {left, right, top, bottom} = card.getBoundingClientRect();
  const {stage, wheels} = page;
  const scene = stage.canvas.getBoundingClientRect();
  const model = stage.models[0];
  page.draw();
  const point = model.contact.getWorldPosition(model.contact.position.clone()).project(stage.eye);
  const [x, y] = [scene.left + (1 + point.x) / 2 * scene.width, scene.top + (1 - point.y) / 2 * scene.height];
  return x > left && x < right && y > top && y < bottom;
})"""


@pytest.mark.parametrize("size", [(1280, 720), (360, 740)])
@pytest.mark.parametrize("step", [2, 3, 6, 9, 10, 11])
def test_words_and_cards_hide_neither_contact_nor_controls(window, live_file, step, size):
    """The contact is in sight, and on a screen the words, the controls and both diagrams need no scrolling."""
    with opened(window, live_file, f"step={step}") as page:
        page.set_viewport_size({"width": size[0], "height": size[1]})
        open_step(page, step)
        for t in (0.2, 1.0):
            seek(page, t)
            assert not any(page.evaluate(COVERS))
        if size[0] < 1000:
            return
        parts = page.locator("#story, #controls .knob, .plot, #transport").all()
        boxes = [part.bounding_box() for part in parts if part.is_visible()]
        assert len(boxes) > 3 and all(box["y"] + box["height"] <= size[1] for box in boxes)
        page.add_style_tag(content="#story { font-size: 40px }")
        assert page.evaluate(
            "(({scrollHeight, clientHeight}) => scrollHeight > clientHeight)(document.querySelector('#live'))"
        )
