"""What a user types after ./scripts/view is taken as typed, or refused."""

from pathlib import Path

import pytest
from support.typed import check_refused, check_taken

REFUSED = {
    "view motion.csv --r_0 0,3 --r 0,05": "the decimal mark is a point",
    "view motion.csv --slope steep": "is not a number",
    "view motion.csv --slope 95deg": "must be",
    "view motion.csv --r_0 -1 --r 0": "must be",
    "view motion.csv --title a --title b": "given twice, as ",
    "view motion.csv --output motion.csv": "is read",
    "view motion.csv -o ./motion.csv": "is read",
    "view motion.csv --output thesis.html": "is not of this command",
}
TAKEN = ("view motion.csv --slope 12% --r_0 30cm --r 5cm", "view motion.csv --output thesis.html --overwrite")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "motion.csv").write_text("time,X_O\n0,0\n1,1\n")
    (tmp_path / "thesis.html").write_text("years of work")
    return tmp_path


@pytest.mark.parametrize(("line", "words"), REFUSED.items())
def test_a_fault_is_refused_in_one_sentence_with_status_2(folder: Path, line: str, words: str) -> None:
    check_refused(folder, line, words)


@pytest.mark.parametrize("line", TAKEN)
def test_what_is_meant_is_taken(folder: Path, line: str) -> None:
    check_taken(folder, line)
