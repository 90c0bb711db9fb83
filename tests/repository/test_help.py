"""Every command under scripts/ answers --help and a typing error at once, in a checkout where nothing is installed."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from support.paths import ROOT

SHELL = "#!/usr/bin/env bash\n"
# Commands of folders that can be deleted whole.
PARTS = {"page": "tools/page", "view": "tools/page", "study": "examples/studies", "example": "examples/vehicles"}
GONE = [name for name, folder in PARTS.items() if not (ROOT / folder).exists()]
COMMANDS = sorted({p.name for p in (ROOT / "scripts").iterdir()} - set(GONE))
WRONG = {
    **{"build": ("faster",), "documents": ("--chek",), "example": ("car", "m_B=-1"), "fuzz": ("a minute",)},
    **{"lint": ("--fixx",), "page": ("--output",), "report": ("sped",), "run": ("m=-5",), "setup": ("tests",)},
    **{"study": ("--vary", "tetha_start=1,2"), "view": ("there_is_no_such_file.csv",)},
}


@pytest.fixture(scope="module")
def bare(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A checkout without anything that is built or installed."""
    place = tmp_path_factory.mktemp("checkout")
    copy = f"git ls-files -coz --exclude-standard | xargs -0 cp --parents -t '{place}'"
    subprocess.run(["bash", "-c", copy], cwd=ROOT, check=False)  # a file may be deleted
    return place


def files(folder: Path) -> set[Path]:
    return {p for p in folder.rglob("*") if p.is_file()}


def call(folder: Path, name: str, *words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | variables
    command = [folder / "scripts" / name, *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120)


def test_the_folder_holds_commands_alone_among_them_those_that_newcomers_are_logged_of() -> None:
    assert {"run", "test", "build", "setup", "lint", "release", "report", *PARTS} <= {*COMMANDS, *GONE}
    for name in COMMANDS:
        path = ROOT / "scripts" / name
        assert path.is_file() and os.access(path, os.X_OK), f"scripts/{name} cannot be typed"
        assert path.read_text().startswith(SHELL)


@pytest.mark.parametrize("option", ["--help", "-h"])
@pytest.mark.parametrize("name", COMMANDS)
def test_help_tells_what_a_command_does_and_does_nothing(bare: Path, name: str, option: str) -> None:
    before = files(bare)
    done = call(bare, name, option)
    assert done.returncode == 0 and not done.stderr
    assert len(done.stdout.split()) >= 10
    assert files(bare) == before


@pytest.mark.parametrize("name", [name for name in WRONG if name in COMMANDS])
def test_a_typing_error_is_logged_before_anything_is_installed(bare: Path, name: str) -> None:
    before = files(bare)
    done = call(bare, name, *WRONG[name])
    assert done.returncode in (1, 2) and not done.stdout
    said = done.stderr.strip().splitlines()[-1]
    assert WRONG[name][-1].split("=")[name == "run"] in said or "one file" in said
    assert files(bare) == before


def test_help_of_run_names_what_it_makes_where_there_is_no_python(bare: Path, tmp_path: Path) -> None:
    for tool in ("bash", "basename", "dirname", "sed", "env"):
        (tmp_path / tool).symlink_to(shutil.which(tool))
    done = call(bare, "run", "--help", PATH=str(tmp_path))
    assert done.returncode == 0
    assert all(word in done.stdout for word in ("results/", "wheel.html", "theta_start=60deg", "docs/variables.md"))


def test_help_lists_every_command(bare: Path) -> None:
    listed = call(bare, "help").stdout.splitlines()
    assert [line.split()[0] for line in listed] == COMMANDS
    assert all(len(line.split()) > 3 and line.endswith(".") for line in listed)


def test_help_may_be_read_in_part(bare: Path) -> None:
    done = subprocess.run(["bash", "-c", "./scripts/run --help | head -1"], cwd=bare, capture_output=True, text=True)
    assert done.stdout.count("\n") == 1 and not done.stderr
