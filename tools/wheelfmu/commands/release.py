"""Builds one wheel.fmu for Linux, Windows and macOS, on Linux (x86-64), and tests it as far as it runs here. Leaves the
folder build/wheel-VERSION with the FMU, the site, the notes and their SHA-256 sums, writes docs/results/platforms.md,
and prints the commands that tag it. Every library is built twice, in two folders; the two FMUs must be identical
files."""

from argparse import Namespace

from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.paths import ROOT

NEEDS = ("release", "platforms", "test", "check", *["site"] * (ROOT / "lab" / "site").exists())


def main(_given: Namespace) -> None:
    from wheelfmu.release.__main__ import main as release

    with alone(ROOT / "build" / "wheel-release"):
        release()
