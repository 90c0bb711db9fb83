"""The table of the solver's constants follows from the code, and each constant is in it."""

import re

import numpy as np
import pandas as pd

from wheelfmu.commands.constants import PAGE
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.constants import FACTORS, MOST_ERROR, beyond, constants


def test_the_page_of_constants_has_each_with_its_value_unit_and_reason() -> None:
    written = PAGE.read_text(encoding="utf-8")
    rows = [[cell.strip() for cell in line.split("|")[1:5]] for line in written.splitlines() if line.startswith("| `")]
    assert rows == [[f"`{each.name}`", f"`{each.value}`", each.unit, each.reason] for each in constants()]


def test_every_declaration_of_a_constant_is_read() -> None:
    paths = [path for path in (ROOT / "fmu-src").glob("*/*.?pp") if path.name != "constant.hpp"]
    declared = sum(len(re.findall(r"\bCONSTANT\(", path.read_text(encoding="utf-8"))) for path in paths)
    names = [each.name for each in constants()]
    assert len(names) == len(set(names)) == declared > 50


def test_a_constant_that_leads_beyond_a_limit_is_named() -> None:
    figures = {"error": 0.1, "growth": 1.0, "of": "free", "by": "free"}
    row = figures | {"name": "search.of_bend", "factor": FACTORS[0], "largest": MOST_ERROR, "work": 1.0}
    assert not beyond(pd.DataFrame([row]))
    for wrong in ({"largest": 1.01 * MOST_ERROR}, {"largest": np.nan}, {"work": 2.1}):
        assert [name for name, *_ in beyond(pd.DataFrame([row | wrong]))] == ["search.of_bend"]
