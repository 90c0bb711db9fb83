"""The pages, and headless Chromium to look at them."""

from __future__ import annotations

import fcntl
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from playwright.sync_api import Browser, Page
from support.driver import HEADLINE
from support.paths import ROOT

from page.browser import chromium
from page.tests.pages import FLAGS, RECORD, opened, view, write_csv


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium(*FLAGS) as found:
        yield found


@pytest.fixture(scope="session")
def simulate(fmu: str, description):
    """simulate(step, stop, output, **start values) -> record array of these outputs, by `fmpy.simulate_fmu`."""

    def run(step: float = 0.1, stop: float = 10.0, output: tuple[str, ...] = HEADLINE, **start: float) -> np.ndarray:
        options = {"model_description": description, "output_interval": step, "stop_time": stop, "output": output}
        return simulate_fmu(fmu, start_values=start, **options)

    return run


@pytest.fixture(scope="session")
def scenes(simulate) -> dict[str, np.ndarray]:
    """The paper's two scenes as ./scripts/run records them."""
    return {name: simulate(step=0.01, output=RECORD, s=s) for name, s in (("free", 0.0), ("friction", 0.03))}


@pytest.fixture(scope="session")
def recorded_file(scenes, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    files = [write_csv(folder / f"{n}.csv", {c: rows[c] for c in rows.dtype.names}) for n, rows in scenes.items()]
    done = view(*files, "--output", folder / "wheel.html")
    assert done.returncode == 0, done.stderr
    return folder / "wheel.html"


@pytest.fixture(scope="session")
def live_file() -> Path:
    build = ROOT / "build"
    build.mkdir(exist_ok=True)
    with (build / "wasm.lock").open("w") as file:  # one process at a time builds the module
        fcntl.flock(file, fcntl.LOCK_EX)
        subprocess.run([ROOT / "scripts" / "page", build / "wheel_live.html"], check=True, capture_output=True)
        return build / "wheel_live.html"


@pytest.fixture(scope="session")
def recorded_page(browser, recorded_file) -> Iterator[Page]:
    with opened(browser, recorded_file) as page:
        yield page


@pytest.fixture(scope="session")
def live_page(browser, live_file) -> Iterator[Page]:
    with opened(browser, live_file) as page:
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
    """Each of the two pages."""
    return request.getfixturevalue(request.param)
