"""The lint of prose finds the habits that the documents have dropped, and leaves code, formulas and tables alone."""

from __future__ import annotations

import pytest

from publishing import prose

prose.register()

HABITS = (
    "The log tells when the wheel stops.",
    "A sentence per fault.",
    "It is made of what the reader offers.",
    "The page has a clock of its own.",
    "A held wheel stops by itself.",
    "With constant inputs the grid changes no bit.",
    "A restored instance gives the same bits.",
    "The unit contains its solver.",
    "The call is refused.",
    "The Newton matrix is factorised.",
    "The colors follow the system.",
)
GOOD = (
    "Stick, release and reversal are located as events; the run ends and the log says why.",
    "DOP853 restarts cheaply after a discontinuity.",
    "Parameters are initialized; 3 meters is `what tells by itself`.".replace("meters", "metres"),
    "$the unit$ and\n\n```\nsame bits\n```\n",
    "<!-- variables -->\n\n| told, of its own |\n\n<!-- end of variables -->",
)


@pytest.mark.parametrize("text", HABITS)
def test_a_habit_is_found_with_its_line(text: str) -> None:
    (fault, *_) = prose.faults("page.md", f"A wheel rolls.\n\n{text}\n")
    assert fault.startswith("page.md:3: ")


@pytest.mark.parametrize("text", GOOD)
def test_good_prose_code_formulas_and_tables_pass(text: str) -> None:
    assert prose.faults("page.md", text) == []


def test_messages_are_prose() -> None:
    assert prose.faults("page.md", "| `the call is refused` | x |") == []
    assert len(prose.faults("docs/messages.md", "| `the call is refused` | x |")) == 1


def test_help_texts_are_prose_and_code_is_none() -> None:
    script = '#!/usr/bin/env bash\n# The log tells the end.\nprintf "that of"\n'
    assert len(prose.faults("scripts/x", prose.help_of(script))) == 1
