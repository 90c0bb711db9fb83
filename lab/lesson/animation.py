"""An animated picture of a page, frame by frame in headless Chromium: animation.py PAGE.html PICTURE.webp."""

import io
import sys
from pathlib import Path

from PIL import Image

from lab.lesson.browser import chromium, show, surroundings
from wheelfmu.fmu.files import worded

FRAMES_PER_SECOND = 12.5
WINDOW = {"width": 1080, "height": 560}  # CSS pixels
WIDTH = 864  # of the picture
LIMIT = 1_500_000  # bytes
# Without the controls, and with a camera that stands still, nearer than usual: what does not move needs no bytes.
STILL = """document.body.classList.add('bare');
document.querySelector('[name=follow]').click();
page.stage.camera.position.multiplyScalar(0.72)"""


def frames(page_file: Path) -> list[Image.Image]:
    """The page without its controls, from the first instant to the last."""
    with chromium() as browser:
        page = show(surroundings(browser, viewport=WINDOW).new_page(), page_file)
        page.evaluate(STILL)
        page.wait_for_function("!page.stage.dirty")
        end = page.evaluate("page.player.end")
        shots = []
        for k in range(round(end * FRAMES_PER_SECOND)):
            page.evaluate("(t) => { page.player.seek(t); page.draw(); }", k / FRAMES_PER_SECOND)
            image = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
            shots.append(image.resize((WIDTH, round(WIDTH * image.height / image.width)), Image.Resampling.LANCZOS))
    return shots


def main(page_file: str, picture: str) -> None:
    """Write the best quality whose file stays below LIMIT."""
    first, *others = frames(Path(page_file))
    for quality in range(80, 20, -10):
        how = {"save_all": True, "append_images": others, "duration": 1000 / FRAMES_PER_SECOND, "loop": 0}
        first.save(picture, "WEBP", quality=quality, method=4, **how)
        if (size := Path(picture).stat().st_size) < LIMIT:
            print(f"{picture} ({size / 1e6:.1f} MB)")
            return
    sys.exit(f"{picture} is larger than {LIMIT} bytes.")


if __name__ == "__main__":
    with worded("figures"):
        main(*sys.argv[1:])
