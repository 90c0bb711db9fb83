"""CONTRIBUTING's recipes for a parameter with its message, an output, an event and one with its own parameter, carried
out on a copy with a third event. The first crossing is logged in every way of running, and the tests of the contract
hold. They are those of theta, the normal force and Y_O, read on a fine grid."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within
from support.checkout import copy_checkout

from wheelfmu.fmu.building import CMAKE
from wheelfmu.fmu.description.measuring import measured
from wheelfmu.fmu.description.numbering import numbered, with_event_indicators
from wheelfmu.fmu.driver import FMU2Wheel
from wheelfmu.fmu.paths import ROOT
from wheelfmu.fmu.values import variables
from wheelfmu.truth import exchange as exchanging
from wheelfmu.truth.motion import Library, Run

LEAN = 1.29  # rad: the level of the recipe
WAYS = {"unfolded": {}, "Runge-Kutta": {"method": 4}, "Adams": {"method": 2}, "multibody": {"formulation": 3}}
STOP = 6.0
pytestmark = pytest.mark.xdist_group("recipes")  # one build for all

# Another observed event: it depends on the place of the wheel, which is no symmetry of the unfolded motion.
LINE = {
    "fmu-src/wheel/in_force.hpp": ["crosses_line,\n"],
    "fmu-src/wheel/events.cpp": [
        """bool has_line(const Setup& setup, const InForce&) { return setup.keep_contact; }

double short_of_line(const Setup& setup, const InForce&, double, const double* y) {
  WheelKinematics now;
  setup.rolling_equations->kinematics(&setup.wheel, y, &now);
  return (setup.Y_O.whole(now.Y_O) + 0.1) / setup.length;
}
""",
        """    {.event = Event::crosses_line,
     .can_occur = has_line,
     .value = short_of_line,
     .observation = "the wheel crosses the line"},
""",
    ],
}
# In front of what a new variable, member, assignment, name, function and row stand.
PLACES = {
    "modelDescription.xml": ['    <ScalarVariable name="F_X"'],
    "fmu-src/wheel/setup.hpp": ["};\n\n// (parameters, tolerance, kind; whether the wheel can slide) => setup"],
    "fmu-src/wheel/setup.cpp": ["  return setup;\n}\n\nvoid scales_at"],
    "fmu-src/wheel/in_force.hpp": ["  count\n};"],
    "fmu-src/wheel/events.cpp": [
        "}  // namespace\n\nconstexpr EventRow event_rows[]",
        "};\n\nnamespace {\n\n// A row that does not always end",
    ],
}
OF_PARAMETERS = {
    "modelDescription.xml": ['    <ScalarVariable name="F_X"'],
    "fmu-src/wheel/setup.cpp": ["  setup.friction_law = static_cast", "  // Another solver is offered"],
}
OF_MESSAGES = {
    "docs/messages.md": ["| `psi_dot_start, theta_dot_start = "],
    "tests/support/refusals.py": ['    ({"J_x": 3.0}'],
}
OF_OUTPUTS = {
    "modelDescription.xml": ['    <ScalarVariable name="theta_ddot"'],
    "fmu-src/wheel/variables.cpp": ["};\n\n#undef AT"],
    "docs/equations.md": ["\nSome outputs, such as"],
}
UNITS = "  </UnitDefinitions>"
Blocks = dict[str, list[str]]  # of code, by file


def recipes(title: str = "Add an event") -> list[Blocks]:
    """Of CONTRIBUTING.md: the blocks of code, each of the file that was named last."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = re.search(rf"^## {title}\n(.*?)^## ", text, re.DOTALL | re.MULTILINE)[1]
    found: list[Blocks] = []
    for part in section.split("\nAn event with its own parameter"):
        blocks, file = Blocks(), ""
        for said, block in re.findall(r"(.*?)```\w+\n(.*?) *```", part, re.DOTALL):
            names = re.findall(r"`([\w./-]+)`", said)
            places = {**PLACES, **OF_OUTPUTS, **OF_MESSAGES}
            named = [place for name in names for place in places if place.endswith(name)]
            file = named[-1] if named else file
            blocks.setdefault(file, []).append(re.sub(r"^   ", "", block, flags=re.MULTILINE))
        found.append(blocks)
    return found


def patch(folder: Path, blocks: Blocks, places: Blocks = PLACES) -> None:
    for file, texts in blocks.items():
        path = folder / file
        for before, text in zip(places[file], texts, strict=True):
            old = path.read_text(encoding="utf-8")
            assert old.count(before) == 1, (path, before)
            path.write_text(old.replace(before, text + before), encoding="utf-8")


class Patched(NamedTuple):
    """A checkout with all events, the FMU that it makes, and the texts of the messages."""

    root: Path
    fmu: Path
    library: Library
    lean: str
    load: str
    line: str


