"""The page of recorded motions in headless Chromium: the paper's two scenes, and a car."""

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Page
from scipy.spatial.transform import Rotation
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.truth.measure import transitions

from .pages import POSE, RECORD, TURN, opened, view, write_csv

INSTANTS = (0.0, 0.37, 1.0, 1.23, 2.5, 3.99, 5.0, 6.66, 8.01, 10.0)
MATRIX = """([t, name]) => {
  page.player.seek(t);
  page.pose();
  const {road, scene} = page.stage;
  const part = scene.getObjectByName(name);
  part.updateWorldMatrix(true, false);
  return part.matrixWorld.clone().premultiply(road.matrixWorld.clone().invert()).elements;
}"""


def pose(place: list[float], axes: str, angles: list[float]) -> np.ndarray:
    """4 x 4 matrix of the body axes in fixed axes, turned about its own axes in this order."""
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler(axes, angles).as_matrix()
    matrix[:3, 3] = place
    return matrix


def pose_of(row) -> np.ndarray:
    """That of a wheel: z-x-z angles of the paper, (3)."""
    return pose([row[name] for name in ("X_O", "Y_O", "Z_O")], "ZXZ", [row[name] for name in ("psi", "theta", "phi")])


def shown(page: Page, t: float, name: str) -> np.ndarray:
    """The pose of a part of the scene in the road's axes."""
    return np.reshape(page.evaluate(MATRIX, [t, name]), (4, 4)).T


@pytest.mark.parametrize("name", ["free", "friction"])
def test_the_wheels_pose_in_the_scene_is_that_of_the_file(recorded, scenes, name):
    there = [shown(recorded, t, f"spin:{name}") for t in INSTANTS]
    rows = [round(t / 0.01) for t in INSTANTS]
    within(absolute_error(there, [pose_of(scenes[name][k]) for k in rows]), 64 * EPSILON, "entries of the pose")
    beyond(absolute_error(there, [pose_of(scenes[name][abs(k - 1)]) for k in rows]), 1e-2, "pose of the row before")


def test_between_the_rows_the_pose_is_that_of_the_fmu(recorded, scenes, simulate):
    fine = simulate(output_interval=0.005, output=POSE, start_values={"s": 0.03})
    middles = range(25, 2000, 50)
    there = [shown(recorded, 0.005 * k, "spin:friction") for k in middles]
    exact, nearest = ([pose_of(row) for row in rows] for rows in (fine[25::50], scenes["friction"][12::25]))
    within(absolute_error(there, exact), 1e-5, "entries of the pose")  # largest where the friction changes sign within
    beyond(absolute_error(nearest, exact), 1e-2, "entries of the pose of the nearest row")


@pytest.fixture(scope="module")
def fast(window, tmp_path_factory) -> Iterator[Page]:
    """A wheel that spins by ten radians from row to row, beside columns of no wheel, on a road that rises."""
    t = np.arange(11) * 0.1
    wheel = {"X_O": 0 * t, "Y_O": 0 * t, "psi": 0 * t, "theta": 0 * t + np.pi / 2, "phi": -100 * t}
    named = {"chassis.X": t} | {f"wheel_fl.{k}": v for k, v in wheel.items()}
    path = write_csv(tmp_path_factory.mktemp("fast") / "fast.csv", {"time": t} | named)
    view(path, "--slope", "10deg", "--slope_direction", "1.5")
    with opened(window, path.with_suffix(".html")) as page:
        yield page


def test_a_fast_wheel_never_seems_to_run_backwards(fast):
    """The short way between the attitudes of two rows would be 2.6 rad the other way."""
    matrices = [shown(fast, 0.1 + 0.001 * k, "spin:wheel_fl") for k in range(100)]
    steps = [a[:3, :3].T @ b[:3, :3] for a, b in zip(matrices, matrices[1:], strict=False)]
    assert np.allclose([np.arctan2(step[1, 0], step[0, 0]) for step in steps], -0.1)


def test_a_slope_that_the_command_gives_tilts_the_ground_and_is_marked_uphill(fast, recorded):
    slope = np.radians(10)
    fast.evaluate("page.player.seek(0); page.draw()")
    up = [np.sin(slope) * np.cos(1.5), np.sin(slope) * np.sin(1.5), np.cos(slope)]
    assert fast.evaluate(TURN, up) == pytest.approx([0, 0, 1])
    visible, direction = fast.evaluate("(({visible, rotation}) => [visible, rotation.z])(page.stage.models[0].uphill)")
    assert visible and direction == 1.5
    assert not recorded.evaluate("page.pose() ?? page.stage.models[0].uphill.visible")


TABLE = """const {Table} = await import('#table');
  const table = new Table(Object.fromEntries(columns.map(([name, list]) => [name, Float64Array.from(list)])));"""
PHASES = f"async (columns) => {{ {TABLE} return (await import('#phases')).phasesOf(table); }}"
ENDING = f"async (columns) => {{ {TABLE} return (await import('#labels')).endingOf(table, 10); }}"


def phases(page: Page, rows: np.ndarray, leave_out: str = "") -> dict[str, list]:
    """Stick phases and transitions as the page reads them from these rows."""
    return page.evaluate(PHASES, [[n, rows[n].tolist()] for n in rows.dtype.names if n != leave_out])


def test_the_wheel_sticks_at_its_instant_and_without_friction_never(recorded):
    free, friction = recorded.evaluate("page.wheels.map(({phases}) => phases)")
    begin, end = friction["sticks"][0]
    within(abs(begin - transitions()[1, 0]), 5e-3, "begin of it, s")  # half a row
    beyond(end, 1.3, "end of the first stick, s")
    assert free == {"sticks": [], "slides": [], "transitions": []}


def test_every_transition_is_marked_though_several_lie_between_two_rows(recorded, simulate):
    rows = simulate(output_interval=0.1, output=RECORD, start_values={"s": 0.03})
    found = phases(recorded, rows)
    instants = transitions()[1:, 0]
    assert len(found["transitions"]) == len(instants) == 37
    within(absolute_error(found["transitions"], instants), 0.1, "instants of all, s")  # the distance of two rows
    assert len(phases(recorded, rows, leave_out="n_events")["transitions"]) < 37


def test_the_force_points_along_lambda(recorded, scenes):
    recorded.evaluate("page.player.seek(5); page.switches.flip('force', true); page.choose(0); page.pose()")
    direction = recorded.evaluate("""() => {
      const {arrows, group} = page.stage.models[1];
      group.updateWorldMatrix(true, true);
      const {arrow} = arrows.get('F');
      return arrow.up.clone().set(0, 0, 1).transformDirection(arrow.matrixWorld).toArray();
    }""")
    force = np.array([scenes["friction"][500][f"lambda_{k}"] for k in (1, 2, 3)])
    within(abs(direction @ force / np.linalg.norm(force) - 1), 1e-12, "cosine between arrow and force off 1")


@pytest.mark.parametrize(
    ("theta", "N", "end", "sentence"),
    [
        (0.0, 196, 0.59282, "lies flat at 0.5928 s"),
        (np.pi, 196, 0.7, "lies flat at 0.7 s"),
        (1.0, 0, 1.25, "lifted off at 1.25 s"),
        (1.0, 196, 1.25, "its record ends at 1.25 s"),
        (0.3, 196, 10.0, None),
    ],
)
def test_a_motion_that_ends_early_says_why(recorded, theta, N, end, sentence):
    rows = {"time": [0.0, 0.5, end], "theta": [1.0, 1.0, theta], "lambda_3": [196, 150, N]}
    assert recorded.evaluate(ENDING, list(rows.items())) == sentence
