"""The scripts for importers pass on the built FMU, and fail where the feature that they try is missing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from support.paths import ROOT

FOLDER = ROOT / "examples" / "importer"
# What an importer without the feature does, as a change of FMPy.
MISSING = {
    "interpolated_input": "FMU2Slave.setRealInputDerivatives = lambda *_: None",
    "rollback": "FMU2Slave.setFMUstate = lambda *_: None",
    "directional_derivative": "FMU2Slave.getDirectionalDerivative = lambda *_: [0.0]",
    "early_return": "FMU2Slave.getBooleanStatus = lambda *_: False",
    "terminals": "FMU2Slave, ElementTree.parse = None, lambda _: ElementTree.ElementTree(ElementTree.Element('empty'))",
    "serialization": "FMU2Slave.deSerializeFMUstate = lambda self, state: self.getFMUstate()",
}
WITHOUT = """
import runpy, sys
from xml.etree import ElementTree
from fmpy.fmi2 import FMU2Slave
{change}
sys.argv[0] = {script!r}
sys.path.insert(0, {folder!r})
runpy.run_path({script!r}, run_name="__main__")
"""


def run(*command: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *command], capture_output=True, text=True, cwd=FOLDER)


def test_every_script_has_an_importer_that_it_fails() -> None:
    assert {path.stem for path in FOLDER.glob("*.py")} - {"unit"} == set(MISSING)
    page = (ROOT / "docs" / "test_your_importer.md").read_text(encoding="utf-8")
    assert all(f"importer/{name}.py" in page for name in MISSING)


@pytest.mark.parametrize("name", MISSING)
def test_the_script_passes(fmu_path: Path, name: str) -> None:
    done = run(FOLDER / f"{name}.py", fmu_path)
    assert (done.returncode, done.stdout.count("pass: ")) == (0, 1), done.stdout + done.stderr


@pytest.mark.parametrize("name", MISSING)
def test_the_script_fails_in_an_importer_without_the_feature(fmu_path: Path, name: str) -> None:
    script = str(FOLDER / f"{name}.py")
    code = WITHOUT.format(change=MISSING[name], script=script, folder=str(FOLDER))
    if name == "serialization":  # the other process is the one that cannot
        state = run("-c", code, fmu_path, "00")
        assert state.stdout != run(script, fmu_path).stdout.split(" at 2 s ")[1]
        return
    done = run("-c", code, fmu_path)
    assert done.returncode != 0, done.stdout
    assert "pass: " not in done.stdout
