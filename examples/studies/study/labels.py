"""Short labels for axes and legends, `θ at the start`, made of the names of the FMU's variables."""

from __future__ import annotations

import re

GREEK = {"psi": "ψ", "theta": "θ", "phi": "φ", "omega": "ω", "lambda": "λ", "mu": "μ", "tau": "τ"}
DOTS = {"_ddot": "\N{COMBINING DIAERESIS}", "_dot": "\N{COMBINING DOT ABOVE}"}
LOWEST = "smallest angle to the ground"


def label(text: str) -> str:
    """The label of a variable, or of a measure of variables."""
    if text.strip() in ("lowest", "min(plane_angle)"):
        return LOWEST
    return re.sub(r"[A-Za-z]\w*", lambda found: _variable(found[0]), text)


def _variable(name: str) -> str:
    name, start = re.subn(r"_start$", "", name)
    for ending, dots in DOTS.items():
        if name.endswith(ending):
            first, _, rest = name.removesuffix(ending).partition("_")
            name = f"{GREEK.get(first, first)}{dots}{rest and '_' + rest}"
            break
    else:
        first, _, rest = name.partition("_")
        name = GREEK.get(first, first) + (rest and ("_" + rest))
    return name.replace("plane_angle", "angle to the ground") + (" at the start" if start else "")
