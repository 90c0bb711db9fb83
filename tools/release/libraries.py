"""Judges the libraries of a release as files: processor, exports, imports, oldest system; no part of the paper.

Each rule is checked on every library; the first that is broken ends the release.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import lief

from publishing import markdown
from release.fmu import ARM, ARM_MAC, LINUX, UNIVERSAL, WINDOWS

GLIBC_FLOOR = (2, 17)
MACOS_FLOOR = [11, 0, 0]
FUNCTIONS = 44  # of FMI 2.0
LARGEST = 1 << 20  # bytes of a library for one processor
# What the systems' own mathematics may be asked for: it is exact. All else is compiled in.
EXACT = {"floor", "ceil", "trunc", "fabs", "sqrt", "fmod", "scalbn", "ldexp", "frexp", "modf", "copysign"}
EXACT |= {"nearbyint", "remainder", "fma"}  # each rounded correctly, as IEEE 754 asks
INEXACT = {"sin", "cos", "sincos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh"}
INEXACT |= {"atanh", "exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "pow", "cbrt", "hypot"}


class Facts(NamedTuple):
    name: str
    size: int
    exports: set[str]
    imports: set[str]
    needs: set[str]  # libraries
    oldest: str  # system on which it loads


def require(name: str, holds: bool, rule: str) -> None:
    if not holds:
        raise SystemExit(f"{name}: {rule}")


def linux(name: str, path: Path, machine: lief.ELF.ARCH) -> Facts:
    library = lief.ELF.parse(str(path))
    require(name, library.header.machine_type == machine, "is for another processor")
    needs = set(library.libraries)
    allowed = {"libc.so.6", "libm.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
    require(name, needs <= allowed, f"needs {needs - allowed}")
    asked = {v.name for r in library.symbols_version_requirement for v in r.get_auxiliary_symbols()}
    versions = [tuple(int(n) for n in version.removeprefix("GLIBC_").split(".")) for version in asked]
    require(name, max(versions) <= GLIBC_FLOOR, f"asks for glibc {max(versions)}")
    stack = library.get(lief.ELF.Segment.TYPE.GNU_STACK)
    require(name, stack is not None and not stack.has(lief.ELF.Segment.FLAGS.X), "has an executable stack")
    exports = {s.name for s in library.exported_symbols} - {"WHEEL", "wheel_1"}
    imports = {s.name for s in library.imported_symbols}
    newest = ".".join(map(str, max(versions)))
    return Facts(name, path.stat().st_size, exports, imports, needs, f"glibc 2.17; newest symbol asked for: {newest}")


def windows(name: str, path: Path) -> Facts:
    library = lief.PE.parse(str(path))
    require(name, library.header.machine == lief.PE.Header.MACHINE_TYPES.AMD64, "is for another processor")
    needs = {entry.name for entry in library.imports}
    foreign = {n for n in needs if n.lower() != "kernel32.dll" and not n.startswith("api-ms-win-crt-")}
    require(name, not foreign, f"needs {foreign}")
    exports = {entry.name for entry in library.get_export().entries}
    imports = {f.name for entry in library.imports for f in entry.entries}
    return Facts(name, path.stat().st_size, exports, imports, {"kernel32", "the C run-time"}, "Windows 10")


def macos(name: str, path: Path, processor: lief.MachO.Header.CPU_TYPE) -> Facts:
    fat = lief.MachO.parse(str(path))
    (library,) = [part for part in fat if part.header.cpu_type == processor]
    require(name, library.header.file_type == lief.MachO.Header.FILE_TYPE.DYLIB, "is not a dynamic library")
    require(name, library.build_version.minos == MACOS_FLOOR, f"wants macOS {library.build_version.minos}")
    own, *needs = [item.name for item in library.libraries]
    require(name, own == "@rpath/wheel.dylib", f"is called {own}")
    require(name, needs == ["/usr/lib/libSystem.B.dylib"], f"needs {needs}")
    if processor == lief.MachO.Header.CPU_TYPE.ARM64:  # Apple's processors load nothing unsigned
        require(name, signed(path.read_bytes(), library), "its signature is not that of its pages")
    exports = {s.name.removeprefix("_") for s in library.exported_symbols}
    imports = {s.name.removeprefix("_") for s in library.imported_symbols}
    exports -= {"_mh_dylib_header", "__dso_handle"}  # every library of this linker has these
    return Facts(name, library.original_size, exports, imports, set(needs), "macOS 11.0")


def signed(data: bytes, library: lief.MachO.Binary) -> bool:
    """The code directory of the ad-hoc signature holds the SHA-256 of every page of the library."""
    start = library.fat_offset
    blob = start + library.code_signature.data_offset
    _, _, count = struct.unpack_from(">III", data, blob)
    slots = [struct.unpack_from(">II", data, blob + 12 + 8 * k) for k in range(count)]
    directory = blob + dict(slots)[0]
    _, _, _, _, hashes, _, _, pages, limit = struct.unpack_from(">9I", data, directory)
    length, kind, _, shift = struct.unpack_from(">4B", data, directory + 36)
    code = data[start : start + limit]
    found = [data[directory + hashes + length * k :][:length] for k in range(pages)]
    own = [hashlib.sha256(code[k << shift : (k + 1) << shift]).digest() for k in range(pages)]
    return kind == 2 and pages == -(-limit // (1 << shift)) and found == own


def judge(facts: Facts) -> None:
    require(facts.name, facts.size < LARGEST, f"has {facts.size} bytes")
    foreign = {name for name in facts.exports if not name.startswith("fmi2")}
    require(facts.name, not foreign, f"exports {sorted(foreign)[:9]}")
    require(facts.name, len(facts.exports) == FUNCTIONS, f"exports {len(facts.exports)} functions")
    inexact = facts.imports & INEXACT
    require(facts.name, not inexact, f"takes {inexact} from the system: they round differently from machine to machine")


def libraries(folder: Path) -> Iterator[Facts]:
    yield linux("linux64", folder / LINUX / "wheel.so", lief.ELF.ARCH.X86_64)
    yield linux("aarch64-linux", folder / ARM / "wheel.so", lief.ELF.ARCH.AARCH64)
    yield windows("win64", folder / WINDOWS / "wheel.dll")
    yield macos("darwin64 (x86-64)", folder / UNIVERSAL, lief.MachO.Header.CPU_TYPE.X86_64)
    yield macos("darwin64 (arm64)", folder / UNIVERSAL, lief.MachO.Header.CPU_TYPE.ARM64)
    yield macos("aarch64-darwin", folder / ARM_MAC / "wheel.dylib", lief.MachO.Header.CPU_TYPE.ARM64)


def table(folder: Path) -> str:
    """What was found of each library, all of them judged."""
    lief.logging.disable()
    rows = []
    for facts in libraries(folder):
        judge(facts)
        mathematics = ", ".join(sorted(facts.imports & EXACT)) or "nothing"
        needs = ", ".join(sorted(Path(name).name for name in facts.needs))
        rows.append([facts.name, f"{facts.size / 1e3:.0f} kB", facts.oldest, needs, mathematics])
    return markdown.table(["library", "size", "loads from", "needs", "of the system's mathematics"], rows)
