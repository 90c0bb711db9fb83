"""The docs name what exists: all equations (1)-(33) of the paper, functions and tests.

Reads docs/equations.md, docs/errata.md and docs/decisions/multibody_state.md.
"""

import re

import pytest
from support.paths import ROOT

TESTS = "\n".join(path.read_text("utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
EQUATIONS = [path for path in (ROOT / "fmu-src" / "equations").iterdir() if path.is_file()]
SOURCES = "\n".join(path.read_text("utf-8") for path in EQUATIONS)
ROW = re.compile(r"^\| (\([^|]*?) \| [^|]* \| ([^|]*) \| ([^|]*) \|$", re.MULTILINE)


def rows() -> list[tuple[str, str, str]]:
    """Equations, functions and tests of the table in docs/equations.md."""
    return ROW.findall((ROOT / "docs" / "equations.md").read_text("utf-8"))


def numbers(equations: str) -> list[int]:
    first, *rest = (int(number) for number in re.findall(r"\d+", equations))
    return list(range(first, rest[0] + 1)) if "–" in equations else [first, *rest]  # noqa: RUF001


def names(cell: str) -> list[str]:
    return re.findall(r"`(\w+)`", cell)


def missing_tests(text: str) -> list[str]:
    return [name for name in re.findall(r"`(test_\w+)`", text) if f"def {name}(" not in TESTS]


def test_the_table_has_every_equation_of_the_paper_once() -> None:
    assert sorted(n for equations, _, _ in rows() for n in numbers(equations)) == list(range(1, 34))


def test_every_equation_has_a_function_of_the_equations_room_and_a_test() -> None:
    for equations, functions, tests in rows():
        assert names(functions), equations
        assert names(tests), equations
        for name in names(functions):
            assert re.search(rf"\b{name}\b", SOURCES), f"{equations}: {name}"
    assert not re.search(r"\bB_hat\b", SOURCES)  # a name the paper does not have


@pytest.mark.parametrize("page", ["equations.md", "errata.md", "decisions/multibody_state.md"])
def test_every_test_that_the_docs_name_exists(page: str) -> None:
    text = (ROOT / "docs" / page).read_text("utf-8")
    assert "`test_" in text
    assert missing_tests(text) == []
    assert missing_tests(text + "`test_of_nothing`") == ["test_of_nothing"]
