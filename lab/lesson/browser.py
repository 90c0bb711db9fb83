"""Headless Chromium without a graphics card: it makes pictures, measures, and runs the tests of the pages."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright

# The processor draws; the rest keeps the browser from looking for hosts.
FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
FLAGS += ["--no-first-run", "--disable-component-update", "--disable-sync", "--disable-quic"]
FLAGS += ["--no-sandbox"] if os.geteuid() == 0 else []
PATIENCE = 1_800_000  # ms; a page is drawn by the processor


@contextmanager
def chromium(*flags: str) -> Iterator[Browser]:
    with sync_playwright() as playwright:
        program = shutil.which("chromium-headless-shell") or shutil.which("chromium")
        browser = playwright.chromium.launch(executable_path=program, args=[*FLAGS, *flags])
        yield browser
        browser.close()


def surroundings(browser: Browser, **look: Any) -> BrowserContext:
    """Offline, and with pages that stand still at their start."""
    found = browser.new_context(offline=True, reduced_motion="reduce", **look)
    found.set_default_timeout(PATIENCE)
    return found


def show(page: Page, path: Path, address: str = "") -> Page:
    """A page with its first picture. address: what stands after the #."""
    page.goto(f"{path.resolve().as_uri()}{f'#{address}' if address else ''}")
    page.wait_for_function("window.page && page.first && !page.stage.dirty")
    return page
