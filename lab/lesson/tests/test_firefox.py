"""The lesson in Firefox ESR, opened from the disk: steps, a drawn guess, a push, saved files."""

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lab.lesson.bodies import read_bodies

from .firefox import Tab, firefox

WAIT = """(async () => {
  while (!(window.page?.first && page.lesson && !page.stage.dirty)) await new Promise((done) => setTimeout(done, 50));
  return true;
})()"""
STEP = """(() => {
  page.lesson.turn(%d);
  page.lesson.forget();
  const {lesson, plots, wheels} = page;
  page.player.seek(1);
  lesson.frame();
  page.draw();
  const {columns, rows} = wheels[0].table;
  const drawn = plots.all.filter(({canvas}) => canvas.toDataURL().length > 2000);
  return [lesson.current.title, rows, Number.isFinite(columns.theta.at(-1)), drawn.length, lesson.trouble];
})()"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("firefox")


@pytest.fixture(scope="module")
def tab(folder: Path, live_file: Path) -> Iterator[Tab]:
    with firefox(folder) as found:
        found.resize(1280, 720)
        found.open(live_file.as_uri())
        assert found.evaluate(WAIT)
        yield found


def pointer(tab: Tab, points: list[tuple[float, float]]) -> None:
    """Presses, moves and releases the mouse."""
    moves = [{"type": "pointerMove", "x": round(x), "y": round(y), "duration": 20} for x, y in points]
    press, release = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
    tab.act("pointer", moves[0], press, *moves[1:], release, pointerType="mouse")


def box(tab: Tab, selector: str) -> tuple[float, float, float, float]:
    box_of = "(({x, y, width, height}) => [x, y, width, height])"
    return tuple(tab.evaluate(f"{box_of}(document.querySelector('{selector}').getBoundingClientRect())"))


def test_every_step_runs_and_its_diagrams_are_drawn(tab):
    assert tab.evaluate("location.protocol") == "file:"
    titles = []
    for k in range(tab.evaluate("page.lesson.steps.length")):
        title, rows, finite, diagrams, trouble = tab.evaluate(STEP % k)
        assert rows > 300 and finite and diagrams in (1, 2) and trouble is None, title
        titles.append(title)
    assert len(set(titles)) == 11 and tab.faults == []
    tab.evaluate("console.error('a fault')")  # it would be seen
    assert tab.faults.pop() == "a fault"


def test_a_guess_is_drawn_with_the_mouse(tab):
    tab.evaluate("page.lesson.turn(1)")
    x, y, _, height = box(tab, ".plot canvas")
    pointer(tab, [(x + 60 + 22 * i, y + height / 2 + 0.25 * height * np.sin(i)) for i in range(11)])
    drawn = np.array(tab.evaluate("page.plots.tilt.sketch"))
    assert len(drawn) >= 12 and (np.diff(drawn[:, 0]) > 0).all() and np.ptp(drawn[1:, 1]) > 20
    assert tab.evaluate("page.player.t") == 0 and tab.faults == []


def test_a_push_changes_the_motion(tab):
    tab.evaluate("page.lesson.turn(0)")
    before = tab.evaluate("page.wheels[0].table.columns.omega_z.at(-1)")
    x, y, width, height = box(tab, ".push:last-child")
    middle = {"type": "pointerMove", "x": round(x + width / 2), "y": round(y + height / 2)}
    press, release = ({"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp"))
    tab.act("pointer", middle, press, {"type": "pause", "duration": 600}, release, pointerType="mouse")
    tab.evaluate("(page.player.pause(), page.lesson.frame())")
    changes = tab.evaluate("page.lesson.plan.changes.map(({name, value}) => [name, value])")
    assert changes == [["M_3", -6], ["M_3", 0]]
    assert tab.evaluate("page.wheels[0].table.columns.omega_z.at(-1)") != before and tab.faults == []


@pytest.mark.parametrize(("name", "file"), [("csv", "motion.csv"), ("png", "wheel_1.00s.png")])
def test_values_and_picture_are_saved(tab, folder, name, file):
    tab.evaluate("(page.lesson.turn(2), page.player.pause(), page.player.seek(1), page.lesson.frame(), page.draw())")
    tab.evaluate(f"document.querySelector('#take [name={name}]').click()")
    path, end = folder / file, time.monotonic() + 60
    while not (path.exists() and path.stat().st_size) and time.monotonic() < end:
        time.sleep(0.1)
    while path.with_name(f"{file}.part").exists():
        time.sleep(0.1)
    if name == "csv":
        (body,) = read_bodies(path)
        assert list(body.columns["theta"]) == tab.evaluate("[...page.wheels[0].table.columns.theta]")
    else:
        assert len(np.unique(np.asarray(Image.open(path).convert("RGB")).reshape(-1, 3), axis=0)) > 100
    assert tab.faults == []
