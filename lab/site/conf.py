"""The site of ./scripts/site: every document as it is kept, by Sphinx; nothing is loaded from elsewhere.

The source folder is the project's root, so that links between documents, and to sources, stay as they are.
Formulas become MathML, which browsers draw by themselves, with a font for mathematics that the site brings along.
"""

from __future__ import annotations

import json
import re
from importlib.resources import files
from pathlib import Path
from typing import Any

import latex2mathml.converter
from docutils import nodes
from fontTools import subset
from lxml import html
from PIL import Image
from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]

project, author = "wheel.fmu", "the maintainers of wheel.fmu"
copyright = "the maintainers of wheel.fmu, BSD-3-Clause"  # noqa: A001 - Sphinx's name for it
(release,) = re.findall(r"VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text())
root_doc = "README"
extensions = ["myst_nb"]
exclude_patterns = ["build", "results", ".*"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
nb_execution_mode = "off"  # the notebook is kept with what its cells gave; a test runs it
nb_merge_streams = True
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
# Folders of the lab can be deleted whole, and a release fills dist/: of a link into what is not here, the words stay.
ABSENT = [f"lab/{name}" for name in ("lesson", "notebook", "reports", "studies", "vehicles")] + ["dist/wheel.fmu"]
suppress_warnings += ["myst.xref_missing"] * any(not (ROOT / part).exists() for part in ABSENT)
CONTENTS = (HERE / "contents.txt").read_text(encoding="utf-8").splitlines()
CONTENTS = [line for line in CONTENTS if line[:1] != "/" or "*" in line or any(ROOT.glob(f"{line[1:]}.*"))]
html_theme = "furo"
html_title = f"wheel.fmu {release}"
html_favicon = "../../fmu-src/archive/model.png"
html_static_path = ["site.css", "search.js"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sphinx = False
templates_path = ["_templates"]
html_additional_pages = {"index": "front.html"}
html_math_renderer = "mathml"

LINES = 0.7  # of a picture: white between lines; a map has less, and keeps its colours on a dark page
PANELS = 1.7  # width over height, from which on a picture has panels side by side

# A letter with a subscript in prose, such as r_0, X_O, ω_crit, 1/m_1, and no part of a path; a name of a variable
# begins with more letters.
SYMBOL = re.compile(r"(?<![\w.'])(?<![a-z]{2}/)([A-Za-zα-ωΑ-Ω])(\u0307?)_(\w+)")
ALIGNED = {"aligned": "split"}  # environments that latex2mathml lacks, and its own of the same layout
# Letters, digits and punctuation; accents, Greek, arrows, operators, brackets, and the italic letters of formulas.
GLYPHS = "U+20-7E,U+A0-FF,U+2B0-2FF,U+300-36F,U+370-3FF,U+2000-206F,U+2100-23FF,U+27C0-27FF,U+2A00-2AFF,U+1D400-1D7FF"
KEPT = (nodes.literal, nodes.literal_block, nodes.raw, nodes.math, nodes.math_block, nodes.comment)
BAR = '<mo stretchy="false">&#x0007C;</mo>'
THIN = '<mspace width="0.17em"/>'
HEADER = "```{literalinclude} /fmu-src/equations/wheel_equations.h\n:language: c\n:start-after: '#endif'\n```\n"
NAMED = {
    '<p class="caption" role="heading">': '<p class="caption" role="heading" aria-level="2">',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="All pages">',
    '<aside class="toc-drawer': '<aside aria-label="This page" class="toc-drawer',
    '<div class="table-wrapper': '<div tabindex="0" class="table-wrapper',
    '<div class="formula">': '<div tabindex="0" class="formula">',
    "<pre>": '<pre tabindex="0">',
}
MORE = {root_doc: "\n".join(CONTENTS), "docs/c_header": f"\n## Reference\n\n{HEADER}"}


def read(app: Sphinx, name: str, source: list[str]) -> None:
    """The README gets the chapters of the site, the page of the C header the header; a step opens the lesson."""
    source[0] += MORE.get(name, "")
    if app.config.html_context.get("live"):
        source[0] = re.sub(r"`(#step=\d+)`", rf'<a href="{"../" * name.count("/")}live.html\1">\1</a>', source[0])


def mathml(latex: str, display: str) -> str:
    """A formula as MathML, with thin spaces about the names of functions, and none beside bars and brackets."""
    for name, own in ALIGNED.items():
        latex = latex.replace(f"{{{name}}}", f"{{{own}}}")
    written = latex2mathml.converter.convert(latex, display=display)
    written = written.replace(BAR, BAR.replace(">", ' lspace="0" rspace="0">', 1))
    written = re.sub(r"(?<!<msup>)(<mi>(?:(?:sin|cos|tan)h?|exp)</mi>)", rf"{THIN}\1{THIN}", written)
    return re.sub(rf"(?<=&#x00028;</mo>){THIN}|{THIN}(?=<mo[^>]*>&#x00028;)", "", written)


def formula(writer: Any, node: nodes.Element) -> None:
    """Writes a formula; one that is wider than the page scrolls in its frame."""
    block = isinstance(node, nodes.math_block)
    written = mathml(node.astext(), "block" if block else "inline")
    writer.body.append(f'<div class="formula">{written}</div>' if block else written)
    raise nodes.SkipNode


def symbol(found: re.Match[str]) -> nodes.math:
    """A symbol of prose as a formula."""
    letter, dot, low = found.groups()
    base, index = f"{{\\dot {letter}}}" if dot else letter, low if len(low) == 1 else f"\\mathrm{{{low}}}"
    return nodes.math(found[0], f"{base}_{{{index}}}")


def set_symbols(app: Sphinx, document: nodes.document) -> None:
    """Symbols in prose become formulas."""
    for text in [*document.findall(nodes.Text)]:
        parts, rest = [], "" if isinstance(text.parent, KEPT) else text.astext()
        while found := SYMBOL.search(rest):
            parts += [nodes.Text(rest[: found.start()]), symbol(found)]
            rest = rest[found.end() :]
        if parts:
            text.parent.replace(text, [*parts, nodes.Text(rest)])


def widen(app: Sphinx, document: nodes.document) -> None:
    """Marks pictures with panels side by side, drawings in lines on white, which turn dark with the page, and cells of
    prose, which a table must not squeeze beside names that cannot be broken."""
    for image in document.findall(nodes.image):
        path = Path(app.srcdir) / image["uri"]
        if path.suffix == ".png" and path.is_file():
            picture = Image.open(path)
            width, height = picture.size
            image["classes"] += ["panels"] * (width > PANELS * height)
            image["classes"] += ["drawn"] * (sum(picture.convert("L").histogram()[250:]) > LINES * width * height)
        image["classes"] += ["drawn"] * (path.suffix == ".svg")
    for cell in document.findall(nodes.entry):
        if len(cell.astext()) > 45:
            cell["classes"].append("prose")


def bring_font(app: Sphinx, fault: Exception | None) -> None:
    """The font, with the glyphs of formulas and their tables."""
    if not fault:
        font = files("ziamath") / "fonts" / "STIXTwoMath-Regular.ttf"
        made = Path(app.outdir) / "_static" / "math.woff"
        options = ["--layout-features=*", "--flavor=woff", f"--unicodes={GLYPHS}", "--name-IDs=*"]
        subset.main([str(font), f"--output-file={made}", *options])


def gather_texts(app: Sphinx, fault: Exception | None) -> None:
    """The words of every page by section, for the search: a page that is opened from a disk may fetch no other."""
    texts = {}
    for page in [] if fault else sorted(Path(app.outdir).rglob("*.html")):
        for main in html.fromstring(page.read_bytes()).xpath("//*[@role='main']"):
            for part in main.xpath(".//script | .//style | .//a[contains(@class, 'headerlink')]"):
                part.drop_tree()
            for part in [*main.iterdescendants()]:
                if part.tag != "section":
                    part.drop_tag()
            texts[page.relative_to(app.outdir).as_posix()] = html.tostring(main, encoding="unicode", with_tail=False)
    if texts:
        words = json.dumps({name: re.sub(r"\s+", " ", text) for name, text in texts.items()}, ensure_ascii=False)
        (Path(app.outdir) / "_static" / "texts.js").write_text(f"const TEXTS = {words};\n", encoding="utf-8")


def make_accessible(app: Sphinx, fault: Exception | None) -> None:
    """What the theme leaves out: the level of a heading, names of landmarks, the keyboard's way into what scrolls."""
    for page in Path(app.outdir).rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        for tag, named in NAMED.items():
            text = text.replace(tag, named)
        page.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> None:
    app.connect("source-read", read)
    app.connect("doctree-read", widen)
    app.connect("doctree-read", set_symbols)
    app.connect("build-finished", bring_font)
    app.connect("build-finished", gather_texts)
    app.connect("build-finished", make_accessible)
    app.add_html_math_renderer("mathml", (formula, None), (formula, None))
