"""What both pages share: keys, mouse, cards, tooltips, and their layout on a screen and on a phone."""

import re

import numpy as np
import pytest
from playwright.sync_api import BrowserContext
from support.bounds import beyond, within

from wheelfmu.fmu.paths import ROOT

from .pages import opened, window_of

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
        either.keyboard.press("g")
        assert either.evaluate("page.pose() ?? page.stage.models[0].force.visible") is shown


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
    assert len(tooltips) > 20 and [button for title, button in tooltips if not title] == []
    diagrams = either.eval_on_selector_all(".plot:not([hidden]) canvas", "all => all.map((x) => x.ariaLabel)")
    assert len(set(diagrams)) == len(diagrams) > 2 and all(len(name) > 20 for name in diagrams)  # for screen readers


CONTROLS = "header > button, #toggles label, #live .tabs button, .push, summary, label.keep"
ARROWS = str.maketrans("", "", "⤓◀▶")


def unnamed(controls: list[str], guide: str) -> list[str]:
    """Controls whose name does not begin with a phrase that the guide sets in italics or bold."""
    marked = re.findall(r"\*+([^*]+)\*+", " ".join(guide.lower().split()))
    names = (control.translate(ARROWS).strip().lower() for control in controls)
    return [name for name in names if not any(name.startswith(phrase.strip(".")) for phrase in marked)]


def test_the_guide_names_every_control_of_the_live_page(live):
    controls = live.locator(CONTROLS).all_inner_texts()
    guide = (ROOT / "lab" / "lesson" / "README.md").read_text(encoding="utf-8")
    assert len(controls) > 14 and unnamed(controls, guide) == []
    assert unnamed(controls, guide.replace("*Values*", "").replace("*◐*", "")) == ["values", "◐"]


def test_a_site_that_shows_the_page_sets_its_colours_and_has_the_only_button_for_them(browser, recorded_file):
    with opened(window_of(browser, color_scheme="light"), recorded_file) as page:
        assert page.locator("#theme").is_visible()
        page.evaluate("postMessage({theme: 'dark'}, '*')")
        page.wait_for_function("document.documentElement.dataset.theme === 'dark'")
        assert page.locator("#theme").is_hidden()


@pytest.fixture(scope="module")
def phone(browser) -> BrowserContext:
    """One whose browser encodes no films."""
    found = window_of(browser, viewport={"width": 360, "height": 740}, has_touch=True, is_mobile=True)
    found.add_init_script("delete window.VideoEncoder")
    return found


SMALL = """() => [...document.querySelectorAll('button, select, summary, #toggles label, #live input')]
  .filter((part) => part.type !== 'checkbox' && part.checkVisibility() && !part.closest('.portrait'))
  .filter((part) => part.getBoundingClientRect().height < 43.5)
  .map(({outerHTML}) => outerHTML.slice(0, 80))"""


@pytest.mark.parametrize("kind", ["recorded", "live"])
def test_a_phone_shows_everything_without_scrolling_sideways_and_as_high_as_a_finger(phone, request, kind):
    with opened(phone, request.getfixturevalue(f"{kind}_file")) as page:
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            page.wait_for_function("(scheme) => document.documentElement.dataset.theme === scheme", arg=scheme)
            assert page.evaluate("document.documentElement.scrollWidth") <= 360
        edges = page.evaluate("page.stage.rectangles.map(({y}) => y)")
        assert len(set(edges)) == len(edges)  # above each other
        scene, switches = (page.locator(place).bounding_box() for place in ("#scene", "#toggles"))
        assert switches["y"] >= scene["y"] + scene["height"] - 2.5  # px; the switches cover no part of the scene
        film = page.locator("#take [name=film]")
        assert film.is_disabled() and "Firefox 130" in film.get_attribute("title")
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


def test_on_a_phone_a_card_cuts_nothing_off_with_two_motions(phone, live_file):
    with opened(phone, live_file, "step=4") as page:
        assert page.evaluate(CUT_OFF) == [0, 0, 0]  # px
        page.add_style_tag(content="#values table { font-size: 14px }")
        assert max(page.evaluate(CUT_OFF)) > 10


def test_on_a_phone_on_its_side_scene_clock_and_story_are_in_sight_together(browser, live_file):
    size = {"width": 844, "height": 390}
    with opened(window_of(browser, viewport=size, has_touch=True, is_mobile=True), live_file, "step=4") as page:
        for place in ("#scene", "#play", "#time", "#live [name=next]", "#story h2"):
            box = page.locator(place).bounding_box()
            assert box["y"] >= 0 and box["y"] + box["height"] <= 390 and box["x"] + box["width"] <= 844, place
        assert page.locator("#scene").bounding_box()["height"] > 250
        assert page.locator("#time").bounding_box()["width"] > 200
        page.locator("#live [name=scenes]").click()
        assert page.evaluate(SMALL) == [] and page.evaluate("document.documentElement.scrollWidth") <= 844
