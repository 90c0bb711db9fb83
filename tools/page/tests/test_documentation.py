"""Documents in a browser: the FMU's own page is read without scrolling sideways; the site's formulas."""

import subprocess
import sys
from pathlib import Path

import pytest
from playwright.sync_api import BrowserContext
from support.bounds import beyond, within
from support.paths import ROOT

# Tags of the page and of its parts that are wider or higher than the place they have.
OVERFLOWING = """() => [document.documentElement, ...document.querySelectorAll('math[display=block], table, pre, img')]
    .filter(part => part.scrollWidth > part.clientWidth + 1 || part.scrollHeight > part.clientHeight + 1
                    || part.getBoundingClientRect().right > window.innerWidth)
    .filter(part => part !== document.documentElement || part.scrollWidth > part.clientWidth)
    .map(part => part.tagName.toLowerCase())"""


def ask(window: BrowserContext, page_file: Path, question: str, width: int = 900):
    """What a document answers to a script, once its fonts are there."""
    page = window.new_page()
    page.set_viewport_size({"width": width, "height": 900})
    page.goto(page_file.as_uri())
    page.evaluate("document.fonts.ready")
    found = page.evaluate(question)
    page.close()
    return found


@pytest.mark.parametrize(("width", "parts"), [(1280, set()), (390, set()), (200, {"html", "math", "table"})])
def test_formulas_tables_and_commands_fit_a_screen_and_a_telephone_and_no_narrower_page(window, fmu, width, parts):
    overflowing = set(ask(window, Path(fmu) / "documentation" / "index.html", OVERFLOWING, width))
    assert overflowing >= parts and bool(overflowing) == bool(parts)


WRITTEN = "# A page\n\nThe radius $r_0$.\n\n```math\n" + "a + b + " * 40 + "c\n```\n"
# How far a subscript stands below its letter, in heights of the letter.
SUNK = """() => {
  const [base, low] = [...document.querySelector('msub').children].map((part) => part.getBoundingClientRect());
  return (low.bottom - base.bottom) / base.height;
}"""


@pytest.fixture(scope="module")
def small_site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    (folder / "page.md").write_text(WRITTEN)
    settings = ["-c", ROOT / "tools" / "publishing" / "site", "-D", "html_favicon=", "-D", "root_doc=page"]
    command = ["sphinx", "-q", *settings, "-b", "html", folder]
    subprocess.run([sys.executable, "-m", *map(str, command), str(folder / "out")], check=True)
    return folder / "out"


def test_a_digit_below_a_letter_is_lowered(window, small_site):
    beyond(ask(window, small_site / "page.html", SUNK), 0.1, "subscript below its letter, heights of the letter")
    (small_site / "_static" / "math.woff").rename(small_site / "math.woff")
    without = ask(window, small_site / "page.html", SUNK)
    (small_site / "math.woff").rename(small_site / "_static" / "math.woff")
    within(without, 0.1, "subscript without a font for mathematics, heights of the letter")


# Whether the formula is wider than its frame, and whether its end comes into sight by scrolling the frame alone.
SCROLLED = """() => {
  const frame = document.querySelector('math[display=block]').parentElement;
  frame.scrollLeft = 1e6;
  const end = document.querySelector('math[display=block] :is(mi, mo):last-child').getBoundingClientRect().right;
  const {documentElement: page} = document;
  return [frame.scrollWidth > frame.clientWidth, end <= innerWidth && page.scrollWidth <= page.clientWidth];
}"""


def test_a_formula_that_is_wider_than_a_telephone_scrolls_in_its_frame(window, small_site):
    assert ask(window, small_site / "page.html", SCROLLED, width=390) == [True, True]
    style = small_site / "_static" / "site.css"
    text = style.read_text()
    style.write_text(text.replace(".formula { overflow-x: auto; overflow-y: hidden;", ".formula {"))
    assert ask(window, small_site / "page.html", SCROLLED, width=390)[1] is False
    style.write_text(text)
