"""The release folder: right sums, notes of the version, equal bytes for equal content; the bill of materials."""

from __future__ import annotations

import shutil
import subprocess
import tarfile
from pathlib import Path

import pytest
from support.paths import ROOT

from release import folder, sbom

CHANGES = "# Changes\n\nWords.\n\n## 2.1.0, 2026-12-01\n\n- New.\n\n## 2.0.0\n\n- Old.\n"


def test_the_files_name_one_version_and_another_one_is_noticed(tmp_path: Path) -> None:
    number = folder.version()
    for name in folder.VERSIONS:
        shutil.copyfile(ROOT / name, tmp_path / name)
    assert folder.version(tmp_path) == number
    text = (tmp_path / "CITATION.cff").read_text()
    (tmp_path / "CITATION.cff").write_text(text.replace(f"version: {number}", "version: 9.9.9"))
    with pytest.raises(SystemExit, match=r"CITATION.cff names 9\.9\.9"):
        folder.version(tmp_path)


def test_the_notes_are_the_newest_section_of_the_changelog() -> None:
    assert folder.notes(CHANGES, "2.1.0") == ("# wheel.fmu 2.1.0\n\n- New.\n", False)
    assert folder.notes(CHANGES.replace("2.1.0, 2026-12-01", "Unreleased"), "2.1.0")[1]
    with pytest.raises(SystemExit, match="not with one of version 3"):
        folder.notes(CHANGES, "3.0.0")
    assert folder.notes((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), folder.version())[0].count("\n- ") > 0


def test_the_folder_holds_what_its_sums_say_and_the_same_bytes_each_time(tmp_path: Path) -> None:
    fmu, site = tmp_path / "built.fmu", tmp_path / "site"
    fmu.write_bytes(b"archive")
    (site / "docs").mkdir(parents=True)
    for page in ("index.html", "docs/physics.html"):
        (site / page).write_text("page")
    folder.write(tmp_path / "one", fmu, site, "notes\n")
    for path in site.rglob("*"):
        path.touch()
    folder.write(tmp_path / "two", fmu, site, "notes\n")
    sums = tmp_path / "one" / "SHA256SUMS"
    assert sums.read_text().split()[1::2] == ["NOTES.md", "wheel-site.tar.gz", "wheel.fmu"]
    check = ["sha256sum", "--check", "--quiet", sums]
    subprocess.run(check, cwd=tmp_path / "two", check=True)
    with tarfile.open(tmp_path / "one" / "wheel-site.tar.gz") as tar:
        assert {"wheel-site/index.html", "wheel-site/docs/physics.html"} <= set(tar.getnames())
    (site / "index.html").write_text("another front")
    folder.write(tmp_path / "two", fmu, site, "notes\n")
    assert subprocess.run(check, cwd=tmp_path / "two", capture_output=True, check=False).returncode == 1


def test_the_bill_of_materials_is_that_of_the_pins() -> None:
    assert sbom.KEPT.read_text(encoding="utf-8") == sbom.bill(), "run tools/release/sbom.py"


def test_another_eigen_would_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    macros = tmp_path / "include" / "eigen3" / "Eigen" / "src" / "Core" / "util" / "Macros.h"
    macros.parent.mkdir(parents=True)
    macros.write_text("".join(f"#define EIGEN_{part}_VERSION 9\n" for part in ("WORLD", "MAJOR", "MINOR")))
    monkeypatch.setenv("Eigen3_DIR", str(tmp_path / "share" / "eigen3" / "cmake"))
    assert "pkg:generic/eigen@9.9.9" in sbom.bill() != sbom.KEPT.read_text(encoding="utf-8")
