"""Searches for calls of the FMU that break it, by libFuzzer under sanitizers (tests/robustness/fuzz).

  ./scripts/fuzz SECONDS [FOLDER]   stops at a broken expectation; FOLDER keeps the inputs found (default build/corpus)
  ./scripts/fuzz keep [FOLDER]      reduces those inputs to the corpus from which every run starts

WHEEL_FUZZ_TRACE=1 build/asan/tests/robustness/fuzz/fuzz FILE shows an artifact as a sequence of calls.
"""

import re
import sys
from argparse import Namespace
from pathlib import Path
from subprocess import STDOUT
from tempfile import TemporaryDirectory

from wheelfmu.commands import processes
from wheelfmu.commands.build import build
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import Fault

NEEDS = ("asan",)
FUZZ = ROOT / "build" / "asan" / "tests" / "robustness" / "fuzz" / "fuzz"
CORPUS = ROOT / "tests" / "robustness" / "fuzz" / "corpus.txt"  # an input in hexadecimal a line
TOLD = re.compile(r"^Expectation|runtime error|^==.*ERROR|^    #[0-9]+ .*(fuzz::|fmi|wheel::|orbit::|solver::)")
LIMITS = ("-max_len=256", "-timeout=1800", "-rss_limit_mb=2048", "-print_final_stats=1")


def seconds(text: str) -> str:
    if text != "keep" and not text.isdecimal():
        raise Fault(f'"{text}" is no number of seconds')
    return text


OPTIONS = {
    "seconds": {"nargs": "?", "type": seconds, "default": "60", "metavar": "SECONDS|keep", "help": "60 if not given"},
    "folder": {
        "nargs": "?",
        "type": Path,
        "default": Path("build/corpus"),
        "metavar": "FOLDER",
        "help": "build/corpus if not given",
    },
}


def main(given: Namespace) -> None:
    build("asan")
    log, artifacts = ROOT / "build" / "fuzz-run.log", ROOT / "build" / "fuzz-artifacts"
    for folder in (given.folder, artifacts):
        folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=ROOT / "build") as place, log.open("w+", errors="replace") as file:
        seeds = Path(place, "seeds")
        seeds.mkdir()
        for number, line in enumerate(CORPUS.read_text().split()):
            (seeds / str(number)).write_bytes(bytes.fromhex(line))
        if given.seconds == "keep":
            keep(Path(place, "kept"), seeds, given.folder, file)
            return
        words = [given.folder, seeds, f"-max_total_time={given.seconds}", f"-artifact_prefix={artifacts}/", *LIMITS]
        code = processes.status(FUZZ, *words, stdout=file, stderr=STDOUT)
        file.seek(0)
        said = file.read()
    if code:
        print(*[line for line in said.splitlines() if TOLD.search(line)][:30], sep="\n", file=sys.stderr)
        print(f"The fuzzer found something; the input is in {artifacts}, the whole log is {log}.", file=sys.stderr)
        raise processes.Failed(1)
    edges, (executed,) = re.findall(r"cov: (\d+)", said)[-1], re.findall(r"number_of_executed_units: *(\d+)", said)
    print(f"Fuzzed {given.seconds} s: {executed} executions, {edges} edges, no finding.")


def keep(kept: Path, seeds: Path, learned: Path, log) -> None:  # noqa: ANN001 - an open file
    """The corpus anew, of the fewest inputs that reach what all of them do."""
    kept.mkdir()
    processes.check(FUZZ, "-set_cover_merge=1", "-use_counters=0", kept, seeds, learned, stdout=log, stderr=STDOUT)
    lines = sorted(path.read_bytes().hex().upper() for path in kept.iterdir())
    CORPUS.write_text("".join(f"{line}\n" for line in lines))
    print(f"The corpus has {len(lines)} inputs.")
