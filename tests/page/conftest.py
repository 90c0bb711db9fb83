"""The pages, and headless Chromium to look at them."""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from paths import ROOT
from playwright.sync_api import Browser, Page, sync_playwright

POSE = ("X_O", "Y_O", "Z_O", "psi", "theta", "phi")
RATES = tuple(f"{name}_dot" for name in POSE)
RECORD = (*POSE, *RATES, "omega_z", "lambda_1", "lambda_2", "lambda_3", "E", "friction_mode")
# No graphics card is asked for; the rest keeps the browser from looking for hosts of its own.
FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking"]
FLAGS += ["--no-first-run", "--disable-component-update", "--disable-sync", "--disable-quic"]
FLAGS += ["--no-sandbox"] if os.geteuid() == 0 else []
PATIENCE = 120_000  # ms; a page is drawn by the processor here


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        yield chromium
        chromium.close()


@contextmanager
def opened(browser: Browser, path: Path, **context: object) -> Iterator[Page]:
    """A page that stands still at its start; afterwards its console must hold no error and no warning."""
    look = {"viewport": {"width": 900, "height": 640}, "reduced_motion": "reduce"} | context
    surroundings = browser.new_context(offline=True, **look)
    surroundings.set_default_timeout(PATIENCE)
    page = surroundings.new_page()
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text) if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda fault: said.append(str(fault)))
    page.goto(path.as_uri())
    page.wait_for_function("window.page && page.views && !page.stage.dirty")
    yield page
    surroundings.close()
    noise = "GPU stall due to ReadPixels"  # of taking a picture without a graphics card
    assert [line for line in said if noise not in line] == []


@pytest.fixture(scope="session")
def scenes(simulate) -> dict[str, np.ndarray]:
    """The paper's two scenes as ./scripts/run records them."""
    return {name: simulate(step=0.01, output=RECORD, s=s) for name, s in (("free", 0.0), ("friction", 0.03))}


def write_csv(path: Path, columns: dict[str, np.ndarray]) -> Path:
    """A result file as FMPy writes it."""
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(repr(float(value)) for value in row) for row in rows]
    path.write_text("\n".join([",".join(f'"{name}"' for name in columns), *lines, ""]))
    return path


def view(*arguments: object) -> subprocess.CompletedProcess[str]:
    """What ./scripts/view does, once all is set up."""
    command = [sys.executable, "-m", "view_page", "recorded", *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(ROOT / "scripts")}
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environment)


@pytest.fixture(scope="session")
def recorded_file(scenes, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("page")
    files = [write_csv(folder / f"{n}.csv", {c: rows[c] for c in rows.dtype.names}) for n, rows in scenes.items()]
    done = view(*files, "--output", folder / "wheel.html")
    assert done.returncode == 0, done.stderr
    return folder / "wheel.html"


@pytest.fixture(scope="session")
def recorded(browser, recorded_file) -> Iterator[Page]:
    with opened(browser, recorded_file) as page:
        yield page


@pytest.fixture(scope="session")
def locked() -> Callable:
    """locked(name): one process at a time builds this folder of build/."""

    @contextmanager
    def lock(name: str) -> Iterator[Path]:
        (ROOT / "build").mkdir(exist_ok=True)
        with (ROOT / "build" / f"{name}.lock").open("w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield ROOT / "build" / name

    return lock


@pytest.fixture(scope="session")
def live_file(locked) -> Path:
    with locked("wasm") as folder:
        page = folder.with_name("wheel_live.html")
        subprocess.run([ROOT / "scripts" / "page", page], check=True, capture_output=True)
        return page


@pytest.fixture(scope="session")
def live(browser, live_file) -> Iterator[Page]:
    with opened(browser, live_file) as page:
        yield page
