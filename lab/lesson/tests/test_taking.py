"""Files that a reader takes from a page: values and picture."""

from pathlib import Path

import numpy as np
from PIL import Image

from lab.lesson.bodies import read_bodies

from .pages import column, drawn, opened, start, view


def taken(page, name: str, tmp_path) -> Path:
    """The file that a button of the card hands over."""
    page.locator("[popovertarget=take]").click()
    with page.expect_download() as download:
        page.locator(f"#take [name={name}]").click()
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    page.keyboard.press("Escape")
    return path


def test_the_values_are_read_back_to_the_bit(live, tmp_path):
    start(live, body="coin", s=0.001, spin=30)
    (body,) = read_bodies(taken(live, "csv", tmp_path))
    assert (body.parameters["r_0"], body.parameters["r"]) == (0.011775, 0.0011) and body.parameters["s"] == 0.001
    for name in ("time", "X_O", "theta", "phi", "omega_z", "E", "theta_dot"):
        assert (body.columns[name] == column(live, name)).all(), name


def test_the_values_of_a_guided_wheel_make_a_page_with_fork_moment_and_no_empty_diagram(live, window, tmp_path):
    start(live, lean=0, spin=10, steer=0.4)
    path = taken(live, "csv", tmp_path)
    (body,) = read_bodies(path)
    assert body.parameters["guided"] == 1 and np.ptp(body.columns["M_guide_1"]) > 1
    view(path)
    with opened(window, path.with_suffix(".html")) as page:
        page.evaluate("page.switches.flip('force', true); page.choose(0); page.player.seek(2); page.pose()")
        shown = "[page.stage.models[0].look.held, page.stage.models[0].arrows.get('M_guide').group.visible]"
        assert page.evaluate(shown) == [True, True]
        kinds = page.evaluate("page.plots.all.map(({kind}) => kind.title)")
        assert any("M_guide" in title for title in kinds) and not any("lean" in title for title in kinds)


def test_two_wheels_that_are_shown_are_two_wheels_of_the_file(recorded, scenes, tmp_path):
    bodies = {body.name: body for body in read_bodies(taken(recorded, "csv", tmp_path))}
    assert set(bodies) == {"free", "friction"}
    assert (bodies["friction"].columns["psi"] == scenes["friction"]["psi"]).all()


def test_a_picture_shows_scene_and_diagrams(either, tmp_path):
    with drawn(either):
        either.evaluate("page.player.seek(0.3)")
        path = taken(either, "png", tmp_path)
    assert path.name == "wheel_0.30s.png"
    picture = np.asarray(Image.open(path).convert("RGB"), dtype=int)
    height = either.evaluate("page.stage.canvas.clientHeight")
    assert len(picture) - height > 100
    for part in (picture[:height], picture[height:]):
        assert len(np.unique(part.reshape(-1, 3), axis=0)) > 50