@pytest.fixture(scope="module")
def patched(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Patched]:
    """Parameter, output and all events in the place of the recipes; numbered and built."""
    root, events = tmp_path_factory.mktemp("checkout"), [*recipes(), LINE]
    copy_checkout(root)
    for blocks in events:
        patch(root, blocks)
    for title, places in (("parameter", OF_PARAMETERS), ("message", OF_MESSAGES), ("output", OF_OUTPUTS)):
        patch(root, *recipes(f"Add an? {title}"), places)
    description = root / "modelDescription.xml"
    (unit,) = re.findall(r"with the unit\s+`(<Unit.*)`", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    patch(root, {"modelDescription.xml": [f"    {unit}\n"]}, {"modelDescription.xml": [UNITS]})
    text = description.read_text(encoding="utf-8")
    count = int(re.search(r'numberOfEventIndicators="(\d+)"', text)[1]) + len(events)
    description.write_text(numbered(with_event_indicators(text, count)), encoding="utf-8")
    sundials = os.environ.get("WHEEL_SUNDIALS_SOURCE") or next((ROOT / "build" / "sundials").glob("*/vendor"))
    options = {"CMAKE_UNITY_BUILD": "ON", "Python3_EXECUTABLE": sys.executable, "WHEEL_SUNDIALS_SOURCE": sundials}
    # It is built twice: with assertions, and not optimized as a whole.
    options |= {"CMAKE_BUILD_TYPE": "RelWithDebInfo", "CMAKE_CXX_FLAGS_RELWITHDEBINFO": "-O1"}
    configure = [*CMAKE, "-S", root, "-B", root / "build", *(f"-D{name}={value}" for name, value in options.items())]
    make = ["cmake", "--build", root / "build", "--target", "fmu", "wheel_equations", "-j2"]
    fmu = root / "build" / "wheel.fmu"
    for command in (configure, make):
        subprocess.run(command, check=True, capture_output=True)
    description.write_text(numbered(description.read_text(encoding="utf-8"), measured(fmu)), encoding="utf-8")
    subprocess.run(make, check=True, capture_output=True)
    rows = [blocks["fmu-src/wheel/events.cpp"][1] for blocks in events]
    texts = [re.search(r'observation = "([^"]*)', row)[1] for row in rows]
    library = Library.unpacked(fmu)
    yield Patched(root, fmu, library, *texts)
    library.remove()


def falls(run: Run, name: str, level: float, sign: float = 1.0) -> list[float]:
    """Where the output, or its negative, falls below the level, by the secant on the grid of the run."""
    t, x = run.t, sign * (run[name] - level)
    k = np.flatnonzero((x[:-1] >= 0) & (x[1:] < 0))
    return [float(v) for v in t[k] - x[k] * (t[k + 1] - t[k]) / (x[k + 1] - x[k])]


def logged(text: str, messages: list[str]) -> list[float]:
    """The instants of the messages with this text."""
    found = (re.match(rf"t = (\S+) s: {text}", message) for message in messages)
    return [float(match[1]) for match in found if match]


def gap(want: list[float], got: list[float]) -> float:
    """Of the first, which alone is logged."""
    (first,) = got
    return abs(want[0] - first)


@pytest.fixture(scope="module")
def fine(library: Library) -> Run:
    """The motion of the core without these events, every millisecond."""
    return library.simulate(np.linspace(0, STOP, 6001), 1e-11)


@pytest.fixture(scope="module")
def limit(fine: Run) -> dict[str, float]:
    """The parameter, halfway between the least and the largest normal force."""
    (name,) = re.findall(r'<ScalarVariable name="(\w+)"', recipes()[1]["modelDescription.xml"][0])
    return {name: 0.5 * float(fine["lambda_3"].min() + fine["lambda_3"].max())}


def test_the_parameter_does_what_its_recipe_says(patched: Patched) -> None:
    def turned(J_z: float, J_hub: float) -> FMU2Wheel:
        return patched.library.wheel().start(J_z=J_z, J_hub=J_hub, s=0.03).to(1.0)

    with turned(1.5, 0.25) as wheel, turned(1.75, 0.0) as same, turned(1.5, 0.0) as other:
        assert wheel.bits() == same.bits() != other.bits()


def test_new_variables_have_the_next_references_and_no_other_moves(patched: Patched) -> None:
    old, new = (
        {name: v.reference for name, v in variables(description=(folder / "modelDescription.xml").read_bytes()).items()}
        for folder in (ROOT, patched.root)
    )
    assert old == {name: new[name] for name in old}
    added = {name: reference for name, reference in new.items() if name not in old}
    assert added.keys() == {"J_hub", "N_max", "P_brake"}
    assert sorted(added.values()) == [max(old.values()) + k for k in (1, 2, 3)]


def test_the_page_lists_the_message_of_the_parameter_as_the_code_has_it() -> None:
    (code,), (page,) = recipes("Add a parameter"), recipes("Add a message")
    (text,) = re.findall(r'"(.+)"', code["fmu-src/wheel/setup.cpp"][1])
    assert f"`{text.replace('%s', '…')}`" in page["docs/messages.md"][0]


BRAKED = {"s": 0.03, "phi_dot_start": -6.0}


@pytest.mark.parametrize("law", [{}, {"friction_law": 2, "omega_s": 2.0}], ids=["exact", "regularized"])
def test_the_rate_of_an_output_of_state_and_force_is_that_of_its_course(patched: Patched, law) -> None:
    """By P_brake a little before and after, fourth order; under a regularized law kappa itself changes."""
    h, weights = 1e-3, np.array([1, -8, 0, 8, -1]) / 12
    with patched.library.wheel().start(tolerance=1e-12, **BRAKED, **law).put(M_brake=0.4) as wheel:
        powers = []
        for t in 0.5 + h * np.arange(-2, 3):
            tau_brake, omega_z, P = wheel.to(t).get("tau_brake", "omega_z", "P_brake")
            within(abs(P - tau_brake * omega_z), 8 * EPSILON, "power, W")
            powers.append(P)
            if len(powers) == 3:
                (rate,) = wheel.rates(["P_brake"])()
        within(abs(rate - weights @ powers / h), 2e-7, "rate of the power, W/s")
        beyond(abs(rate), 1e-2, "rate of the power, W/s")


def test_the_tests_of_the_contract_hold_with_these_events_too(patched: Patched) -> None:
    contract = ("call_states", "description", "parameters", "serialization")
    tests = [f"../tests/contract/test_{name}.py" for name in contract] + ["../tests/exchange/test_calls.py"]
    environment = os.environ | {"WHEEL_BUILD": str(patched.fmu.parent)}
    environment.pop("PYTHONSAFEPATH", None)  # the package is that of the copy
    # These read the only message; the wheel of the copy logs its leans too.
    others = "not (damaged_truncated or place_in_a_layer or spin_set_across or slides_although or tolerance_beyond)"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests, "-k", others]
    done = subprocess.run(
        command, cwd=patched.root / "tools", env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout[-3000:]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("step", [0.01, 1.0, STOP])
def test_the_first_crossing_is_logged_whatever_the_grid(library, patched: Patched, fine, limit, way: str, step: float):
    times = np.arange(0, STOP + step / 2, step)
    run = patched.library.simulate(times, 1e-11, **WAYS[way], **limit)
    (level,) = limit.values()
    leans, loads = logged(patched.lean, run.messages), logged(patched.load, run.messages)
    within(gap(falls(fine, "theta", LEAN), leans), 1e-6, "instant of the lean, s")
    within(gap(falls(fine, "lambda_3", level, -1), loads), 1e-6, "instant of the overload, s")
    beyond(gap(falls(fine, "theta", LEAN - 1e-3), leans), 1e-5, "instant of another lean, s")
    beyond(gap(falls(fine, "lambda_3", level + 1, -1), loads), 1e-5, "instant of another limit, s")
    if way == "unfolded":  # it still is
        assert run.counters["n_steps"] == library.simulate(times, 1e-11).counters["n_steps"]


@pytest.mark.parametrize("way", WAYS)
def test_an_event_that_is_no_symmetry_of_the_motion_keeps_it_from_being_unfolded(library, patched, fine, way: str):
    run = patched.library.simulate([0.0, 2.0, STOP], 1e-11, keep_contact=True, **WAYS[way])
    within(gap(falls(fine, "Y_O", -0.1), logged(patched.line, run.messages)), 1e-6, "instant of the line, s")
    within(gap(falls(fine, "theta", LEAN), logged(patched.lean, run.messages)), 1e-6, "instant of the lean, s")
    if way == "unfolded":
        assert run.counters["n_rhs"] > 2 * library.simulate([0.0, STOP], 1e-11, keep_contact=True).counters["n_rhs"]


def test_another_solver_finds_them_by_their_indicators(patched: Patched, fine: Run, limit) -> None:
    (level,) = limit.values()
    with exchanging.exchange(patched.library, logging=True, keep_contact=True, **limit) as wheel:
        exchanging.Run(wheel, 1e-10, exchanging.no_inputs).to(STOP)
        found = wheel.sentences
    within(gap(falls(fine, "Y_O", -0.1), logged(patched.line, found)), 1e-6, "instant of the line, s")
    within(gap(falls(fine, "theta", LEAN), logged(patched.lean, found)), 1e-6, "instant of the lean, s")
    within(gap(falls(fine, "lambda_3", level, -1), logged(patched.load, found)), 1e-6, "instant of the overload, s")
