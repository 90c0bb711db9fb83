"""Memory that runs short: every allocation of an instance's life fails in turn, once, or from there on for good."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

# formulation, friction law, method (4: Runge-Kutta): here every allocation is our own. SUNDIALS does not survive each
# failure of one it makes (docs/decisions/package.md), so its methods are not played with.
SCENES = {"reduced": (2, 1, 4), "multibody": (3, 1, 4), "reduced, regularized": (2, 2, 4)}


@pytest.fixture(scope="module")
def hook(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """To be preloaded."""
    hook, source = tmp_path_factory.mktemp("memory") / "short_memory.so", Path(__file__).with_name("short_memory.c")
    clean = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    subprocess.run(["cc", "-std=gnu11", "-O1", "-fPIC", "-shared", source, "-o", hook, "-ldl"], check=True, env=clean)
    return hook


@pytest.mark.parametrize("scene", SCENES)
def test_no_failed_allocation_crashes_goes_unlogged_or_changes_a_later_bit(hook: Path, fmu: str, scene: str) -> None:
    preloaded = f"{hook}:{os.environ.get('LD_PRELOAD', '')}".rstrip(":")
    options = f"{os.environ.get('ASAN_OPTIONS', '')}:verify_asan_link_order=0"
    environment = os.environ | {"LD_PRELOAD": preloaded, "ASAN_OPTIONS": options}
    words = [sys.executable, Path(__file__).with_name("short_memory.py"), fmu, *map(str, SCENES[scene])]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=1800, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert int(done.stdout) >= 3  # the instance; a state; the state that bytes become
