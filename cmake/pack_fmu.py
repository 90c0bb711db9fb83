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
ENDINGS = {"linux64": ".so", "aarch64-linux": ".so", "win64": ".dll", "darwin64": ".dylib", "aarch64-darwin": ".dylib"}
FIGURES = ("wheel.png", "paper_diagrams.png")
# Linked in by the cross compiler itself: its run-time, in part ported from musl, and those of C++ and of Windows.
ZIG_LICENCES = {
    "zig-license.txt": "LICENSE",
    "libcxx-license.txt": "lib/libcxx/LICENSE.TXT",
    "mingw-w64-license.txt": "lib/libc/mingw/COPYING",
    "musl-license.txt": "lib/libc/musl/COPYRIGHT",
}
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
    if arguments.zig:
        entries |= {name: arguments.zig / path for name, path in ZIG_LICENCES.items()}
    return {f"licenses/{name}": content for name, content in entries.items()}


def contents(
    binaries: dict[str, Path], licence_texts: dict[str, Content], evidence: Path | None = None
) -> dict[str, Content]:
    """Archive name of every entry and what goes into it."""
    entries: dict[str, Content] = {"modelDescription.xml": ROOT / "modelDescription.xml", **licence_texts}
    archive = ROOT / "fmu-src" / "archive"
    for path in archive.rglob("*"):
        if path.is_file():
            entries[path.relative_to(archive).as_posix()] = path
    for path in sorted(evidence.iterdir()) if evidence else ():
        entries[f"extra/org.fmi-standard.fmi-ls-ref/{path.name}"] = path
    for name in FIGURES:
        entries[f"documentation/{name}"] = ROOT / "docs" / "figures" / name
    for platform, path in binaries.items():
        entries[f"binaries/{platform}/wheel{ENDINGS.get(platform, path.suffix)}"] = path
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
    parser.add_argument("--zig", type=Path, help="folder of ziglang where it is the compiler, for what it links in")
    parser.add_argument("--evidence", type=Path, help="folder of the evidence of a release")
    parser.add_argument("--binary", action="append", default=[], help="platform=library")
    arguments = parser.parse_args()
    binaries = {}
    for pair in arguments.binary:
        platform, path = pair.split("=", 1)
        binaries[platform] = Path(path)
    pack(contents(binaries, licences(arguments), arguments.evidence), arguments.output)


if __name__ == "__main__":
    main()
