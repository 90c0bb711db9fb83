"""The values that ./scripts/run takes: parameters, inputs, units, presets; its refusals are in test_typed_values.py."""

import json
import subprocess
from collections.abc import Callable
from math import atan, pi
from pathlib import Path

import numpy as np
import pytest
from fmpy import simulate_fmu
from scipy.integrate import quad
from support.bounds import EPSILON, beyond, within
from support.printed import COMMANDS
from support.refusals import REFUSALS

from wheelfmu.commands import run
from wheelfmu.diagrams import paper, races, style
from wheelfmu.fmu import start_values
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.presets import doubt, moments
from wheelfmu.fmu.values import variables

PARAMETERS = variables("parameter", "input")
BODIES = json.loads((ROOT / "examples" / "bodies.json").read_text(encoding="utf-8"))


def given(*typed: str) -> dict[str, str]:
    """Times and start values among the arguments of FMPy for what is typed."""
    words = start_values.command(start_values.values([*typed]))
    start = words[words.index("--start-values") + 1 :]
    times = (word.removeprefix("--").replace("-", "_").partition("=") for word in words[: len(start_values.RUN)])
    return {name: value for name, _, value in times} | dict(zip(start[::2], start[1::2], strict=True))


TYPED = {"formulation=2": 2, "formulation=multibody": 3, "friction_law=regularized": 2, "method=runge_kutta": 4}
TYPED |= {"s=0.01": 0.01, "theta_start=60deg": pi / 3, "stop_time=20": 20, "M_brake=20": 20, "M_3=-2Nm": -2}
TYPED |= {"m=12kg": 12, "m=500g": 0.5, "r_0=30cm": 0.3, "slope=8deg": 8 * pi / 180, "slope=12%": atan(0.12)}
TYPED |= {"F_X=0.3kN": 300, "phi_dot_start=-30rpm": -pi, "output_interval=5ms": 0.005}


@pytest.mark.parametrize(("argument", "value"), TYPED.items())
def test_a_value_with_its_unit_or_a_choice_by_its_word_becomes_a_number_in_si(argument, value):
    name = argument.partition("=")[0]
    found, plain = given(argument), given()
    within(abs(float(found.pop(name)) / value - 1), 16 * EPSILON, "the value in SI, relative")
    assert found == {other: text for other, text in plain.items() if other != name}
    assert given("keep_contact=true")["keep_contact"] == "true"


BY_THE_WHEEL = {"mu_slide=0.4": ["mu_slide = 0.4: mu_max must be at least as large, and is 0."], "mu_max=9": []}
BY_THE_WHEEL |= {"slope=90deg": ["slope = 1.57079633 rad: it must be less than 1.5708."], "slope=8deg": []}


@pytest.mark.parametrize(("argument", "words"), BY_THE_WHEEL.items())
def test_a_start_that_the_wheel_refuses_is_refused_in_its_own_words(fmu_path, tmp_path, argument, words):
    (tmp_path / "wheel.fmu").symlink_to(fmu_path)
    arguments = start_values.command(start_values.values([argument, "stop_time=0.1"]))
    command = run.simulation("--output-file", "free.csv", *arguments)
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    said = [line.removeprefix("[ERROR] ") for line in done.stdout.splitlines() if line.startswith("[ERROR] ")]
    assert said == words and (done.returncode == 0) is (words == [])


@pytest.mark.parametrize("words", [words for name, *words in COMMANDS if name == "run"], ids=" ".join)
def test_every_run_that_a_document_prints_simulates_and_draws(fmu_path, tmp_path, monkeypatch, words):
    """By FMPy, with its estimates of the error and its first picture, which has the panels of all others."""
    values = start_values.values(words)
    table = tmp_path / "friction.csv"
    command = run.simulation("--output-file", str(table), *start_values.command(values))
    subprocess.run(command, cwd=fmu_path.parent, check=True, capture_output=True)
    assert run.moves(table)
    monkeypatch.setattr(races, "ROOT", fmu_path.parent)
    races.main(tmp_path, {**values})
    assert all(" computing time " in (tmp_path / f"{scene}.error").read_text() for scene in run.SCENES)
    style.use_style()
    monkeypatch.setattr(style, "save", style.save_png)
    first, *_ = paper.pictures(paper.scenes_of(tmp_path, values, fmu_path), tmp_path / "drawn")
    paper.draw(*first)
    (drawn,) = tmp_path.glob("drawn/*diagrams.png")
    assert drawn.stat().st_size > 1e5


