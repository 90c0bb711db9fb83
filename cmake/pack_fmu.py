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


def licences(arguments: argparse.Namespace) -> dict[str, Content]:
    entries: dict[str, Content] = {
        "license.txt": ROOT / "LICENSE",
        "sundials-license.txt": arguments.sundials / "LICENSE",
        "sundials-notice.txt": arguments.sundials / "NOTICE",
        "fmi-headers-notice.txt": notice(arguments.fmi_headers / "fmi2Functions.h"),
    }
    if arguments.eigen_license:
        entries["eigen-license.txt"] = arguments.eigen_license
    if arguments.libm:
        entries["fdlibm-notice.txt"] = notice(arguments.libm / "s_sin.c")
        entries["arm-math-license.txt"] = notice(arguments.libm / "pow.c")
    return {f"licenses/{name}": content for name, content in entries.items()}


def contents(platform: str, library: Path, licence_texts: dict[str, Content]) -> dict[str, Content]:
    """Archive name of every entry and what goes into it."""
    entries: dict[str, Content] = {"modelDescription.xml": ROOT / "modelDescription.xml", **licence_texts}
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--sundials", type=Path, required=True, help="SUNDIALS source, for its licence")
    parser.add_argument("--fmi-headers", type=Path, required=True, help="folder of the FMI headers, for their notice")
    parser.add_argument("--eigen-license", type=Path, help="Eigen's licence")
    parser.add_argument(
        "--libm", type=Path, help="folder of libm's sources, for their notices, where they are linked in"
    )
    parser.add_argument("--platform", required=True, help="folder of the library in the archive")
    parser.add_argument("--library", type=Path, required=True)
    arguments = parser.parse_args()
    pack(contents(arguments.platform, arguments.library, licences(arguments)), arguments.output)


if __name__ == "__main__":
    main()
