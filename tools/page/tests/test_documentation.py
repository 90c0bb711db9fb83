"""Documents in a browser: the FMU's own page is read without scrolling sideways."""

from pathlib import Path

import pytest

# Tags of the page and of its parts that are wider or higher than the place they have.
OVERFLOWING = """() => [document.documentElement, ...document.querySelectorAll('math[display=block], table, pre, img')]
    .filter(part => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1
                    || part.getBoundingClientRect().right > window.innerWidth)
    .filter(part => part !== document.documentElement || part.scrollWidth > part.clientWidth)
    .map(part => part.tagName.toLowerCase())"""


@pytest.mark.parametrize(("width", "parts"), [(1280, set()), (390, set()), (200, {"html", "math", "table"})])
def test_formulas_tables_and_commands_fit_a_screen_and_a_telephone_and_no_narrower_page(window, fmu, width, parts):
    page = window.new_page()
    page.set_viewport_size({"width": width, "height": 900})
    page.goto((Path(fmu) / "documentation" / "index.html").as_uri())
    page.evaluate("document.fonts.ready")
    overflowing = set(page.evaluate(OVERFLOWING))
    page.close()
    assert overflowing >= parts and bool(overflowing) == bool(parts)
