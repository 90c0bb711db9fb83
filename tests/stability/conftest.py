"""The stability tests drive the built FMU with the report's own tools, scripts/stability_report."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))

from stability_report.driver import Library  # noqa: E402


@pytest.fixture(scope="session")
def library(fmu_path: Path) -> Iterator[Library]:
    """The loaded library; instances come and go."""
    loaded = Library(fmu_path)
    yield loaded
    loaded.close()
