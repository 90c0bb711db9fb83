"""Packs an example's FMU: python pack.py NAME.fmu modelDescription.xml LIBRARY. The same inputs give the same bytes."""

from __future__ import annotations

import platform
import sys
from pathlib import Path

from pack_fmu import pack  # of the project's folder cmake/

FOLDERS = {"Linux": "linux64", "Darwin": "darwin64", "Windows": "win64"}  # ../../../docs/decisions/platform_folders.md


def main() -> None:
    """Writes the archive."""
    fmu, description, library = map(Path, sys.argv[1:])
    folder = FOLDERS[platform.system()]
    entries = {"modelDescription.xml": description, f"binaries/{folder}/{library.name}": library}
    terminals = description.parent / "terminalsAndIcons.xml"
    if terminals.exists():
        entries["terminalsAndIcons/terminalsAndIcons.xml"] = terminals
    pack(entries, fmu)


if __name__ == "__main__":
    main()
