"""The site is built with every warning as an error, and asks for nothing from elsewhere."""

from __future__ import annotations

import re
import runpy
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from fontTools.ttLib import TTFont
from lxml import html

from wheelfmu.fmu.paths import ROOT
from wheelfmu.publishing.markdown import pages

CONF = ROOT / "lab" / "site"
LOADED = re.compile(r"""<(?:script|img|iframe|source|link)\b[^>]*?\b(?:src|href)=["']((?:https?:)?//[^"']+)""")


def build(source: Path, out: Path, *more: str) -> subprocess.CompletedProcess[str]:
    words = ["-q", "-n", "-W", "--keep-going", "-c", CONF, "-d", out / "trees", "-b", "html", *more, source, out]
    return subprocess.run([sys.executable, "-m", "sphinx", *words], capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("site")
    done = build(ROOT, out)
    assert done.returncode == 0, done.stderr
    return out


def test_the_site_holds_every_document_and_asks_for_nothing_from_elsewhere(site: Path) -> None:
    documents = (page.relative_to(ROOT).with_suffix(".html") for page in pages() if page.suffix == ".md")
    expected = {page for page in documents if page.parts[0] != ".github"}
    expected |= {page.relative_to(ROOT).with_suffix(".html") for page in ROOT.glob("lab/*/*.ipynb")}
    made = {page.relative_to(site): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    assert len(expected) > 40 and expected | {Path("index.html")} <= {*made}
    assert {page: LOADED.findall(text) for page, text in made.items() if LOADED.search(text)} == {}
    assert LOADED.findall('<script src="https://example.org/x.js"></script>') == ["https://example.org/x.js"]


def test_headings_have_levels_landmarks_names_and_what_scrolls_takes_the_focus(site: Path) -> None:
    texts = {page.relative_to(site): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    for name, text in texts.items():
        page = html.fromstring(text)
        assert not page.xpath("//*[@role='heading'][not(@aria-level)] | //*[@role='main']//*[@role='main']"), name
        assert not page.xpath("//aside[not(@aria-label)]"), name
        scrolls = "//pre[not(@tabindex)] | //*[contains(@class, 'table-wrapper') or @class='formula'][not(@tabindex)]"
        assert not page.xpath(scrolls), name
    assert texts[Path("docs/equations.html")].count('aria-level="2"') > 3


# Signs of LaTeX that no formula shows: of an alignment, of a command.
UNREAD = re.compile(r"[&\\]")
IN_PROSE = re.compile(r"(?<!\w)(?<!\w{3}/)[A-Za-zα-ω]\u0307?_\w+")
OUTSIDE_PROSE = ["code", "pre", "script", "style", "math", "title"]


def unread(page: str) -> list[str]:
    """Parts of formulas that hold LaTeX."""
    return [part.text for part in html.fromstring(page).iter("mi", "mo", "mn") if UNREAD.search(part.text or "")]


def unset(page: str) -> list[str]:
    """Symbols with an underscore in the prose of a page."""
    root = html.fromstring(page)
    for part in [*root.iter(*OUTSIDE_PROSE)]:
        part.drop_tree()
    return IN_PROSE.findall(root.text_content())


def test_formulas_are_drawn_by_the_browser_itself_and_none_keeps_latex(site: Path) -> None:
    texts = {page.relative_to(site): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    equations = texts[Path("docs/equations.html")]
    assert equations.count("<math") > 50 and "MathJax" not in equations
    assert {name: found for name, text in texts.items() if (found := unread(text))} == {}
    assert sum(text.count("<mtable") for text in texts.values()) > 10


def test_latex_that_is_not_converted_would_be_noticed() -> None:
    mathml = runpy.run_path(f"{CONF}/conf.py")["mathml"]
    assert {*unread(mathml(r"\begin{unheard} a &= \unheard \end{unheard}", "block"))} >= {"&", r"\unheard"}


def test_symbols_in_prose_are_set_as_mathematics(site: Path) -> None:
    pages = {page.relative_to(site): unset(page.read_text(encoding="utf-8")) for page in site.rglob("*.html")}
    assert {name: found for name, found in pages.items() if found} == {}
    assert unset("<p>The radius r_0, <code>J_x</code>, phi_dot, 1/m_1</p>") == ["r_0", "m_1"]


def test_the_page_of_the_c_header_has_every_function(site: Path) -> None:
    header, page = ROOT / "fmu-src" / "equations" / "wheel_equations.h", site / "docs" / "c_header.html"
    functions = set(re.findall(r"\b(wheel_\w+)\(", header.read_text(encoding="utf-8")))
    assert len(functions) > 5 and not functions - {*re.findall(r"\w+", page.read_text(encoding="utf-8"))}


GONE = ["[gone](gone.md)", "[gone](#gone)", "[gone](gone.py)", "[gone](gone/)", "![gone](gone.png)"]


def test_links_that_lead_nowhere_stop_the_site(tmp_path: Path) -> None:
    (tmp_path / "start.md").write_text("\n\n".join(["# A page", *GONE]))
    done = build(tmp_path, tmp_path / "out", "-Dhtml_favicon=", "-Droot_doc=start", "-Dsuppress_warnings=myst.header")
    assert done.returncode != 0
    assert {*re.findall(r"start\.md:(\d+): WARNING.*gone", done.stderr)} == {"3", "5", "7", "9", "11"}


@pytest.mark.parametrize("live", ["live.html", ""])
def test_a_step_opens_the_lesson_where_the_site_has_it(live: str) -> None:
    read = runpy.run_path(str(CONF / "conf.py"))["read"]
    source = [(ROOT / "docs" / "teaching.md").read_text(encoding="utf-8")]
    read(SimpleNamespace(config=SimpleNamespace(html_context={"live": live})), "docs/teaching", source)
    links = re.findall(r'<a href="\.\./live\.html#step=(\d+)">', source[0])
    assert links == (["1", "2", "3", "4", "6", "7", "9", "10"] if live else [])


def test_every_glyph_of_every_formula_is_in_the_font_that_the_site_brings(site: Path) -> None:
    glyphs = TTFont(site / "_static" / "math.woff").getBestCmap()
    formulas = (part for page in site.rglob("*.html") for part in html.parse(page).iter("math"))
    used = {sign for part in formulas for sign in part.text_content()}
    assert {sign for sign in used if not sign.isspace() and ord(sign) not in glyphs} == set()
    assert "\u02d9" in used and ord("\u2603") not in glyphs  # the dot of a derivative; a partner


def test_the_search_shows_words_about_what_it_found_without_a_server_too(site: Path, browser: Any) -> None:
    page = browser.new_page()
    page.goto(f"{(site / 'search.html').as_uri()}?q=nutation")
    page.wait_for_selector("#search-results .context")
    found = page.locator("#search-results li").all_inner_texts()
    words = [text.partition("\n")[2].strip().lower() for text in found]  # beneath the titles
    assert len(words) > 3 and all(len(text) > 40 for text in words) and sum("nutation" in text for text in words) > 3


def test_drawings_turn_dark_with_the_site_and_maps_keep_their_colours(site: Path, browser: Any) -> None:
    read = "all => all.map((one) => getComputedStyle(one).filter)"
    for scheme, drawn in (("light", "none"), ("dark", "invert(0.93) hue-rotate(180deg)")):
        page = browser.new_page(color_scheme=scheme)
        page.goto((site / "docs" / "physics.html").as_uri())
        filters = page.eval_on_selector_all("img.drawn", read)
        assert len(filters) > 5 and {*filters} == {drawn}
        if not (maps := site / "lab" / "studies" / "README.html").exists():  # its folder may be absent
            continue
        page.goto(maps.as_uri())
        assert page.eval_on_selector_all(".article-container img", read) == ["none", drawn, "none"]
