"""Result files, pages, and a browser that looks at them."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, BrowserContext, Page

from lab.lesson import bodies
from lab.lesson.__main__ import main
from lab.lesson.browser import show, surroundings

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
REST = """if (page.live?.kept) page.live.keep(false);
page.choose(0);
page.player.set({playing: false, t: 0, speed: 1});
page.plots.portrait.choose('phase');
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


def view(*arguments: object) -> int:
    """What ./scripts/view does, once all is set up; its exit status."""
    return main(*map(str, arguments))


def column(page: Page, name: str, wheel: int = 0) -> np.ndarray:
    return np.array(page.evaluate("([i, name]) => [...page.wheels[i].table.columns[name]]", [wheel, name]), dtype=float)


def seek(page: Page, t: float) -> None:
    """A page at the instant t."""
    page.evaluate("(t) => { page.player.seek(t); page.live?.frame(); page.draw(); }", t)


def start(page: Page, at: float = 0.0, **values: float) -> None:
    """The live page with the paper's wheel, but for these start values, and its clock standing at `at`."""
    page.evaluate("(values) => { page.player.pause(); page.live.load({values}); }", values)
    seek(page, at)


def change(page: Page, **values: float) -> None:
    """Other start values, as by the sliders."""
    page.evaluate(
        "(all) => { for (const one of all) page.live.setStart(...one); page.live.frame(); }", [*values.items()]
    )


def do(page: Page, at: float, **values: float) -> None:
    """These values act in the live page from the instant `at` on."""
    act = "([t, all]) => { page.player.seek(t); for (const one of all) page.live.setNow(...one); page.live.compute(); }"
    page.evaluate(act, [at, [*values.items()]])


def value(page: Page, name: str) -> float:
    """A start value of the live page."""
    return page.evaluate("(name) => page.live.value(name)", name)
