"""The pictures of the lesson: every arrow, bar, band and circle is a quantity of the FMU."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from support.bounds import absolute_error, beyond, relative_error, within

from wheelfmu.truth.closed_forms import critical_spin
from wheelfmu.truth.scenes import PAPER

from .pages import change, column, numbers, open_step, parameters, seek, start

ARROWS = """async ([t, picture]) => {
  const {arrowsOf} = await import('#pictures');
  const found = arrowsOf(page.wheels[0], [picture], t);
  return Object.fromEntries(found.map(({name, vector, from = [0, 0, 0]}) => [name, [...vector, ...from]]));
}"""
# {name: an arrow of wheel i as it is drawn, from tail to tip, in m of the road's axes}
DRAWN = """(i) => {
  const {road, models} = page.stage;
  page.pose();
  road.updateMatrixWorld(true);
  const seen = [...models[i].arrows].filter(([, {group, arrow}]) => group.visible && arrow.visible);
  return Object.fromEntries(seen.map(([name, {arrow}]) => {
    const {head, headLength} = arrow.userData;
    const [tail, tip] = [0, head.position.z + 0.5 * headLength * head.scale.z].map(
        (z) => road.worldToLocal(arrow.localToWorld(arrow.position.clone().set(0, 0, z))));
    return [name, tip.sub(tail).toArray()];
  }));
}"""
NUMBERS = "Object.fromEntries(Object.entries(page.units).map(([kind, {number}]) => [kind, number]))"
INSTANTS = (0.0, 0.2, 0.55, 1.3, 4.0)


def arrows(page, t: float, picture: str) -> dict[str, np.ndarray]:
    """{name: [vector, where it begins]} of the wheel."""
    found = page.evaluate(ARROWS, [t, picture])
    return {name: np.reshape(numbers, (2, 3)) for name, numbers in found.items()}


def drawn(page, t: float, wheel: int = 0) -> dict[str, np.ndarray]:
    seek(page, t)
    return {name: np.array(vector) for name, vector in page.evaluate(DRAWN, wheel).items()}


def row(page, t: float, wheel: int = 0):
    """name -> the value that the FMU gave at t."""
    k = int(np.argmin(abs(column(page, "time", wheel) - t)))
    return lambda name: column(page, name, wheel)[k]


def about_contact(of) -> tuple[np.ndarray, np.ndarray]:
    """Angular momentum of the paper's wheel about the contact, and the moment of its weight, along e1, e2, e3."""
    psi, theta = of("psi"), of("theta")
    carrier = Rotation.from_euler("ZX", [psi, theta]).as_matrix()
    omega = np.array([of("theta_dot"), of("psi_dot") * np.sin(theta), of("omega_z")])
    centre = carrier.T @ [0.3 * np.cos(theta) * -np.sin(psi), 0.3 * np.cos(theta) * np.cos(psi), of("Z_O")]
    velocity, weight = carrier.T @ [of(f"{k}_O_dot") for k in "XYZ"], carrier.T @ [0, 0, -20 * 9.81]
    return np.diag([0.9, 0.9, 1.8]) @ omega + 20 * np.cross(centre, velocity), np.cross(centre, weight)


@pytest.mark.parametrize("t", INSTANTS)
def test_momentum_and_moment_about_the_contact_are_those_of_the_wheels_motion(live, t):
    """L is the part along the axle; the weight has a moment along e1 alone; dL is the moment's, in 0.3 s."""
    open_step(live, 2)
    shown, (L, M) = arrows(live, t, "precession"), about_contact(row(live, t))
    within(absolute_error(shown["L"][0], [0, 0, L[2]]), 1e-9, "L, kg m²/s")
    within(absolute_error(shown["M"][0], M), 1e-9, "M, N m")
    within(absolute_error(shown["ghost"][0] - shown["L"][0], 0.3 * M), 1e-9, "dL, kg m²/s")
    L, M = about_contact(row(live, t + 0.05))
    beyond(absolute_error(shown["M"][0], M), 0.05, "M at another instant, N m")


def test_the_axle_turns_towards_the_ghost(live):
    """In a steady circle at a small lean the moment turns L, and L keeps its length: 1 % of lean squared is left."""
    open_step(live, 2, {"lean": 2, "spin": 12})
    rates = column(live, "psi_dot")
    k = int(np.argmin(abs(rates[10:200] - rates[:400].mean()))) + 10  # where it turns as on the average
    t = column(live, "time")[k]
    shown = arrows(live, t, "precession")
    tilt = shown["ghost"][0][0] / shown["L"][0][2]  # of the ghost's axle about e2, in 0.3 s
    assert tilt == pytest.approx(0.3 * rates[k] * np.sin(column(live, "theta")[k]), rel=0.1)


