"""The rules of axe-core on both pages: cards, tabs and colours, light and dark."""

import pytest
from axe_playwright_python.sync_playwright import Axe

from .pages import start

CARDS = ("help", "take")


def violations(page) -> list[str]:
    found = Axe().run(page).response["violations"]
    return [f"{rule['id']} ({rule['impact']}): {node['html'][:100]}" for rule in found for node in rule["nodes"]]


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_pages_break_no_rule_of_accessibility(either, scheme):
    either.emulate_media(color_scheme=scheme)
    either.wait_for_function("(scheme) => document.documentElement.dataset.theme === scheme", arg=scheme)
    assert violations(either) == []
    for card in CARDS:
        either.locator(f"[popovertarget={card}]").click()
        assert violations(either) == []
        either.keyboard.press("Escape")
    either.emulate_media(color_scheme="light")


@pytest.mark.parametrize("theta", [1.5, 0.5])  # near upright, and not
def test_the_panel_breaks_none_with_all_its_parts_open(live, theta):
    start(live, at=0.7, theta_start=theta, mu_max=0.45, mu_slide=0.4, m=12)
    live.evaluate("document.querySelector('#wheel').open = true; page.live.refusal = 'A wrong address.'")
    live.evaluate("page.live.frame(); page.draw()")
    for tab in ("story", "scenes"):
        live.locator(f"#live [name={tab}]").click()
        live.evaluate("page.player.pause(); page.live.frame()")
        assert violations(live) == []
    live.evaluate("document.querySelector('main').append(document.createElement('button'))")
    assert any("button-name" in rule for rule in violations(live))
    live.evaluate("document.querySelector('main > button').remove()")
