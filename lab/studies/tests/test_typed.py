"""What a user types after ./scripts/study, and the tables of starts, are taken as written, or refused."""

import re
from pathlib import Path

import pytest
from support.typed import asked, typing_tests

from wheelfmu.fmu.csv_file import read_table
from wheelfmu.fmu.values import Fault

REFUSED = {
    "study --vary theta_start=1,1:1,2:3": "the decimal mark is a point",
    "study --vary s=0,01,0,02": "the decimal mark is a point",
    "study --vary s=0,0.1 --set m=12,5": "the decimal mark is a point",
    "study --vary s=0,0.1 --stop-time 2,5": "the decimal mark is a point",
    "study --vary s=0,1e999": "is not a number",
    "study --vary s=0,,1": "is not a number",
    "study --vary s=0,0.1 --set m=heavy": "is not a number",
    "study --vary s=0,0.1 --interval soon": "is not a number",
    "study --vary formulation=1:3:5": "is not one of",
    "study --vary s=0,0.1 --set formulation=2.7": "is not one of",
    "study --vary keep_contact=true,maybe": "is not one of",
    "study --vary s=-1:1:3": "must be",
    "study --vary s=0,0.1 --set m=-5": "must be",
    "study --vary mu=0.4": "Do you mean ",
    "study --vary brake=60": "Do you mean ",
    "study --vary s=0,0.1 --set masss=1": "Do you mean ",
    "study --vary s=0,0.1 --measure a=max(tetha)": "Do you mean ",
    "study --vary s=0,0.1 --history Thetta": "Do you mean ",
    "study --vary s=0,0.1 --vary s=1,2": "given twice, as ",
    "study --vary s=0,0.1 --set m=10 --set m=30": "given twice, as ",
    "study --vary s=0,0.1 --measure a=theta --measure a=lowest": "given twice, as ",
    "study --vary s=0,0.1 --out a.zarr --out b.zarr": "given twice, as ",
    "study --vary s=0,0.1 --stop-time 1 --stop-time 2": "given twice, as ",
    "study --vary s=0,0.1 --over": "unrecognized arguments",
    "study --vary s=0,0.1 --set m": "of the form",
    "study --vary =1": "of the form",
    "study --vary s=0,0.1 --measure low=": "of the form",
    "study --vary s=0:1:one": "write --vary NAME=1,2,3 or NAME=first:last:count",
    "study": "Which wheels? Give an example",
    "study fate": "Do you mean fates?",
}
TAKEN = ("study --vary formulation=1,multibody --set keep_contact=true --set method=bdf", "study --vary s=0:0.1:3")

test_a_fault_is_refused_in_one_sentence_with_status_2, test_what_is_meant_is_taken = typing_tests(REFUSED, TAKEN)


GOOD = "theta_start,phi_dot_start\n75deg,-2\n1.2,0\n"
SPREADSHEETS = {
    "a byte-order mark": "\ufeff" + GOOD,
    "lines of Windows": GOOD.replace("\n", "\r\n"),
    "blanks beside the commas": GOOD.replace(",", " , "),
    "a trailing comma in each row": GOOD.replace("\n", ",\n"),
    "a trailing comma in the first row": GOOD.replace("start\n", "start,\n"),
    "empty rows": GOOD.replace("\n", "\n\n,\n") + ",,\n",
    "quotes": re.sub(r"[^,\n]+", r'"\g<0>"', GOOD),
    "no end of the last line": GOOD.rstrip(),
}


@pytest.mark.parametrize("text", SPREADSHEETS.values(), ids=SPREADSHEETS)
def test_a_table_is_read_as_spreadsheets_write_it(tmp_path: Path, text: str) -> None:
    (tmp_path / "starts.csv").write_text(text, newline="")
    expected = {"theta_start": ["75deg", "1.2"], "phi_dot_start": ["-2", "0"]}
    assert read_table(tmp_path / "starts.csv").columns == expected
    assert asked(tmp_path, "study --list starts.csv").returncode == 0


UNREADABLE = {
    "theta_start,phi_dot_start\n75deg,-2\n\n1.2,zero\n": 'line 4, column 2: phi_dot_start = "zero" is not a number',
    'theta_start,phi_dot_start\n"1,2","-2,5"\n': 'line 2, column 1: theta_start = "1,2" is not one number',
    "theta_start\n0:0.03:2\n": 'line 2, column 1: theta_start = "0:0.03:2"',
    "formulation\n1\n2.7\n": "line 3, column 1: formulation = 2.7 is not one of",
    "theta_start,theta_start\n1.2,1.3\n": "theta_start is given twice, as column 1 and as column 2",
    "theta_start;phi_dot_start\n1,2;-2\n": "semicolons separate its columns",
    '"theta_start";"phi_dot_start"\n"1.2";"-2"\n': "semicolons separate its columns",
    "theta_start\tphi_dot_start\n1.2\t-2\n": "tabs separate its columns",
    ",theta_start\n0,1.2\n": "column 1 has no name",
    "theta_start,s\n1.2\n": "line 2: 1 values for the 2 names",
    "theta_start,s\n1.2,0,7\n": "line 2: 3 values for the 2 names",
    "theta_start,s\n1.2,\n": 's = "" is not a number',
    "theta_start,s\n": "has no rows",
    "": "has no rows",
    "theta_strat\n1.2\n": "Do you mean theta_start",
}


@pytest.mark.parametrize(("text", "words"), UNREADABLE.items())
def test_a_table_that_cannot_be_meant_is_refused_with_its_place_and_content(tmp_path: Path, text, words) -> None:
    (tmp_path / "starts.csv").write_text(text)
    done = asked(tmp_path, "study --list starts.csv")
    assert done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1


def test_a_file_in_another_encoding_is_refused_with_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "starts.csv").write_bytes(GOOD.encode("utf-16"))
    with pytest.raises(Fault, match="it is not UTF-8 text"):
        read_table(tmp_path / "starts.csv")
