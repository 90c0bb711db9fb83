"""What the documents print for their readers to type."""

import re
import shlex

from wheelfmu.fmu.paths import ROOT
from wheelfmu.publishing.markdown import pages

TEXTS = {str(page.relative_to(ROOT)): page.read_text(encoding="utf-8") for page in pages()}
PAGES = {name: text for name, text in TEXTS.items() if name.endswith(".md")}
COMMAND = re.compile(r"""\./scripts/(\w+)((?: +(?:'[^'\n]*'|[^\s`#'"|)&;]+))*)""")


def commands(text: str) -> set[tuple[str, ...]]:
    """The commands under scripts/ with their arguments; ... and NAME stand for what a reader types."""
    joined = re.sub(r"\\\n *", "", text)
    spans = re.findall(r"```.*?```|`[^`\n]+`|^ {4}.*$", joined, re.DOTALL | re.MULTILINE)
    return {(name, *shlex.split(rest)) for span in spans for name, rest in COMMAND.findall(span)}


COMMANDS = sorted({command for text in PAGES.values() for command in commands(text)})
