"""Lint of prose in documents and help texts, for ./scripts/lint: proselint and the vocabulary of this project.

Code, formulas, addresses and tables that are filled in are left out; the messages of docs/messages.md are not.
"""

from __future__ import annotations

import re
import sys

from proselint.checks import __register__ as usual
from proselint.config import DEFAULT
from proselint.registry import CheckRegistry
from proselint.registry.checks import Check, Padding
from proselint.registry.checks.types import Existence
from proselint.tools import LintFile

from publishing.documents import ROOT, pages

# Checks of proselint that judge names, numbers or terms of mechanics.
UNUSED = (
    "lexical_illusions",
    "typography",
    "spelling",
    "needless_variants",
    "terms",
    "restricted",
    "misc.preferred_forms",
    "misc.phrasal_adjectives",
    "annotations",
)
VOCABULARY = {
    "software logs, returns, reports or shows": r"tells?|told|telling|is said|are said|sa(?:ys|id) so",
    "a message or a line, not a sentence": r"sentences?",
    "name the thing itself": r"(?:of|from|by|on|in|with|for|to|at|and|is|are|see|says?|shows?) what",
    "say it directly": r"of (?:its|their|your|our|one's) own|by (?:itself|themselves)|that of|those of",
    "say what is, not what is not": r"no bit changes|changes no bit|not a bit|without a word|nothing to report",
    "bit-identical": r"(?:the )?same bits|all bits equal|to the (?:last )?bit|bit by bit",
    "FMU": r"the unit|(?:the|this|that|an) archive",
    "co-simulation master, importer": r"slaves?",
    "reject": r"refus(?:e|es|ed|ing)",
    "-ize": r"(?:initial|linear|regular|stabil|normal|optim|serial|factor|recogn|general|minim)is(?:e[sd]?|ation)",
    "British spelling with -ize": r"colors?|(?-i:gray)|behaviors?|meters?|centers?|modeling|modeled",  # Gray is a name
}
BLANKED = re.compile(
    r"^ *```.*?^ *```|^ {4}\S[^\n]*$|`[^`\n]*`|<!-- variables -->.*?<!-- end of variables -->|<!--.*?-->|"
    r"\$\$.*?\$\$|\$[^$\n]+\$|\]\([^)]*\)|\"[^\"\n]{1,200}\"|\b[\w./-]+\.(?:md|py|cpp|hpp|csv|fmu)\b",
    re.DOTALL | re.MULTILINE,
)
SPANS_ARE_PROSE = "docs/messages.md"
CONFIG = DEFAULT | {
    "checks": dict.fromkeys((*sorted({check.path.split(".")[0] for check in usual} - set(UNUSED)), "wheel"), True)
}


def checks() -> list[Check]:
    own = [
        Check(
            check_type=Existence(items=(f"(?:{pattern})",), padding=Padding.WORDS_IN_TEXT),
            path="wheel",
            message=f"'{{}}': {advice}.",
        )
        for advice, pattern in VOCABULARY.items()
    ]
    return [check for check in usual if not check.path.startswith(UNUSED)] + own


def prose_of(text: str, spans: bool = False) -> str:
    """The text with everything that is not prose blanked, in place."""

    def blank(found: re.Match[str]) -> str:
        if spans and found[0].startswith("`") and not found[0].startswith("``"):
            return f" {found[0][1:-1]} "
        return re.sub(r"[^\n]", " ", found[0])

    return BLANKED.sub(blank, text)


def faults(name: str, text: str) -> list[str]:
    """`file:line: message` of each fault."""
    found = LintFile(source=name, content=prose_of(text, name == SPANS_ARE_PROSE)).lint(CONFIG)
    return [f"{name}:{fault.pos[0]}: {fault.check_result.message}" for fault in found]


def register() -> None:
    CheckRegistry().register_many(tuple(checks()))


def help_of(script: str) -> str:
    """The comments of a command, from which its --help comes."""
    return "\n".join(line[2:] if line.startswith("# ") else "" for line in script.split("\n"))


def main() -> int:
    register()
    names = [str(page.relative_to(ROOT)) for page in pages() if page.suffix == ".md"]
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in names}
    texts |= {
        f"scripts/{path.name}": help_of(path.read_text(encoding="utf-8")) for path in (ROOT / "scripts").iterdir()
    }
    found = [fault for name, text in texts.items() for fault in faults(name, text)]
    print(*found, sep="\n", end="\n" if found else "")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
