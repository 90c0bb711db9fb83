"""docs/messages.md lists the messages of the FMU as they stand in the code: none is missing, none is left over."""

from __future__ import annotations

import re
from pathlib import Path

from support.paths import ROOT

FOLDERS = ("fmi", "wheel", "solver", "orbit", "support")
COMMENT = re.compile(
    r'("(?:[^"\\\n]|\\.)*")|//[^\n]*|/\*.*?\*/|^\s*#\s*include[^\n]*|\bstatic_assert\(.*?;', re.DOTALL | re.MULTILINE
)
PIECE = r'"(?:[^"\\\n]|\\.)*"'
LITERAL = re.compile(rf"{PIECE}(?:\s*(?:[A-Z_]+\s*)?{PIECE})*")
SPECIFIER = re.compile(r"%(?:s|d|u|zu|lld)(?:%s)?")
REASON = re.compile(rf"(?:\breturn|\bfailure_ =)\s+({PIECE})")


def sources() -> list[str]:
    """The code of the FMU without comments."""
    files = [path for name in FOLDERS for path in sorted((ROOT / "fmu-src" / name).glob("*.[ch]pp"))]
    return [COMMENT.sub(lambda found: found[1] or " ", file.read_text(encoding="utf-8")) for file in files]


def text_of(literal: str) -> str:
    """A literal, joined from its pieces, with … for what is filled in when the FMU runs."""
    joined = re.sub(r'"\s*"', "", literal)
    joined = re.sub(r'"\s*[A-Z_]+\s*"', "…", joined)[1:-1].replace('\\"', '"')
    return SPECIFIER.sub("…", joined).replace("……", "…")


def in_code(code: list[str]) -> set[str]:
    """Whole messages: literals that end with a full stop."""
    literals = (text_of(found) for text in code for found in LITERAL.findall(text))
    return {text for text in literals if " " in text and text.endswith(".")}


def in_page(page: str) -> set[str]:
    """The code at the start of each item."""
    return set(re.findall(r"^- `([^`]+)`", page, re.MULTILINE))


def page() -> set[str]:
    return in_page((ROOT / "docs" / "messages.md").read_text(encoding="utf-8"))


def test_every_message_of_the_code_is_on_the_page_and_none_is_left_over() -> None:
    messages = in_code(sources())
    assert len(messages) > 50
    listed = {text for text in page() if text.endswith(".")}
    assert messages - listed == set()
    assert listed - messages == set()


def test_every_reason_on_the_page_stands_in_the_code_and_the_solvers_reasons_are_all_listed() -> None:
    code = sources()
    listed = {text for text in page() if not text.endswith(".")}
    literals = {text_of(found) for text in code for found in LITERAL.findall(text)}
    assert listed - literals == set()
    solver = [COMMENT.sub(lambda found: found[1] or " ", path.read_text(encoding="utf-8")) for path in solvers()]
    given = {text_of(found) for text in solver for found in REASON.findall(text)}
    assert len(given) > 5
    assert given - listed == set()


def solvers() -> list[Path]:
    return sorted((ROOT / "fmu-src" / "solver").glob("*.[ch]pp"))


def test_a_new_message_is_noticed_and_a_comment_is_none() -> None:
    code = 'i.log(e, "%s: the %d-th wheel "\n  "is %s.", a); // "a comment is no message."\nlog("x");'
    bare = COMMENT.sub(lambda found: found[1] or " ", code)
    assert in_code([bare]) == {"…: the …-th wheel is …."}
