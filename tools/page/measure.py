"""Measures the pages in headless Chromium, drawn at twice the resolution: python -m page.measure LIVE RECORDED

Sizes, the time to the first picture, the processor time of the page itself until then, without drawing the scene, and
pictures per second of processor time go into docs/results/data/page.csv.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

from playwright.sync_api import Browser

from page.browser import chromium, show, surroundings

DATA = Path(__file__).resolve().parents[2] / "docs" / "results" / "data" / "page.csv"
FRAMES = 10
LOOK = {"viewport": {"width": 1280, "height": 800}, "device_scale_factor": 2}
DRAW = """(frames) => {
  const gl = page.stage.renderer.getContext();
  let own = 0;
  for (let k = 0; k < frames; ++k) {
    const begin = performance.now();
    page.player.seek((k * page.player.end) / frames);
    page.draw();
    own += performance.now() - begin;
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));  // waits until the picture is there
  }
  return own / 1000;
}"""


def processor_time(browser: Browser, kind: str = "") -> float:
    """Seconds of processor time of all of the browser's processes, or of those of one kind."""
    session = browser.new_browser_cdp_session()
    processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
    session.detach()
    return sum(process["cpuTime"] for process in processes if kind in ("", process["type"]))


def measure(browser: Browser, name: str, path: Path) -> dict[str, float]:
    """Figures of one page; the first opening fills the browser's caches as any page before it does."""
    show(surroundings(browser, **LOOK), path).close()
    firsts, owns = [], []
    for _ in range(2):
        before = processor_time(browser, "renderer")
        page = show(surroundings(browser, **LOOK), path)
        firsts.append(page.evaluate("page.first") / 1000)
        owns.append(processor_time(browser, "renderer") - before)
        if len(firsts) < 2:
            page.close()
    page.evaluate(DRAW, 2)
    before = processor_time(browser)
    own = page.evaluate(DRAW, FRAMES)
    spent = processor_time(browser) - before
    took = page.evaluate("page.live?.took ?? 0")
    page.close()
    figures = {"megabytes": path.stat().st_size / 1e6, "first": min(firsts), "first_own": min(owns)}
    figures |= {"frames": FRAMES / spent, "own": FRAMES / own} | ({"run": took} if took else {})
    return {f"{name}_{figure}": value for figure, value in figures.items()}


def main() -> None:
    live, recorded = map(Path, sys.argv[1:])
    with chromium() as browser:
        figures = measure(browser, "live", live) | measure(browser, "recorded", recorded)
    rows = [("figure", "measured"), *((name, f"{value:.4g}") for name, value in figures.items())]
    with DATA.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)
    print(*(f"{name}: {value}" for name, value in rows[1:]), sep="\n")


if __name__ == "__main__":
    main()
