"""Each message of docs/messages.md has its own names and numbers at their places, in runs that begin at 7.25 s."""

import re
from collections.abc import Iterator
from itertools import combinations
from math import inf, isclose, pi

from support.refusals import REFUSALS

from wheelfmu.fmu.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK, FMU2Wheel, Value
from wheelfmu.fmu.paths import ROOT
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import PAPER
from wheelfmu.truth.sliding import ROAD, SLIDES, gripping_torque

START = 7.25  # s
FULL = gripping_torque(PAPER, 1.0)  # N m: an upright wheel that brakes so requires lambda_x = N
ROLLING = {"theta_start": pi / 2, "phi_dot_start": -60.0}
PULLED = {"keep_contact": True, "theta_start": 1.2, "theta_dot_start": 4.0, "psi_dot_start": 0.1, "phi_dot_start": 0.0}
LIMIT = "needs a friction coefficient above mu_max"
JAM = "jams (Painleve's paradox) with mu_slide"
PULLS = "the road pulls, and the wheel would lift off without keep_contact"
Case = tuple[str, str]  # as it is logged, and as it must be, numbers to five digits


def started(library: Library, **values: Value) -> FMU2Wheel:
    return library.wheel(logging=True).start(START, **values)


def ended(library: Library, **values: Value) -> tuple[FMU2Wheel, str]:
    """The wheel, and where its run has ended."""
    w = started(library, **values)
    assert w.step(3.0) == DISCARD
    return w, f"at t = {w.status(LAST_SUCCESSFUL_TIME)} s"


def ends(library: Library) -> Iterator[Case]:
    for values, what in (
        ({**SLIDES["jams"].start, "mu_max": 0.9, "mu_slide": 0.8}, f"{JAM} = 0.8"),
        ({"mu_max": 0.3}, f"{LIMIT} = 0.3"),
    ):
        w, end = ended(library, **values)
        yield w.said(), f"The wheel {what} {end}, theta = {w.get('theta')[0]} rad: the run ends there."
        assert w.step(0.1) == ERROR
        yield w.said(), f"fmi2DoStep: the wheel {what} {end}. Restore a state or reset."
    before = (w := started(library, mu_max=0.3)).serialized()
    for _ in range(100):
        assert w.back(before).step(3.0) == DISCARD
    yield w.texts()[-1], "100 ends were logged; further ones are not logged until a reset."
    assert w.back(before).step(3.0) == DISCARD and w.texts() == []
    assert w.reset() == OK and w.start(START, mu_max=0.3).step(3.0) == DISCARD and len(w.texts()) == 1
    w = library.wheel().initializing(
        J_x=0.1, J_y=0.1, J_z=0.1, theta_start=1.0, slip_y_start=-0.5, mu_max=6.0, mu_slide=5.0
    )
    assert w.exitInitializationMode() == ERROR
    yield w.said(), f"At the start the wheel {JAM} = 5: the run ends there."


def warnings(library: Library) -> Iterator[Case]:
    w, _ = ended(library, **PULLED | {"keep_contact": False})
    lift_off = w.status(LAST_SUCCESSFUL_TIME)
    yield started(library, **PULLED).to(lift_off + 1e-3).said(), f"t = {lift_off} s: {PULLS}."
    said = started(library, **ROLLING).give({"M_brake": (FULL - 20, 200.0)}).to(START + 0.3).said()
    t = float(said.split()[2])
    mu = f"mu_required = {1 + (200 * (t - START) - 20) / FULL:.3g}"
    yield said, f"t = {t} s: {mu}, more than a dry road gives; mu_max = 0 sets no limit."
    for given, used in ((0.1, 1e-4), (1e-16, 1e-13)):
        said = library.wheel().start(START, tolerance=given).said()
        yield said, f"The tolerance {given} is outside [1e-13, 0.0001]; {used} is used."


