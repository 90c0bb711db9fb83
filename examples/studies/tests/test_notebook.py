"""The notebook is kept with what its cells give: they run from the first to the last, and give that again. Its lesson
is true: the linear solution is the wheel's own for small leans, and each solution of an exercise gives its numbers."""

import contextlib
import io
import re
from base64 import b64decode
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from PIL import Image
from support.bounds import beyond, within
from support.closed_forms import critical_spin
from support.scenes import PAPER

from publishing.notebook import NOTEBOOK, executed


def contents(notebook: nbformat.NotebookNode) -> tuple[list[str], list[np.ndarray]]:
    """The printed texts, with nine digits, for the last ones depend on the machine; the pictures in tones of grey."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    data = [{"text/plain": output.get("text", "")} | output.get("data", {}) for output in outputs]
    assert all(kinds.keys() <= {"text/plain", "image/png"} for kinds in data)
    words = [re.sub(r"(\d\.\d{9})\d+", r"\1", kinds["text/plain"]) for kinds in data]
    files = [io.BytesIO(b64decode(kinds["image/png"])) for kinds in data if "image/png" in kinds]
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
    assert len(pictures) == 5
    assert f"{critical_spin(PAPER):.4f} rad/s" in printed and "nan" not in printed
    assert "it/s" not in text and "iopub" not in text and "stderr" not in text


@pytest.fixture(scope="module")
def lesson(fmu_path: Path) -> dict[str, object]:
    """What is defined after all cells but that of the study, without pictures."""
    mpl.use("Agg")
    names: dict[str, object] = {}
    with contextlib.chdir(NOTEBOOK.parent), contextlib.redirect_stdout(io.StringIO()):
        for cell in nbformat.read(NOTEBOOK, as_version=4).cells:
            if cell.cell_type == "code" and "study.run" not in cell.source:
                exec(cell.source.replace("../wheel.fmu", str(fmu_path)), names)
    plt.close("all")
    return names


@pytest.mark.parametrize("share", [0.9, 1.1, 2.0])
def test_the_linear_lean_of_the_lesson_is_the_wheels_for_small_leans(lesson, share: float) -> None:
    spin = share * lesson["critical"]

    def apart(lean: float) -> float:
        """The largest difference over the largest lean."""
        start = {"theta_start": np.pi / 2 - lean, "phi_dot_start": -spin}
        run = lesson["simulate_fmu"](lesson["fmu"], start_values=start, stop_time=2, output=["theta"])
        linear = lesson["linear_lean"](run["time"], lean, spin, **lesson["paper"])
        return abs(np.pi / 2 - run["theta"] - linear).max() / linear.max()

    within(apart(1e-5), 1e-6, "linear solution off the wheel's, of the largest lean")
    beyond(apart(0.1), 1e-3, "the same of a start with 6 deg")


GRAVITY, RADIUS = 9.81, 0.35


def test_the_hoop_of_the_lesson_grips_and_comes_back_as_by_hand(lesson) -> None:
    run, t = lesson["run"], lesson["t_grip"]
    slip = np.interp([t - 0.02, t + 0.02], run["time"], run["slip_x"])
    assert slip[0] > 0 and slip[1] == 0
    within(abs(run["X_O_dot"][-1] - 2 + lesson["mu"] * GRAVITY * t), 1e-7, "velocity after the slide, m/s")
    beyond(abs(run["X_O_dot"][-1] - 2 + 1.01 * lesson["mu"] * GRAVITY * t), 0.01, "with 1 % more friction, m/s")


SOLUTIONS = re.findall(
    r"\*\*(\d)\. .*?<details><summary>Solution</summary>\n(.*?)```python\n(.*?)```\n\n</details>",
    "".join(cell.source for cell in nbformat.read(NOTEBOOK, as_version=4).cells if "Exercises" in cell.source),
    re.DOTALL,
)
# By exercise: pairs of what is printed and what it must be, relative; None: any value.
EXPECTED = {
    "1": [np.sqrt(GRAVITY / 4 / RADIUS), np.sqrt(GRAVITY / 4 / RADIUS)]
    + [np.sqrt(GRAVITY / 3 / RADIUS), np.sqrt(GRAVITY / 3 / RADIUS)],
    "2": [15.3, 0.2],
    "3": [5.1, 7.0],
    "4": [-4.94, 0.0],
    "6": [0.593, 0.591],
}


@pytest.mark.parametrize("number", "123456")
def test_every_exercise_has_a_hidden_solution_that_gives_its_numbers(lesson, number: str) -> None:
    assert [found for found, *_ in SOLUTIONS] == list("123456")
    ((_, words, code),) = (found for found in SOLUTIONS if found[0] == number)
    with contextlib.redirect_stdout(io.StringIO()) as printed, contextlib.chdir(NOTEBOOK.parent):
        exec(code, dict(lesson))
    lines = [line for line in printed.getvalue().splitlines() if not line.startswith("[")]
    values = [float(value) for value in re.findall(r"-?\d+\.\d+(?:e-?\d+)?", " ".join(lines))]
    if number == "5":  # the same motion whatever the mass
        within(abs(values[0] / values[1] - 1), 1e-9, "theta after 10 s of two masses, relative")
        return
    for value, expected in zip(values, EXPECTED[number], strict=True):
        assert value == pytest.approx(expected, rel=0.02, abs=1e-6)
    claimed = {"2": "15.3 rad/s", "3": "5.1", "4": "-4.94 rad/s", "6": "0.593 s"}
    assert claimed.get(number, "") in words
