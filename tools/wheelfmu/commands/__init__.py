"""The commands under scripts/, a module each, whose docstring is its help: of the product here, of the lab in
lab/FOLDER/commands.

What is typed is read by OPTIONS, of one parser for all, or by `reads`, with its help by `usage`; NEEDS, or `needs`, are
the words of set-up for it; `main` carries it out and returns the exit status. What stands at the head of a module is of
the standard library alone: arguments are read before anything is installed. One that FINISHES ends itself at Ctrl-C,
and INTERRUPTED is its word on that; one that STAYS works in the caller's folder, all others in the project's.
"""

from pathlib import Path

from wheelfmu.fmu.paths import LAB, ROOT

PLACES = {"wheelfmu.commands": Path(__file__).parent}
PLACES |= {f"lab.{name}.commands": ROOT / "lab" / name / "commands" for name in LAB}
# The module of each command that is here.
MODULES = {
    path.stem: f"{package}.{path.stem}"
    for package, folder in PLACES.items()
    for path in folder.glob("[a-z]*.py")
    if path.stem != "processes"
}
