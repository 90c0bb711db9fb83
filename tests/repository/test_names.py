"""The documents name what exists: commands, files and folders of this project, and variables of the FMU."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from support.paths import ROOT

from publishing.documents import pages

COMMAND = re.compile(r"\./scripts/(\w+)")
PLACE = re.compile(r"`((?:cmake|docs|examples|fmu-src|publishing|release|reports|scripts|tests|tools)/[\w./-]*)`")
DOCUMENTS = [page for page in pages() if page.suffix == ".md"]


def missing(text: str) -> list[str]:
    """Commands and places that the text names and the project has not."""
    gone = [f"./scripts/{name}" for name in COMMAND.findall(text) if not (ROOT / "scripts" / name).is_file()]
    return gone + [place for place in PLACE.findall(text) if "NAME" not in place and not (ROOT / place).exists()]


@pytest.mark.parametrize("page", DOCUMENTS, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_command_and_file_that_a_document_names_exists(page: Path) -> None:
    ours = page.parent.relative_to(ROOT)
    text = page.read_text(encoding="utf-8")
    assert [name for name in missing(text) if not (ROOT / ours / name).exists()] == []


def test_a_name_that_is_gone_is_found() -> None:
    assert missing("`./scripts/run`, `tests/support/bounds.py`, `fmu-src/`") == []
    assert missing("`./scripts/walk` and `tests/support/bounds.cpp`") == ["./scripts/walk", "tests/support/bounds.cpp"]
