"""Lists the commands, a line each; `./scripts/NAME --help` explains one."""

import re
import sys
from importlib import import_module
from pathlib import Path


def reads(_words: list[str]) -> None:
    names = sorted(path.stem for path in Path(__file__).parent.glob("[a-z]*.py"))
    for name in names:
        module = import_module(f"wheelfmu.commands.{name}")
        if hasattr(module, "main"):
            about = " ".join((module.__doc__ or "").split())
            print(f"{name:12s}{re.split(r'[.;:] ', about)[0].rstrip('.')}.")
    sys.exit()


def main(_given: None) -> None:
    """The list is printed as the arguments are read."""
