from pathlib import Path

import pytest
from support.checkout import copy_checkout


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A fresh one, where nothing is built or installed."""
    place = tmp_path_factory.mktemp("checkout")
    copy_checkout(place)
    return place
