"""The unfolded free wheel alone: a shared library made in the folder under test."""

from __future__ import annotations

import ctypes
import subprocess

import pytest
from support.paths import build_folder


@pytest.fixture(scope="session")
def library() -> ctypes.CDLL:
    folder = build_folder()
    subprocess.run(["cmake", "--build", folder, "--target", "orbit_probe"], check=True, capture_output=True)
    return ctypes.CDLL(str(next((folder / "tests" / "orbit").glob("*orbit_probe.*"))))
