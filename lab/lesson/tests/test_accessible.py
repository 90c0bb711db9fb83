"""Accessible to all: the rules of axe-core, live regions, radio groups by keys, contrast, colour blindness, paper."""

import pytest
from axe_playwright_python.sync_playwright import Axe
from coloraide import Color
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


GROUPS = {  # of each page, what is chosen in the end
    "Picture": ("live", "page.lesson.picture", "sliding"),
    "View": ("recorded", "page.choice", 3),
}


@pytest.mark.parametrize("group", GROUPS)
def test_arrow_keys_move_through_a_radio_group(tab, group):
    kind, chosen, last = GROUPS[group]
    page = tab(kind)
    if kind == "live":
        open_step(page, 11)
    radios = page.get_by_role("radiogroup", name=group).get_by_role("radio")
    radios.first.focus()
    t = page.evaluate("page.player.t")
    for k in range(1, radios.count()):
        page.keyboard.press("ArrowRight")
        assert radios.nth(k).is_checked() and page.evaluate("page.player.t") == t
    assert page.evaluate(chosen) == last
    if kind == "live":
        page.evaluate("page.lesson.picture = 'precession'")


def own(page, name: str) -> Color:
    """A colour of style.css."""
    value = "(name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim()"
    return Color(page.evaluate(value, name))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_curves_bars_and_marks_have_a_contrast_of_three_to_one(live, scheme):
    """Future curves too, which are drawn in the colour of the past, but thinner."""
    live.emulate_media(color_scheme=scheme)
    paper = own(live, "--paper")
    for name in ("--stick", "--slide", "--tips", "--rights", "--force", "--momentum", "--v", "--turn", "--guide"):
        beyond(own(live, name).contrast(paper), 3, f"contrast of {name}")
    for k in range(6):
        beyond(own(live, f"--wheel-{k}").contrast(paper), 3, f"contrast of --wheel-{k}")
    assert own(live, "--rule").contrast(paper) < 3  # of the grid
    live.emulate_media(color_scheme="light")


APART = [
    ("--tips", "--rights"),
    ("--slide", "--wheel-0"),
    ("--slide", "--stick"),
    ("--v", "--turn"),
    ("--wheel-0", "--wheel-2"),
]


@pytest.mark.parametrize("eyes", ["deutan", "protan"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_colours_that_mean_something_else_stay_apart_for_colour_blind_eyes(live, scheme, eyes):
    live.emulate_media(color_scheme=scheme)

    def distance(*pair: Color) -> float:
        a, b = (colour.filter(eyes) for colour in pair)
        return a.delta_e(b)

    for pair in APART:
        beyond(distance(*(own(live, name) for name in pair)), 20, f"distance of {pair} in CIELAB")
    assert distance(Color("rgb(80% 30% 10%)"), Color("rgb(45% 50% 10%)")) < 20  # red and green
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
    beyond(own(live, "--soft").contrast(own(live, "--paper")), 4.5, "contrast of the legend on paper")
    assert live.locator("#legend").is_visible() and live.locator("#story .text").is_visible()
    assert not live.locator("#transport").is_visible() and not live.locator("header button").first.is_visible()
    live.emulate_media(media="screen", color_scheme="light")
