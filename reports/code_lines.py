"""Lines of code of the core: neither empty nor comment alone."""

from __future__ import annotations

import re
from pathlib import Path

from support.paths import ROOT

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def of_core(root: Path = ROOT) -> int:
    """All of fmu-src: C and C++, sources and headers."""
    files = [p for p in (root / "fmu-src").rglob("*") if p.suffix in (".c", ".cpp", ".h", ".hpp")]
    texts = [COMMENT.sub("", path.read_text(encoding="utf-8")) for path in files]
    return sum(bool(line.strip()) for text in texts for line in text.splitlines())
