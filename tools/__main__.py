"""python3 tools COMMAND [WORD...]: the set-up of every command. It answers --help and typing errors, installs what the
command needs, Debian packages (packages) and Python packages in .venv (requirements.lock), and gives its place to the
command. By the standard library alone.
"""

import fcntl
import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path
from subprocess import DEVNULL
from typing import Any

from wheelfmu.fmu.outputs import worded
from wheelfmu.fmu.paths import LAB, ROOT
from wheelfmu.fmu.values import Fault

# The words that a word contains.
PARTS = {
    "all": ["test", "check", "tidy", "asan", "browser", "release", *LAB],
    "asan": ["tidy", "check"],
    "tidy": ["check"],
}
VENV = ROOT / ".venv"
PYTHON = VENV / "bin" / "python"
RENEWAL = "Delete it (rm -r .venv), and the next command makes it anew."


def run(*words: object, may_fail: bool = False, **how: Any) -> int:
    """The exit status of a program, which keeps the lock until it ends; a failure ends this one, too, unless it may."""
    code = subprocess.run([str(word) for word in words], cwd=ROOT, close_fds=False, check=False, **how).returncode
    return code if may_fail or not code else sys.exit(code if code > 0 else 128 - code)


def there(sign: str) -> bool:
    if sign.startswith("$"):
        return bool(os.environ.get(sign[1:]))
    if sign.startswith("import:"):
        return find_spec(sign[7:]) is not None
    if "/" in sign:
        return any((Path("/") if sign[0] == "/" else ROOT).glob(sign.lstrip("/")))
    return shutil.which(sign) is not None


def debian(words: set[str]) -> None:
    """Installs the packages that are missing."""
    rows = [line.split() for line in (ROOT / "tools" / "packages").read_text().splitlines() if line[0] != "#"]
    if missing := [package for word, package, *signs in rows if word in words and not any(map(there, signs))]:
        run("bash", ROOT / "tools" / "debian", *missing)


def environment() -> None:
    """.venv, whose programs contain its path and use one Python. Never emptied: one that does not fit is refused."""
    if not (VENV / "bin" / "pip").exists():  # written last
        run(sys.executable, "-I", "-m", "venv", VENV)
    ask = "import sys; print('Python %d.%d' % sys.version_info[:2])"
    try:
        python = subprocess.check_output([PYTHON, "-I", "-c", ask], stderr=DEVNULL, text=True).strip()
    except (OSError, subprocess.CalledProcessError):
        raise Fault(f".venv has no Python that runs. {RENEWAL}") from None
    here, place = f"{ROOT} {python}", VENV / "place"
    if not place.exists():
        place.write_text(f"{here}\n", encoding="utf-8")
    elif not (made := place.read_text(encoding="utf-8").strip()).startswith(here):
        raise Fault(f".venv was made for {made}, and this is {here}. {RENEWAL}")


def packages(words: set[str]) -> None:
    """The packages of the groups that have these names, in .venv."""
    (site,) = VENV.glob("lib/python3*/site-packages")
    # The packages wheelfmu and lab; relative: under the locale C no other letters than ASCII are read there.
    (site / "wheelfmu.pth").write_text("../../../../tools\n../../../../.\n")
    # A package that a killed set-up had begun is installed again: INSTALLER is written last.
    for info in [info for info in site.glob("*.dist-info") if not (info / "INSTALLER").exists()]:
        shutil.rmtree(info)
    lock, whole, uv = ROOT / "requirements.lock", VENV / "installed.lock", VENV / "bin" / "uv"
    if whole.exists() and whole.read_bytes() == lock.read_bytes():  # pip has installed all of it
        return
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["dependency-groups"]
    pip = [PYTHON, "-I", "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    if not uv.exists():
        run(*pip, *groups["installer"], may_fail=True, stderr=DEVNULL)
    sync = [uv, "--quiet", "--no-progress", "--no-python-downloads", "pip", "install", "--python", PYTHON]
    sync += ["-r", "pyproject.toml", "--constraint", lock, *(f"--group={word}" for word in words & groups.keys())]
    if uv.exists() and not run(*sync, "--offline", may_fail=True, stderr=DEVNULL):
        return
    print("Installing Python packages into .venv", flush=True)
    # By pip where uv cannot be installed, or does not reach the index that pip is configured for.
    if not uv.exists() or run(*sync, may_fail=True):
        (VENV / "without_uv.txt").write_text(re.sub(r"(?m)^uv==(.*\\\n)*.*\n", "", lock.read_text()))
        run(*pip, "--no-deps", "-r", VENV / "without_uv.txt")
        shutil.copy(lock, whole)


def install(words: set[str]) -> None:
    """One set-up at a time in this checkout; the others wait until it ends."""
    (ROOT / "build").mkdir(exist_ok=True)
    with (ROOT / "build" / "setup.lock").open("w") as file:
        os.set_inheritable(file.fileno(), True)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print("Waiting for another process to finish its set-up.", file=sys.stderr)
            fcntl.flock(file, fcntl.LOCK_EX)
        debian(words)
        environment()
        packages(words)


def main(name: str, *typed: str) -> None:
    from wheelfmu.__main__ import needs

    sys.path.append(str(ROOT))  # of the lab's commands; .venv has it once it is made
    asked = needs(name, *typed)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends set-up and the programs that it has started
    words = {".", "installer", *asked, *(["lesson"] if "lesson" in LAB else [])}  # for the 3D page of ./scripts/run
    with worded(name, 1):
        install(words.union(*(PARTS.get(word, ()) for word in words)))
    os.environ["PATH"] = f"{VENV / 'bin'}:{os.environ['PATH']}"
    os.execv(PYTHON, [str(PYTHON), "-P", "-m", "wheelfmu", name, *typed])


if __name__ == "__main__":
    main(*sys.argv[1:])