@pytest.mark.parametrize("near", [near for *_, near in REFUSALS], ids=str)
def test_what_a_wheel_can_have_next_to_what_it_refuses_can_be_typed(near):
    """tests/contract/test_parameters.py: the wheel takes it."""
    for name, value in near.items():
        assert PARAMETERS[name].number_of(str(value)) == value


def start_of(fmu_path: Path, *arguments: str) -> dict[str, float]:
    """The first row of the motion that the arguments ask for."""
    asked = given(*arguments)
    values = {n: float(x) for n, x in asked.items() if n not in ("stop_time", "output_interval")}
    names = ("X_O", "Y_O", "Z_O", "X_O_dot", "Y_O_dot", "Z_O_dot", "psi", "theta", "omega_z")
    row = simulate_fmu(str(fmu_path), start_values=values, stop_time=0.1, output=names)[0]
    return {name: float(row[name]) for name in names}


@pytest.mark.parametrize(("more", "R"), [([], 0.35), (["car_tyre"], 0.3135), (["r_0=0.5", "coin"], 0.5011)])
def test_a_speed_starts_a_wheel_upright_from_the_origin_forward_along_x(fmu_path, more, R):
    start = start_of(fmu_path, "v=18km/h", *more)
    want = {"X_O": 0, "Y_O": 0, "Z_O": R, "X_O_dot": 5, "Y_O_dot": 0, "Z_O_dot": 0}
    want |= {"psi": 0, "theta": pi / 2, "omega_z": -5 / R}
    off = max(abs(start[name] - value) for name, value in want.items())
    within(off, 16 * EPSILON * 5 / R, "start, SI")
    beyond(abs(start["omega_z"] - 5 / R), 5, "spin of a wheel that rolls backwards, rad/s")


@pytest.mark.parametrize("psi_dot", [0.0, 0.7])
@pytest.mark.parametrize("theta", [0.6, 2.0])
def test_a_speed_is_that_of_the_centre_along_the_heading_of_a_leaning_wheel_too(fmu_path, theta, psi_dot):
    start = start_of(fmu_path, f"theta_start={theta}", f"psi_dot_start={psi_dot}", "v=3", "psi_start=1", "X_O_start=2")
    along = start["X_O_dot"] * np.cos(1) + start["Y_O_dot"] * np.sin(1)
    within(abs(along - 3), 32 * EPSILON * 3, "speed along the heading off 3, m/s")
    assert (start["X_O"], start["psi"], start["theta"]) == (2, 1, theta)
    beyond(abs(3 * 0.35 / (0.3 + 0.05 * np.sin(theta)) - 3), 0.03, "speed by the radius when upright off 3, m/s")


def rings(rho: np.ndarray, z: np.ndarray, masses: np.ndarray) -> dict[str, float]:
    """m, J_x = J_y and J_z in SI of rings of radius rho about the axle, one at each of +z and -z."""
    across = (masses * (rho**2 / 2 + z**2)).sum()
    return {"m": masses.sum(), "J_x": across, "J_y": across, "J_z": (masses * rho**2).sum()}


def solid(rho: tuple[float, float], height: Callable[[float], float], m: float) -> dict[str, float]:
    """A homogeneous body of revolution between two radii, of this half height over the radius: by quadrature."""

    def over(power: int, of_height: int) -> float:
        return quad(lambda x: x**power * height(x) ** of_height, *rho, epsabs=0, epsrel=1e-11)[0]

    volume, J_z = over(1, 1), over(3, 1)
    across = J_z / 2 + over(1, 3) / 3
    return {"m": m} | {name: m * J / volume for name, J in (("J_x", across), ("J_y", across), ("J_z", J_z))}


