"""Result files, pages, and a browser that looks at them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Page
from support.paths import ROOT

POSE = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi")
RATES = tuple(f"{name}_dot" for name in POSE)
RECORD = (*POSE, *RATES, "omega_z", "lambda_1", "lambda_2", "lambda_3", "E", "friction_mode", "n_events")
# The page beside the scene is composed at once, instead of by the processor in the place of a graphics card.
FLAGS = ("--disable-gpu-compositing", "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas")
# Advice of the browser on how the tests look at pictures.
NOISE = ("GPU stall due to ReadPixels", "willReadFrequently")
PATIENCE = 60_000  # ms; a page is drawn by the processor here


# The calls that make the processor draw the scene: most tests look at everything but its pixels.
UNDRAWN = """window.undrawn = true;
for (const call of ["clear", "drawElements", "drawArrays", "texSubImage2D", "generateMipmap"]) {
  const draw = WebGL2RenderingContext.prototype[call];
  WebGL2RenderingContext.prototype[call] = function (...all) { window.undrawn || draw.apply(this, all); };
}"""


@contextmanager
def drawn(page: Page) -> Iterator[Page]:
    """A page whose scene is drawn."""
    page.evaluate("window.undrawn = false; page.dress(); page.draw()")
    yield page
    page.evaluate("window.undrawn = true")


@contextmanager
def opened(browser: Browser, path: Path, address: str = "", **context: object) -> Iterator[Page]:
    """A page that stands still at its start; afterwards its console must hold no error and no warning.

    address: what stands after the # of the page's address.
    """
    look = {"viewport": {"width": 900, "height": 640}, "reduced_motion": "reduce"} | context
    surroundings = browser.new_context(offline=True, **look)
    surroundings.set_default_timeout(PATIENCE)
    surroundings.add_init_script(UNDRAWN)
    page = surroundings.new_page()
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda fault: said.append(str(fault)))
    page.goto(f"{path.as_uri()}#{address}" if address else path.as_uri())
    page.wait_for_function("window.page && page.views && !page.stage.dirty")
    yield page
    surroundings.close()
    faults = [line for line in said if not any(noise in line for noise in NOISE)]
    assert not faults, faults


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A result file as FMPy writes it."""
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(repr(float(value)) for value in row) for row in rows]
    path.write_text("\n".join([",".join(f'"{name}"' for name in columns), *lines, ""]))
    return path


def view(*arguments: object) -> subprocess.CompletedProcess[str]:
    """What ./scripts/view does, once all is set up."""
    command = [sys.executable, "-P", "-m", "page", "recorded", *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "tools")}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def column(page, name: str) -> np.ndarray:
    return np.array(page.evaluate("(name) => [...page.wheels[0].table.columns[name]]", name))


def preset(page, label: str) -> None:
    page.locator("#live [name=scenes]").click()
    page.get_by_role("button", name=label, exact=True).click()
    page.evaluate("page.player.pause()")
