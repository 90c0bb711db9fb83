"""Fixtures of every folder of tests: the built FMU and its instances, the reference of the paper's scenes."""

import os
import re
import resource
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from fmpy import extract, read_model_description
from hypothesis import HealthCheck, settings

from wheelfmu.fmu.driver import FMU2Wheel
from wheelfmu.fmu.paths import ROOT, build_folder
from wheelfmu.truth.measure import FRICTION, paper
from wheelfmu.truth.motion import Library
from wheelfmu.truth.reference import Solution

# hypothesis: the same examples in every run.
UNCHECKED = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
settings.register_profile("same", derandomize=True, deadline=None, database=None, suppress_health_check=UNCHECKED)
settings.load_profile("same")

# A page is composed at once, instead of by the processor in the place of a graphics card.
AT_ONCE = ("--disable-gpu-compositing", "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas")
LARGEST = 4 << 30  # bytes that a test may take, many times what one needs
COMPONENTS = ("diagrams", "examples", "release")  # of the product, not the core
BESIDE = {"vehicles": "examples"}  # whose tests share a process with those of another, and its builds
LONGEST = ("hostile place", "examples", "lesson", "diagrams", "recipes", "studies")  # groups, by their computing time


def component(path: Path) -> str:
    """Of tests: the folder of their component, or of the lab; none for the core's."""
    part, folder = path.relative_to(ROOT).parts[:2]
    return BESIDE.get(folder, folder) if part == "lab" or folder in COMPONENTS else ""


@pytest.fixture(autouse=True)
def bounded_memory(request: pytest.FixtureRequest) -> Iterator[None]:
    """A fault that takes memory without end fails its test, not the machine. (Browsers and sanitizers reserve more.)"""
    if component(request.path) or "LD_PRELOAD" in os.environ:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    resource.setrlimit(resource.RLIMIT_DATA, (LARGEST, hard))
    yield
    resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "local: neither for a release nor under the sanitizers, needs a local build")
    if hasattr(config, "workerinput"):  # set for this process, not for programs that tests start
        os.environ.pop("PYTHONSAFEPATH", None)


def pytest_sessionstart(session: pytest.Session) -> None:
    """Once, before processes start and tests are imported: the release build is that of the sources. A build that
    WHEEL_BUILD names is tested as it is."""
    if "WHEEL_BUILD" in os.environ or hasattr(session.config, "workerinput"):
        return
    command = ["bash", ROOT / "scripts" / "build", "release"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        pytest.exit(done.stdout, 1)


def pytest_itemcollected(item: pytest.Item) -> None:
    """With --dist loadgroup the tests of a component share a process, and with it a browser or a cluster."""
    if name := component(item.path):
        item.add_marker(pytest.mark.xdist_group(name))


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """With --dist loadgroup the longest groups begin first, and tests without a group fill the processes at the end."""

    def rank(item: pytest.Item) -> int:
        marker = item.get_closest_marker("xdist_group")
        name = marker.args[0] if marker else ""
        return LONGEST.index(name) if name in LONGEST else len(LONGEST) + (not marker)

    if getattr(config.option, "loadgroup", False):
        items.sort(key=rank)


def pytest_collection_finish(session: pytest.Session) -> None:
    grouped = [item for item in session.items if item.get_closest_marker("xdist_group")]
    if getattr(session.config.option, "loadgroup", False) and not all("@" in item.nodeid for item in grouped):
        raise pytest.UsageError("pytest-xdist sees no groups of tests: do its and pytest's versions fit?")


@pytest.fixture(scope="session")
def fmu_path() -> Path:
    return build_folder() / "wheel.fmu"


@pytest.fixture(scope="session")
def fmu(fmu_path: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The unpacked FMU."""
    return extract(str(fmu_path), str(tmp_path_factory.mktemp("fmu")))


@pytest.fixture(scope="session")
def library(fmu: str) -> Library:
    """The unpacked FMU as a function from a scene to its motion; instances come and go."""
    return Library(fmu)


@pytest.fixture(scope="session")
def description(fmu: str):
    return read_model_description(fmu)


@pytest.fixture(scope="session")
def references() -> dict[str, Solution]:
    """The paper's two scenes by the reference, every 0.1 s."""
    return {scene: paper(scene) for scene in FRICTION}


@pytest.fixture(scope="session")
def vehicles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The FMUs of examples/vehicles and their packages, copied into an empty folder and built by the recipe of their
    page."""
    page = (ROOT / "examples" / "vehicles" / "README.md").read_text(encoding="utf-8")
    (recipe,) = re.findall(r"```\n(project=.*?)```", page, re.DOTALL)
    folder = tmp_path_factory.mktemp("copy")
    recipe = recipe.replace("/path/to/this/checkout", str(ROOT)).replace("$project/dist/wheel.fmu", "$wheel")
    commands = f"wheel={shlex.quote(str(build_folder() / 'wheel.fmu'))}\n{recipe}"
    active = os.environ | {"VIRTUAL_ENV": sys.prefix}
    subprocess.run(["bash", "-e", "-c", commands], cwd=folder, env=active, check=True, capture_output=True)
    return folder / "build"


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """A headless browser, the only one of its process: Playwright starts no second. Its folder can be deleted."""
    with pytest.importorskip("lab.lesson.browser").chromium(*AT_ONCE) as found:
        yield found


@pytest.fixture
def wheel(library: Library) -> Iterator[Callable[..., FMU2Wheel]]:
    """wheel(...) -> a new instance in the state "instantiated"; freed after the test."""
    made: list[FMU2Wheel] = []

    def make(**options) -> FMU2Wheel:
        made.append(library.wheel(**options))
        return made[-1]

    yield make
    for instance in made:
        instance.close()