SIZES = [(20.0, 0.3, 0.05), (12.0, 0.2, 0.2), (0.0085, 0.011775, 0.0011)]


def integrated(body: str, m: float, r_0: float, r: float) -> dict[str, float]:
    if body == "torus":
        return solid((r_0 - r, r_0 + r), lambda rho: max(r * r - (rho - r_0) ** 2, 0) ** 0.5, m)
    if body == "disc":
        return solid((0, r_0 + r), lambda _: r, m)
    return rings(np.array([r_0]), np.array([0.0]), np.array([m]))


@pytest.mark.parametrize(("m", "r_0", "r"), SIZES)
@pytest.mark.parametrize("body", BODIES)
def test_the_moments_of_a_ready_body_are_those_of_its_mass_in_space(body, m, r_0, r):
    size = {"m": m, "r_0": r_0, "r": r}
    p = moments(body, **size)
    exact, other = integrated(body, **size), integrated("hoop" if body == "torus" else "torus", **size)
    for name in ("J_x", "J_y", "J_z"):
        within(abs(p[name] / exact[name] - 1), 2048 * EPSILON, f"{name} of a {body}, relative")
        beyond(abs(p[name] / other[name] - 1), 1e-3, f"{name} of another body, relative")


@pytest.mark.parametrize("seed", range(20))
def test_mass_within_the_outline_is_never_doubted_and_mass_beyond_it_always(seed):
    """The outline: the convex hull of the torus. Mass within, mass on its border, and 1 % of the tube beyond."""
    rng, count = np.random.default_rng(seed), 30
    r_0 = rng.uniform(0.1, 0.5)
    r = r_0 * rng.choice([0.2, 0.5, 1.0])
    z, masses = r * rng.uniform(-1, 1, count), rng.uniform(0, 2, count)
    inside = rng.uniform(0, 1, count) * (r_0 + np.sqrt(r * r - z * z))
    size = {"r_0": r_0, "r": r}
    assert doubt(rings(inside, z, masses) | size) == ""
    angle = rng.uniform(-np.pi / 2, np.pi / 2)
    for tube, possible in ((r, True), (1.01 * r, False)):
        border = (np.array([part]) for part in (r_0 + tube * np.cos(angle), tube * np.sin(angle), 3.0))
        assert (doubt(rings(*border) | size) == "") is possible


def test_a_hub_may_be_wider_than_a_thin_tube_but_not_as_wide_as_a_drum():
    for width, possible in ((0.09, True), (0.11, False)):
        wheel = rings(np.array([0.2, 0.9]), np.array([width, width]), np.array([1.0, 1.0]))
        assert (doubt(wheel | {"r_0": 1.0, "r": 0.0}) == "") is possible


WHEELS = json.loads((ROOT / "examples" / "wheels.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", WHEELS)
def test_a_ready_wheel_has_a_source_is_a_body_that_can_exist_and_rolls(fmu_path, name):
    wheel = WHEELS[name]
    assert wheel["title"] and wheel["source"].endswith(".")
    p = {key: float(value) for key, value in given(name).items()}
    assert {"m", "r_0", "r", "J_x", "J_y", "J_z"} == {*wheel["parameters"]} < {*p}
    assert max(p["J_x"], p["J_y"], p["J_z"]) <= (p["J_x"] + p["J_y"] + p["J_z"]) / 2 * (1 + 4 * EPSILON)
    assert p["J_z"] / (p["m"] * (p["r_0"] + p["r"]) ** 2) > 0.3 and not doubt(p)
    start = {key: value for key, value in p.items() if key not in ("stop_time", "output_interval")}
    end = simulate_fmu(str(fmu_path), start_values=start, stop_time=0.1, output=["E"])
    assert end["time"][-1] == 0.1 and end["E"][-1] < end["E"][0]


def test_a_name_given_beside_a_ready_wheel_prevails():
    assert given("coin", "m=1g", "s=2mm")["m"] == "0.001"


def test_help_lists_every_parameter_input_and_ready_wheel():
    assert all(f"  {name} " in start_values.usage() for name in [*PARAMETERS, *WHEELS])
