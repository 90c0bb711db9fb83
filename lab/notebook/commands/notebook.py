"""Opens a lesson on the rolling wheel, the notebook lab/notebook/wheel.ipynb, in JupyterLab."""

import os
from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.commands.build import fmu

NEEDS = ("notebook", "studies")
OPTIONS = {"--write": {"action": "store_true", "help": "runs the notebook instead and saves its outputs in the file"}}


def main(given: Namespace) -> None:
    fmu()
    if given.write:
        from lab.notebook import writing

        writing.write()
    else:
        del os.environ["MPLBACKEND"]  # figures stand in the notebook
        # As root too, as in a container.
        processes.check(*processes.python("jupyterlab", "--allow-root", "lab/notebook/wheel.ipynb"))
