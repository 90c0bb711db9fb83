"""Packs wheel.fmu: description, libraries, documentation and licences in one zip whose bytes depend on nothing else.

Entries are sorted, dated 1980-01-01 and deflated; no time, owner or path of the building machine goes in.
"""

from __future__ import annotations

import argparse
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENDINGS = {"linux64": ".so", "aarch64-linux": ".so", "win64": ".dll", "darwin64": ".dylib"}
FIGURES = ("wheel.png", "paper_diagrams.png")


def contents(binaries: dict[str, Path], sundials: Path, musl: Path | None) -> dict[str, Path]:
    """Archive name of every entry and the file behind it."""
    entries = {
        "modelDescription.xml": ROOT / "modelDescription.xml",
        "licenses/license.txt": ROOT / "LICENSE",
        "licenses/sundials-license.txt": sundials / "LICENSE",
        "licenses/sundials-notice.txt": sundials / "NOTICE",
    }
    if musl:
        entries["licenses/musl-license.txt"] = musl / "COPYRIGHT"
    archive = ROOT / "fmu-src" / "archive"
    for path in archive.rglob("*"):
        if path.is_file():
            entries[path.relative_to(archive).as_posix()] = path
    for name in FIGURES:
        entries[f"documentation/{name}"] = ROOT / "docs" / "figures" / name
    for platform, path in binaries.items():
        entries[f"binaries/{platform}/wheel{ENDINGS.get(platform, path.suffix)}"] = path
    return entries


def pack(entries: dict[str, Path], output: Path) -> None:
    with zipfile.ZipFile(output, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, path in sorted(entries.items()):
            info = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3  # Unix, so that the permissions below are read
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, path.read_bytes(), compresslevel=9)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--sundials", type=Path, required=True, help="SUNDIALS source, for its licence")
    parser.add_argument("--musl", type=Path, help="musl's folder, for its licence, where its libm is linked in")
    parser.add_argument("--binary", action="append", default=[], help="platform=library")
    arguments = parser.parse_args()
    binaries = {}
    for pair in arguments.binary:
        platform, path = pair.split("=", 1)
        binaries[platform] = Path(path)
    pack(contents(binaries, arguments.sundials, arguments.musl), arguments.output)


if __name__ == "__main__":
    main()
