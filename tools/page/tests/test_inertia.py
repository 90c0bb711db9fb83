"""Ready bodies on the live page, and the remark on moments of inertia that no mass within the outline has."""

import sys

import numpy as np
import pytest
from support.paths import ROOT

from page.tests.pages import column, opened, start

sys.path.append(str(ROOT / "examples" / "python"))
from values import bodies, doubt, moments  # noqa: E402

SAME = """async ([sizes, wheels]) => {
  const {bodies, doubtOf, momentsOf} = await import('#mechanics');
  const found = Object.keys(bodies).map((name) => sizes.map((size) => momentsOf(name, size)));
  return [found, wheels.map((wheel) => doubtOf(wheel) !== null)];
}"""


def test_moments_and_doubts_of_the_page_are_those_of_the_commands(live):
    rng = np.random.default_rng(1)
    sizes = [{"m": m, "r_0": r_0, "r": r} for m, r_0, r in rng.uniform([0.01, 0.1, 0], [30, 0.6, 0.1], (40, 3))]
    largest = [[size["m"] * (size["r_0"] + size["r"]) ** 2] for size in sizes]
    j = (rng.uniform(0, 1.2, (40, 3)) * largest).tolist()
    wheels = [size | dict(zip(("J_x", "J_y", "J_z"), row, strict=True)) for size, row in zip(sizes, j, strict=True)]
    wheels += [size | moments(name, **size) for size in sizes[:10] for name in bodies()]
    found, doubts = live.evaluate(SAME, [sizes, wheels])
    assert found == [[moments(name, **size) for size in sizes] for name in bodies()]
    assert doubts == [bool(doubt(wheel)) for wheel in wheels]
    assert 5 < sum(doubts) < len(doubts) - 5


def choose(page, name: str) -> None:
    page.evaluate("document.querySelector('#wheel').open = true")
    page.locator("#ready").select_option(name)
    page.evaluate("page.live.frame()")


J = "['J_x', 'J_y', 'J_z'].map((name) => page.live.value(name))"
LINK = "page.live.link.write()"


def test_the_moments_of_a_body_follow_mass_and_radii_until_one_is_set(live):
    start(live)
    choose(live, "body:torus")
    for name, value in (("m", 12.0), ("r_0", 0.25)):
        live.evaluate("([name, value]) => { page.live.setStart(name, value); page.live.frame(); }", [name, value])
    torus = moments("torus", m=12.0, r_0=0.25)
    assert live.evaluate(J) == [*torus.values()] and live.locator("#ready").input_value() == "body:torus"
    assert live.evaluate("page.live.trouble") is None
    live.evaluate("page.live.setStart('J_x', 0.5); page.live.setStart('m', 13); page.live.frame()")
    assert live.evaluate(J) == [0.5, 0.5, torus["J_z"]] and live.locator("#ready").input_value() == ""


def test_a_link_with_a_body_shows_the_same_wheel(live, live_file, window):
    start(live)
    choose(live, "body:disc")
    live.evaluate("page.live.setStart('m', 12.5); page.live.compute()")
    link, theta = live.evaluate(LINK), column(live, "theta")
    assert link.split("&show=")[0] == "body=disc&m=12.5"  # what is shown follows the tests before
    with opened(window, live_file, link) as other:
        assert (column(other, "theta") == theta).all() and other.evaluate(LINK) == link
        other.evaluate("page.live.setStart('m', 12); page.live.compute()")
        assert other.evaluate(J) == [*moments("disc", m=12.0).values()]


@pytest.mark.parametrize(("plan", "words"), [({"m": 12}, "more than m (r0 + r)² = 1.47 kg m²"), ({}, None)])
def test_a_wheel_that_cannot_exist_is_remarked(live, plan, words):
    start(live, **plan)
    live.evaluate("page.live.frame()")
    remark = live.locator("#doubt")
    assert remark.is_visible() is (words is not None) and (not words or words in remark.inner_text())
    choose(live, "body:torus")
    assert not remark.is_visible()


def test_a_ready_wheel_that_is_chosen_is_named_until_it_is_changed(live):
    start(live)
    choose(live, "wheel:coin")
    assert live.locator("#ready").input_value() == "wheel:coin"
    assert "Council Regulation" in live.locator("#ready").get_attribute("title")
    live.evaluate("page.live.setStart('m', 0.009); page.live.frame()")
    assert live.locator("#ready").input_value() == ""


def test_the_thin_disc_of_the_scenes_is_homogeneous(live):
    live.locator("#live [name=scenes]").click()
    live.locator("#presets button", has_text="Thin disc").click()
    m, r_0, r, J_x, J_z = live.evaluate("['m', 'r_0', 'r', 'J_x', 'J_z'].map((name) => page.live.value(name))")
    assert r == 0 and pytest.approx([m * r_0**2 / 4, m * r_0**2 / 2]) == [J_x, J_z]
