"""Opens a lesson on the rolling wheel, the notebook examples/wheel.ipynb, in JupyterLab."""

import os
from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.commands.build import fmu

OPTIONS = {"--write": {"action": "store_true", "help": "runs the notebook instead and saves its outputs in the file"}}


def needs(given: Namespace) -> list[str]:
    return ["study", "site", *["notebook"] * (not given.write)]


def main(given: Namespace) -> None:
    fmu()
    if given.write:
        from wheelfmu.publishing import notebook

        notebook.write()
    else:
        del os.environ["MPLBACKEND"]  # figures stand in the notebook
        # As root too, as in a container.
        processes.check(*processes.python("jupyterlab", "--allow-root", "examples/wheel.ipynb"))
