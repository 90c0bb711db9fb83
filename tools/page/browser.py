"""Headless Chromium without a graphics card: it makes pictures, measures, and runs the tests of the pages."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager

from playwright.sync_api import Browser, sync_playwright

# The processor draws; the rest keeps the browser from looking for hosts.
FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
FLAGS += ["--no-first-run", "--disable-component-update", "--disable-sync", "--disable-quic"]
FLAGS += ["--no-sandbox"] if os.geteuid() == 0 else []


@contextmanager
def chromium(*flags: str) -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=[*FLAGS, *flags])
        yield browser
        browser.close()
