"""The notebook is kept with what its cells give: they run from the first to the last, and give that again. Its lesson
is true: the linear solution is the wheel's own for small leans, and each solution of an exercise gives its numbers."""

from __future__ import annotations

import contextlib
import io
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from support.bounds import beyond, relative_error, within

from lab.notebook.writing import NOTEBOOK, executed, kept
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER

if TYPE_CHECKING:
    from nbformat import NotebookNode


def printed(notebook: NotebookNode) -> list[str]:
    """The texts that the cells give, with nine digits, for the last ones depend on the machine; a line per picture."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    texts = [output.get("text") or output["data"].get("text/plain", "a picture") for output in outputs]
    return [re.sub(r"(\d\.\d{9})\d+", r"\1", text) for text in texts]


def test_the_notebook_keeps_what_its_cells_give_and_nothing_of_the_machine(fmu_path: Path, tmp_path: Path) -> None:
    words, fresh = (printed(book) for book in (kept(), executed(str(fmu_path), str(tmp_path))))
    assert words == fresh, "run ./scripts/notebook --write"
    assert words.count("a picture") == 7 and "nan" not in "".join(words)
    assert f"{critical_spin(PAPER):.4f} rad/s" in "".join(words)
    text = NOTEBOOK.read_text(encoding="utf-8")
    assert "it/s" not in text and "iopub" not in text and "stderr" not in text


@pytest.fixture(scope="module")
def lesson(fmu_path: Path) -> dict[str, object]:
    """What is defined after all cells but that of the study, without pictures."""
    mpl.use("Agg")
    names: dict[str, object] = {}
    with contextlib.chdir(NOTEBOOK.parent), contextlib.redirect_stdout(io.StringIO()):
        for cell in kept().cells:
            if cell.cell_type == "code" and "study.run" not in cell.source:
                exec(cell.source.replace("../../wheel.fmu", str(fmu_path)), names)
    plt.close("all")
    return names


def test_the_cell_that_teachers_add_gives_the_critical_spin_of_its_wheel(lesson, capsys) -> None:
    guide = (ROOT / "docs" / "teaching.md").read_text(encoding="utf-8")
    (cell,) = re.findall(r"```python\n(.*?)```", guide, re.DOTALL)
    exec(cell, dict(lesson))
    m, r_0, r = 20.0, 0.25, 0.08  # homogeneous torus
    J_x, J_z = m * (r_0**2 / 2 + 5 / 8 * r**2), m * (r_0**2 + 3 / 4 * r**2)
    critical = np.sqrt(m * 9.81 * r_0 * J_x / (J_z * (J_z + m * (r_0 + r) ** 2)))
    within(abs(float(capsys.readouterr().out) / critical - 1), 1e-12, "critical spin, relative")


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
    beyond(apart(0.1), 1e-3, "linear solution off a wheel that starts with 6 deg, of the largest lean")


@cache
def solutions() -> list[tuple[str, str, str]]:
    """Number, words and code of each exercise's."""
    return re.findall(
        r"\*\*(\d)\. .*?<details><summary>Solution</summary>\n(.*?)```python\n(.*?)```\n\n</details>",
        "".join(cell.source for cell in kept().cells if "Exercises" in cell.source),
        re.DOTALL,
    )


@pytest.mark.parametrize("number", "1234567")
def test_every_exercise_has_a_hidden_solution_that_gives_its_numbers(lesson, number: str) -> None:
    assert [found for found, *_ in solutions()] == list("1234567")
    ((_, words, code),) = (found for found in solutions() if found[0] == number)
    with contextlib.redirect_stdout(io.StringIO()) as printed, contextlib.chdir(NOTEBOOK.parent):
        exec(code, dict(lesson))
    values = np.array(re.findall(r"-?\d+\.\d+(?:e-?\d+)?", printed.getvalue()), dtype=float)
    if number in "15":  # beside the closed form; of two masses
        within(relative_error(values[::2], values[1::2]), 1e-9, "closed form or masses apart, relative")
    elif number == "7":  # coefficient, farthest place, speed at the end, of two roads
        within(relative_error(values[2::3], np.full(2, -1.0)), 1e-9, "speed at the end off 1 m/s back, relative")
        beyond(relative_error(values[1::3], values[1]), 0.1, "places apart, relative")
    else:
        assert f"{values[0]:.2g}" in words or f"{values[0]:.3g}" in words
