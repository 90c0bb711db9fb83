"""Lists the commands, a line each; `./scripts/NAME --help` explains one."""

import re
import sys
from importlib import import_module

from wheelfmu.commands import MODULES


def reads(_words: list[str]) -> None:
    for name, module in sorted(MODULES.items()):
        about = " ".join((import_module(module).__doc__ or "").split())
        print(f"{name:12s}{re.split(r'[.;:] ', about)[0].rstrip('.')}.")
    sys.exit()


def main(_given: None) -> None:
    """The list is printed as the arguments are read."""
