"""Puts a page together: text, style, scripts, three.js and data in one HTML file that loads nothing from elsewhere.

The scripts are ECMAScript modules, each a data: address in an import map, so that the browser itself joins them.
"""

from __future__ import annotations

import base64
import json
import re
from dataclasses import replace
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from page import description
from page.bodies import Body

WEB = Path(__file__).parent / "web"
SHAPE = ("r_0", "r", "slope", "slope_direction")
PAGE_LIMIT = 3_000_000  # bytes of a page
RECORDED_LIMIT = 1_500_000  # bytes of them for recorded motions
THREE = "nicegui/elements/scene/dist/index.js"  # three.js and its OrbitControls, minified, within PyPI's nicegui


def base64_of(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def library() -> tuple[str, str]:
    """three.js as the text of a module, and its notice."""
    spec = find_spec("nicegui")
    if spec is None or spec.origin is None:
        raise SystemExit("three.js is missing: run ./scripts/setup, which fetches it with the package nicegui.")
    site = Path(spec.origin).parent.parent
    text = (site / THREE).read_text(encoding="utf-8")
    revision = re.search(r'const \w+="(1\d\d)"', text)
    licence = (site / f"nicegui-{version('nicegui')}.dist-info" / "licenses" / "LICENSE").read_text(encoding="utf-8")
    name = f"three.js r{revision.group(1)}" if revision else "three.js"
    notice = f"{name}, Copyright (c) 2010-2025 three.js authors, as bundled by NiceGUI {version('nicegui')}:\n{licence}"
    return re.sub(r"\n//# sourceMappingURL=.*", "", text), notice.replace("--", "-")


def modules(three: str) -> str:
    """The import map: every module by its name."""
    texts = {"three": three}
    for path in sorted(WEB.glob("*.js")):
        texts[f"#{path.stem}"] = f"{path.read_text(encoding='utf-8')}\n//# sourceURL=page/{path.name}\n"
    head = "data:text/javascript;base64,"
    return json.dumps({"imports": {name: head + base64_of(text.encode()) for name, text in texts.items()}})


def thinned(bodies: list[Body], limit: int = RECORDED_LIMIT) -> tuple[list[Body], int]:
    """Every n-th row of each body and the last, so that all fit into `limit` bytes; and n."""
    total = sum(len(column) for body in bodies for column in body.columns.values()) * 8 * 4 / 3
    every = -int(-total // limit)

    def few(body: Body) -> Body:
        last = len(body.columns["time"]) - 1
        rows = sorted({*range(0, last, every), last})
        return replace(body, columns={name: column[rows] for name, column in body.columns.items()})

    return [few(body) for body in bodies], every


def encoded(body: Body) -> dict:
    columns = {name: base64_of(column.astype("<f8").tobytes()) for name, column in body.columns.items()}
    entry = {"name": body.name, "label": body.label, "columns": columns}
    if body.size is not None:
        return entry | {"size": body.size}
    shape = {name: body.parameters[name] for name in SHAPE if name in body.parameters}
    return entry | shape | {"parameters": body.parameters}


def write(output: Path, title: str, bodies: list[Body], sources: int = 1, live: dict | None = None) -> int:
    """Write the page and return its size in bytes. sources: how many files the bodies come from."""
    three, notice = library()
    recorded = {"bodies": [encoded(body) for body in bodies], "sources": sources}
    data = recorded | {"variables": description.variables(), "live": live}
    parts = {
        "title": title.replace("&", "&amp;").replace("<", "&lt;"),
        "licences": notice,
        "style": (WEB / "style.css").read_text(encoding="utf-8"),
        "data": json.dumps(data).replace("<", "\\u003c"),
        "modules": modules(three),
    }
    page = re.sub(r"\{\{(\w+)\}\}", lambda m: parts[m.group(1)], (WEB / "page.html").read_text(encoding="utf-8"))
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(page, encoding="utf-8")
    return len(page.encode())
