"""The files that a user takes, dist/: the paper's two scenes by the released FMU, and the page about the files.

The error is that of the documents: of the four headline outputs, every 10 ms, over the range of each.
"""

import re
import subprocess
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from fmpy import extract
from support.bounds import beyond, within

from wheelfmu.fmu.driver import HEADLINE
from wheelfmu.fmu.paths import ROOT
from wheelfmu.release import folder
from wheelfmu.truth.errors import range_error
from wheelfmu.truth.motion import Library, Run

DIST = ROOT / "dist"
ROLLING_RESISTANCE = {"free": 0.0, "friction": 0.03}  # s, m
BOUND = 1e-6  # of the range: six digits

taken = pytest.mark.skipif(not (DIST / "wheel.fmu").exists(), reason="only a commit of a release has files in dist/")
each = pytest.mark.parametrize("scene", ROLLING_RESISTANCE)


def run(library: Library, scene: str, tolerance: float | None = None) -> Run:
    return library.simulate(np.linspace(0, 10, 1001), tolerance, s=ROLLING_RESISTANCE[scene])


@pytest.fixture(scope="module")
def released(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return Library(extract(str(DIST / "wheel.fmu"), str(tmp_path_factory.mktemp("released"))))


@taken
@each
def test_the_released_file_gives_the_papers_scenes(released: Library, library: Library, scene: str) -> None:
    """As the sources do, at their tightest tolerance, which other tests compare with the references."""
    want, (other,) = run(library, scene, 1e-13), {*ROLLING_RESISTANCE} - {scene}
    within(range_error(run(released, scene), want, HEADLINE), BOUND, f"{scene}: error / range")
    beyond(range_error(run(released, other), want, HEADLINE), 1e4 * BOUND, f"{other} for {scene}: error / range")


def version() -> str:
    """Of the released file."""
    description = ZipFile(DIST / "wheel.fmu").read("modelDescription.xml").decode()
    return re.findall(r'\bversion="([^"]+)" license', description)[0]


def sources_are_released() -> bool:
    """Whether the sources are of the same version, without changes since."""
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    return folder.version() == version() and not folder.notes(changes, version())[1]


@taken
@each
def test_the_released_file_is_bit_identical_to_a_build_of_its_version(released, library, scene) -> None:
    if not sources_are_released():
        pytest.skip("the sources have changes since the released version, which may change last digits")
    first, second, coarse = run(released, scene), run(library, scene), run(library, scene, 1e-7)
    assert all(np.array_equal(first[name], second[name]) for name in HEADLINE)
    assert not all(np.array_equal(first[name], coarse[name]) for name in HEADLINE)


@taken
def test_the_page_of_the_released_files_has_their_version_and_sums() -> None:
    page = (DIST / "README.md").read_text(encoding="utf-8")
    files = sorted(path for path in DIST.iterdir() if path.name != "README.md")
    assert f"# wheel.fmu {version()}\n" in page
    assert all(f"| {folder.sum_of(path)} |" in page for path in files)


def test_the_page_of_a_release_names_its_commit_and_what_lies_beside_it(tmp_path: Path) -> None:
    (tmp_path / "wheel.fmu").write_bytes(b"an archive")
    page = folder.page_of(tmp_path, "9.9.9", "0123abcd")
    assert "# wheel.fmu 9.9.9" in page and "`0123abcd`" in page and "wheel_lesson.html" not in page
    assert "draft" not in page and "a draft" in folder.page_of(tmp_path, "9.9.9", "0123abcd", draft=True)
    assert f"| {folder.sum_of(tmp_path / 'wheel.fmu')} |" in page
    (tmp_path / "wheel.fmu").write_bytes(b"another archive")
    assert f"| {folder.sum_of(tmp_path / 'wheel.fmu')} |" not in page
    (tmp_path / "wheel_lesson.html").write_text("<p>")
    assert "wheel_lesson.html" in folder.page_of(tmp_path, "9.9.9", "0123abcd")


def test_a_release_names_a_commit_that_has_all_its_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def git(*words: str) -> str:
        command = ["git", "-c", "user.name=a", "-c", "user.email=a", *words]
        return subprocess.check_output(command, cwd=tmp_path, text=True)

    monkeypatch.setattr(folder, "ROOT", tmp_path)
    git("init", "-q")
    (tmp_path / "source.c").touch()
    with pytest.raises(SystemExit, match="commit all changes"):
        folder.commit()
    git("add", "source.c")
    git("commit", "-q", "-m", "a")
    (tmp_path / "dist").mkdir()
    (tmp_path / "dist" / "wheel.fmu").touch()  # of the release before
    assert folder.commit() == git("rev-parse", "HEAD").strip()
