"""The diagrams beside the curves: phase portrait, angular velocities, path from above."""

from __future__ import annotations

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

POINTS = """(name) => {
  page.plots.portrait.choose(name);
  const {lines, wheels} = page.plots.portrait;  // those of the rows
  const found = lines.map(({times, points}, k) => points.filter((_, i) => wheels[k].table.time.includes(times[i])));
  page.plots.portrait.choose('phase');
  return found;
}"""


def points(page, name: str) -> dict[str, np.ndarray]:
    found = page.evaluate(POINTS, name)
    wheels = page.evaluate("page.plots.portrait.wheels.map(({ name }) => name)")
    return {wheel: np.array(rows) for wheel, rows in zip(wheels, found, strict=True)}


def test_the_phase_portrait_is_the_rate_of_the_tilt_over_the_tilt(recorded, scenes):
    for name, rows in points(recorded, "phase").items():
        expected = np.degrees(np.column_stack([scenes[name]["theta"], scenes[name]["theta_dot"]]))
        within(absolute_error(rows, expected), 1e-9, "points off, deg")


def test_the_angular_velocities_are_those_along_e2_and_e3(recorded, simulate):
    rates = simulate(step=0.01, output=("psi_dot", "phi_dot", "theta"), s=0.03)
    along_e2 = rates["psi_dot"] * np.sin(rates["theta"])
    along_e3 = rates["phi_dot"] + rates["psi_dot"] * np.cos(rates["theta"])
    found = points(recorded, "spin")
    off = absolute_error(found["friction"], np.column_stack([along_e2, along_e3]))
    within(off, 64 * 8 * EPSILON, "points off, rad/s")
    beyond(absolute_error(found["free"], found["friction"]), 1, "the two wheels apart, rad/s")


def test_without_friction_both_rates_lie_on_one_curve_and_with_friction_it_shrinks(recorded, scenes):
    """Chaplygin: without friction both are functions of theta alone."""
    found = points(recorded, "spin")
    theta = scenes["free"]["theta"]
    order = np.argsort(theta)
    rough = {name: abs(np.diff(found[name][order, 1], 2)).max() for name in found}
    within(rough["free"] / rough["friction"], 0.03, "roughness without friction over that with it")
    ends = {name: np.ptp(found[name][-300:], axis=0) for name in found}
    assert (ends["friction"] < ends["free"]).all()


def test_the_path_from_above_is_that_of_the_contact_point(recorded, simulate):
    rows = simulate(step=0.01, output=("X_C", "Y_C"), s=0.03)
    off = absolute_error(points(recorded, "path")["friction"], np.column_stack([rows["X_C"], rows["Y_C"]]))
    within(off, 64 * EPSILON, "points off, m")


@pytest.mark.parametrize("name", ["spin", "path", "phase"])
def test_a_button_chooses_the_diagram_and_the_present_is_marked(recorded, name):
    recorded.locator(f".portrait [name={name}]").click()
    assert recorded.locator(".portrait [aria-checked=true]").get_attribute("name") == name
    mark = """(t) => {
      const {plots, player} = page;
      player.seek(t);
      plots.portrait.draw(t);
      const [wheel] = plots.portrait.wheels;
      const point = plots.portrait.at(wheel, t);
      const [x, y] = [plots.portrait.x(point[0]), plots.portrait.y(point[1])].map((place) => place * devicePixelRatio);
      const colour = [...plots.portrait.pen.getImageData(x, y, 1, 1).data].slice(0, 3);
      return ['#' + colour.map((part) => part.toString(16).padStart(2, '0')).join(''), wheel.colour];
    }"""
    recorded.evaluate("page.choose(2)")
    shown, wanted = recorded.evaluate(mark, 3.0)
    recorded.evaluate("page.choose(0)")
    assert shown == wanted


def test_both_axes_of_the_path_have_one_scale(recorded):
    recorded.evaluate("page.plots.portrait.choose('path')")
    (x, y), (width, height) = recorded.evaluate("""() => {
      const {ranges, width, height} = page.plots.portrait;
      return [ranges.map(([low, high]) => high - low), [width - 54, height - 30]];
    }""")
    recorded.evaluate("page.plots.portrait.choose('phase')")
    assert x / width == pytest.approx(y / height)
