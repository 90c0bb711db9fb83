"""CONTRIBUTING's recipe for an event, carried out on a copy of the core, and a second event of the same kind: each is
logged at every crossing in every way of running, before and after a snapshot. The crossings are those of theta and X_O,
read on a fine grid."""

import json
import re
import shlex
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from support import driver
from support import exchange as exchanging
from support.bounds import beyond, within
from support.motion import Library
from support.paths import ROOT, build_folder
from support.scenes import PAPER

DIPS, LINE, LIGHT = (
    re.compile(rf"t = (\S+) s: the wheel {what}") for what in ("leans by more", "crosses the line", "presses less")
)
LEAN = 1.29  # rad: the level of the recipe
WAYS = {"unfolded": {}, "Runge-Kutta": {"method": 4}, "Adams": {"method": 2}, "multibody": {"formulation": 3}}
STOP = 6.0
pytestmark = pytest.mark.xdist_group("event recipe")  # one build for all


# Another observed event: it depends on the place of the wheel, which is no symmetry of the unfolded motion.
LINE_NAME = "crosses_line"
LINE_VALUE = """
bool has_line(const Setup& setup, const InForce&) { return setup.keep_contact; }

double short_of_line(const Setup& setup, const InForce&, double, const double* y) {
  WheelKinematics pose;
  setup.formulation->pose(&setup.wheel, y, &pose);
  return (setup.X_O.whole(pose.X_O) + 0.5) / setup.length;
}
"""
LINE_ROW = """    {.event = Event::crosses_line,
     .can_occur = has_line,
     .value = short_of_line,
     .follow = observe,
     .observed = "the wheel crosses the line"},
"""
# A third one, whose value comes with the rates: N below a share of the weight.
LIGHT_NAME, SHARE = "presses_less", 0.95
LIGHT_VALUE = f"""
double above_share(const Setup& setup, const double*, double N) {{ return N / setup.weight - {SHARE}; }}
"""
LIGHT_ROW = """    {.event = Event::presses_less,
     .can_occur = always,
     .quick_value = above_share,
     .follow = observe,
     .observed = "the wheel presses less than usual"},
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
    insert(events, "}  // namespace\n\nconstexpr EventRow event_rows[]", f"{value}\n")
    insert(events, "};\n\nnamespace {\n\nconstexpr bool is_sound", row)


def build(folder: Path) -> Path:
    """The library with both events: `wheel` and `fmi` are compiled from the copy, without the optimisation that takes
    long and changes no bit; the rest is taken as built."""
    built, library = build_folder(), folder / "wheel.so"
    commands = (built / "compile_commands.json").read_text(encoding="utf-8")
    link = shlex.split((built / "CMakeFiles" / "wheel_fmu.dir" / "link.txt").read_text(encoding="utf-8"))
    for module in ("wheel", "fmi"):
        original, copy = str(ROOT / "fmu-src" / module), folder / module
        shutil.copytree(original, copy)
        units = built / "CMakeFiles" / f"{module}.dir" / "Unity"  # each includes the files that are compiled at once
        for unit in units.glob("*.cxx"):
            (copy / unit.name).write_text(
                unit.read_text(encoding="utf-8").replace(original, str(copy)), encoding="utf-8"
            )
        commands = commands.replace(original, str(copy)).replace(str(units), str(copy))
    patch(folder, *recipe())
    patch(folder, LINE_NAME, LINE_VALUE, LINE_ROW)
    patch(folder, LIGHT_NAME, LIGHT_VALUE, LIGHT_ROW)
    made = {entry["output"]: entry for entry in json.loads(commands) if folder in Path(entry["file"]).parents}
    objects = {output: str(folder / output.replace("/", "_")) for output in made}
    compilations = [
        [*(objects.get(word, word) for word in shlex.split(entry["command"])), "-O1", "-fno-lto"]
        for output, entry in made.items()
    ]
    with ThreadPoolExecutor(2) as pool:
        list(pool.map(lambda command: subprocess.run(command, cwd=built, check=True), compilations))
    link[link.index("-o") + 1] = str(library)
    subprocess.run([objects.get(word, word) for word in link], cwd=built, check=True)
    return library


@pytest.fixture(scope="module")
def patched(fmu: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Library]:
    folder = tmp_path_factory.mktemp("event")
    unpacked = folder / "fmu"
    shutil.copytree(fmu, unpacked)
    (binary,) = unpacked.glob("binaries/*/wheel.so")
    shutil.copy(build(folder), binary)
    yield Library(Path(unpacked))


def falls(library: Library, name: str, level: float, **start: float) -> list[float]:
    """Where the output falls below the level, by the secant on a grid of a millisecond."""
    run = library.simulate(np.linspace(0, STOP, 6001), 1e-11, **start)
    t, x = run.t, run[name] - level
    k = np.flatnonzero((x[:-1] >= 0) & (x[1:] < 0))
    return [float(v) for v in t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])]


def logged(pattern: re.Pattern, messages: list[str]) -> list[float]:
    return [float(found[1]) for message in messages if (found := pattern.search(message))]


def gap(want: list[float], got: list[float]) -> float:
    assert len(want) == len(got) >= 3
    return float(np.abs(np.array(want) - got).max())


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("step", [0.01, 1.0, STOP])
def test_every_crossing_is_logged_whatever_the_grid(library: Library, patched: Library, way: str, step: float) -> None:
    times = np.arange(0, STOP + step / 2, step)
    run = patched.simulate(times, 1e-11, **WAYS[way])
    want = falls(library, "theta", LEAN)
    within(gap(want, logged(DIPS, run.messages)), 1e-6, "instant, s")
    beyond(gap(falls(library, "theta", LEAN - 1e-3), logged(DIPS, run.messages)), 1e-5, "instant of another level, s")
    light = falls(library, "lambda_3", SHARE * PAPER.m * PAPER.g, **WAYS[way])
    within(gap(light, logged(LIGHT, run.messages)), 2e-5, "instant of a smaller N, s")  # N curves within a millisecond
    if way == "unfolded":  # it still is
        assert run.counters["n_steps"] == library.simulate(times, 1e-11).counters["n_steps"]


@pytest.mark.parametrize("way", WAYS)
def test_an_event_that_is_no_symmetry_of_the_motion_keeps_it_from_being_unfolded(library, patched, way: str) -> None:
    run = patched.simulate([0.0, 2.0, STOP], 1e-11, keep_contact=True, **WAYS[way])
    within(gap(falls(library, "X_O", -0.5, keep_contact=True), logged(LINE, run.messages)), 1e-6, "instant, s")
    within(gap(falls(library, "theta", LEAN), logged(DIPS, run.messages)), 1e-6, "instant, s")
    if way == "unfolded":
        assert run.counters["n_rhs"] > 2 * library.simulate([0.0, STOP], 1e-11, keep_contact=True).counters["n_rhs"]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("cut", [0.9, 2.1, 3.4])
def test_a_restored_run_logs_what_lies_ahead_and_nothing_else(patched: Library, way: str, cut: float) -> None:
    whole, other = patched.wheel(logging=True).start(**WAYS[way]).to(cut), patched.wheel(logging=True)
    whole.take_messages()
    assert other.back(whole.serialized()).messages == []
    for wheel in (whole, other):
        wheel.put(M_1=1e-7).to(STOP)  # off the orbit
    assert whole.sentences == other.sentences and min(logged(DIPS, other.sentences)) > cut


def test_another_solver_finds_it_by_its_indicator(library, patched, monkeypatch) -> None:
    names = (*driver.INDICATORS, "leans", "crosses_line", "presses_less")
    monkeypatch.setattr(driver, "INDICATORS", names)
    with exchanging.exchange(patched, logging=True, keep_contact=True) as wheel:
        run = exchanging.Run(wheel, 1e-10, exchanging.no_inputs)
        run.to(2.0)
        blob = wheel.serialized()
        run.to(STOP)
        found = wheel.sentences
        within(gap(falls(library, "X_O", -0.5, keep_contact=True), logged(LINE, found)), 1e-6, "instant, s")
        within(gap(falls(library, "theta", LEAN), logged(DIPS, found)), 1e-6, "instant, s")
        wheel.take_messages()
        assert wheel.back(blob).messages == []
        again = exchanging.Run(wheel, 1e-10, exchanging.no_inputs)
        again.t = 2.0
        again.to(STOP)
        later = [t for t in logged(DIPS, found) if t > 2.0]
        within(gap(later, logged(DIPS, wheel.sentences)), 1e-6, "instant after the snapshot, s")


def test_many_occurrences_are_counted_and_the_first_hundred_logged(patched: Library) -> None:
    run = patched.simulate([0.0, 1000.0], 1e-9)
    assert len(logged(DIPS, run.messages)) == 100