def friction(library: Library) -> Iterator[Case]:
    """Instants of the reference (physics/test_scenes.py, physics/test_sliding.py)."""
    stick, release = started(library, s=0.03).to(START + 1.4).texts()
    yield stick, f"t = {START + 1.225520636} s: stick, omega_z is held at zero."
    yield release, f"t = {START + 1.329817} s: release, omega_z becomes negative."
    yield started(library, **ROAD).to(START + 0.6).said(), f"t = {START + 0.570827} s: the wheel starts to slide."


def values(library: Library) -> Iterator[Case]:
    """Refused at the end of initialization (test_parameters.py: word for word), or during the run."""
    yield from ((text, text) for _, text, _ in REFUSALS)
    w = started(library, s=0.03, slope=0.1, F_X=3.0, mu_max=0.9)
    carrier = "this input needs guided = true and co-simulation; the value stays 0."
    for name, value, why in (
        ("s", -0.5, "it must be at least 0; the value stays 0.03."),
        ("slope", 1.75, f"it must be less than {pi / 2}; the value stays 0.1."),
        ("F_X", inf, "a finite number is needed; the value stays 3."),
        ("mu_slide", 0.4, "whether the wheel can slide is decided at the start; the value stays 0."),
        ("psi_dot_guide", 0.4, carrier),
    ):
        assert w.set(**{name: value}) == DISCARD
        yield w.said(), f"fmi2SetReal: {name} = {value}: {why}"


def calls(library: Library) -> Iterator[Case]:
    w = library.wheel()

    def answer(function: str, *arguments: object) -> str:
        assert w.ask(function, *arguments) in (DISCARD, ERROR)
        return w.said()

    for experiment, text in (
        ((1, 1e-5, inf, 1, 5.5), "start inf s: it must be finite."),
        ((1, 1e-5, START, 1, 5.5), f"stop 5.5 s: it must not lie before the start, {START} s."),
        ((1, -1e-5, START, 1, 8.5), "tolerance -1e-05: it must be positive."),
        ((1, 0.0, START, 1, 8.5), "tolerance 0: it must be positive."),
    ):
        yield answer("SetupExperiment", *experiment), f"fmi2SetupExperiment: {text}"
    w.start(START, stop=8.5)
    for t, h, text in (
        (START, -0.5, f"from {START} s by -0.5 s: times must be finite and the step not negative."),
        (START, 1e-16, f"from {START} s by 1e-16 s: the step is lost in the rounding of the time."),
        (7.5, 0.1, f"from 7.5 s: the FMU has reached {START} s."),
        (START, 2.0, "to 9.25 s: the stop time is 8.5 s."),
    ):
        yield answer("DoStep", t, h, 0), f"fmi2DoStep {text}"
    w.give({"M_brake": (1.0, 0.0, 0.0, 1e301)})
    text = f"by 0.5 s: M_brake would become {1e301 / 8}: it must be at most 1e+300."
    yield answer("DoStep", START, 0.5, 0), f"fmi2DoStep {text}"
    w.give({"M_brake": (0.0,)})
    theta, force = w.refer("theta"), w.refer("F_X")
    text = "no variable of this type has the value reference 999."
    yield answer("GetReal", [999], 1, [0]), f"fmi2GetReal: {text}"
    rates, inputs = "GetRealOutputDerivatives", "SetRealInputDerivatives"
    yield answer(rates, [999], 1, [1], [0]), f"fmi2{rates}: value reference 999 is not a real output."
    yield answer(rates, theta, 1, [2], [0]), f"fmi2{rates}: order 2 of theta: only the first derivative is provided."
    text = "derivative 4 = 2.5 of F_X: orders 1 to 3 and finite values are allowed."
    yield answer(inputs, force, 1, [4], [2.5]), f"fmi2{inputs}: {text}"
    text = "derivative 1 = 2.5 of psi_dot_guide: this input needs guided = true and co-simulation."
    yield answer(inputs, w.refer("psi_dot_guide"), 1, [1], [2.5]), f"fmi2{inputs}: {text}"
    yield answer("GetRealStatus", 1, [0]), "fmi2GetRealStatus: there is no status of kind 1."
    spin = w.by(0.5).get("omega_z")[0]
    assert w.put(M_3=1e300).step(0.5) == ERROR
    text = (
        f"The solver stopped at t = 7.75 s, where omega_z = {spin:.4g} rad/s, in a step that began with a slip of 0 m/s"
    )
    yield w.said().partition(": extreme")[0] + ".", f"{text}: the step size became too small."
    w, slopes = library.wheel().initializing(J_x=0.75, J_y=0.75, J_z=1e-12), "GetDirectionalDerivative"
    text = f"fmi2{slopes}: no valid initial values near J_x = 0.75 for a derivative."
    yield answer(slopes, theta, 1, w.refer("J_x"), 1, [1], [0]), text


