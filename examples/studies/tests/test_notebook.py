"""The notebook is kept with what its cells give: they run from the first to the last, and give that again."""

import re
from base64 import b64decode
from io import BytesIO
from pathlib import Path

import nbformat
import numpy as np
from PIL import Image
from support.bounds import beyond, within

from publishing.notebook import NOTEBOOK, executed


def contents(notebook: nbformat.NotebookNode) -> tuple[list[str], list[np.ndarray]]:
    """The printed texts, with nine digits, for the last ones depend on the machine; the pictures in tones of grey."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    data = [{"text/plain": output.get("text", "")} | output.get("data", {}) for output in outputs]
    assert all(kinds.keys() <= {"text/plain", "image/png"} for kinds in data)
    words = [re.sub(r"(\d\.\d{9})\d+", r"\1", kinds["text/plain"]) for kinds in data]
    files = [BytesIO(b64decode(kinds["image/png"])) for kinds in data if "image/png" in kinds]
    return words, [np.asarray(Image.open(file).convert("L"), dtype=float) for file in files]


def test_the_notebook_keeps_what_its_cells_give_and_nothing_of_the_machine(fmu_path: Path, tmp_path: Path) -> None:
    words, pictures = contents(nbformat.read(NOTEBOOK, as_version=4))
    fresh_words, fresh_pictures = contents(executed(str(fmu_path), str(tmp_path)))
    assert words == fresh_words, "run ./scripts/notebook --write"
    for one, other in zip(pictures, fresh_pictures, strict=True):
        assert one.shape == other.shape
        within(abs(one - other).mean(), 0.5, "pictures apart, of 255 tones of grey")  # other fonts
    height, width = np.minimum(pictures[0].shape, pictures[1].shape)
    beyond(abs(pictures[0][:height, :width] - pictures[1][:height, :width]).mean(), 5, "another picture apart, tones")
    printed, text = "".join(words), NOTEBOOK.read_text(encoding="utf-8")
    assert len(pictures) == 3
    assert "ended at t = 0.59" in printed and printed.count("of 40 wheels") == 3 and "nan" not in printed
    assert "it/s" not in text and "iopub" not in text and "stderr" not in text
