"""Markdown from data: tables, numbers, images."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def number(value: object) -> str:
    """Short text of a value: 3 digits of a float with a plain exponent, integers and text as they are."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value)
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table: the first column to the left, the others to the right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)]]
    lines += [[number(cell) for cell in row] for row in rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def image(file: str, alternative: str) -> str:
    return f"![{alternative}]({file})"


def document(title: str, sections: Iterable[str]) -> str:
    return f"# {title}\n\n" + "\n\n".join(section.strip() for section in sections) + "\n"
