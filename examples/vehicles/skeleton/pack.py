"""Packs an example's FMU: python pack.py NAME.fmu modelDescription.xml LIBRARY. The same inputs give the same bytes."""

from __future__ import annotations

import platform
import sys
import zipfile
from pathlib import Path

FOLDERS = {
    ("Linux", "x86_64"): "linux64",
    ("Linux", "aarch64"): "aarch64-linux",
    ("Darwin", "x86_64"): "darwin64",
    ("Darwin", "arm64"): "darwin64",
    ("Windows", "AMD64"): "win64",
}


def main() -> None:
    """Writes the archive."""
    fmu, description, library = map(Path, sys.argv[1:])
    folder = FOLDERS[platform.system(), platform.machine()]
    entries = {"modelDescription.xml": description, f"binaries/{folder}/{library.name}": library}
    terminals = description.parent / "terminalsAndIcons.xml"
    if terminals.exists():
        entries["terminalsAndIcons/terminalsAndIcons.xml"] = terminals
    with zipfile.ZipFile(fmu, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, path in entries.items():
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, path.read_bytes())


if __name__ == "__main__":
    main()
