"""Tables and numbers as the report writes them."""

from __future__ import annotations

from collections.abc import Iterable


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def number(value: float | None, form: str = ".3g") -> str:
    return "—" if value is None else f"{value:{form}}"


def microseconds(seconds: float | None) -> str:
    return "—" if seconds is None else f"{1e6 * seconds:,.0f}"
