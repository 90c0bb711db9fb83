"""The scripts for importers pass on the built FMU, and fail where the feature that they try is missing."""

import runpy
import sys
from xml.etree import ElementTree

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave

from wheelfmu.fmu.paths import ROOT

FOLDER = ROOT / "examples" / "importer"
# What an importer without the feature does, as a change of FMPy.
MISSING = {
    "interpolated_input": (FMU2Slave, "setRealInputDerivatives", lambda *_: None),
    "rollback": (FMU2Slave, "setFMUstate", lambda *_: None),
    "directional_derivative": (FMU2Slave, "getDirectionalDerivative", lambda *_: [0.0]),
    "early_return": (FMU2Slave, "getBooleanStatus", lambda *_: False),
    "terminals": (ElementTree, "parse", lambda _: ElementTree.ElementTree(ElementTree.Element("empty"))),
    "serialization": (FMU2Slave, "deSerializeFMUstate", lambda self, _: self.getFMUstate()),
}


def run(name: str, capsys: pytest.CaptureFixture) -> str:
    """The printed text of a script."""
    with pytest.raises((SystemExit, ValueError, FMICallException)) as ended:
        runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
    printed = capsys.readouterr().out
    assert ("pass: " in printed) == (getattr(ended.value, "code", 1) is False)
    return printed


def test_every_script_has_an_importer_that_it_fails() -> None:
    assert {path.stem for path in FOLDER.glob("*.py")} - {"unit"} == set(MISSING)
    page = (ROOT / "docs" / "test_your_importer.md").read_text(encoding="utf-8")
    assert all(f"importer/{name}.py" in page for name in MISSING)


@pytest.mark.parametrize("name", MISSING)
def test_the_script_passes_but_not_in_an_importer_without_the_feature(name, fmu_path, monkeypatch, capsys) -> None:
    monkeypatch.setattr(sys, "argv", [name, str(fmu_path)])
    monkeypatch.syspath_prepend(FOLDER)
    passed = run(name, capsys)
    assert passed.count("pass: ") == 1
    monkeypatch.setattr(*MISSING[name])
    sys.argv.append("00")  # as the other process of the serialization, which is the one that cannot
    failed = run(name, capsys)
    assert "pass: " not in failed and failed != passed.split(" at 2 s ")[-1]
