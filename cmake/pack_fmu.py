"""Packs wheel.fmu: description, libraries, documentation and licences in one zip whose bytes depend on nothing else.

No part of the paper. Entries are sorted, dated 1980-01-01 and deflated; no time, owner or path of the building
machine goes in. The licences of what is compiled in are taken from its sources, word for word.
"""

from __future__ import annotations

import argparse
import re
import textwrap
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FIGURES = ("wheel.png", "paper_diagrams.png")
Content = Path | bytes


def notice(source: Path) -> bytes:
    """Copyright, conditions and disclaimer of a C source, as they stand in its first comment with a copyright."""
    text = source.read_text(encoding="utf-8")
    place = text.lower().index("copyright (c)")
    comment = text[text.rindex("\n", 0, place) + 1 : text.index("*/", place)]
    lines = [re.sub(r"^ \*(=| =)*|\s+$", "", line) for line in comment.splitlines()]  # stars in front, lines of "="
    return (textwrap.dedent("\n".join(lines)).strip() + "\n").encode()


def contents(platform: str, library: Path, licences: dict[str, Content]) -> dict[str, Content]:
    """Archive name of every entry and what goes into it."""
    entries: dict[str, Content] = {
        "modelDescription.xml": ROOT / "modelDescription.xml",
        "licenses/license.txt": ROOT / "LICENSE",
    } | licences
    archive = ROOT / "fmu-src" / "archive"
    for path in archive.rglob("*"):
        if path.is_file():
            entries[path.relative_to(archive).as_posix()] = path
    for name in FIGURES:
        entries[f"documentation/{name}"] = ROOT / "docs" / "figures" / name
    entries[f"binaries/{platform}/wheel{library.suffix}"] = library
    return entries


def pack(entries: dict[str, Content], output: Path) -> None:
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in sorted(entries.items()):
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3  # Unix, so that the permissions below are read
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            data = content if isinstance(content, bytes) else content.read_bytes()
            archive.writestr(info, data, compresslevel=9)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path)
    parser.add_argument("platform", help="folder of the library in the archive")
    parser.add_argument("library", type=Path)
    parser.add_argument("licences", nargs="*", help="NAME=FILE for licenses/NAME, or for a C source its notice alone")
    given = parser.parse_args()
    files = {name: Path(file) for name, file in (pair.split("=", 1) for pair in given.licences)}
    licences = {f"licenses/{n}": notice(file) if file.suffix in (".c", ".h") else file for n, file in files.items()}
    pack(contents(given.platform, given.library, licences), given.output)
