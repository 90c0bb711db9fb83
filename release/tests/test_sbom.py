"""The bill of materials in the archive names what is linked in."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from release import sbom  # noqa: E402


def test_the_bill_of_materials_is_that_of_the_pins() -> None:
    kept = ROOT / "fmu-src" / "archive" / "extra" / "org.fmi-standard.fmi-ls-ref" / "sbom.cdx.json"
    assert kept.read_text(encoding="utf-8") == sbom.bill(), "run release/sbom.py"
