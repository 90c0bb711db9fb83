"""The FMU's own documentation page in a browser: it can be read without scrolling sideways."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser

# Tags of the page and of its parts that are wider or higher than the place they have.
OVERFLOWING = """() => [document.documentElement, ...document.querySelectorAll('math[display=block], table, pre, img')]
    .filter(part => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1
                    || part.getBoundingClientRect().right > window.innerWidth)
    .filter(part => part !== document.documentElement || part.scrollWidth > part.clientWidth)
    .map(part => part.tagName.toLowerCase())"""


def overflowing(browser: Browser, fmu: str, width: int) -> set[str]:
    page = browser.new_page(viewport={"width": width, "height": 900})
    page.goto((Path(fmu) / "documentation" / "index.html").as_uri())
    found = page.evaluate(OVERFLOWING)
    page.close()
    return set(found)


@pytest.mark.parametrize("width", [1280, 390])  # px: a screen, a telephone
def test_formulas_tables_and_commands_fit_the_page_without_scroll_bars(browser: Browser, fmu: str, width: int) -> None:
    assert overflowing(browser, fmu, width) == set()


def test_on_a_page_that_is_too_narrow_the_overflow_is_seen(browser: Browser, fmu: str) -> None:
    assert {"html", "math", "table"} <= overflowing(browser, fmu, 200)
