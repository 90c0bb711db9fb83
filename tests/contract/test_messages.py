"""Each message of docs/messages.md has its own names and numbers at their places, in runs that begin at 7.25 s."""

import re
from collections import defaultdict
from collections.abc import Iterator
from itertools import combinations
from math import inf, isclose, nan, pi

from wheelfmu.fmu.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK, FMU2Wheel, Value
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.sliding import HUB, ROAD

START = 7.25  # s
FULL = (1.8 / 0.35**2 + 20) * 9.81 * 0.35  # N m: an upright wheel that brakes so requires lambda_x = N
ROLLING = {"theta_start": pi / 2, "phi_dot_start": -60.0}
PULLED = {"keep_contact": True, "theta_start": 1.2, "theta_dot_start": 4.0, "psi_dot_start": 0.1, "phi_dot_start": 0.0}
JAMS = {**HUB, "theta_start": 0.87, "theta_dot_start": 2.0, "slip_x_start": 2.0, "slip_y_start": -5.0}
LIMIT = "needs a friction coefficient above mu_max"
PULLS = "the ground pulls; without keep_contact the wheel would lift off"
Part = str | float
Case = tuple[str, str, list[Part]]  # a message of the page, as it is logged, and what stands at its places


def started(library: Library, **values: Value) -> FMU2Wheel:
    return library.wheel(logging=True).start(START, **values)


def ended(library: Library, **values: Value) -> tuple[FMU2Wheel, float]:
    """The wheel and the instant at which its run has ended."""
    w = started(library, **values)
    assert w.step(3.0) == DISCARD
    return w, w.status(LAST_SUCCESSFUL_TIME)


def ends(library: Library) -> Iterator[Case]:
    text = "The wheel … at t = … s, theta = … rad: the run ends there."
    w, end = ended(library, **JAMS, mu_max=0.9, mu_slide=0.8)
    yield text, w.said(), ["jams (Painleve's paradox) with mu_slide = 0.8", end, *w.get("theta")]
    w, end = ended(library, mu_max=0.3)
    yield text, w.said(), [f"{LIMIT} = 0.3", end, *w.get("theta")]
    assert w.step(0.1) == ERROR
    yield "…: the wheel … at t = … s. Restore a state or reset.", w.said(), ["fmi2DoStep", f"{LIMIT} = 0.3", end]
    before = (w := started(library, mu_max=0.3)).serialized()
    for _ in range(100):
        assert w.back(before).step(3.0) == DISCARD
    yield "… ends were logged; further ones are not logged until a reset.", w.texts()[-1], [100]
    w = library.wheel().initializing(
        J_x=0.1, J_y=0.1, J_z=0.1, theta_start=1.0, slip_y_start=-0.5, mu_max=6.0, mu_slide=5.0
    )
    assert w.exitInitializationMode() == ERROR
    yield "At the start the wheel …: the run ends there.", w.said(), ["jams (Painleve's paradox) with mu_slide = 5"]


def warnings(library: Library) -> Iterator[Case]:
    _, lift_off = ended(library, **PULLED | {"keep_contact": False})
    w = started(library, **PULLED).to(lift_off + 1e-3)
    yield "t = … s: ….", w.said(), [lift_off, PULLS]
    w = started(library, **ROLLING).give({"M_brake": (FULL - 20, 200.0)}).to(START + 0.3)
    t = float((said := w.said()).split()[2])
    text = "t = … s: mu_required = …, more than a dry road gives; mu_max = 0 sets no limit."
    yield text, said, [t, float(f"{1 + (200 * (t - START) - 20) / FULL:.3g}")]


def friction(library: Library) -> Iterator[Case]:
    """Instants of the reference (physics/test_friction_events.py, physics/test_sliding.py)."""
    stick, release = started(library, s=0.03).to(START + 1.4).texts()
    yield "t = … s: stick, omega_z is held at zero.", stick, [START + 1.225520636]
    yield "t = … s: …, omega_z becomes ….", release, [START + 1.329817, "release", "negative"]
    (slides,) = started(library, **ROAD).to(START + 0.6).texts()
    yield "t = … s: the wheel ….", slides, [START + 0.570827, "starts to slide"]


