"""Builds one wheel.fmu for Linux, Windows and macOS, on Linux (x86-64), and tests it as far as it runs here. Every
library is built twice, in two folders; the two FMUs must be identical files. Writes

  dist/                        wheel.fmu, the lesson, and README.md with version, source commit and SHA-256 sums
  docs/results/platforms.md    what was run and what was only built
  build/wheel-VERSION          the FMU, the site, the notes and their sums, to attach to a tag

and prints the commands that tag it. All sources must be committed, because dist/README.md names their commit."""

from argparse import Namespace

from wheelfmu.fmu.files import alone
from wheelfmu.fmu.paths import ROOT

NEEDS = ("release", "platforms", "test", "check", *["site"] * (ROOT / "lab" / "site").exists())


def main(_given: Namespace) -> None:
    from wheelfmu.release.__main__ import main as release

    with alone(ROOT / "build" / "wheel-release"):
        release()
