"""./scripts/example: parameters with units, messages before anything is built, verdicts, exit status, and all that a
document prints."""

import csv
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.typed import asked

from lab.vehicles import example, options
from lab.vehicles.master import Component, loaded
from lab.vehicles.vehicle import Fmus
from wheelfmu.diagrams import style
from wheelfmu.fmu.paths import ROOT

VEHICLES = ROOT / "examples" / "vehicles"
PAGES = (*VEHICLES.rglob("*.md"), *(ROOT / "docs").glob("*.md"), ROOT / "README.md")
TEXT = "\n".join(page.read_text() for page in PAGES)
PRINTED = {line.strip() for line in re.findall(r"\./scripts/example ([a-z]+\b(?!\|)[^`#\n]*)", TEXT)} - {"control"}
RUNS = sorted(line for line in PRINTED if "--help" not in line)
ROWS = csv.DictReader(Path(__file__).with_name("command_lines.csv").read_text().splitlines()[1:])
CASES = {line: {"line": line, "status": "0", "said": "", "unsaid": "Failed"} for line in RUNS}
CASES |= {row["line"]: row for row in ROWS}
PACKAGE = re.compile(
    r"^package=results/examples/(\S+)\n.*?run_package.py \w+ \$package ([^\n]+)", re.DOTALL | re.MULTILINE
)
PACKAGES = PACKAGE.findall(TEXT)


def reads(line: str) -> subprocess.CompletedProcess:
    """The command line as it is checked before anything is built, by the standard library alone."""
    return asked(ROOT, f"example {line}")


@pytest.mark.parametrize("case", [case for case in CASES.values() if case["status"] == "2"], ids=lambda of: of["line"])
def test_what_does_not_exist_or_is_not_allowed_gets_one_sentence_before_anything_is_built(case: dict) -> None:
    done = reads(case["line"])
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"example: {case['said']}") and done.stderr.count("\n") == 1


@pytest.mark.parametrize("name", options.ABOUT)
def test_help_lists_every_parameter_and_all_of_them_are_taken(name: str) -> None:
    listed = reads(f"{name} --help").stdout
    for parameter in options.takes(name)[1]:
        assert f"\n  {parameter} " in listed
        assert options.value(name, f"{parameter}=1") == (parameter, 1.0)


@pytest.mark.parametrize(
    ("model", "name", "said"), [("chassis", "m_B", ": it must be above 0 kg."), ("wheel", "m", "")]
)
def test_the_unit_refuses_a_value_in_its_own_words(fmus: Fmus, model: str, name: str, said: str) -> None:
    component = Component(model, fmus[model], {name: -1.0})
    with pytest.raises(ValueError, match=f"^{model}: {name} = -1{said}"), loaded(component):
        component.asked(component.fmu.exitInitializationMode)


@pytest.fixture
def run(fmus: Fmus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> Callable:
    """run(line): exit status and output of the example, which writes into tmp_path/NAME."""
    monkeypatch.setattr(example, "RESULTS", tmp_path)
    monkeypatch.setattr(example, "build_all", lambda: fmus)

    def call(line: str) -> tuple[int, str]:
        return example.main(line.split()), "".join(capsys.readouterr())

    return call


@pytest.mark.parametrize(("package", "rest"), PACKAGES)
def test_every_package_of_a_document_has_its_values(run: Callable, tmp_path: Path, package: str, rest: str) -> None:
    run(f"{package.split('/')[0]} stop=0.1")
    step, _, *names = rest.split()
    command = [sys.executable, VEHICLES / "run_package.py", "fmpy", tmp_path / package, step, "0.1", *names]
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    values = {line.split()[0]: np.isfinite(float(line.split()[1])) for line in lines}
    assert values == dict.fromkeys(names, True)


@pytest.mark.parametrize("case", [case for case in CASES.values() if case["status"] != "2"], ids=lambda of: of["line"])
def test_the_exit_status_follows_from_the_verdict_and_table_picture_fmus_and_package_are_kept(
    run: Callable, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: dict
) -> None:
    """Also of every command that a document prints: it runs, is the manoeuvre it names, and draws it."""
    if case["line"] not in RUNS:
        monkeypatch.setattr(style, "save_png", lambda _, path: path.touch())
    (status, output), name = run(case["line"]), case["line"].split()[0]
    assert (status, case["said"] in output, case["unsaid"] in output) == (int(case["status"]), True, False), output
    kept, models = {p.name for p in (tmp_path / name).iterdir()}, ["wheel", *options.file(name)["models"]]
    package = options.file(name).get("package", name)
    written = {f"{name}.csv", f"{name}.png", f"{package}.ssp", *(f"{model}.fmu" for model in models)}
    assert kept == (set() if "x_fl" in case["line"] else written)


def test_an_example_is_copied_into_an_empty_folder_by_the_recipe_of_the_document(tmp_path: Path) -> None:
    (recipe,) = re.findall(r"```\n(project=.*?)```", (VEHICLES / "README.md").read_text(), re.DOTALL)
    recipe = recipe.replace("/path/to/this/checkout", str(ROOT))
    subprocess.run(["bash", "-e", "-c", recipe], cwd=tmp_path, check=True, capture_output=True)
    with loaded(copied := Component("quarter_car", tmp_path / "build" / "quarter_car.fmu", {"m_B": 100.0})):
        assert set(copied.variable) >= {"X_B", "F_X"}
