"""A C header as Markdown: each declaration with the comment above it."""

from __future__ import annotations

import re

COMMENT = re.compile(r"/\*(.*?)\*/\s*", re.DOTALL)
NAME = re.compile(r"\b(wheel_\w+)\(|typedef (?:struct|enum) (\w+)")


def plain(comment: str) -> str:
    """A comment's words; a line that is set in keeps its place as code."""
    lines = [re.sub(r"^ ?\*? ?", "", line).rstrip() for line in comment.strip().splitlines()]
    return "\n".join(f"    {line.strip()}" if line.startswith("  ") else line for line in lines)


def reference(header: str) -> str:
    """Sections of functions and types, in the header's order."""
    body = header[header.index("typedef") :]
    body = body[: body.rindex("#ifdef __cplusplus")]
    pages = ["\n## Reference\n"]
    for block in re.split(r"\n\s*\n(?=/\*|\w)", body):
        comment = COMMENT.match(block)
        code = block[comment.end() :].strip() if comment else block.strip()
        names = [a or b for a, b in NAME.findall(code)]
        if not names:
            continue
        pages += [f"\n### {', '.join(f'`{name}`' for name in dict.fromkeys(names))}\n"]
        pages += [plain(comment[1])] if comment else []
        pages += [f"\n```c\n{code}\n```\n"]
    return "\n".join(pages)
