"""Random mutants: small changes of C and C++ at places that clang's syntax tree gives.

A mutant replaces an operator by its neighbour, a number by another, a condition by its opposite or by a constant, or
takes a statement away. Whether it compiles and changes the library is found out when it is built.
"""

from __future__ import annotations

import json
import random
import shlex
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from clang.cindex import Cursor, CursorKind, Index, TokenKind

OTHER = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==",
    "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "&": "|", "|": "&", "%": "*",
}  # fmt: skip
OPERATIONS = (CursorKind.BINARY_OPERATOR, CursorKind.COMPOUND_ASSIGNMENT_OPERATOR)
NUMBERS = (CursorKind.INTEGER_LITERAL, CursorKind.FLOATING_LITERAL)
BRANCHES = (CursorKind.IF_STMT, CursorKind.WHILE_STMT, CursorKind.CONDITIONAL_OPERATOR)
ACTIONS = (*OPERATIONS, CursorKind.CALL_EXPR, CursorKind.BREAK_STMT, CursorKind.CONTINUE_STMT)


class Mutant(NamedTuple):
    """Bytes `begin` to `end` of `file`, under fmu-src, become `new`."""

    file: str
    line: int
    begin: int
    end: int
    old: str
    new: str

    def title(self) -> str:
        return f"{' '.join(self.old.split())} -> {self.new or 'nothing'}"


def commands(build: Path) -> dict[str, list[str]]:
    """The options that each file of fmu-src is compiled with, as far as its syntax needs them."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        words = iter(shlex.split(entry["command"])[1:])
        kept = []
        for word in words:
            if word == "-isystem":
                kept += [word, next(words)]
            elif word.startswith(("-I", "-D", "-std")):
                kept.append(word)
        if "/fmu-src/" in entry["file"]:
            found[entry["file"]] = kept
    return found


def walk(cursor: Cursor, folder: str) -> Iterator[tuple[Cursor, Cursor]]:
    """(parent, child) of all that stands in files of the folder: headers of other libraries are left out."""
    for child in cursor.get_children():
        place = child.location.file
        if place is None or place.name.startswith(folder):
            yield cursor, child
            yield from walk(child, folder)


def operator_of(cursor: Cursor) -> tuple[int, int, str]:
    """Begin, end and spelling of the operator between the two operands."""
    left = next(cursor.get_children()).extent.end.offset
    for token in cursor.get_tokens():
        if token.kind == TokenKind.PUNCTUATION and token.extent.start.offset >= left and token.spelling in OTHER:
            return token.extent.start.offset, token.extent.end.offset, token.spelling
    return 0, 0, ""


def changes(parent: Cursor, cursor: Cursor, text: bytes) -> Iterator[tuple[int, int, str]]:
    begin, end = cursor.extent.start.offset, cursor.extent.end.offset
    kind = cursor.kind
    if kind in OPERATIONS:
        first, last, operator = operator_of(cursor)
        if operator:
            yield first, last, OTHER[operator]
    if kind in NUMBERS:
        number = text[begin:end].decode()
        yield begin, end, f"({number} + 1)"
        if number.strip("0.uUlL"):
            yield begin, end, "0"
    if kind == CursorKind.UNARY_OPERATOR and text[begin : begin + 1] in (b"-", b"!"):
        yield begin, begin + 1, ""
    if kind in BRANCHES:
        condition = next(cursor.get_children())
        if condition.kind not in (CursorKind.VAR_DECL, CursorKind.DECL_STMT):
            first, last = condition.extent.start.offset, condition.extent.end.offset
            yield first, last, "1"
            yield first, last, "0"
            yield first, last, f"!({text[first:last].decode()})"
    if kind in ACTIONS and parent.kind == CursorKind.COMPOUND_STMT and text[end : end + 1] == b";":
        yield begin, end, ""


def mutants_of(file: str, folder: Path, options: list[str]) -> dict[tuple, Mutant]:
    """All mutants of a file and of the headers of the core that it includes."""
    resources = subprocess.run(["clang-19", "-print-resource-dir"], capture_output=True, text=True).stdout.strip()
    unit = Index.create().parse(file, args=[*options, "-resource-dir", resources])
    made = {}
    for parent, cursor in walk(unit.cursor, f"{folder}/"):
        place = cursor.extent.start.file
        if place is None or cursor.extent.end.file is None or cursor.extent.end.file.name != place.name:
            continue
        text = Path(place.name).read_bytes()
        for begin, end, new in changes(parent, cursor, text):
            name, line = str(Path(place.name).relative_to(folder)), text.count(b"\n", 0, begin)
            if b"static_assert" not in text.split(b"\n")[line]:
                made[name, begin, end, new] = Mutant(name, line + 1, begin, end, text[begin:end].decode(), new)
    return made


def sample(root: Path, build: Path, count: int, seed: int) -> list[Mutant]:
    """So many of all mutants, drawn without replacement."""
    every: dict[tuple, Mutant] = {}
    for file, options in sorted(commands(build).items()):
        every |= mutants_of(file, root / "fmu-src", options)
    return random.Random(seed).sample(sorted(every.values()), min(count, len(every)))
