"""Runs wheel.ipynb and keeps the outputs of its cells: text and pictures, without run times and progress bars.

`write` keeps them in the notebook. The site shows it, and a test runs it again and compares. nbformat is imported where
it is used: that takes seconds.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from wheelfmu.fmu.paths import ROOT

if TYPE_CHECKING:
    from nbformat import NotebookNode

NOTEBOOK = ROOT / "lab" / "notebook" / "wheel.ipynb"
KEPT = ("text/plain", "image/png")


def kept() -> NotebookNode:
    """The notebook as it is."""
    import nbformat

    return nbformat.read(NOTEBOOK, as_version=4)


def executed(fmu: str = "../../wheel.fmu", results: str = "../../results") -> NotebookNode:
    """The notebook with fresh outputs; fmu, results: in the place of ../../wheel.fmu and ../../results.

    As without Jupyter's widgets, of which no file keeps what they show.
    """
    from nbclient import NotebookClient

    notebook = kept()
    cells = [(cell, cell.source) for cell in notebook.cells]
    for cell, source in cells:
        here = source.replace("../../wheel.fmu", fmu).replace("../../results", results)
        cell.source = here.replace("from ipywidgets", "from no_widgets")
    place = {"metadata": {"path": NOTEBOOK.parent}}
    # The output of a cell comes in pieces, more of them on a busy machine: each stream becomes one.
    client = NotebookClient(notebook, timeout=1800, record_timing=False, coalesce_streams=True, resources=place)
    # Figures stand in the notebook, whatever the backend of this process.
    client.execute(env={name: value for name, value in os.environ.items() if name != "MPLBACKEND"})
    for number, (cell, source) in enumerate(cells):
        cell.source, cell.metadata, cell.id = source, {}, f"cell-{number}"
        if cell.cell_type == "code":
            cell.outputs = [strip(output) for output in cell.outputs if output.get("name") != "stderr"]
    notebook.metadata.pop("widgets", None)
    notebook.metadata["language_info"] = {"name": "python"}
    return notebook


def strip(output: NotebookNode) -> NotebookNode:
    """Words and pictures alone; where there is a picture, it is enough."""
    if "data" in output:
        kinds = [kind for kind in KEPT if kind in output.data]
        output.data = {kind: output.data[kind] for kind in kinds[-1:]}
        output.metadata = {}
    return output


def write() -> None:
    import nbformat

    nbformat.write(executed(), NOTEBOOK)
    print(f"Ran {NOTEBOOK.relative_to(ROOT)}.")