BARS = """() => {
  const {all, wheels} = page.plots;
  const bars = all.find(({kind}) => kind.form === 'bars');
  const own = ['--tips', '--rights'].map((name) => getComputedStyle(document.documentElement).getPropertyValue(name));
  const pen = CanvasRenderingContext2D.prototype;
  const fill = pen.fillRect;
  const found = [];
  pen.fillRect = function (x, y, width, height) {
    if (height > 8 && width > 1) found.push(width / bars.sizes[0] * bars.ranges[0][1]);
    fill.call(this, x, y, width, height);
  };
  bars.draw();
  pen.fillRect = fill;
  return [found.filter((width) => width > 0), wheels.map(({perRadian}) => perRadian), bars.values.textContent];
}"""
BODIES = ("tyre", "coin", "disc", "hoop")


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("times_critical", [0.5, 1.0, 2.0])
def test_the_bars_are_the_two_moments_of_the_fmus_linearization(live, body, times_critical):
    """Tips m g r_0, rights (J_z + m R²)(J_z / J_x) ω²; drawn in one scale, and equal at the critical spin."""
    start(live, body=body)
    wheel = parameters(live)
    m, g, r_0, J_x, J_z = (wheel[name] for name in ("m", "g", "r_0", "J_x", "J_z"))
    spin = times_critical * critical_spin(SimpleNamespace(**wheel))
    change(live, spin=spin)
    seek(live, 0)
    shown, (found,), verdict = live.evaluate(BARS)
    rights = (J_z + m * (r_0 + wheel["r"]) ** 2) * (J_z / J_x) * spin**2
    within(relative_error([found["tips"], found["rights"]], [m * g * r_0, rights]), 1e-5, "moments per radian")
    within(relative_error(shown, [found["tips"], found["rights"]]), 1e-9, "bars")
    assert verdict == {0.5: "tipped", 1.0: "equal: the critical spin", 2.0: "righted"}[times_critical]


def test_the_wheel_falls_where_the_bar_that_tips_is_the_longer_one(live):
    for part, below in ((0.95, True), (1.05, False)):
        start(live, lean=0.5, spin=part * critical_spin(PAPER))
        _, (found,), _ = live.evaluate(BARS)
        leans = abs(90 - np.degrees(column(live, "theta")))
        assert (found["tips"] > found["rights"]) is below is bool(leans.max() > 10)


STRIP = "page.plots.all.find(({kind}) => kind.band).lines[0]"
PLACE = ("theta", "theta_dot", "psi_dot", "phi_dot")


def test_the_strip_is_the_moment_that_holds_the_spin_within_the_band_of_rolling_resistance(live, wheel):
    """Put into the FMU at an instant without resistance, that moment alone leaves ω_z as it is."""
    open_step(live, 6)
    strip = np.array(live.evaluate(STRIP))
    within(absolute_error(strip[:, 2], 0.03 * column(live, "lambda_3")), 1e-9, "limit of the band, N m")
    mode, tau = column(live, "friction_mode"), column(live, "tau")
    within(absolute_error(strip[mode == 0, 1], tau[mode == 0]), 1e-9, "moment that holds, N m")
    assert (abs(strip[mode == 0, 1]) <= strip[mode == 0, 2]).all() and (mode == 0).sum() > 100
    assert (abs(strip[mode != 0, 1]) > strip[mode != 0, 2]).sum() > 100  # and beyond it is not held
    for k in (10, 60, 150, 170, 230):
        there = {f"{name}_start": column(live, name)[k] for name in PLACE}
        for moment, holds in ((strip[k, 1], True), (0.0, False)):
            at = wheel()
            at.start(**there)
            at.set(M_3=moment)
            (rate,) = at.get("omega_z_dot")
            assert (abs(rate) < 1e-9) is holds, (k, rate)


def test_the_wheel_load_stands_ahead_of_the_contact_by_the_moment_over_it(live):
    open_step(live, 6)
    for t in (0.3, 1.25, 3.0):  # forward, held, back
        of, shown = row(live, t), arrows(live, t, "resistance")
        assert shown["N"][0] == pytest.approx([0, 0, of("lambda_3")])
        assert shown["N"][1] == pytest.approx([of("tau") / of("lambda_3"), 0, 0])
        assert shown["s"][0] == pytest.approx(shown["N"][1])
        ahead, held = shown["N"][1][0], of("friction_mode") == 0
        assert abs(ahead) < 0.0299 if held else abs(ahead) == pytest.approx(0.03)
        assert held or ahead * of("omega_z") < 0  # against the spin


