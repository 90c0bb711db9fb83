"""The site of ./scripts/site: every document as it is kept, by Sphinx; nothing is loaded from elsewhere.

The source folder is the project's root, so that links between documents, and to sources, stay as they are.
Formulas become MathML, which browsers draw by themselves, with a font for mathematics that the site brings along.
docs/decisions/others.md says why it is made like this.
"""

from __future__ import annotations

import json
import re
import sys
from importlib.resources import files
from pathlib import Path

import latex2mathml.converter
from docutils import nodes
from fontTools import subset
from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(Path(__file__).parent))
from c_header import reference  # noqa: E402

project, author = "wheel.fmu", "the maintainers of wheel.fmu"
copyright = "the maintainers of wheel.fmu, BSD-3-Clause"  # noqa: A001 - Sphinx's name for it
release = re.search(r"VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text())[1]
root_doc = "README"
extensions = ["myst_nb"]
exclude_patterns = ["build", "results", ".*"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
nb_execution_mode = "off"  # the notebook is kept with what its cells gave; a test runs it
nb_merge_streams = True
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
suppress_warnings = ["myst.header", "toc.not_included", "misc.highlighting_failure"]
html_theme = "furo"
html_title = f"wheel.fmu {release}"
html_favicon = "../../../fmu-src/archive/model.png"
html_static_path = ["site.css", "search.js"]
html_css_files = ["site.css"]
html_show_search_summary = (
    False  # search.js takes excerpts from texts.js: a page opened from the disk may fetch nothing
)
html_copy_source = False
html_show_sphinx = False
templates_path = ["_templates"]
html_additional_pages = {"index": "front.html"}
html_math_renderer = "mathml"

CONTENTS = """
```{{toctree}}
:hidden:
:caption: {caption}

{pages}
```
"""
# Letters, digits and punctuation; accents, Greek, arrows, operators, brackets, and the italic letters of formulas.
GLYPHS = "U+20-7E,U+A0-FF,U+300-36F,U+370-3FF,U+2000-206F,U+2100-23FF,U+27C0-27FF,U+2A00-2AFF,U+1D400-1D7FF"
THIN = '<mspace width="0.17em"/>'
DELETABLE = ("tools/page", "examples/vehicles", "examples/studies", "examples/control", "examples/importer")
GONE = [ROOT / part for part in DELETABLE if not (ROOT / part).exists()]
CHAPTERS = {
    "Learn": "docs/README examples/wheel docs/physics",
    "How to": "docs/in_your_tool docs/recipes docs/brake_hold_steer docs/vehicle docs/model_exchange "
    "docs/linearize_and_control docs/studies docs/page docs/benchmark docs/test_your_importer",
    "Look up": "docs/variables docs/messages docs/glossary docs/equations docs/errata docs/c_header "
    "docs/interoperability",
    "Examples": "examples/README examples/*/README",
    "Judge": "docs/credibility docs/testing docs/* docs/results/*",
    "Make": "CONTRIBUTING */README tools/*/README CHANGELOG SECURITY docs/decisions/*",
}


def contents() -> str:
    """The chapters of the site, below the README: each document stands where it is named first."""
    found, seen = [], set()
    for caption, names in CHAPTERS.items():
        kinds = [f"{name}{kind}" for name in names.split() for kind in (".md", ".ipynb")]
        paths = [path.relative_to(ROOT) for kind in kinds for path in sorted(ROOT.glob(kind))]
        pages = [str(path.with_suffix("")) for path in paths if not path.parts[0].startswith(".")]
        pages = [page for page in dict.fromkeys(pages) if page not in seen]
        seen.update(pages)
        found.append(CONTENTS.format(caption=caption, pages="\n".join(f"/{page}" for page in pages)))
    return "".join(found)


def titles(text: str) -> str:
    """A link whose words are the name of its document gets the document's title."""
    return re.sub(r"(?<!!)\[`?[\w./-]+\.md`?\](\([\w./-]+\.md(?:#[\w-]+)?\))", r"[]\1", text)


def folders(text: str, page: Path) -> str:
    """Links to a folder lead to its README; where it has none, and of parts that were deleted, the words stay."""

    def mended(link: re.Match[str]) -> str:
        words, target = link[1], link[2]
        if any((page.parent / target).resolve().is_relative_to(part) for part in GONE):
            return words
        if "://" in target or not (page.parent / target).is_dir():
            return link[0]
        return f"[{words}]({target.rstrip('/')}/README.md)" if (page.parent / target / "README.md").exists() else words

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)#\s]+)\)", mended, text)


def read(app: Sphinx, name: str, source: list[str]) -> None:
    path = Path(app.env.doc2path(name))
    source[0] = titles(folders(source[0], path) if path.suffix == ".md" else source[0])
    if name == root_doc:
        source[0] += contents()
    if name == "docs/c_header":
        source[0] += reference((ROOT / "fmu-src" / "equations" / "wheel_equations.h").read_text(encoding="utf-8"))


def formula(display: str):
    """Visitor that writes a formula as MathML, with thin spaces about the names of functions."""

    def visit(writer: object, node: nodes.Element) -> None:
        written = latex2mathml.converter.convert(node.astext(), display=display)
        writer.body.append(re.sub(r"(?<!<msup>)(<mi>(?:sin|cos|tan|exp)</mi>)", rf"{THIN}\1{THIN}", written))
        raise nodes.SkipNode

    return visit


def widen(app: Sphinx, document: nodes.document) -> None:
    """Marks the cells of prose, which a table must not squeeze beside names that cannot be broken."""
    for cell in document.findall(nodes.entry):
        if len(cell.astext()) > 45:
            cell["classes"].append("prose")


def front(app: Sphinx, name: str, template: str, context: dict, doctree: object) -> None:
    """The front page shows the live page where ./scripts/site has put one."""
    context["live"] = (Path(app.outdir) / "live.html").exists()


def text_of(document: nodes.document) -> str:
    """The words of a document, without formulas and marks."""
    left_out = (nodes.math, nodes.math_block, nodes.raw)
    return " ".join(
        " ".join(t.astext() for t in document.findall(nodes.Text) if not isinstance(t.parent, left_out)).split()
    )


def bring_along(app: Sphinx, fault: Exception | None) -> None:
    """The texts of all documents, for the search; the font, with the glyphs of formulas and their tables."""
    if fault:
        return
    static = Path(app.outdir) / "_static"
    texts = {name: text_of(app.env.get_doctree(name)) for name in sorted(app.env.found_docs)}
    (static / "texts.js").write_text(f"const TEXTS = {json.dumps(texts, ensure_ascii=False)};\n", encoding="utf-8")
    font = files("ziamath") / "fonts" / "STIXTwoMath-Regular.ttf"
    options = ["--layout-features=*", "--flavor=woff", f"--unicodes={GLYPHS}", "--name-IDs=*"]
    subset.main([str(font), f"--output-file={static / 'math.woff'}", *options])


def setup(app: Sphinx) -> None:
    app.connect("html-page-context", front)
    app.connect("source-read", read)
    app.connect("doctree-read", widen)
    app.connect("build-finished", bring_along)
    app.add_html_math_renderer("mathml", (formula("inline"), None), (formula("block"), None))
