"""Lint of prose in documents and help texts, for ./scripts/lint: proselint and the vocabulary of this project.

Code, formulas, addresses and tables that are filled in are left out; the messages of docs/messages.md are not.
"""

from __future__ import annotations

import re
import sys

from proselint.checks import __register__ as usual
from proselint.config import Config
from proselint.registry import CheckRegistry
from proselint.tools import LintFile

from publishing.documents import ROOT, pages

# But for those that judge names, numbers or terms of mechanics.
UNUSED = ("lexical_illusions", "typography", "spelling", "needless_variants", "terms", "restricted", "annotations")
UNUSED += ("misc.preferred_forms", "misc.phrasal_adjectives")
CHECKS = tuple(check for check in usual if not check.path.startswith(UNUSED))
CheckRegistry().register_many(CHECKS)
CONFIG = Config(max_errors=1000, checks={check.path.split(".")[0]: True for check in CHECKS})
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


def faults(name: str, text: str) -> list[str]:
    """`file:line: message` of each fault; all that is no prose is blanked in place."""
    if name == SPANS_ARE_PROSE:
        text = re.sub("(?<!`)`(?!`)", " ", text)
    prose = BLANKED.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    found = [(fault.pos[0], fault.check_result.message) for fault in LintFile(name, prose).lint(CONFIG)]
    for advice, pattern in VOCABULARY.items():
        words = re.finditer(rf"\b(?:{pattern})\b", prose, re.IGNORECASE)
        found += [(1 + prose.count("\n", 0, word.start()), f"'{word[0]}': {advice}.") for word in words]
    return [f"{name}:{line}: {message}" for line, message in sorted(found)]


def help_of(script: str) -> str:
    """The comments of a command, from which its --help comes."""
    return "\n".join(line[2:] if line.startswith("# ") else "" for line in script.split("\n"))


def main() -> int:
    names = [str(page.relative_to(ROOT)) for page in pages() if page.suffix == ".md"]
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in names}
    texts |= {f"scripts/{path.name}": help_of(path.read_text(encoding="utf-8")) for path in ROOT.glob("scripts/*")}
    found = [fault for name, text in texts.items() for fault in faults(name, text)]
    print(*found, sep="\n", end="\n" if found else "")
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
