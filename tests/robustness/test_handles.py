"""What a call on an instance or with a state touches: these two alone, and neither once it is freed."""

import os
import signal
import subprocess
import sys

import pytest
from support.paths import ROOT

pytestmark = pytest.mark.local  # the address sanitizer has another heap


def ending(fmu: str, what: str, **environment: str) -> int:
    """Exit status of handles.py."""
    words = [sys.executable, "-m", "robustness.handles", fmu, what]
    return subprocess.run(words, env=os.environ | environment | {"PYTHONPATH": str(ROOT / "tests")}).returncode


@pytest.mark.parametrize(("what", "status"), [("own", 0), ("instance", -signal.SIGSEGV), ("state", -signal.SIGSEGV)])
def test_a_call_touches_no_other_instance_and_no_other_state(fmu, what, status):
    """So its cost does not depend on how many there are. The partners use one whose memory is fenced off."""
    assert ending(fmu, what, MALLOC_MMAP_THRESHOLD_="0", MALLOC_ARENA_MAX="1") == status


def test_a_freed_instance_or_state_is_refused_as_long_as_its_memory_is_there(fmu, memory_hook):
    assert ending(fmu, "freed", LD_PRELOAD=str(memory_hook)) == 0
