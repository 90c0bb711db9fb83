"""The notebook is kept with what its cells give: they run from the first to the last, and give that again."""

import re
from base64 import b64decode
from io import BytesIO
from pathlib import Path

import nbformat
import numpy as np
import pytest
from PIL import Image
from support.bounds import beyond, within

from publishing.notebook import NOTEBOOK, executed

Outputs = list[nbformat.NotebookNode]


def outputs(notebook: nbformat.NotebookNode) -> Outputs:
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def words(kept: Outputs) -> list[str]:
    """The printed text, with nine digits: the last ones depend on the machine."""
    texts = [output.get("text") or output.get("data", {}).get("text/plain", "") for output in kept]
    return [re.sub(r"(\d\.\d{9})\d+", r"\1", text) for text in texts]


def pictures(kept: Outputs) -> list[np.ndarray]:
    found = [output.data["image/png"] for output in kept if "image/png" in output.get("data", {})]
    return [np.asarray(Image.open(BytesIO(b64decode(png))).convert("L"), dtype=float) for png in found]


@pytest.fixture(scope="module")
def kept() -> Outputs:
    return outputs(nbformat.read(NOTEBOOK, as_version=4))


@pytest.fixture(scope="module")
def fresh(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Outputs:
    return outputs(executed(str(fmu_path), str(tmp_path_factory.mktemp("notebook"))))


def test_what_the_notebook_keeps_is_what_its_cells_give(kept: Outputs, fresh: Outputs) -> None:
    assert words(kept) == words(fresh), "run ./scripts/notebook --write"
    for one, other in zip(pictures(kept), pictures(fresh), strict=True):
        assert one.shape == other.shape
        within(abs(one - other).mean(), 0.5, "pictures apart, of 255 tones of grey")  # other fonts
    first, second, *_ = pictures(kept)
    height, width = (min(one, other) for one, other in zip(first.shape, second.shape, strict=True))
    apart = abs(first[:height, :width] - second[:height, :width]).mean()
    beyond(apart, 5, "another picture apart, of 255 tones of grey")


def test_the_notebook_keeps_its_message_counts_and_pictures_and_nothing_of_the_machine(kept: Outputs) -> None:
    printed = "".join(words(kept))
    assert len(pictures(kept)) == 3
    assert "ended at t = 0.59" in printed and printed.count("of 40 wheels") == 3 and "nan" not in printed
    text = NOTEBOOK.read_text(encoding="utf-8")
    assert "it/s" not in text and "iopub" not in text and "stderr" not in text
    assert all(set(output.get("data", {})) <= {"text/plain", "image/png"} for output in kept)
