"""What a release gives away: dist/, the files in the repository with a page about them; and a folder with the archive,
the site, notes from CHANGELOG.md, and the sums of all three."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

from wheelfmu.fmu.outputs import deliver
from wheelfmu.fmu.paths import ROOT
from wheelfmu.publishing.markdown import page

VERSIONS = {
    "CMakeLists.txt": r"project\(wheel VERSION (\S+)",
    "modelDescription.xml": r'\bversion="([^"]+)" license',
    "CITATION.cff": r"^version: (\S+)",
}
DRAFT = "Unreleased"
DIST = ROOT / "dist"
LESSON = "wheel_lesson.html"
WRITTEN = ("dist", "docs/results/platforms.md")  # by a release, and committed after it


def version(root: Path = ROOT) -> str:
    """The version that all files name; SystemExit with one sentence if they differ."""
    texts = {name: (root / name).read_text(encoding="utf-8") for name in VERSIONS}
    found = {name: "".join(re.findall(VERSIONS[name], text, re.MULTILINE) or ["none"]) for name, text in texts.items()}
    if len(set(found.values())) > 1:
        named = ", ".join(f"{name} names {value}" for name, value in found.items())
        raise SystemExit(f"The versions differ: {named}.")
    return next(iter(found.values()))


def notes(changelog: str, number: str) -> tuple[str, bool]:
    """The newest section of the changelog, and whether it still is a draft; SystemExit if it is of another version."""
    title, _, rest = changelog.partition("\n## ")[2].partition("\n")
    text = rest.split("\n## ")[0].strip()
    if re.split(r"[ ,]", title)[:1] not in ([number], [DRAFT]):
        raise SystemExit(f"CHANGELOG.md opens with a section {title}, not with one of version {number}.")
    return f"# wheel.fmu {number}\n\n{text}\n", title.startswith(DRAFT)


def pack(site: Path, archive: Path) -> None:
    """The site in one file; the same content gives the same bytes."""
    plain = ["--sort=name", "--mtime=@0", "--owner=0", "--group=0", "--numeric-owner", "--mode=u=rwX,go=rX"]
    folder: list[str | Path] = ["--transform=s,^[.],wheel-site,", "-C", site, "."]
    subprocess.run(["tar", "--format=gnu", *plain, "-I", "gzip -9n", "-cf", archive, *folder], check=True)


def write(out: Path, fmu: Path, site: Path, text: str) -> None:
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    shutil.copyfile(fmu, out / "wheel.fmu")
    pack(site, out / "wheel-site.tar.gz")
    (out / "NOTES.md").write_text(text, encoding="utf-8")
    names = sorted(path.name for path in out.iterdir())
    sums = subprocess.check_output(["sha256sum", *names], cwd=out)
    (out / "SHA256SUMS").write_bytes(sums)


def described() -> tuple[str, str, bool]:
    """The version, its notes, and whether it is a draft."""
    number = version()
    text, draft = notes((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), number)
    if draft:
        print(f"CHANGELOG.md has a section {DRAFT}: give it the version and the date before you tag.", file=sys.stderr)
    return number, text, draft


def commit() -> str:
    """The commit that the sources are; SystemExit where they are none, since dist/ could not name it."""
    others = [f":(exclude){name}" for name in WRITTEN]
    command = ["git", "status", "--porcelain", "--", ".", *others]
    status = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if status.returncode or status.stdout:
        raise SystemExit("A release is built from a commit, which dist/README.md names: commit all changes first.")
    return subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=ROOT, text=True).strip()


def sum_of(file: Path) -> str:
    return sha256(file.read_bytes()).hexdigest()


def page_of(place: Path, number: str, source: str, *, draft: bool = False) -> str:
    """The page about the files of a folder; a draft is a version that the changelog does not date yet."""
    files = [
        {"name": path.name, "size": f"{path.stat().st_size / 1e3:.0f}", "sum": sum_of(path)}
        for path in sorted(place.iterdir())
        if path.name != "README.md"
    ]
    lesson = any(file["name"] == LESSON for file in files)
    return page("dist.md.j2", version=number, commit=source, files=files, lesson=lesson, draft=draft)


def distribute(fmu: Path, source: str, number: str, *, draft: bool) -> None:
    """Writes dist/, the lesson too where the lab has it."""
    deliver(fmu, DIST / "wheel.fmu")
    if (ROOT / "lab" / "lesson").exists():
        subprocess.run(["bash", "scripts/page", DIST / LESSON, "--overwrite"], cwd=ROOT, check=True)
    (DIST / "README.md").write_text(page_of(DIST, number, source, draft=draft), encoding="utf-8")


def publish(fmu: Path, site: Path, number: str, text: str) -> None:
    out = (ROOT / "build" / f"wheel-{number}").relative_to(Path.cwd())
    write(out, fmu, site, text)
    print("dist/ has the files for the repository. Commit them and docs/results/platforms.md as the release.")
    print(f"{out} holds {', '.join(sorted(path.name for path in out.iterdir()))}. To tag that commit:")
    print(f"  git tag -a v{number} -F {out / 'NOTES.md'} --cleanup=whitespace")
    print(f"  git push origin v{number}")
    print(".github/workflows/release.yml attaches the same files, built anew; elsewhere attach those of the folder.")