def model_exchange(library: Library) -> Iterator[Case]:
    fast = {"theta_start": 1.2, "psi_dot_start": 0.3, "phi_dot_start": -6.0}
    w = loaded(library).new()
    assert w.put(**fast, mu_max=0.01).initialise(None, START) == ERROR
    N, mu = started(library, **fast).get("lambda_3", "mu_required")
    text = f"At the start the wheel {LIMIT} = 0.01 (N = {N} N, mu_required = {mu}): the run ends there."
    yield w.said(), text
    w = loaded(library).new()
    assert w.put(mu_max=0.5, mu_slide=0.4).initialise(None, START) == ERROR
    yield w.said(), "mu_slide = 0.4: model exchange has no states for a slip and needs 0."
    w = loaded(library).new().start(START)
    w.decide()
    assert w.setTime(inf) == ERROR
    yield w.said(), "fmi2SetTime: inf s: the time must be finite."
    assert w.enterContinuousTimeMode() == OK
    assert w.ask("SetContinuousStates", [0] * 7, 7) == ERROR
    yield w.said(), "fmi2SetContinuousStates: needs an array of 8 numbers, not of 7."
    x = w.x()
    x[5] = 1e200
    w.place(START + 0.5, x)
    assert w.ask("GetDerivatives", [0] * 8, 8) == DISCARD
    yield w.said(), f"fmi2GetDerivatives: at t = {START + 0.5} s the derivatives are not finite."


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


def listed() -> set[str]:
    """Messages of the page with a place for more than the function's name."""
    page = re.sub(r"\n +", " ", (ROOT / "docs" / "messages.md").read_text(encoding="utf-8"))
    return {text for text in re.findall("`([^`]+)`", page) if re.search("….*…|^[^…]+…|^… ", text)}


NUMBER = re.compile(r"-?\b\d+(?:\.\d+)?(?:e[-+]?\d+)?\b")


def same(text: str, expected: str) -> bool:
    """Word for word, and in each number."""
    pairs = zip(NUMBER.findall(text), NUMBER.findall(expected), strict=False)
    return NUMBER.sub("#", text) == NUMBER.sub("#", expected) and all(
        isclose(float(a), float(b), rel_tol=1e-5) for a, b in pairs
    )


def test_every_number_of_every_message_stands_at_its_place_and_no_two_could_be_interchanged(library: Library) -> None:
    page, alike, words = listed(), dict[str, set[tuple[int, int]]](), set()
    for group in (ends, warnings, friction, values, calls, model_exchange):
        for text, expected in group(library):
            assert same(text, expected), (text, expected)
            message = max((each for each in page if re.fullmatch(pattern(each), text)), key=len)
            parts = re.fullmatch(pattern(message), text).groups()
            pairs = {(i, k) for i, k in combinations(range(len(parts)), 2) if parts[i] == parts[k]}
            alike[message] = alike.get(message, pairs) & pairs
            words |= {*parts}
    assert not [message for message, pairs in alike.items() if pairs]
    named = {text for text in page if any(re.fullmatch(pattern(text), word) for word in words)}
    assert page == {*alike} | named | WORDS, "on the left alone: messages without a case"
    assert not same("t = 2 s: 1 N", "t = 1 s: 2 N") and not same("1 N", "1 m")
