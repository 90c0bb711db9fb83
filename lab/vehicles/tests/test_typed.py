"""What a user types after ./scripts/example is taken as typed, or refused."""

from pathlib import Path

import pytest
from support.typed import check_refused, check_taken

REFUSED = {
    "example car v=18,5": "the decimal mark is a point",
    "example balance k_theta=2,5": "the decimal mark is a point",
    "example car v=fast": "is not a number",
    "example car path=1.5": "is not one of",
    "example suspended follow=0.5": "is not one of",
    "example car manoeuvre=loop": "is not one of",
    "example car s=-1": "must be",
    "example car slope=95deg": "must be",
    "example cra": "Do you mean ",
    "example car vv=5": "Do you mean ",
    "example car manoeuvre=lanes": "Do you mean ",
    "example car v=3 v=4": "given twice, as ",
    "example car v": "of the form",
}
TAKEN = ("example car path=1 v=18.5", "example suspended exchange=held")


@pytest.mark.parametrize(("line", "words"), REFUSED.items())
def test_a_fault_is_refused_in_one_sentence_with_status_2(tmp_path: Path, line: str, words: str) -> None:
    check_refused(tmp_path, line, words)


@pytest.mark.parametrize("line", TAKEN)
def test_what_is_meant_is_taken(tmp_path: Path, line: str) -> None:
    check_taken(tmp_path, line)
