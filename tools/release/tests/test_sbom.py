"""The bill of materials in the archive names what is linked in."""

from __future__ import annotations

from pathlib import Path

import pytest

from release import sbom


def test_the_bill_of_materials_is_that_of_the_pins() -> None:
    assert sbom.KEPT.read_text(encoding="utf-8") == sbom.bill(), "run tools/release/sbom.py"


def test_another_eigen_would_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    macros = tmp_path / "include" / "eigen3" / "Eigen" / "src" / "Core" / "util" / "Macros.h"
    macros.parent.mkdir(parents=True)
    macros.write_text("".join(f"#define EIGEN_{part}_VERSION 9\n" for part in ("WORLD", "MAJOR", "MINOR")))
    monkeypatch.setenv("Eigen3_DIR", str(tmp_path / "share" / "eigen3" / "cmake"))
    assert "pkg:generic/eigen@9.9.9" in sbom.bill() != sbom.KEPT.read_text(encoding="utf-8")
