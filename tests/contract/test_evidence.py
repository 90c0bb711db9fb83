"""The evidence in the archive (FMI-LS-REF): all files are named, parameter sets are valid, results come again."""

import csv
import shutil
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.ssp.ssd import read_ssv

from wheelfmu.release import evidence
from wheelfmu.truth.motion import Library

pytestmark = pytest.mark.local


@pytest.fixture(scope="module")
def folder(fmu: str, fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What stands under `extra` in the archive of a release."""
    kept = Path(fmu) / "extra" / "org.fmi-standard.fmi-ls-ref"
    folder = Path(shutil.copytree(kept, tmp_path_factory.mktemp("extra") / kept.name))
    evidence.write(fmu_path, folder)
    return folder


def test_the_manifest_names_every_file_and_no_other_and_all_is_below_a_megabyte(folder: Path, fmu_path: Path) -> None:
    related = [entry.get("source", "") for entry in ElementTree.parse(folder / "fmi-ls-manifest.xml").iter("Related")]
    assert all((folder / source).exists() for source in related)
    inside = {source for source in related if "/" not in source}
    assert inside == {path.name for path in folder.iterdir()} - {"fmi-ls-manifest.xml"}
    assert fmu_path.stat().st_size + sum(path.stat().st_size for path in folder.iterdir()) < 1e6


def values_of(path: Path) -> dict[str, str]:
    """Start values of a parameter set, which FMPy validates."""
    return {parameter.name: parameter.value for parameter in read_ssv(path).parameters}


@pytest.mark.parametrize("name", evidence.SETS)
def test_a_parameter_set_is_valid_and_gives_its_result_in_fmpy(folder: Path, fmu: str, name: str) -> None:
    values = values_of(folder / f"{name}.ssv")
    torque = np.genfromtxt(folder / "driven_in.csv", delimiter=",", names=True) if name == "driven" else None
    run = simulate_fmu(
        fmu, start_values=values, input=torque, output_interval=0.1, stop_time=10.0, relative_tolerance=1e-8,
        output=evidence.OUTPUTS,
    )  # fmt: skip
    kept = np.genfromtxt(folder / f"{name}_out.csv", delimiter=",", names=True)
    assert len(kept) == len(run) == 101
    for output in evidence.OUTPUTS:
        assert kept[output] == pytest.approx(run[output], rel=1e-8, abs=1e-8), output
    assert values != values_of(folder / "paper_free.ssv") or name == "paper_free"


def test_the_state_continues_with_the_bits_of_its_result(folder: Path, library: Library) -> None:
    _, row = csv.reader((folder / "state_out.csv").read_text(encoding="utf-8").splitlines())
    want = [float(cell) for cell in row[1:]]
    with library.wheel() as wheel:
        wheel.start(tolerance=1e-8).back((folder / "state.bin").read_bytes()).time = evidence.STATE_AT
        assert wheel.to(evidence.STATE_TO).get(*evidence.OUTPUTS) == want != wheel.to(2.1).get(*evidence.OUTPUTS)
