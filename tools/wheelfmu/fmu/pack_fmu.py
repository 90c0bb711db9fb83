"""pack_fmu.py OUTPUT PLATFORM LIBRARY [NAME=FILE...]: description, libraries, documentation and licences in one zip
whose bytes depend on nothing else.

No part of the paper. PLATFORM: the folder of the library. Entries are sorted, dated 1980-01-01 and deflated; no time,
owner or path of the building machine goes in. NAME=FILE: licenses/NAME, or of a C source its notice, word for word.
"""

from __future__ import annotations

import re
import sys
import textwrap
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
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
    archive = ROOT / "fmu-src" / "archive"
    entries = {path.relative_to(archive).as_posix(): path for path in archive.rglob("*") if path.is_file()}
    entries |= {f"documentation/{name}": ROOT / "docs" / "figures" / name for name in FIGURES}
    entries |= {"modelDescription.xml": ROOT / "modelDescription.xml", "licenses/license.txt": ROOT / "LICENSE"}
    return entries | licences | {f"binaries/{platform}/wheel{library.suffix}": library}


def pack(entries: dict[str, Content], output: Path) -> None:
    with zipfile.ZipFile(output, "w") as archive:
        for name, content in sorted(entries.items()):
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.create_system = 3  # Unix, so that the permissions below are read
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            data = content if isinstance(content, bytes) else content.read_bytes()
            archive.writestr(info, data, zipfile.ZIP_DEFLATED, compresslevel=9)


if __name__ == "__main__":
    output, platform, library, *pairs = sys.argv[1:]
    files = {name: Path(file) for name, file in (pair.split("=", 1) for pair in pairs)}
    licences = {f"licenses/{n}": notice(file) if file.suffix in (".c", ".h") else file for n, file in files.items()}
    pack(contents(platform, Path(library), licences), Path(output))
