"""The FMU as a function from scene to motion."""

from __future__ import annotations

import pytest

from .product import Product


@pytest.fixture(scope="session")
def wheel(fmu: str, description) -> Product:
    return Product(fmu, description)
