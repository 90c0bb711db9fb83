"""What a reader takes from a page: values, picture, film, and the commands that make the same run."""

import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from support.bounds import absolute_error, beyond, within

from lab.lesson.bodies import read_bodies

from .pages import change, column, do, drawn, start, value


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
    start(live, r=0, theta_start=0.35, psi_dot_start=9, phi_dot_start=-9)
    (body,) = read_bodies(taken(live, "csv", tmp_path))
    assert (body.parameters["r_0"], body.parameters["r"]) == (0.3, 0.0)
    for name in ("time", "X_O", "theta", "phi", "omega_z", "E", "theta_dot"):
        assert (body.columns[name] == column(live, name)).all(), name


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


FILM = """async (bytes) => {
  const video = document.createElement('video');
  video.src = URL.createObjectURL(new Blob([Uint8Array.from(bytes)], {type: 'video/webm'}));
  const pen = new OffscreenCanvas(64, 64).getContext('2d', {alpha: false});
  const pictures = [];
  for (const t of [0, 1e9, 0]) {
    const shown = new Promise((done) => video.requestVideoFrameCallback(done));
    video.currentTime = t;
    await shown;
    pen.drawImage(video, 0, 0, 64, 64);
    pictures.push([...pen.getImageData(0, 0, 64, 64).data]);
  }
  return [video.duration, video.videoWidth, pictures];
}"""


def test_a_film_lasts_as_long_as_its_motion(live, tmp_path):
    start(live, phi_dot_start=0)
    live.evaluate("page.player.set({speed: 4})")
    with drawn(live):
        data = taken(live, "film", tmp_path).read_bytes()  # 0.59 s of falling, four times as fast: 4 pictures
    assert data.startswith(b"\x1a\x45\xdf\xa3") and b"webm" in data[:64]  # EBML
    seconds, width, (first, last, again) = live.evaluate(FILM, list(data))
    assert width == pytest.approx(live.evaluate("page.stage.canvas.clientWidth"), abs=2)
    within(abs(seconds - 0.5928 / 4), 1 / 25, "length of the film off that of the motion, s")  # one picture
    within(absolute_error(first, again), 20, "parts of 255 between the first picture and itself")
    beyond(absolute_error(first, last), 20, "parts of 255 between the first picture and the last")


TEXT = "document.querySelector('#take [name=film]').textContent"


def test_a_film_shows_the_time_that_it_still_takes_and_ends_at_a_second_click(live, tmp_path):
    start(live)
    button = live.locator("#take [name=film]")
    live.locator("[popovertarget=take]").click()
    with live.expect_download() as download:
        button.click()
        live.wait_for_function(f"/End the video: \\d+ s left/.test({TEXT})")
        button.click()
    download.value.save_as(tmp_path / "short.webm")
    assert (tmp_path / "short.webm").stat().st_size > 0
    assert button.inner_text() == "Video (WebM)"
    live.keyboard.press("Escape")


PLANS = {
    "free": ({}, ()),
    "steered": ({"guided": 1, "theta_start": np.pi / 2, "phi_dot_start": -20}, ((1, {"psi_dot_guide": 0.8}),)),
    "pushed": (
        {"theta_start": 1.4, "phi_dot_start": -3, "s": 0.02},
        ((1, {"M_3": -2}), (1.5, {"M_3": 0}), (2, {"s": 0.005})),
    ),
}


@pytest.fixture(params=PLANS)
def planned(live, request):
    values, changes = PLANS[request.param]
    start(live, **values)
    for t, what in changes:
        do(live, t, **what)
    return live


def command(page, kind: str) -> str:
    page.locator("[popovertarget=take]").click()
    page.locator(f"#take .tabs [name={kind}]").click()
    text = page.locator("#take pre").inner_text()
    page.keyboard.press("Escape")
    return text


def run(words: list[str], folder: Path) -> str:
    return subprocess.run(words, cwd=folder, check=True, stdout=subprocess.PIPE, text=True).stdout


def test_the_commands_of_fmpy_and_python_make_the_same_run(planned, fmu_path, tmp_path):
    (tmp_path / "wheel.fmu").symlink_to(fmu_path)
    words = command(planned, "fmpy").replace("fmpy simulate", f"{shlex.quote(sys.executable)} -m fmpy simulate")
    run(["bash", "-euc", words], tmp_path)
    motion = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
    at = [np.argmin(abs(motion["time"] - instant)) for instant in column(planned, "time")]
    for name in ("theta", "X_O", "psi_dot"):
        assert abs(motion[name][at] - column(planned, name)).max() < 1e-7, name
    assert abs(motion["X_O"][at] - column(planned, "X_O")[::-1]).max() > 0.1
    last = float(run([sys.executable, "-c", command(planned, "Python")], tmp_path))
    assert last == pytest.approx(column(planned, "theta")[-1], abs=1e-7)


def test_the_c_program_makes_the_same_run_to_the_bit(planned, fmu, tmp_path):
    """So the wheel in the page has the bits of the FMU."""
    (tmp_path / "run.c").write_text(command(planned, "C"))
    (shared,) = map(str, Path(fmu).glob("binaries/*/wheel.so"))
    run(["cc", "-Wall", "-Werror", "run.c", shared, "-o", "run"], tmp_path)
    rows = np.array([line.split() for line in run([tmp_path / "run"], tmp_path).splitlines()], dtype=float)
    assert len(rows) == 1000

    def same() -> list[bool]:
        names = ("theta", "omega_z", "X_O", "Y_O")
        return [rows[:, k].tobytes() == column(planned, name)[1:].tobytes() for k, name in enumerate(names, 1)]

    assert all(same())
    change(planned, phi_dot_start=np.nextafter(value(planned, "phi_dot_start"), 0))
    assert not all(same())
