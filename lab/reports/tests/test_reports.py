"""Reports: pages and figures are those of the data, a bound that is missed fails, one part alone is measured."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from lab.reports import __main__ as command
from lab.reports import options, page
from lab.reports.page import RESULTS, Part, Report, read_figures, read_tables
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault


def report(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "lab.reports", *words], cwd=ROOT, capture_output=True, text=True)


def test_pages_and_figures_in_prose_are_those_of_the_data() -> None:
    done = report("all", "--check")
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(RESULTS / "data", tmp_path / "data")
    return tmp_path


def test_a_figure_beyond_its_bound_or_missing_is_named_in_one_sentence_and_fails(folder: Path, capsys) -> None:
    assert not command.missed(["validation"], folder)
    path = folder / "data" / "figures.csv"
    figures = path.read_text()
    path.write_text(figures.replace("validation,coast,", "validation,coast,9"))
    assert command.missed(["validation"], folder)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("validation.coast, coast-down: error of the duration, is 91.8 %; at most 5 % is allowed.")
    path.write_text("\n".join(line for line in figures.splitlines() if "validation,coast," not in line))
    assert page.misses("validation", folder)[0].endswith("is not measured; at most 5 % is allowed.")


def test_one_part_is_measured_on_top_of_the_data_that_are_there(folder: Path, monkeypatch) -> None:
    """The part's figures and tables are new, and made.csv has its own line; all others are as they were."""
    monkeypatch.setattr(page, "made", lambda name, part: {"report": name, "part": part, "commit": "new"})
    figures, tables, others = (read("validation", folder) for read in (read_figures, read_tables, page.read_made))

    def rig(_report: Report) -> dict[str, object]:
        return {"repeat": 2.5, "loads": pd.DataFrame({"load": [1.0, 2.0]})}

    one = Report("validation", None, folder)
    one.measure(Part(rig, 1, {}))
    one.write("rig")
    found = read_figures("validation", folder)
    assert {name for name in figures if found[name] != figures[name]} == {"repeat"} and found["repeat"] == 2.5
    again = read_tables("validation", folder)
    assert again.keys() == tables.keys()
    assert [name for name in tables if not again[name].equals(tables[name])] == ["loads"]
    made = page.read_made("validation", folder)
    assert made["part"].tolist() == ["all", "rig"] and made["commit"].tolist() == [*others["commit"], "new"]
    assert read_figures("speed", folder) == read_figures("speed")


def test_the_parts_that_are_listed_are_those_that_are_measured() -> None:
    for name in options.NAMES:
        assert list(options.parts(name)) == [part.name for part in command.parts_of(name)], name


WRONG = {"speed --part stps": "there is no part of speed", "speed accuracy --part steps": "a part of one report"}
WRONG |= {"--publish": "which report?", "all --part steps": "a part of one report"}


@pytest.mark.parametrize(("line", "words"), WRONG.items())
def test_what_cannot_be_meant_is_refused(line: str, words: str) -> None:
    with pytest.raises(Fault, match=words.replace("?", r"\?")):
        options.arguments(line.split())


NEEDED = {"accuracy": ["reports"], "others": ["reports", "reports-others"], "all --render": ["reports"], "": []}
NEEDED |= {"speed --part steps": ["reports", "reports-speed"]}


@pytest.mark.parametrize(("line", "groups"), NEEDED.items())
def test_a_report_installs_what_it_needs_alone(line: str, groups: list[str]) -> None:
    assert options.needs(options.arguments(line.split())) == groups


@pytest.mark.parametrize("folder", ["studies", "vehicles"])
def test_without_another_folder_of_the_lab_its_report_or_part_is_not_there(folder: str, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    shutil.copytree(ROOT / "lab" / "reports", tmp_path / "lab" / "reports")
    (tmp_path / "lab" / "__init__.py").touch()
    for other in {"studies", "vehicles"} - {folder}:
        (tmp_path / "lab" / other).mkdir()
    lists = [sys.executable, "-c", "from lab.reports import options; print(options.listing())"]
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{tmp_path / 'tools'}", "PYTHONSAFEPATH": "1"}
    shown = subprocess.run(lists, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True).stdout
    line = re.compile(rf"^ *{folder}\b", re.MULTILINE)
    assert not line.search(shown) and "accuracy" in shown
    assert bool(line.search(options.listing())) == (ROOT / "lab" / folder).exists()
