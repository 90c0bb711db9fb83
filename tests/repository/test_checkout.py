"""A checkout that was moved, renamed or copied builds again by itself; an interrupted fetch of SUNDIALS mends itself.

The scripts are tried on small folders: a stand-in for cmake or cargo takes the place of the long work.
"""

import hashlib
import os
import shutil
import subprocess
import tarfile
from pathlib import Path

import pytest
from support.paths import ROOT

CRATE = "sundials-sys-0.6.2"


def program(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def run(
    *command: str | Path, path: str | None = None, folder: Path | None = None, **variables: str
) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name not in ("LD_PRELOAD", "VIRTUAL_ENV")}
    environment |= {"PATH": path or os.environ["PATH"], **variables}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """The scripts that build and set up, alone in a folder."""
    place = tmp_path / "checkout"
    for name in ("scripts/build", "scripts/setup", "scripts/help", "cmake/sundials.cmake", "CMakePresets.json"):
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, place / name)
    (place / "pyproject.toml").write_text('[dependency-groups]\ninstaller = ["pip"]\ncore = ["pip"]\n')
    return place


def test_a_build_folder_of_another_place_is_built_anew(checkout: Path, tmp_path: Path) -> None:
    program(tmp_path / "bin" / "cmake", "exit 0")
    path = f"{tmp_path / 'bin'}:{os.environ['PATH']}"

    def survives(place: Path, home: Path) -> bool:
        built = place / "build" / "release" / "object"
        built.parent.mkdir(parents=True, exist_ok=True)
        (built.parent / "CMakeCache.txt").write_text(f"CMAKE_HOME_DIRECTORY:INTERNAL={home}\n")
        built.touch()
        assert run(place / "scripts" / "build", "release", path=path).returncode == 0
        return built.exists()

    assert survives(checkout, checkout)
    assert not survives(checkout, tmp_path / "elsewhere")
    renamed = checkout.rename(tmp_path / "renamed")
    assert not survives(renamed, checkout)
    (tmp_path / "link").symlink_to(renamed)
    assert survives(tmp_path / "link", renamed)  # the same place by another name


def test_the_python_environment_of_another_place_is_made_anew(checkout: Path, tmp_path: Path) -> None:
    def works(place: Path) -> bool:
        done = run(place / "scripts" / "setup", WHEEL_SUNDIALS_SOURCE="given", path="/usr/bin:/bin")
        assert done.returncode == 0, done.stderr
        return run(place / ".venv" / "bin" / "pip", "--version").returncode == 0

    assert works(checkout)
    kept = checkout / ".venv" / "kept"
    kept.touch()
    assert works(checkout) and kept.exists()
    renamed = checkout.rename(tmp_path / "renamed")
    with pytest.raises(FileNotFoundError):  # its first line names the old place
        run(renamed / ".venv" / "bin" / "pip", "--version")
    assert works(renamed) and not (renamed / ".venv" / "kept").exists()


class Fetch:
    """fetch_sundials of cmake/sundials.cmake in an empty folder, with a registry that holds a small archive."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.cache = folder, folder / "build" / "sundials"
        self.bin, self.calls = folder / "bin", folder / "calls"
        self.archive = folder / f"{CRATE}.crate"
        source = folder / CRATE / "vendor"
        source.mkdir(parents=True)
        for name in ("CMakeLists.txt", "last.c"):
            (source / name).write_text(name)
        with tarfile.open(self.archive, "w:gz") as tar:
            tar.add(folder / CRATE, CRATE)
        digest = hashlib.sha256(self.archive.read_bytes()).hexdigest()
        (folder / "fetch.cmake").write_text(
            f'include("{ROOT}/cmake/sundials.cmake")\nset(sundials_sha256 {digest})\nfetch_sundials(source)\n'
        )
        self.bin.mkdir()
        (self.bin / "cmake").symlink_to(shutil.which("cmake"))
        crates = "$CARGO_HOME/registry/cache/here"
        registry = f'echo called >>{self.calls}\nmkdir -p "{crates}"\ncp {self.archive} "{crates}"'
        program(self.bin / "cargo", f"PATH=/usr/bin:/bin\n{registry}")

    def __call__(self) -> tuple[str, int]:
        """What CMake said of a failure, and how often the registry was asked."""
        self.calls.write_text("")
        done = run(self.bin / "cmake", "-P", self.folder / "fetch.cmake", path=str(self.bin), folder=self.folder)
        if done.returncode == 0:
            assert (self.cache / CRATE / "vendor" / "last.c").read_text() == "last.c"
        return " ".join(done.stderr.split()) * (done.returncode != 0), len(self.calls.read_text().split())


@pytest.fixture
def fetch(tmp_path: Path) -> Fetch:
    return Fetch(tmp_path)


def test_sundials_is_fetched_once_whatever_was_interrupted(fetch: Fetch) -> None:
    crates = fetch.cache / "new" / "registry" / "cache" / "here"
    crates.mkdir(parents=True)
    (crates / fetch.archive.name).write_bytes(fetch.archive.read_bytes()[:100])
    (fetch.cache / "new" / CRATE / "vendor").mkdir(parents=True)
    assert fetch() == ("", 1)
    (fetch.bin / "cargo").unlink()
    assert fetch() == ("", 0)
    shutil.rmtree(fetch.cache)
    assert "cargo is missing" in fetch()[0]  # the partner: there is something to fetch


def test_an_archive_other_than_the_pinned_one_is_refused(fetch: Fetch) -> None:
    fetch.archive.write_bytes(b"something else")
    said, calls = fetch()
    assert "SUNDIALS could not be fetched" in said and "expected" in said
    assert calls == 1
    assert not (fetch.cache / CRATE).exists()


def test_setup_asks_for_cargo_only_where_sundials_is_neither_given_nor_fetched(checkout: Path, tmp_path: Path) -> None:
    """As a user who may not install packages, on a machine without cargo; `id` and Python are stand-ins."""
    program(tmp_path / "bin" / "id", "echo 1000")
    program(tmp_path / "bin" / "python3", "exit 0")
    program(tmp_path / "bin" / "cargo", "exit 127")
    path = f"{tmp_path / 'bin'}:/usr/bin:/bin"

    def asked(**given: str) -> bool:
        return "cargo-web" in run(checkout / "scripts" / "setup", path=path, **given).stderr

    assert asked(WHEEL_SUNDIALS_SOURCE="")
    assert not asked(WHEEL_SUNDIALS_SOURCE="given")
    (checkout / "build" / "sundials" / "another-version").mkdir(parents=True)
    assert asked(WHEEL_SUNDIALS_SOURCE="")
    (checkout / "build" / "sundials" / CRATE).mkdir()
    assert not asked(WHEEL_SUNDIALS_SOURCE="")
