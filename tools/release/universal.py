"""Joins Mach-O libraries of several processors into one universal library (fat header, big endian).

universal.py OUTPUT LIBRARY...
"""

from __future__ import annotations

import struct
import sys
from pathlib import Path

FAT_MAGIC = 0xCAFEBABE
MACHO_64 = 0xFEEDFACF
ALIGNMENT = 14  # power of two: 16 KiB, the page of Apple's arm processors


def universal(libraries: list[bytes]) -> bytes:
    """The fat file: a header, one row per processor (type, subtype, offset, size, alignment), then the libraries."""
    page = 1 << ALIGNMENT
    header = struct.pack(">II", FAT_MAGIC, len(libraries))
    offset = page
    body = b""
    for library in libraries:
        magic, processor, subtype = struct.unpack_from("<III", library)
        if magic != MACHO_64:
            raise ValueError("not a 64-bit Mach-O library")
        header += struct.pack(">IIIII", processor, subtype, offset, len(library), ALIGNMENT)
        padded = library + b"\0" * (-len(library) % page)
        body += padded
        offset += len(padded)
    return header.ljust(page, b"\0") + body


def main() -> None:
    output, *libraries = (Path(argument) for argument in sys.argv[1:])
    output.write_bytes(universal([library.read_bytes() for library in libraries]))


if __name__ == "__main__":
    main()
