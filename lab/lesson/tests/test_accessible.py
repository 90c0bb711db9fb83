"""Accessible to all: the rules of axe-core, live regions, radio groups by keys, contrast, colour blindness, paper."""

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from support.bounds import beyond

from .pages import open_step, start

SCHEMES = ("light", "dark")


def violations(page) -> list[str]:
    found = Axe().run(page).response["violations"]
    return [f"{rule['id']} ({rule['impact']}): {node['html'][:100]}" for rule in found for node in rule["nodes"]]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_pages_break_no_rule_of_accessibility(either, scheme):
    either.emulate_media(color_scheme=scheme)
    assert violations(either) == []
    for card in ("help", "take"):
        either.locator(f"[popovertarget={card}]").click()
        assert violations(either) == []
        either.keyboard.press("Escape")
    either.emulate_media(color_scheme="light")


def test_neither_a_question_nor_free_play_breaks_one(live):
    open_step(live, 4, asks=True)
    assert violations(live) == []
    start(live, at=0.7, mu=0.45)
    live.evaluate("page.lesson.refusal = 'A wrong address.'; page.lesson.frame(); page.draw()")
    assert violations(live) == []
    live.evaluate("document.querySelector('main').append(document.createElement('button'))")
    assert any("button-name" in rule for rule in violations(live))
    live.evaluate("document.querySelector('main > button').remove()")


CHANGES = """(act) => {
  const regions = '[role=status], [role=alert], [role=log], [aria-live], output';
  let count = 0;
  const watch = new MutationObserver((all) => (count += all.length));
  for (const region of document.querySelectorAll(regions))
    watch.observe(region, {childList: true, subtree: true, characterData: true, attributes: true});
  for (const t of [0.1, 0.5, 1.3, 2.0, 4.0]) {
    page.player.seek(t);
    page.lesson.frame();
    page.draw();
  }
  if (act) document.querySelector('#refusal').textContent = 'A change.';
  count += watch.takeRecords().length;
  watch.disconnect();
  return count;
}"""


@pytest.mark.parametrize("step", [2, 6, 9, 11])
def test_nothing_that_changes_while_it_plays_is_a_live_region(live, step):
    open_step(live, step)
    assert live.evaluate(CHANGES, False) == 0 < live.evaluate(CHANGES, True)


@pytest.mark.parametrize("group", ["Picture", "View"])
def test_arrow_keys_move_through_a_radio_group(live, group):
    open_step(live, 11 if group == "Picture" else 4)
    radios = live.get_by_role("radiogroup", name=group).get_by_role("radio")
    radios.first.focus()
    t = live.evaluate("page.player.t")
    for k in range(1, radios.count()):
        live.keyboard.press("ArrowRight")
        assert radios.nth(k).is_checked() and live.evaluate("page.player.t") == t
    chosen = live.evaluate("page.lesson.picture" if group == "Picture" else "page.choice")
    assert chosen == ("sliding" if group == "Picture" else radios.count() - 1)
    live.evaluate("page.lesson.picture = 'precession'")


def rgb(page, name: str) -> np.ndarray:
    """A colour of style.css, parts of 1."""
    paint = """(name) => {
      const pen = Object.assign(document.createElement('canvas'), {width: 1, height: 1}).getContext('2d');
      pen.fillStyle = getComputedStyle(document.documentElement).getPropertyValue(name);
      pen.fillRect(0, 0, 1, 1);
      return [...pen.getImageData(0, 0, 1, 1).data.slice(0, 3)];
    }"""
    return np.array(page.evaluate(paint, name)) / 255


def linear(colour: np.ndarray) -> np.ndarray:
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def contrast(a: np.ndarray, b: np.ndarray) -> float:
    """WCAG 2.2: ratio of the relative luminances."""
    light = sorted(float(linear(colour) @ [0.2126, 0.7152, 0.0722]) + 0.05 for colour in (a, b))
    return light[1] / light[0]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_curves_bars_and_marks_have_a_contrast_of_three_to_one(live, scheme):
    """Future curves too, which are drawn in the colour of the past, but thinner."""
    live.emulate_media(color_scheme=scheme)
    paper = rgb(live, "--paper")
    for name in ("--stick", "--slide", "--tips", "--rights", "--force", "--momentum", "--v", "--turn", "--guide"):
        beyond(contrast(rgb(live, name), paper), 3, f"contrast of {name}")
    for k in range(6):
        beyond(contrast(rgb(live, f"--wheel-{k}"), paper), 3, f"contrast of --wheel-{k}")
    assert contrast(rgb(live, "--rule"), paper) < 3  # of the grid
    live.emulate_media(color_scheme="light")


# What deutan and protan eyes see of linear RGB: Machado, Oliveira, Fernandes 2009, severity 1.
SEEN = {
    "deutan": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "protan": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
}
APART = [
    ("--tips", "--rights"),
    ("--slide", "--wheel-0"),
    ("--slide", "--stick"),
    ("--v", "--turn"),
    ("--wheel-0", "--wheel-2"),
]
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab(colour: np.ndarray) -> np.ndarray:
    """CIELAB of linear RGB."""
    x, y, z = np.cbrt(np.clip(XYZ @ colour, 0, None) / XYZ.sum(axis=1))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


@pytest.mark.parametrize("eyes", SEEN)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_colours_that_mean_something_else_stay_apart_for_colour_blind_eyes(live, scheme, eyes):
    live.emulate_media(color_scheme=scheme)

    def distance(a: np.ndarray, b: np.ndarray) -> float:
        return float(np.linalg.norm(np.subtract(*(lab(SEEN[eyes] @ linear(colour)) for colour in (a, b)))))

    for pair in APART:
        beyond(distance(*(rgb(live, name) for name in pair)), 20, f"distance of {pair} in CIELAB")
    assert distance(np.array([0.8, 0.3, 0.1]), np.array([0.45, 0.5, 0.1])) < 20  # red and green
    live.emulate_media(color_scheme="light")


PRINTED = """() => [...document.querySelectorAll('#stage, .plot canvas')].map((canvas) => {
  const {width, height} = canvas.getBoundingClientRect();
  return width / height / (canvas.width / canvas.height);
})"""


def test_on_paper_pictures_keep_their_shape_the_legend_is_readable_and_controls_are_gone(live):
    open_step(live, 6)
    live.emulate_media(media="print", color_scheme="dark")
    live.wait_for_function(
        "getComputedStyle(document.documentElement).getPropertyValue('--paper').trim() === '#f7f8fa'"
    )
    assert live.evaluate(PRINTED) == pytest.approx([1, 1, 1], rel=0.02)
    ink, paper = rgb(live, "--soft"), rgb(live, "--paper")
    beyond(contrast(ink, paper), 4.5, "contrast of the legend on paper")
    assert live.locator("#legend").is_visible() and live.locator("#story .text").is_visible()
    assert not live.locator("#transport").is_visible() and not live.locator("header button").first.is_visible()
    live.emulate_media(media="screen", color_scheme="light")
