"""Runs the Windows library of a release by FMPy itself: FMPy's remoting starts it under wine and talks to it by TCP.

python -m release.by_fmpy FMU, with `wine64` on the path: prints a line of the report. Scenes of the paper, SI units.
"""

from __future__ import annotations

import contextlib
import io
import shutil
import sys
import tempfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.util import add_remoting
from fmpy.validation import validate_fmu

SCENES = {"free": 0.0, "friction": 0.03}  # s, m


def only(fmu: Path, platform: str, folder: Path) -> Path:
    """The archive unpacked, with the library of one platform."""
    fmpy.extract(fmu, folder)
    for other in (folder / "binaries").iterdir():
        if other.name != platform:
            shutil.rmtree(other)
    return folder


def trajectory(folder: Path, s: float) -> np.ndarray:
    variables = fmpy.read_model_description(folder).modelVariables
    outputs = [v.name for v in variables if v.causality == "output"]
    with contextlib.redirect_stdout(io.StringIO()):  # the remoting tells each attempt to connect
        return fmpy.simulate_fmu(str(folder), start_values={"s": s}, output=outputs)


def main() -> None:
    fmu = Path(sys.argv[1])
    if problems := validate_fmu(str(fmu)):
        raise SystemExit(f"{fmu}: {problems}")
    with tempfile.TemporaryDirectory() as scratch:
        linux = only(fmu, "linux64", Path(scratch) / "linux")
        windows = only(fmu, "win64", Path(scratch) / "windows")
        add_remoting(str(windows), "linux64", "win64")
        for scene, s in SCENES.items():
            here, there = trajectory(linux, s), trajectory(windows, s)
            if len(here) != 1001 or here.tobytes() != there.tobytes():
                raise SystemExit(f"FMPy under wine gives another {scene} wheel than on Linux.")
    print(
        f"FMPy {fmpy.__version__} finds no fault in the FMU. It simulated the paper's two scenes with the Windows "
        f"library, through its remoting and wine, and with the Linux library: {len(here.dtype) - 1} outputs at "
        f"{len(here)} instants, bit-identical."
    )


if __name__ == "__main__":
    main()
