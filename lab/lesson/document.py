"""Puts a page together: text, style, scripts, three.js and data in one HTML file that loads nothing from elsewhere.

The scripts are ECMAScript modules, each a data: address in an import map, so that the browser itself joins them.
"""

import base64
import json
import re
from dataclasses import replace
from importlib.metadata import distribution
from pathlib import Path

from jinja2 import Environment, FileSystemLoader

from lab.lesson.bodies import Body
from wheelfmu.fmu.outputs import fresh
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.presets import POINTS, moments, wheels
from wheelfmu.fmu.presets import bodies as ready_bodies
from wheelfmu.fmu.values import variables as described

WEB = Path(__file__).parent / "web"
PARTS = ("m", "r_0", "r", "J_x", "J_y", "J_z")  # of a body
PAGE_LIMIT = 10_000_000  # bytes of a page: forty rows a period of the fastest preset
RECORDED_LIMIT = 8_500_000  # bytes of them for recorded motions
THREE = "nicegui/elements/scene/dist/index.js"  # three.js and its OrbitControls, minified, within PyPI's nicegui


def base64_of(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")


def library() -> tuple[str, str]:
    """three.js as the text of a module, and its notice."""
    package = distribution("nicegui")
    text = Path(str(package.locate_file(THREE))).read_text(encoding="utf-8")
    (revision,) = re.findall(r'const \w+="(1\d\d)"', text)
    notice = f"three.js r{revision}, Copyright (c) 2010-2025 three.js authors, "
    notice += f"as bundled by NiceGUI {package.version}:\n"
    notice += package.read_text("licenses/LICENSE") or ""
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
    return {"name": body.name, "label": body.label, "columns": columns, "parameters": body.parameters}


def colours() -> dict[str, dict[str, str]]:
    """{colour, quantity or state: {light, dark}}, those of all pictures."""
    found = json.loads((ROOT / "tools" / "wheelfmu" / "diagrams" / "colours.json").read_text(encoding="utf-8"))
    return found["palette"] | {name: found["palette"][tone] for name, tone in found["quantities"].items()}


def chooser() -> dict[str, dict]:
    """The bodies of free play: the paper's wheel, a coin, a disc of the same mass and size, a hoop."""
    paper = {name: v.preset for name, v in described("parameter").items() if name in PARTS}
    sizes = {name: paper[name] for name in ("m", "r_0", "r")}
    disc = {"title": ready_bodies()["disc"]["title"], "parameters": sizes | moments("disc", **sizes)}
    coin, hoop = (wheels()[name] for name in ("coin", "backspin"))
    found = {"tyre": {"title": "The paper's wheel", "parameters": paper}, "coin": coin, "disc": disc, "hoop": hoop}
    gravity = described("parameter")["g"].preset
    return {
        name: {"title": one["title"].split(",")[0], "parameters": one["parameters"] | {"g": gravity}}
        for name, one in found.items()
    }


def wheel_itself(wasm: Path) -> dict:
    """The wheel as a WebAssembly module, and the bodies to choose from."""
    (guid,) = re.findall(r'guid="(.*?)"', (ROOT / "modelDescription.xml").read_text(encoding="utf-8"))
    return {"wasm": base64_of(wasm.read_bytes()), "guid": guid, "bodies": chooser(), "POINTS": POINTS}


def write(output: Path, title: str, bodies: list[Body], sources: int = 1, wasm: Path | None = None) -> int:
    """Write the page and return its size in bytes. sources: how many files the bodies come from."""
    three, notice = library()
    variables = {name: v._asdict() | {"start": v.preset if v.start else None} for name, v in described().items()}
    data = {"bodies": [encoded(body) for body in bodies], "sources": sources, "variables": variables}
    data |= {"live": wheel_itself(wasm) if wasm else None}
    parts = {"licences": notice, "data": json.dumps(data).replace("<", "\\u003c"), "modules": modules(three)}
    template = Environment(loader=FileSystemLoader(WEB)).get_template("page.html")
    page = template.render(title=title, colours=colours(), **parts)
    with fresh(output) as new:
        new.write_text(page, encoding="utf-8")
    return len(page.encode())
