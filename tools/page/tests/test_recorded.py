"""The page of recorded motions in headless Chromium: paper's two scenes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from playwright.sync_api import Page
from reference.tables import read_table
from support.bounds import EPSILON, absolute_error, beyond, within

from page.tests.pages import POSE, RECORD, opened, view, write_csv

INSTANTS = (0.0, 0.37, 1.0, 1.23, 2.5, 3.99, 5.0, 6.66, 8.01, 10.0)
MATRIX = """([t, name]) => {
  page.player.seek(t);
  page.pose();
  const {road, scene} = page.stage;
  const part = scene.getObjectByName(name);
  part.updateWorldMatrix(true, false);
  return part.matrixWorld.clone().premultiply(road.matrixWorld.clone().invert()).elements;
}"""


SPOT = """(t) => {
  page.player.seek(t);
  page.pose();
  return page.stage.models.find(({ wheel }) => wheel.name === 'friction').spot.position.toArray().slice(0, 2);
}"""


def turn(axis: int, angle: float) -> np.ndarray:
    """Rotation about a coordinate axis."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = [k for k in range(3) if k != axis]
    matrix = np.eye(3)
    sign = -1 if axis != 1 else 1
    matrix[[i, j], [i, j]], matrix[i, j], matrix[j, i] = c, sign * s, -sign * s
    return matrix


def pose_of(row) -> np.ndarray:
    """4 x 4 matrix of the body axes in fixed axes: z-x-z angles of the paper, (3)."""
    matrix = np.eye(4)
    matrix[:3, :3] = turn(2, row["psi"]) @ turn(0, row["theta"]) @ turn(2, row["phi"])
    matrix[:3, 3] = [row["X_O"], row["Y_O"], row["Z_O"]]
    return matrix


def shown(page, t: float, name: str, part: str = "spin") -> np.ndarray:
    """The pose of a part of the scene in the road's axes."""
    return np.reshape(page.evaluate(MATRIX, [t, f"{part}:{name}"]), (4, 4)).T


@pytest.mark.parametrize("name", ["free", "friction"])
def test_the_wheels_pose_in_the_scene_is_that_of_the_file(recorded, scenes, name):
    rows = scenes[name]
    off = []
    for t in INSTANTS:
        k = round(t / 0.01)
        there = shown(recorded, t, name)
        within(absolute_error(there, pose_of(rows[k])), 64 * EPSILON, "pose")
        off.append(abs(there - pose_of(rows[max(1, k) - 1])).max())
    beyond(max(off), 1e-2, "pose of the row before")


