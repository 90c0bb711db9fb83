"""Builds the site of all documents, the folder build/site, for any static host. It has search and formulas, reports,
the notebook, the reference of the C header, and the lesson, and is self-contained; a broken link fails the build."""

import shutil
from argparse import Namespace

from wheelfmu.commands import processes
from wheelfmu.fmu.outputs import alone
from wheelfmu.fmu.paths import ROOT

SOURCE, SITE = ROOT / "lab" / "site", ROOT / "build" / "site"
LESSON = (ROOT / "lab" / "lesson").exists()
NEEDS = ("site", *("lesson", "release") * LESSON)


def main(_given: Namespace) -> None:
    with alone(SITE):
        shutil.rmtree(SITE, ignore_errors=True)
        SITE.mkdir(parents=True)
        page = SITE / "live.html"
        if LESSON:
            processes.check(*processes.command("page", page))
        how = ["-q", "-E", "-n", "-W", "--keep-going", "-j", "auto", "-b", "html"]
        where = ["-c", SOURCE, "-d", ROOT / "build" / "site-doctrees", "-A", f"live={page if page.exists() else ''}"]
        processes.check(*processes.python("sphinx", *how, *where, ROOT, SITE))
    print("The site is build/site; open build/site/index.html, or copy the folder to a host.")
