"""Measures the pages in headless Chromium, drawn at twice the resolution: python -m page.measure LIVE RECORDED

Sizes, the time to the first picture, and pictures per second, without drawing the scene, go into
docs/results/data/page.csv.
"""

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


def measure(browser: Browser, name: str, path: Path) -> dict[str, float]:
    """Figures of one page, opened some times: the browser's caches fill as any page before it fills them."""
    firsts = []
    for _ in range(3):
        page = show(surroundings(browser, **LOOK).new_page(), path)
        firsts.append(page.evaluate("page.first") / 1000)
        own, took = page.evaluate(DRAW, FRAMES), page.evaluate("page.live?.took ?? 0")
        page.context.close()
    figures = {"megabytes": path.stat().st_size / 1e6, "first": min(firsts), "own": FRAMES / own}
    return {f"{name}_{figure}": value for figure, value in (figures | ({"run": took} if took else {})).items()}


def main() -> None:
    live, recorded = map(Path, sys.argv[1:])
    with chromium() as browser:
        figures = measure(browser, "live", live) | measure(browser, "recorded", recorded)
    text = "".join(f"{name},{value:.4g}\n" for name, value in figures.items())
    DATA.write_text(f"figure,measured\n{text}", encoding="utf-8")
    print(text, end="")


if __name__ == "__main__":
    main()