def test_between_the_rows_the_pose_is_that_of_the_fmu(recorded, scenes, simulate):
    fine = simulate(step=0.005, output=POSE, s=0.03)
    rows = scenes["friction"]
    middles = [k for k in range(25, 2000, 50) if k % 2]
    errors = [abs(shown(recorded, 0.005 * k, "friction") - pose_of(fine[k])).max() for k in middles]
    within(max(errors), 1e-5, "pose")  # largest where the friction changes sign within the interval
    nearest = [abs(pose_of(rows[k // 2]) - pose_of(fine[k])).max() for k in middles]
    beyond(max(nearest), 1e-2, "pose of the nearest row")


@pytest.fixture(scope="module")
def car(browser, tmp_path_factory) -> Iterator[Page]:
    """A car's body that turns, and a wheel that spins by ten radians from row to row."""
    t = np.arange(11) * 0.1
    pose = {"X": t, "Y": 2 * t, "Z": 0.6 + 0 * t, "yaw": 0.8 * t, "pitch": 0.3 * t, "roll": -0.4 * t}
    wheel = {"X_O": 0 * t, "Y_O": 0 * t, "psi": 0 * t, "theta": 0 * t + np.pi / 2, "phi": -100 * t}
    named = {f"body.{k}": v for k, v in pose.items()} | {f"wheel_fl.{k}": v for k, v in wheel.items()}
    path = write_csv(tmp_path_factory.mktemp("car") / "car.csv", {"time": t} | named)
    assert view(path, "--slope", "10deg", "--slope_direction", "1.5").returncode == 0
    with opened(browser, path.with_suffix(".html")) as page:
        yield page


def test_a_fast_wheel_never_seems_to_run_backwards(car):
    """The short way between the attitudes of two rows would be 2.6 rad the other way."""
    matrices = [shown(car, 0.1 + 0.001 * k, "wheel_fl") for k in range(100)]
    steps = [a[:3, :3].T @ b[:3, :3] for a, b in zip(matrices, matrices[1:], strict=False)]
    assert np.allclose([np.arctan2(step[1, 0], step[0, 0]) for step in steps], -0.1)


def test_a_cars_body_is_turned_by_yaw_then_pitch_then_roll(car):
    there = shown(car, 0.7, "body", part="body")
    expected = np.eye(4)
    expected[:3, :3] = turn(2, 0.56) @ turn(1, 0.21) @ turn(0, -0.28)
    expected[:3, 3] = [0.7, 1.4, 0.6]
    within(absolute_error(there, expected), 64 * EPSILON, "pose off")


def test_the_values_that_a_file_holds_are_listed(browser, scenes, tmp_path):
    rows = {name: scenes["friction"][name] for name in ("time", *POSE)}
    path = write_csv(tmp_path / "one.csv", rows | {"s": 0.03 + 0 * rows["time"], "m": 20 + 0 * rows["time"]})
    head, *lines = path.read_text().splitlines()
    path.write_text("\n".join([f'{head},"keep_contact"', *(f"{line},False" for line in lines)]))
    assert view(path).returncode == 0
    with opened(browser, path.with_suffix(".html")) as page:
        page.locator("[popovertarget=values]").click()
        page.wait_for_selector("#values tr")
        found = [row.split("\t") for row in page.locator("#values tr").all_inner_texts()]
    assert found == [
        ["", "one", ""],
        ["m", "20", "kg"],
        ["r_0", "0.3", "m"],
        ["r", "0.05", "m"],
        ["s", "0.03", "m"],
        ["keep_contact", "0", ""],
    ]


def test_a_slope_that_the_command_gives_tilts_the_ground_and_is_marked_uphill(car, recorded):
    up = [np.sin(np.radians(10)) * np.cos(1.5), np.sin(np.radians(10)) * np.sin(1.5), np.cos(np.radians(10))]
    car.evaluate("page.player.seek(0); page.draw()")
    turned = "(v) => page.stage.camera.position.clone().set(...v).applyQuaternion(page.stage.road.quaternion).toArray()"
    assert car.evaluate(turned, up) == pytest.approx([0, 0, 1])
    wheel = "page.stage.models.find(({uphill}) => uphill).uphill"
    arrow = f"(({{visible: v, rotation: turn, position: p}}) => [v, turn.z, p.x, p.y])({wheel})"
    visible, direction, x, y = car.evaluate(arrow)
    assert visible and direction == 1.5 == pytest.approx(np.arctan2(y, x))
    assert not recorded.evaluate("page.pose() ?? page.stage.models[0].uphill.visible")


def test_the_friction_wheel_sticks_at_its_instant(recorded):
    first = recorded.evaluate("page.wheels.find((wheel) => wheel.name === 'friction').phases.sticks[0]")
    within(abs(first[0] - read_table("paper_friction_events")["t"][1]), 1e-4, "instant, s")  # rows are 0.01 s apart
    beyond(first[1], 1.3, "end of the first stick, s")


PHASES = """async (texts) => {
  const [{ Table }, { phasesOf }] = await Promise.all([import('#table'), import('#phases')]);
  return phasesOf(new Table(Object.fromEntries(texts.map(([name, values]) => [name, Float64Array.from(values)]))));
}"""


def phases(page, rows: np.ndarray, leave_out: str = "") -> dict[str, list]:
    """Stick phases and transitions as the page reads them from these rows."""
    return page.evaluate(PHASES, [[n, rows[n].tolist()] for n in rows.dtype.names if n != leave_out])


def test_transitions_between_two_rows_are_marked_though_no_row_lies_in_the_phase(recorded, simulate):
    rows = simulate(step=0.1, output=RECORD, s=0.03)
    found = phases(recorded, rows)
    instants = read_table("paper_friction_events")["t"][1:]
    assert len(found["transitions"]) == len(instants) == 37
    within(absolute_error(found["transitions"], instants), 0.1, "instants, s")  # the distance of two rows
    assert len(found["sticks"]) == (read_table("paper_friction_events")["mode"] == 0).sum()
    assert len(phases(recorded, rows, leave_out="n_events")["transitions"]) < 37


def test_a_stick_shorter_than_the_rows_begins_and_ends_where_the_spin_is_zero(recorded):
    """Held from 0.523 s to 0.527 s, between the rows at 0.52 s and 0.53 s."""
    t = np.arange(101) * 0.01
    omega = np.where(t < 0.525, t - 0.523, 0.527 - t)
    names = ["time", "omega_z", "friction_mode", "n_events"]
    rows = np.rec.fromarrays([t, omega, np.sign(omega), 2.0 * (t > 0.525)], names=names)
    (stick,) = phases(recorded, rows)["sticks"]
    within(absolute_error(stick, [0.523, 0.527]), 1e-12, "instants, s")
    assert phases(recorded, rows, leave_out="n_events")["sticks"] == []


def test_the_path_on_the_ground_is_that_of_the_contact_point(recorded, simulate):
    rows = simulate(step=0.005, output=("X_C", "Y_C"), s=0.03)
    spots = [recorded.evaluate(SPOT, 0.005 * k) for k in range(1, 2000, 111)]  # on the file's rows and between them
    there = np.column_stack([rows["X_C"], rows["Y_C"]])[1:2000:111]
    within(absolute_error(spots, there), 1e-6, "contact point, m")
    centre = simulate(step=0.005, output=("X_O", "Y_O"), s=0.03)
    beyond(absolute_error(spots, np.column_stack([centre["X_O"], centre["Y_O"]])[1:2000:111]), 0.1, "centre, m")


def test_the_label_and_the_diagram_say_that_the_wheel_sticks(recorded):
    state = """(t) => {
      page.choose(3);
      page.player.seek(t);
      page.draw();
      const plot = page.plots.curves[1];
      const pixel = (at) => [...plot.layers.faint.getContext('2d')
        .getImageData(plot.x(at) * devicePixelRatio, plot.y(-1.5) * devicePixelRatio + 3, 1, 1).data];
      return [document.querySelector('.label').dataset.state, pixel(t)];
    }"""
    before, clear = recorded.evaluate(state, 1.15)
    during, band = recorded.evaluate(state, 1.26)
    recorded.evaluate("page.choose(0)")
    assert (before, during) == ("rolls", "sticks")
    assert clear[3] == 0
    assert band[3] > 0


def test_the_free_wheel_never_sticks(recorded):
    assert recorded.evaluate("page.wheels[0].phases") == {"sticks": [], "transitions": []}


def test_keys_move_the_time_and_switch_what_is_shown(recorded):
    recorded.evaluate("page.player.seek(2); document.activeElement.blur()")
    recorded.keyboard.press("ArrowRight")
    recorded.keyboard.press("Shift+ArrowRight")
    assert recorded.evaluate("page.player.t") == pytest.approx(2.55)
    recorded.keyboard.press("Home")
    assert recorded.evaluate("page.player.t") == 0
    recorded.keyboard.press(" ")
    recorded.wait_for_function("page.player.t > 0.05")
    recorded.keyboard.press(" ")
    assert not recorded.evaluate("page.player.playing")
    recorded.keyboard.press("3")
    assert recorded.evaluate("page.shown.map((wheel) => wheel.name)") == ["free"]
    recorded.keyboard.press("g")
    recorded.evaluate("page.pose()")
    assert recorded.evaluate("page.stage.models[0].force.visible")
    recorded.keyboard.press("g")
    recorded.keyboard.press("1")


def test_a_click_into_a_diagram_goes_there(recorded):
    canvas = recorded.locator(".plot canvas").first
    canvas.click(position={"x": 100, "y": 40})
    expected = canvas.evaluate("() => page.plots.curves[0].timeAt(100)")
    assert recorded.evaluate("page.player.t") == pytest.approx(expected)
    assert 0.5 < expected < 9.5


def test_the_mouse_turns_the_view_and_the_force_points_along_lambda(recorded, scenes):
    where = "[...page.stage.camera.position]"
    before = recorded.evaluate(where)
    box = recorded.locator("#stage").bounding_box()
    recorded.mouse.move(box["x"] + 100, box["y"] + 100)
    recorded.mouse.down()
    recorded.mouse.move(box["x"] + 220, box["y"] + 120, steps=3)
    recorded.mouse.up()
    assert abs(np.subtract(recorded.evaluate(where), before)).max() > 0.1
    recorded.keyboard.press("r")
    recorded.evaluate("page.player.seek(5); document.querySelector('[name=force]').click(); page.pose()")
    direction = recorded.evaluate("""() => {
      const { force } = page.stage.models[1];
      return force.up.clone().set(0, 0, 1).applyQuaternion(force.quaternion).toArray();
    }""")
    recorded.evaluate("document.querySelector('[name=force]').click()")
    row = scenes["friction"][500]
    force = np.array([row["lambda_1"], row["lambda_2"], row["lambda_3"]])
    within(abs(direction @ force / np.linalg.norm(force) - 1), 1e-12, "cosine off 1")


def test_arrow_keys_turn_the_scene_that_has_the_focus(recorded):
    distance = "page.stage.camera.position.length()"
    where = "[...page.stage.camera.position]"
    before, far = recorded.evaluate(where), recorded.evaluate(distance)
    recorded.evaluate("page.player.seek(2)")
    recorded.locator("#stage").focus()
    recorded.keyboard.press("ArrowLeft")
    recorded.keyboard.press("ArrowUp")
    recorded.evaluate("document.activeElement.blur()")
    assert abs(np.subtract(recorded.evaluate(where), before)).max() > 0.02
    assert recorded.evaluate(distance) == pytest.approx(far)
    assert recorded.evaluate("page.player.t") == 2
    recorded.keyboard.press("r")


def test_a_phone_shows_everything_without_scrolling_sideways(browser, recorded_file):
    phone = {"viewport": {"width": 360, "height": 740}, "has_touch": True, "is_mobile": True}
    with opened(browser, recorded_file, **phone) as page:
        for scheme in ("light", "dark"):
            page.emulate_media(color_scheme=scheme)
            page.wait_for_function("(scheme) => document.documentElement.dataset.theme === scheme", arg=scheme)
            assert page.evaluate("document.documentElement.scrollWidth") <= 360
        one, other = page.evaluate("page.stage.rectangles(2)")
        assert one["y"] != other["y"]  # above each other
        scene, switches = (page.locator(place).bounding_box() for place in ("#scene", "#toggles"))
        assert switches["y"] >= scene["y"] + scene["height"] - 2.5  # px; the switches cover no part of the scene
        page.locator("#play").tap()
        page.wait_for_function("page.player.t > 0.05")


ENDING = """async (columns) => {
  const [{ Table }, { endingOf }] = await Promise.all([import('#table'), import('#labels')]);
  const table = Object.fromEntries(Object.entries(columns).map(([name, list]) => [name, Float64Array.from(list)]));
  return endingOf(new Table(table), 10);
}"""


@pytest.mark.parametrize(
    ("start", "sentence"),
    [
        ({"phi_dot_start": 0.0}, "fell flat at 0.5928 s"),
        ({"theta_start": 0.3, "psi_dot_start": -9.0, "phi_dot_start": 9.0, "r": 0.0}, None),
        ({"theta_start": 2.5, "phi_dot_start": 0.0}, "fell flat at "),
    ],
)
def test_a_motion_that_ends_early_says_why(recorded, simulate, start, sentence):
    rows = simulate(step=0.01, output=RECORD, **start)
    told = recorded.evaluate(ENDING, {name: rows[name].tolist() for name in rows.dtype.names})
    assert told == sentence if sentence is None else told.startswith(sentence)


def test_a_wheel_without_normal_force_has_lifted_off_and_a_short_record_ends(recorded):
    t, ones = [0.0, 0.5, 1.25], [1.0, 1.0, 1.0]
    assert recorded.evaluate(ENDING, {"time": t, "theta": ones, "lambda_3": [196, 150, 0]}) == "lifted off at 1.25 s"
    assert recorded.evaluate(ENDING, {"time": t, "theta": ones}) == "its record ends at 1.25 s"
    assert recorded.evaluate(ENDING, {"time": [0.0, 5.0, 10.0], "theta": ones}) is None
