"""Result files, pages, and a browser that looks at them."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, BrowserContext, Page

from lab.lesson import bodies, options, writing
from lab.lesson.browser import show, surroundings
from wheelfmu.fmu.outputs import worded

POSE = (*bodies.POSE, "Z_O")
RECORD = (*bodies.POSE, *bodies.RATES, *bodies.SHOWN)
SIZE = {"width": 900, "height": 640}  # of the window, CSS pixels
# Advice of the browser on how the tests look at pictures.
NOISE = ("GPU stall due to ReadPixels", "willReadFrequently")
# Most tests look at everything but the pixels of the scene: the calls that make the processor draw it are left out, and
# a second has twenty frames.
UNDRAWN = """window.undrawn = true;
for (const call of ["clear", "drawElements", "drawArrays", "texSubImage2D", "generateMipmap"]) {
  const draw = WebGL2RenderingContext.prototype[call];
  WebGL2RenderingContext.prototype[call] = function (...all) { window.undrawn || draw.apply(this, all); };
}
const frame = window.requestAnimationFrame;
window.requestAnimationFrame = (act) => setTimeout(() => frame(act), 40);"""
# The first view of a page, at its start.
REST = """page.choose(0);
page.player.set({playing: false, t: 0, speed: 1});
for (const [name, on] of [['follow', true], ['axes', false], ['force', false]]) page.switches.flip(name, on);
page.stage.controls.reset()"""
# A vector in the road's axes as the scene shows it.
TURN = "(v) => page.stage.camera.position.clone().set(...v).applyQuaternion(page.stage.road.quaternion).toArray()"


def window_of(browser: Browser, **look: object) -> BrowserContext:
    """A window, whose tabs share a process of the browser."""
    window = surroundings(browser, **look)
    window.add_init_script(UNDRAWN)
    return window


@contextmanager
def opened(window: BrowserContext, path: Path, address: str = "", faults: tuple[str, ...] = ()) -> Iterator[Page]:
    """A page that stands still at its start; afterwards its console must hold no error and no warning but these."""
    page = window.new_page()
    found: list[str] = []
    page.on("console", lambda message: found.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda fault: found.append(str(fault)))
    yield show(page, path, address)
    page.close()
    found = [line for line in found if not any(noise in line for noise in (*NOISE, *faults))]
    assert not found, found


@contextmanager
def drawn(page: Page) -> Iterator[Page]:
    """A page whose scene is drawn."""
    page.evaluate("window.undrawn = false; page.dress(); page.draw()")
    yield page
    page.evaluate("window.undrawn = true")


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A result file as FMPy writes it."""
    header = ",".join(f'"{name}"' for name in columns)
    np.savetxt(path, np.column_stack([*columns.values()]), fmt="%.17g", delimiter=",", header=header, comments="")
    return path


def view(*arguments: object) -> None:
    """./scripts/view, once all is set up."""
    with worded("view"):
        writing.recorded(options.arguments([*map(str, arguments)]))


def column(page: Page, name: str, wheel: int = 0) -> np.ndarray:
    return np.array(page.evaluate("([i, name]) => [...page.wheels[i].table.columns[name]]", [wheel, name]), dtype=float)


def seek(page: Page, t: float) -> None:
    """A page at the instant t."""
    page.evaluate("(t) => { page.player.seek(t); page.lesson?.frame(); page.draw(); }", t)


def start(page: Page, at: float = 0.0, **chosen: float | str) -> None:
    """Free play with these values and its clock standing at `at`."""
    open_step(page, 11, chosen)
    seek(page, at)


def open_step(page: Page, step: int, chosen: dict | None = None, *, asks: bool = False) -> str:
    """A step 1, 2 ... at rest, with what it asks answered; returns its text."""
    page.evaluate("([step, chosen]) => page.lesson.open(step - 1, chosen)", [step, chosen or {}])
    page.evaluate("(asks) => { page.player.pause(); asks || page.lesson.forget(); page.lesson.frame(); }", asks)
    return page.locator("#story .text").inner_text()


def change(page: Page, **chosen: float | str) -> None:
    """Other values, as by the controls."""
    page.evaluate(
        "(all) => { for (const one of all) page.lesson.set(...one); page.lesson.frame(); }", [*chosen.items()]
    )


def do(page: Page, at: float, **values: float) -> None:
    """These inputs act from the instant `at` on."""
    act = """([t, all]) => {
      page.player.seek(t);
      for (const one of all) page.lesson.setNow(...one);
      page.lesson.change('kept');
      page.lesson.frame();
    }"""
    page.evaluate(act, [at, [*values.items()]])


def parameters(page: Page, wheel: int = 0) -> dict[str, float]:
    """Those of a wheel that is shown."""
    return page.evaluate("(i) => page.wheels[i].parameters", wheel)


def numbers(text: str) -> list[float]:
    """All numbers of a text."""
    return [float(number.replace("−", "-")) for number in re.findall(r"[-−]?\d+(?:\.\d+)?", text)]
