"""One wheel.fmu for every platform, out of the libraries that the cross compiler makes of one folder of sources."""

from __future__ import annotations

import struct
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

from wheelfmu.fmu import pack_fmu
from wheelfmu.fmu.paths import ROOT
from wheelfmu.release.compiling import build, compiler

LINUX, ARM, WINDOWS = "x86_64-linux-gnu.2.17", "aarch64-linux-gnu.2.17", "x86_64-windows-gnu"
INTEL_MAC, ARM_MAC = "x86_64-macos.11.0", "aarch64-macos.11.0"
UNIVERSAL = "wheel.dylib"  # for both of Apple's processors
# The platforms of FMI, and where a build leaves their libraries.
BINARIES = {
    "linux64": f"{LINUX}/wheel.so",
    "aarch64-linux": f"{ARM}/wheel.so",
    "win64": f"{WINDOWS}/wheel.dll",
    "darwin64": UNIVERSAL,
    "aarch64-darwin": f"{ARM_MAC}/wheel.dylib",
}
MACHO_64, FAT = 0xFEEDFACF, 0xCAFEBABE
ALIGNMENT = 14  # power of two: 16 KiB, the page of Apple's arm processors
EVIDENCE = "extra/org.fmi-standard.fmi-ls-ref"
# Linked in by the cross compiler itself: its run-time, in part ported from musl, and those of C++ and of Windows.
LICENCES = {
    "zig-license.txt": "LICENSE",
    "libcxx-license.txt": "lib/libcxx/LICENSE.TXT",
    "mingw-w64-license.txt": "lib/libc/mingw/COPYING",
    "musl-license.txt": "lib/libc/musl/COPYRIGHT",
}


def universal(libraries: list[bytes]) -> bytes:
    """Mach-O libraries of several processors in one, byte for byte, which keeps their signatures: a header, one row per
    processor (type, subtype, offset, size, alignment), big endian; then the libraries."""
    page = 1 << ALIGNMENT
    header, body = struct.pack(">II", FAT, len(libraries)), b""
    for library in libraries:
        magic, processor, subtype = struct.unpack_from("<III", library)
        if magic != MACHO_64:
            raise ValueError("not a 64-bit Mach-O library")
        header += struct.pack(">IIIII", processor, subtype, page + len(body), len(library), ALIGNMENT)
        body += library + b"\0" * (-len(library) % page)
    return header.ljust(page, b"\0") + body


def licences(zig: Path) -> dict[str, Path]:
    return {f"licenses/{name}": zig / path for name, path in LICENCES.items()}


def write(out: Path, sources: Path = ROOT, zig: Path | None = None, sundials: str = "") -> Path:
    """out/wheel.fmu: the archive of the Linux build with the libraries of all platforms and its own evidence."""
    zig = zig or compiler()
    for platform in (LINUX, ARM, WINDOWS, INTEL_MAC, ARM_MAC):
        build(out / platform, platform, "fmu", sources, zig, sundials)
    macs = [(out / platform / "wheel.dylib").read_bytes() for platform in (INTEL_MAC, ARM_MAC)]
    (out / UNIVERSAL).write_bytes(universal(macs))
    with ZipFile(out / LINUX / "wheel.fmu") as archive:
        entries = {name: archive.read(name) for name in archive.namelist()} | licences(zig)
    entries |= {f"binaries/{name}/wheel{Path(file).suffix}": out / file for name, file in BINARIES.items()}
    fmu, evidence = out / "wheel.fmu", out / "evidence"
    pack_fmu.pack(entries, fmu)
    subprocess.run(
        [sys.executable, sources / "tools" / "wheelfmu" / "release" / "evidence.py", fmu, evidence], check=True
    )
    pack_fmu.pack(entries | {f"{EVIDENCE}/{path.name}": path for path in evidence.iterdir()}, fmu)
    return fmu
