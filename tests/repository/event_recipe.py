"""CONTRIBUTING's recipe for an event, carried out on a copy of the core, and a second event of the same kind."""

import json
import re
import shlex
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from support.paths import ROOT, build_folder

# Another observed event: it depends on the place of the wheel, which is no symmetry of the unfolded motion.
LINE_NAME = "crosses_line"
LINE_VALUE = """
bool has_line(const Setup& setup, const InForce&) { return setup.keep_contact; }

double short_of_line(const Setup& setup, const InForce&, double, const double* y) {
  WheelKinematics pose;
  setup.formulation->pose(&setup.wheel, y, &pose);
  return (pose.X_O + 0.5) / setup.length;
}
"""
LINE_ROW = """    {.event = Event::crosses_line,
     .can_occur = has_line,
     .value = short_of_line,
     .follow = observe,
     .observed = "The wheel crosses the line at t = %s s."},
"""


def recipe() -> tuple[str, str, str]:
    """The name, the value and the row of CONTRIBUTING.md."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = re.search(r"^## Add an event\n(.*?)^## ", text, re.DOTALL | re.MULTILINE)[1]
    blocks = re.findall(r"```cpp\n(.*?)```", section, re.DOTALL)
    name, value, row = (re.sub(r"^   ", "", block, flags=re.MULTILINE) for block in blocks)
    return name.strip().rstrip(","), value, row


def insert(path: Path, before: str, text: str) -> None:
    old = path.read_text(encoding="utf-8")
    assert old.count(before) == 1, (path, before)
    path.write_text(old.replace(before, text + before), encoding="utf-8")


def patch(folder: Path, name: str, value: str, row: str) -> None:
    insert(folder / "wheel" / "run.hpp", "  count\n};", f"  {name},\n")
    events = folder / "wheel" / "events.cpp"
    insert(events, "}  // namespace\n\nconst EventRow event_rows[]", f"{value}\n")
    insert(events, "};\nstatic_assert(std::size(event_rows)", row)


def build(folder: Path) -> Path:
    """The library with both events: `wheel` and `fmi` are compiled from the copy, the rest is taken as built."""
    built, source = build_folder(), ROOT / "fmu-src"
    for module in ("wheel", "fmi"):
        shutil.copytree(source / module, folder / module)
    patch(folder, *recipe())
    patch(folder, LINE_NAME, LINE_VALUE, LINE_ROW)
    link = (built / "CMakeFiles" / "wheel_fmu.dir" / "link.txt").read_text(encoding="utf-8")
    compilations = []
    for entry in json.loads((built / "compile_commands.json").read_text(encoding="utf-8")):
        path = Path(entry["file"])
        if path.parent not in (source / "wheel", source / "fmi"):
            continue
        target = shlex.split(entry["command"])[shlex.split(entry["command"]).index("-o") + 1]
        made = folder / f"{path.parent.name}_{path.stem}.o"
        command = entry["command"].replace(str(source / "wheel"), str(folder / "wheel"))
        command = command.replace(str(source / "fmi"), str(folder / "fmi")).replace(target, str(made))
        compilations.append((shlex.split(command), entry["directory"]))
        link = link.replace(target, str(made))
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda one: subprocess.run(one[0], cwd=one[1], check=True), compilations))
    library = folder / "wheel.so"
    command = shlex.split(link)
    command[command.index("-o") + 1] = str(library)
    subprocess.run(command, cwd=built, check=True)
    return library
