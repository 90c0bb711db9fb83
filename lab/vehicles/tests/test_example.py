"""./scripts/example: its parameters, exit status and output, and all commands that a document prints."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from support.typed import asked

from lab.vehicles import example, options
from lab.vehicles.vehicle import Fmus
from wheelfmu.fmu.paths import ROOT

PAGES = (*(ROOT / "examples").rglob("*.md"), *(ROOT / "docs").glob("*.md"), ROOT / "README.md")
TEXT = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
PRINTED = {line.strip() for line in re.findall(r"\./scripts/example ([a-z]+\b(?!\|)[^`#\n]*)", TEXT)} - {"control"}
FAILS = {
    "suspended follow=0 exchange=held h=5ms": "Failed: a closed form does not hold.",
    "car manoeuvre=step v=22": r"Failed: f. ended the run at t = .*lifted off",
    "car mu_max=0.1": "Failed: .. ended the run at t = .*friction coefficient",
    "car manoeuvre=straight k_h=20e3 c_h=500": "Failed: a closed form does not hold.",
}
RUNS = sorted(line for line in PRINTED - {*FAILS} if "--help" not in line)


@pytest.mark.parametrize("name", options.VEHICLES)
def test_help_lists_every_parameter_and_all_of_them_are_taken(name: str):
    listed = asked(ROOT, f"example {name} --help").stdout
    for parameter in options.takes(name):
        assert f"\n  {parameter} " in listed
        assert options.value(name, parameter, "1") == 1.0


@pytest.fixture
def run(fmus: Fmus, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> Callable:
    """run(line): exit status and output of the example, which writes into tmp_path/NAME."""
    monkeypatch.setattr(example, "RESULTS", tmp_path)
    monkeypatch.setattr(example, "build_all", lambda: fmus)

    def call(line: str) -> tuple[int, str]:
        return example.main(line.split()), "".join(capsys.readouterr())

    return call


@pytest.mark.parametrize("line", RUNS)
def test_every_command_that_a_document_prints_succeeds_and_leaves_all_that_it_names(run, tmp_path: Path, line: str):
    status, output = run(line)
    assert status == 0 and "Failed" not in output, output
    name = line.split()[0]
    kept, models = {p.name for p in (tmp_path / name).iterdir()}, set(options.system(name)["fmus"].values())
    package = Path(options.VEHICLES[name]["system"]).stem
    assert kept == {f"{name}.csv", f"{name}.png", f"{package}.ssp", *(f"{model}.fmu" for model in models)}


@pytest.mark.parametrize("line", FAILS)
def test_a_run_that_ends_early_or_is_beyond_a_closed_forms_bound_has_failed(run, line: str):
    status, output = run(line)
    assert status == 1 and re.search(FAILS[line], output), output


def test_a_model_refuses_its_parameters_in_its_own_words(run):
    assert run("car path=2") == (1, "driver: path must be 0 or 1.\n")