def parameters(library: Library) -> Iterator[Case]:
    """Refused at the end of initialization."""
    faults: list[tuple[str, dict[str, Value], list[Part]]] = [
        ("… = …: a finite number is needed.", {"m": nan}, ["m", "nan"]),
        ("… = …: it must be greater than ….", {"r_0": -0.25}, ["r_0", -0.25, 0]),
        ("… = …: it must be at least ….", {"s": -0.5}, ["s", -0.5, 0]),
        ("… = …: it must be at most ….", {"formulation": 4}, ["formulation", 4, 3]),
        ("… = … rad: it must be less than ….", {"slope": 1.75}, ["slope", 1.75, pi / 2]),
        (
            "… = … rad: the wheel must stand above the ground, 0 < theta < ….",
            {"theta_start": 3.5},
            ["theta_start", 3.5, pi],
        ),
        (
            "… = … rad: beyond … rad an angle has too few digits.",
            {"psi_start": 1e13},
            ["psi_start", 1e13, 1e12],
        ),
        (
            "J_x, J_y, J_z = …, …, … kg m2: none may exceed the sum of the other two.",
            {"J_x": 0.8, "J_y": 1.1, "J_z": 2.5},
            [0.8, 1.1, 2.5],
        ),
        ("mu_slide = …: mu_max must be at least as large, and is ….", {"mu_slide": 0.4, "mu_max": 0.3}, [0.4, 0.3]),
        (
            "slip_x_start, slip_y_start = …, … m/s: an initial slip needs mu_slide.",
            {"slip_x_start": 0.5, "slip_y_start": -0.75},
            [0.5, -0.75],
        ),
        (
            "psi_dot_start, theta_dot_start = …, … rad/s: a guided wheel needs 0 for both.",
            {"guided": True, "psi_dot_start": 0.5, "theta_dot_start": -0.75},
            [0.5, -0.75],
        ),
        (
            "psi_dot_guide, theta_dot_guide = …, … rad/s: only the carrier of a guided wheel turns, by co-simulation; "
            "else they and their derivatives must be 0.",
            {"psi_dot_guide": 0.5, "theta_dot_guide": -0.75},
            [0.5, -0.75],
        ),
        (
            "The initial energy or reaction force overflows: m = … kg, J_z = … kg m2, r_0 = … m, g = … m/s2, "
            "omega_z = … rad/s.",
            {"m": 1.7e308},
            [1.7e308, 1.8, 0.3, 9.81, -2],
        ),
    ]
    for text, values, parts in faults:
        w = library.wheel().initializing(**values)
        assert w.exitInitializationMode() == ERROR
        yield text, w.said(), parts
    text = "The tolerance … is outside […, …]; … is used."
    for given, used in ((0.1, 1e-4), (1e-16, 1e-13)):
        yield text, library.wheel().start(START, tolerance=given).said(), [given, 1e-13, 1e-4, used]


def values(library: Library) -> Iterator[Case]:
    """Refused during the run."""
    w = started(library, s=0.03, slope=0.1, F_X=3.0)

    def answer(name: str, value: float) -> str:
        assert w.set(**{name: value}) == DISCARD
        return w.said()

    text = "…: … = …: it must be … …; the value stays …."
    yield text, answer("s", -0.5), ["fmi2SetReal", "s", -0.5, "at least", 0, 0.03]
    yield text, answer("slope", 1.75), ["fmi2SetReal", "slope", 1.75, "less than", pi / 2, 0.1]
    text = "…: … = …: a finite number is needed; the value stays …."
    yield text, answer("F_X", inf), ["fmi2SetReal", "F_X", "inf", 3]
    text = "…: … = …: whether the wheel can slide is decided at the start; the value stays …."
    yield text, answer("mu_slide", 0.4), ["fmi2SetReal", "mu_slide", 0.4, 0]
    text, carrier = (
        "…: … = …: only the carrier of a guided wheel turns, by co-simulation; the value stays ….",
        "psi_dot_guide",
    )
    yield text, answer(carrier, 0.4), ["fmi2SetReal", carrier, 0.4, 0]


def calls(library: Library) -> Iterator[Case]:
    w = library.wheel()

    def answer(function: str, *arguments: object) -> str:
        assert w.ask(function, *arguments) in (DISCARD, ERROR)
        return w.said()

    text = "…: start … s, stop … s, tolerance …: start must be finite, stop not before it, the tolerance positive."
    yield text, answer("SetupExperiment", 1, 1e-5, START, 1, 5.5), ["fmi2SetupExperiment", START, 5.5, 1e-5]
    w.start(START, stop=8.5)
    text = "… from … s by … s: times must be finite and the step not negative."
    yield text, answer("DoStep", START, -0.5, 0), ["fmi2DoStep", START, -0.5]
    text = "… from … s by … s: the step is lost in the rounding of the time."
    yield text, answer("DoStep", START, 1e-16, 0), ["fmi2DoStep", START, 1e-16]
    text = "… from … s: the FMU has reached … s."
    yield text, answer("DoStep", 7.5, 0.1, 0), ["fmi2DoStep", 7.5, START]
    yield "… to … s: the stop time is … s.", answer("DoStep", START, 2.0, 0), ["fmi2DoStep", 9.25, 8.5]
    text = "…: no variable of this type has the value reference …."
    yield text, answer("GetReal", [999], 1, [0]), ["fmi2GetReal", 999]
    rates, theta, force = "GetRealOutputDerivatives", w.refer("theta"), w.refer("F_X")
    yield "…: value reference … is not ….", answer(rates, [999], 1, [1], [0]), [f"fmi2{rates}", 999, "a real output"]
    text = "…: order … of …: only the first derivative is provided."
    yield text, answer(rates, theta, 1, [2], [0]), [f"fmi2{rates}", 2, "theta"]
    text, inputs = "…: derivative … = … of …: orders 1 to … and finite values are allowed", "SetRealInputDerivatives"
    text += ", of a carrier's rate only where it turns: guided, by co-simulation."
    yield text, answer(inputs, force, 1, [4], [2.5]), [f"fmi2{inputs}", 4, 2.5, "F_X", 3]
    yield "…: there is no status of kind ….", answer("GetRealStatus", 1, [0]), ["fmi2GetRealStatus", 1]
    spin = w.by(0.5).get("omega_z")[0]
    assert w.put(M_3=1e300).step(0.5) == ERROR
    text = "The solver stopped at t = … s, where omega_z = … rad/s, in a step that began with a slip of … m/s: …."
    parts = [7.75, float(f"{spin:.4g}"), 0, "the step size became too small"]
    yield text, w.said().partition(": extreme")[0] + ".", parts
    w, slopes = library.wheel().initializing(J_x=0.75, J_y=0.75, J_z=1e-12), "GetDirectionalDerivative"
    text = "…: no valid initial values near … = … for a derivative."
    yield text, answer(slopes, theta, 1, w.refer("J_x"), 1, [1], [0]), [f"fmi2{slopes}", "J_x", 0.75]


