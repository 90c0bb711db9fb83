"""The pages, and headless Chromium to look at them."""

import fcntl
import subprocess
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from playwright.sync_api import Browser, BrowserContext, Page
from support.paths import ROOT

from page.browser import chromium
from page.tests.pages import FLAGS, RECORD, opened, view, window_of, write_csv


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium(*FLAGS) as found:
        yield found


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
    (ROOT / "build").mkdir(exist_ok=True)
    with (ROOT / "build" / "wasm.lock").open("w") as file:  # one process at a time builds the module
        fcntl.flock(file, fcntl.LOCK_EX)
        subprocess.run([ROOT / "scripts" / "page", ROOT / "build" / "wheel_live.html"], check=True, capture_output=True)
    return ROOT / "build" / "wheel_live.html"


@pytest.fixture(scope="session")
def window(browser) -> BrowserContext:
    return window_of(browser, viewport={"width": 900, "height": 640})


@pytest.fixture(scope="session")
def recorded_page(window, recorded_file) -> Iterator[Page]:
    with opened(window, recorded_file) as page:
        yield page


@pytest.fixture(scope="session")
def live_page(window, live_file) -> Iterator[Page]:
    with opened(window, live_file) as page:
        yield page


@pytest.fixture
def recorded(recorded_page) -> Page:
    recorded_page.bring_to_front()  # of several pages the browser draws the one in front
    return recorded_page


@pytest.fixture
def live(live_page) -> Page:
    live_page.bring_to_front()
    return live_page


@pytest.fixture(params=["recorded", "live"])
def either(request) -> Page:
    return request.getfixturevalue(request.param)