def test_at_the_contact_the_centres_velocity_and_that_of_the_turn_add_up_to_the_slip(live):
    for step, instants in ((9, (0.3, 0.9, 1.1, 1.6)), (10, (0.0, 0.4, 1.5))):
        open_step(live, step)
        for t in instants:
            of, shown = row(live, t), arrows(live, t, "sliding")
            assert shown["v"][0][:2] == pytest.approx([of("v_x"), of("v_y")])
            assert shown["R ω_z"][0] == pytest.approx([0.35 * of("omega_z"), 0, 0], abs=1e-9)
            assert shown["slip"][0] == pytest.approx(shown["v"][0] + shown["R ω_z"][0], abs=1e-9)
            assert shown["slip"][0][:2] == pytest.approx([of("slip_x"), of("slip_y")], abs=1e-9)
    assert np.linalg.norm(shown["slip"][0]) < 1e-12 < 0.1 < abs(shown["v"][0][0])  # it rolls at last


CIRCLE = """(t) => {
  const circle = page.plots.all.find(({kind}) => kind.form === 'circle');
  const pen = CanvasRenderingContext2D.prototype;
  const {arc, lineTo} = pen;
  const radii = [];
  pen.arc = function (x, y, radius, ...more) {
    radii.push(radius / circle.scale);
    arc.call(this, x, y, radius, ...more);
  };
  page.player.seek(t);
  circle.draw(t);
  pen.arc = arc;
  return [radii, Number(circle.values.textContent), 0.5 * circle.height / circle.scale];
}"""


def test_the_friction_circle_holds_the_roads_force_until_it_touches_the_outer_one(live):
    """Gripping, the force stays within; on the verge of sliding it is μ_max N; sliding, μ_slide N against the slip."""
    open_step(live, 9)
    mu_max, mu_slide = 0.45, 0.85 * 0.45
    ((begin, _),) = live.evaluate("page.wheels[0].phases.slides")
    t, N, slips = (column(live, name) for name in ("time", "lambda_3", "slip_x"))
    force = np.hypot(column(live, "lambda_x"), column(live, "lambda_y"))
    sliding = np.hypot(slips, column(live, "slip_y")) > 0
    assert (force[~sliding] <= mu_max * N[~sliding]).all()
    last = int(np.flatnonzero(t < begin)[-1])
    assert force[last] > 0.95 * mu_max * N[last] > mu_slide * N[last]
    within(relative_error(force[sliding], mu_slide * N[sliding]), 1e-9, "force while it slides")
    assert (column(live, "lambda_x")[sliding] * slips[sliding] < 0).all()
    for k in (20, last, last + 2, 150):
        radii, said, edge = live.evaluate(CIRCLE, t[k])
        assert radii == pytest.approx([mu_max * N[k], mu_slide * N[k]]) and max(radii) < edge
        assert said == pytest.approx(force[k], abs=0.51)


@pytest.mark.parametrize(
    ("step", "t", "kinds"),
    [
        (2, 0.7, {"momentum": ("L", "dL"), "moment": ("M",)}),
        (4, 3.0, {"momentum": ("L", "dL"), "moment": ("M",)}),
        (6, 0.5, {"force": ("N",)}),
        (10, 0.2, {"speed": ("v", "R ω_z", "slip")}),
    ],
)
def test_arrows_of_one_kind_have_one_scale_for_all_wheels_and_instants_and_its_key_stands_below(live, step, t, kinds):
    open_step(live, step)
    key, units = live.locator("#legend").inner_text(), live.evaluate(NUMBERS)
    assert set(units) == set(kinds)
    for i in range(live.evaluate("page.wheels.length")):
        for at in (t, 0.5 * t):
            shown = drawn(live, at, i)
            for kind, names in kinds.items():
                assert re_unit(key, names[-1].replace("_", "")) == units[kind]
                for name in names:
                    size = np.linalg.norm(shown[name]) / 0.35 * units[kind]
                    assert size == pytest.approx(expected(live, at, i, name), rel=1e-6), name


def re_unit(key: str, name: str) -> float:
    """The number behind a name in the key of the arrows."""
    return numbers(key.split(f"{name} ")[1])[0]


def expected(page, t: float, wheel: int, name: str) -> float:
    """The size of an arrow by the FMU's values."""
    of = row(page, t, wheel)
    sizes = {
        "L": lambda: abs(about_contact(of)[0][2]),
        "M": lambda: np.linalg.norm(about_contact(of)[1]),
        "dL": lambda: 0.3 * np.linalg.norm(about_contact(of)[1]),
        "N": lambda: of("lambda_3"),
        "v": lambda: np.hypot(of("v_x"), of("v_y")),
        "R ω_z": lambda: 0.35 * abs(of("omega_z")),
        "slip": lambda: np.hypot(of("slip_x"), of("slip_y")),
    }
    return sizes[name]()
