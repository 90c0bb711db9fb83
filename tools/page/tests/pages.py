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

from page.browser import show, surroundings

POSE = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi")
RATES = tuple(f"{name}_dot" for name in POSE)
RECORD = (*POSE, *RATES, "omega_z", "lambda_1", "lambda_2", "lambda_3", "E", "friction_mode", "n_events")
# The page beside the scene is composed at once, instead of by the processor in the place of a graphics card.
FLAGS = ("--disable-gpu-compositing", "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas")
# Advice of the browser on how the tests look at pictures.
NOISE = ("GPU stall due to ReadPixels", "willReadFrequently")
# The calls that make the processor draw the scene: most tests look at everything but its pixels.
UNDRAWN = """window.undrawn = true;
for (const call of ["clear", "drawElements", "drawArrays", "texSubImage2D", "generateMipmap"]) {
  const draw = WebGL2RenderingContext.prototype[call];
  WebGL2RenderingContext.prototype[call] = function (...all) { window.undrawn || draw.apply(this, all); };
}"""
# A vector in the road's axes as the scene shows it.
TURN = "(v) => page.stage.camera.position.clone().set(...v).applyQuaternion(page.stage.road.quaternion).toArray()"


@contextmanager
def drawn(page: Page) -> Iterator[Page]:
    """A page whose scene is drawn."""
    page.evaluate("window.undrawn = false; page.dress(); page.draw()")
    yield page
    page.evaluate("window.undrawn = true")


@contextmanager
def opened(browser: Browser, path: Path, address: str = "", **look: object) -> Iterator[Page]:
    """A page that stands still at its start; afterwards its console must hold no error and no warning."""
    context = surroundings(browser, **{"viewport": {"width": 900, "height": 640}} | look)
    context.add_init_script(UNDRAWN)
    faults: list[str] = []
    context.on("console", lambda message: faults.append(message.text) if message.type in ("error", "warning") else None)
    context.on("weberror", lambda fault: faults.append(str(fault.error)))
    yield show(context, path, address)
    context.close()
    faults = [line for line in faults if not any(noise in line for noise in NOISE)]
    assert not faults, faults


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A result file as FMPy writes it."""
    header = ",".join(f'"{name}"' for name in columns)
    np.savetxt(path, np.column_stack([*columns.values()]), fmt="%.17g", delimiter=",", header=header, comments="")
    return path


def view(*arguments: object) -> subprocess.CompletedProcess[str]:
    """What ./scripts/view does, once all is set up."""
    command = [sys.executable, "-P", "-m", "page", "recorded", *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "tools")}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


def column(page: Page, name: str, wheel: int = 0) -> np.ndarray:
    return np.array(page.evaluate("([i, name]) => [...page.wheels[i].table.columns[name]]", [wheel, name]))


def listed(page: Page) -> list[list[str]]:
    """The rows of the card "Values"."""
    page.locator("[popovertarget=values]").click()
    rows = [row.split("\t") for row in page.locator("#values tr").all_inner_texts()]
    page.keyboard.press("Escape")
    return rows


def start(page: Page, at: float = 0.0, **values: float) -> None:
    """The live page with the paper's wheel, but for these start values, and its clock standing at `at`."""
    load = "([values, t]) => { page.player.pause(); page.live.load({values, stop: 10}); page.player.seek(t); }"
    page.evaluate(load, [values, at])


def do(page: Page, at: float, **values: float) -> None:
    """These values act in the live page from the instant `at` on."""
    act = "([t, all]) => { page.player.seek(t); for (const one of all) page.live.setNow(...one); page.live.compute(); }"
    page.evaluate(act, [at, [*values.items()]])
