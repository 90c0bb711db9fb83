"""python -P -m wheelfmu COMMAND [WORD...]: a command under scripts/, once what it needs is installed."""

import os
import signal
import sys
from argparse import RawDescriptionHelpFormatter
from importlib import import_module
from types import ModuleType
from typing import Any

from wheelfmu import commands
from wheelfmu.fmu.files import worded
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Parser


def module_of(name: str) -> ModuleType:
    """The module of a command: of the product, or of a folder of the lab, each of which may be absent."""
    try:
        return import_module(commands.MODULES[name])
    except KeyError:
        sys.exit(f"scripts/{name} is a command of the lab, and its folder is not here.")


def read(name: str, module: ModuleType, words: list[str]) -> Any:
    """What is typed after a command; Fault, or argparse's end of the program."""
    if own := getattr(module, "reads", None):
        plain = [word for word in words if word not in ("-h", "--help")]
        if len(plain) < len(words) and hasattr(module, "usage"):
            print(module.usage(plain))
            sys.exit()
        return own(words)
    form = {"description": module.__doc__, "formatter_class": RawDescriptionHelpFormatter}
    parser = Parser(prog=f"./scripts/{name}", **form)
    for option, how in getattr(module, "OPTIONS", {}).items():
        parser.add_argument(option, **how)
    return parser.parse_args(words)


def needs(name: str, *words: str) -> tuple[str, ...] | list[str]:
    """What a command with these words needs of set-up; help ends the program."""
    with worded(name):
        module = module_of(name)
        given = read(name, module, [*words])
        return module.needs(given) if hasattr(module, "needs") else getattr(module, "NEEDS", ())


class Stop:
    """Ends a command by KeyboardInterrupt. Where a library takes it for its own, it comes again, unless the command
    itself finishes what it is at."""

    def __init__(self, *, again: float) -> None:
        self.number, self.again = 0, again  # s

    def __call__(self, number: int, _frame: object) -> None:
        self.number = self.number or number
        signal.setitimer(signal.ITIMER_REAL, self.again)
        raise KeyboardInterrupt


def main(name: str, *words: str) -> int:
    """Carries a command out; of what it has started nothing is left, also at Ctrl-C or a signal that ends it."""
    from wheelfmu.commands import processes

    os.environ["MPLBACKEND"] = "Agg"  # whatever a notebook has set for its own figures
    module = module_of(name)
    stop = Stop(again=0.0 if getattr(module, "FINISHES", False) else 1.0)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM):
        if signal.getsignal(number) is not signal.SIG_IGN:  # as by nohup, and SIGINT in a script's background job
            signal.signal(number, stop)
    try:
        with worded(name):
            given = read(name, module, [*words])
            if not getattr(module, "STAYS", False):
                os.chdir(ROOT)
            return int(module.main(given) or 0)
    except KeyboardInterrupt:
        print(f"\n{name}: {getattr(module, 'INTERRUPTED', 'interrupted.')}", file=sys.stderr)
        return 128 + stop.number
    except processes.Failed as failed:
        return failed.status
    finally:
        processes.end_all()


if __name__ == "__main__":
    status = main(*sys.argv[1:])
    if status > 128:  # nothing that a library has kept delays it, or ends it by the signal
        sys.stdout.flush()
        os._exit(status)
    sys.exit(status)
