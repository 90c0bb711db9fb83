"""Shared by the tests of studies: comparing results bit by bit, and the command as a process."""

import os
import subprocess
import sys

import xarray as xr
from support.paths import ROOT


def same(a: xr.Dataset, b: xr.Dataset) -> bool:
    """Whether two results are bit-identical, computing times aside."""
    a, b = (one.drop_vars(("wall_time", "fmu_time")).load() for one in (a, b))
    return a.equals(b)


def command(*options: object, **more: object) -> subprocess.Popen:
    """The command behind ./scripts/study, in the Python of the tests."""
    path = os.pathsep.join(str(ROOT / folder) for folder in ("examples/studies", "tools"))
    how = {"env": os.environ | {"PYTHONPATH": path}, "stderr": subprocess.PIPE, "text": True} | more
    return subprocess.Popen([sys.executable, "-m", "study", *map(str, options)], **how)