def model_exchange(library: Library) -> Iterator[Case]:
    fast = {"theta_start": 1.2, "psi_dot_start": 0.3, "phi_dot_start": -6.0}
    w = loaded(library).new()
    assert w.put(**fast, mu_max=0.01).initialise(None, START) == ERROR
    text = "At the start the wheel … (N = … N, mu_required = …): the run ends there."
    yield text, w.said(), [f"{LIMIT} = 0.01", *started(library, **fast).get("lambda_3", "mu_required")]
    w = loaded(library).new()
    assert w.put(mu_max=0.5, mu_slide=0.4).initialise(None, START) == ERROR
    yield "mu_slide = …: model exchange has no states for a slip and needs 0.", w.said(), [0.4]
    w = loaded(library).new().start(START)
    w.decide()
    assert w.setTime(inf) == ERROR
    yield "…: … s: the time must be finite.", w.said(), ["fmi2SetTime", "inf"]
    assert w.enterContinuousTimeMode() == OK
    assert w.ask("SetContinuousStates", [0] * 7, 7) == ERROR
    yield "…: needs an array of … numbers, not of ….", w.said(), ["fmi2SetContinuousStates", 8, 7]
    x = w.x()
    x[5] = 1e200
    w.place(START + 0.5, x)
    assert w.ask("GetDerivatives", [0] * 8, 8) == DISCARD
    text = "…: at t = … s the … are not finite."
    yield text, w.said(), ["fmi2GetDerivatives", START + 0.5, "derivatives"]


# Places for words alone.
WORDS = {
    "fmi2Instantiate: the GUID differs from this FMU's modelDescription.xml (…).",
    '…: "…" cannot be set after initialization.',
    '…: "…" is calculated and cannot be set.',
    '…: "…" has no value before a successful initialization.',
    '… is not allowed in the state "…".',
    "… belongs to …; this instance was made for ….",
    '…: there is no category "…".',
    "…: ….",
}


def pattern(message: str) -> str:
    return "(.+)".join(map(re.escape, message.split("…")))


def are(found: tuple[str, ...], parts: list[Part]) -> bool:
    return all(
        text == part if isinstance(part, str) else isclose(float(text), part, rel_tol=1e-5)
        for text, part in zip(found, parts, strict=True)
    )


def swapped(parts: list[Part], i: int, k: int) -> list[Part]:
    return [parts[{i: k, k: i}.get(place, place)] for place in range(len(parts))]


def listed() -> set[str]:
    """Messages of the page with a place for more than the function's name."""
    page = re.sub(r"\n +", " ", (ROOT / "docs" / "messages.md").read_text(encoding="utf-8"))
    return {text for text in re.findall("`([^`]+)`", page) if re.search("….*…|^[^…]+…|^… ", text)}


def test_every_number_of_every_message_stands_at_its_place_and_no_two_could_be_interchanged(library: Library) -> None:
    seen, words, same = set(), set(), defaultdict(list)
    for group in (ends, warnings, friction, parameters, values, calls, model_exchange):
        for message, text, parts in group(library):
            found = re.fullmatch(pattern(message), text)
            assert found and are(found.groups(), parts), (text, parts)
            numbers = [k for k, part in enumerate(parts) if not isinstance(part, str)]
            for pair in combinations(numbers, 2):
                same[message, *pair].append(are(found.groups(), swapped(parts, *pair)))
            seen |= {message}
            words |= {part for part in parts if isinstance(part, str)}
    assert not [place for place, cases in same.items() if all(cases)]
    named = {text for text in listed() if any(re.fullmatch(pattern(text), word) for word in words)}
    assert listed() == seen | named | WORDS
