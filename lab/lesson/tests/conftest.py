"""The pages, and headless Chromium to look at them."""

import fcntl
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import cache, partial
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from playwright.sync_api import BrowserContext, Page

from wheelfmu.fmu.paths import ROOT

from .pages import RECORD, REST, SIZE, opened, view, window_of, write_csv


@pytest.fixture(scope="session")
def simulate(fmu: str, description) -> Callable[..., np.ndarray]:
    return partial(simulate_fmu, fmu, model_description=description, stop_time=10)


@pytest.fixture(scope="session")
def scenes(simulate) -> dict[str, np.ndarray]:
    """The paper's two scenes as ./scripts/run records them."""
    options = {"output_interval": 0.01, "output": RECORD}
    return {name: simulate(start_values={"s": s}, **options) for name, s in (("free", 0.0), ("friction", 0.03))}


@pytest.fixture(scope="session")
def recorded_file(scenes, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    files = [write_csv(folder / f"{n}.csv", {c: rows[c] for c in rows.dtype.names}) for n, rows in scenes.items()]
    view(*files, "--output", folder / "wheel.html")
    return folder / "wheel.html"


@pytest.fixture(scope="session")
def live_file() -> Path:
    page = ROOT / "build" / "wheel_lesson.html"
    page.parent.mkdir(exist_ok=True)
    with page.with_name("wasm.lock").open("w") as file:  # one process at a time builds the module
        fcntl.flock(file, fcntl.LOCK_EX)
        subprocess.run(["bash", ROOT / "scripts" / "page", page], check=True, capture_output=True)
    return page


@pytest.fixture(scope="session")
def window(browser) -> BrowserContext:
    return window_of(browser, viewport=SIZE)


@pytest.fixture(scope="session")
def tab(window, request) -> Iterator[Callable[[str], Page]]:
    """tab("recorded") or tab("live"): the page, opened once, in front and at rest."""
    with ExitStack() as stack:
        page_of = cache(lambda kind: stack.enter_context(opened(window, request.getfixturevalue(f"{kind}_file"))))

        def at_rest(kind: str) -> Page:
            page_of(kind).bring_to_front()  # of several pages the browser draws the one in front
            page_of(kind).evaluate(REST)
            return page_of(kind)

        yield at_rest


@pytest.fixture
def recorded(tab) -> Page:
    return tab("recorded")


@pytest.fixture
def live(tab) -> Page:
    return tab("live")


@pytest.fixture(params=["recorded", "live"])
def either(tab, request) -> Page:
    return tab(request.param)
