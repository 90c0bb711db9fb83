"""Judges the libraries of a release as files: processor, exports, imports, oldest system; no part of the paper.

Each rule is checked on every library; the first that is broken ends the release.
"""

from __future__ import annotations

import hashlib
import math
import re
import struct
from pathlib import Path

import lief
from tabulate import tabulate

from wheelfmu.release.assembly import BINARIES, UNIVERSAL

GLIBC_FLOOR = (2, 17)
MACOS_FLOOR = [11, 0, 0]
FUNCTIONS = 44  # of FMI 2.0
NEEDS = re.compile(
    r"lib[cm]\.so\.6|ld-linux-(x86-64|aarch64)\.so\.[12]|(?i:kernel32\.dll)|api-ms-win-crt-.*|/usr/lib/libSystem\.B\.dylib"
)
INTEL, ARM_64 = lief.Header.ARCHITECTURES.X86_64, lief.Header.ARCHITECTURES.ARM64
LIBRARIES = [(name, file, ARM_64 if "aarch64" in name else INTEL) for name, file in BINARIES.items()]
LIBRARIES.append(("darwin64 (arm64)", UNIVERSAL, ARM_64))
LARGEST = 1 << 20  # bytes of a library for one processor
# Functions of the system's libm that may be used, because they are exact; all others are compiled in.
EXACT = {"floor", "ceil", "trunc", "fabs", "sqrt", "fmod", "scalbn", "ldexp", "frexp", "modf", "copysign"}
EXACT |= {"nearbyint", "nextafter", "remainder", "fma", "isfinite", "isinf", "isnan"}  # rounded as IEEE 754 asks
INEXACT = {"sincos", *dir(math)} - EXACT


def require(name: str, holds: bool, rule: str) -> None:
    if not holds:
        raise SystemExit(f"{name}: {rule}")


def oldest(name: str, library: lief.Binary) -> str:
    """The oldest system on which it loads; the rules of its format."""
    if library.format == lief.Binary.FORMATS.ELF:
        asked = {v.name for r in library.symbols_version_requirement for v in r.get_auxiliary_symbols()}
        newest = max(tuple(int(n) for n in version.removeprefix("GLIBC_").split(".")) for version in asked)
        require(name, newest <= GLIBC_FLOOR, f"asks for glibc {newest}")
        require(name, library.has(lief.ELF.Segment.TYPE.GNU_STACK) and library.has_nx, "has an executable stack")
        return f"glibc 2.17; newest versioned symbol required: GLIBC_{'.'.join(map(str, newest))}"
    if library.format == lief.Binary.FORMATS.PE:
        return "Windows 10"
    require(name, library.header.file_type == lief.MachO.Header.FILE_TYPE.DYLIB, "is not a dynamic library")
    require(name, library.build_version.minos == MACOS_FLOOR, f"wants macOS {library.build_version.minos}")
    return "macOS 11.0"


def signed(data: bytes, library: lief.MachO.Binary) -> bool:
    """The code directory of the ad-hoc signature holds the SHA-256 of every page of the library."""
    start = library.fat_offset
    assert library.code_signature is not None
    blob = start + library.code_signature.data_offset
    _, _, count = struct.unpack_from(">III", data, blob)
    slots = [struct.unpack_from(">II", data, blob + 12 + 8 * k) for k in range(count)]
    directory = blob + dict(slots)[0]
    _, _, _, _, hashes, _, _, pages, limit = struct.unpack_from(">9I", data, directory)
    length, kind, _, shift = struct.unpack_from(">4B", data, directory + 36)
    code, page = data[start : start + limit], 1 << shift
    found = [data[directory + hashes + length * k :][:length] for k in range(pages)]
    return kind == 2 and found == [hashlib.sha256(code[k : k + page]).digest() for k in range(0, limit, page)]


def judged(name: str, path: Path, processor: lief.Header.ARCHITECTURES) -> list[str]:
    """A row of the table."""
    # The libraries in one file for macOS live no longer than what was parsed.
    parts = lief.MachO.parse(str(path)) if lief.is_macho(str(path)) else [lief.parse(str(path))]
    fitting = [part for part in parts if part.abstract.header.architecture == processor]
    require(name, len(fitting) == 1, "is for another processor")
    (library,) = fitting
    needs = list(library.abstract.libraries)
    if library.format == lief.Binary.FORMATS.MACHO:
        own, *needs = needs
        require(name, own == "@rpath/wheel.dylib", f"is called {own}")
        trusted = processor == INTEL or signed(path.read_bytes(), library)  # Apple's arm processors ask for it
        require(name, trusted, "its signature does not fit its pages")
    kind = "functions" if library.format == lief.Binary.FORMATS.PE else "symbols"
    found = [getattr(library, f"{way}_{kind}") for way in ("exported", "imported")]
    exports, imports = ({symbol.name.removeprefix("_") for symbol in symbols} for symbols in found)
    exports -= {"WHEEL", "wheel_1", "_mh_dylib_header", "__dso_handle"}  # every library of these linkers has them
    size, foreign = library.original_size, [need for need in needs if not NEEDS.fullmatch(need)]
    require(name, not foreign, f"needs {foreign}")
    require(name, size < LARGEST, f"has {size} bytes")
    others = sorted(export for export in exports if not export.startswith("fmi2"))
    require(name, not others, f"exports {others[:9]}")
    require(name, len(exports) == FUNCTIONS, f"exports {len(exports)} functions")
    require(name, not imports & INEXACT, f"takes {imports & INEXACT} from the system, where they round differently")
    shown = {"the C run-time" if need.startswith("api-ms") else Path(need).name for need in needs}
    mathematics = ", ".join(sorted(imports & EXACT)) or "nothing"
    return [name, f"{size / 1e3:.0f} kB", oldest(name, library), ", ".join(sorted(shown)), mathematics]


def table(folder: Path) -> str:
    """What was found of each library, all of them judged."""
    lief.logging.disable()
    rows = [judged(name, folder / file, processor) for name, file, processor in LIBRARIES]
    head = ("library", "size", "loads from", "needs", "functions of the system's libm")
    return tabulate(rows, head, "pipe", disable_numparse=True)
