"""A host that changes one bit of its floating-point environment: a flush alone, a rounding or a trap of one unit alone,
the x87's precision; between any two calls, or in its logger. Bits and messages stay; each call leaves what it found.
"""

import ctypes
import gc
import os
import platform
import signal
from collections.abc import Callable, Iterator
from copy import copy
from ctypes import c_double
from itertools import repeat

import numpy as np
import pytest
from contract.test_two_conditions import MEETINGS, started, steps

from wheelfmu.fmu.driver import OK, WARNING, FMU2Wheel, Values
from wheelfmu.truth.exchange import loaded
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import FORCED, KINDS
from wheelfmu.truth.sliding import SLIDES

LIBM = ctypes.CDLL("libm.so.6")
for function in (LIBM.fdim, LIBM.exp, LIBM.log, LIBM.sqrt):
    function.restype = c_double
Mode = tuple[int, ...]  # control words
TRAPS = ("invalid", "denormal", "division by zero", "overflow", "underflow", "inexact")

if platform.machine() == "x86_64":
    LAYOUT = (ctypes.c_uint16, ctypes.c_uint16, ctypes.c_uint32)  # femode_t: the x87's word, none, that of SSE
    RELEVANT = (0xF3F, 0, 0xFFC0)  # all but the flags of what has happened
    BITS: dict[str, Callable[[Mode], Mode]] = {
        "results to zero": lambda now: (now[0], 0, now[2] | 0x8000),
        "operands to zero": lambda now: (now[0], 0, now[2] | 0x40),
        "x87: 24 bits": lambda now: (now[0] & ~0x300, 0, now[2]),
        "x87: 53 bits": lambda now: (now[0] & ~0x300 | 0x200, 0, now[2]),
    }
    for _k, _way in enumerate(("downward", "upward", "toward zero"), 1):
        BITS[_way] = lambda now, k=_k: (now[0], 0, now[2] | 0x2000 * k)
        BITS[f"x87: {_way}"] = lambda now, k=_k: (now[0] | 0x400 * k, 0, now[2])
    for _k, _trap in enumerate(TRAPS):
        BITS[f"trap: {_trap}"] = lambda now, k=_k: (now[0], 0, now[2] & ~(0x80 << k))
        BITS[f"x87: trap: {_trap}"] = lambda now, k=_k: (now[0] & ~(1 << k), 0, now[2])
elif platform.machine() == "aarch64":
    LAYOUT, RELEVANT = (ctypes.c_uint32,), (0x7C09F00,)
    BITS = {"to zero": lambda now: (now[0] | 1 << 24,), "default NaN": lambda now: (now[0] | 1 << 25,)}
    for _k, _way in enumerate(("upward", "downward", "toward zero"), 1):
        BITS[_way] = lambda now, k=_k: (now[0] | k << 22,)
    for _place, _trap in zip((8, 15, 9, 10, 11, 12), TRAPS, strict=True):
        BITS[f"trap: {_trap}"] = lambda now, place=_place: (now[0] | 1 << place,)
else:
    pytest.skip(f"the control words of {platform.machine()} are not known here", allow_module_level=True)


class Words(ctypes.Structure):
    """femode_t."""

    _fields_ = [(f"word_{k}", kind) for k, kind in enumerate(LAYOUT)]  # noqa: RUF012


def present() -> Mode:
    words = Words()
    LIBM.fegetmode(ctypes.byref(words))
    return tuple(getattr(words, name) & relevant for (name, _), relevant in zip(Words._fields_, RELEVANT, strict=True))


def enter(mode: Mode) -> None:
    LIBM.feclearexcept(0x3F if platform.machine() == "x86_64" else 0x9F)  # what has happened would trap at once
    LIBM.fesetmode(ctypes.byref(Words(*mode)))


DEFAULT = present()
MODES = {name: bit(DEFAULT) for name, bit in BITS.items()}


def has(name: str) -> bool:
    """Whether this processor has the bit: some have no traps."""
    enter(MODES[name])
    found = present()
    enter(DEFAULT)
    return found == MODES[name]


@pytest.fixture
def mode(request: pytest.FixtureRequest) -> Mode:
    if not has(request.param):
        pytest.skip(f"this processor cannot be set to '{request.param}'")
    return MODES[request.param]


each_mode = pytest.mark.parametrize("mode", MODES, indirect=True)


@pytest.fixture(autouse=True)
def nothing_collected() -> Iterator[None]:
    """Python's collector calls functions that compute, and would run while a trap is set."""
    gc.disable()
    yield
    gc.enable()


class Host:
    """Makes each call of the library, and hears each message, in the next of the modes, which each must leave as it
    was. `in_logger`: the logger changes it, and the rest of the call leaves what the logger has left."""

    def __init__(self, library: FMU2Wheel, modes: Iterator[Mode], in_logger: bool = False) -> None:
        self.modes, self.in_logger, self.changed, self.heard = modes, in_logger, [], 0
        self.library = copy(library)
        self.library._functions = {name: self.around(name, call) for name, call in library._functions.items()}
        self.library.on_message = self.hear

    def around(self, name: str, call: Callable[..., int]) -> Callable[..., int]:
        def hosted(*arguments: object) -> int:
            self.now = next(self.modes)
            enter(self.now)
            status = call(*arguments)
            found = present()
            enter(DEFAULT)
            self.changed += [name] * (found != self.now)
            return status

        hosted.argtypes = call.argtypes
        return hosted

    def hear(self, _message: object) -> None:
        found = present()
        self.heard += 1
        self.changed += ["logger"] * (found != self.now)
        if self.in_logger:
            self.now = next(self.modes)
            enter(self.now)


STARTS: dict[str, Values] = {name: KINDS[name] for name in ("free", "sliding, stiff law", "multibody, bdf", "adams")}
STARTS |= {"tiny": {"X_O_start": 1e-310, "psi_dot_start": -1e-310, "Y_O_start": 3e-308}}
STARTS |= {"refused": {"m": -1 / 3, "omega_s": -0.1}, "ends": {"mu_max": 0.45, "s": 1e-310}}
SCENES = KINDS | {f"slides: {name}": scene.start for name, scene in SLIDES.items()}
SCENES |= {str(kind): {**kind, "s": 0.02, "M_brake": 0.5} for kind in FORCED}
SCENES |= {"weightless": {"g": 0.0, "s": 0.01, "M_3": 4.0, "F_Z": -9.0, "keep_contact": True}}
KNOWNS, UNKNOWNS = ("M_2", "F_Y"), ("lambda_1", "psi_ddot", "X_O", "mu_required")


def co_simulation(w: FMU2Wheel, values: Values) -> list[object]:
    """All that is answered to every function, with inputs on the way."""
    w.set(**values)
    seen: list[object] = [w.setupExperiment(1e-3 / 3, 1 / 3, 1e3), w.enterInitializationMode()]
    seen += [w.get_one("lambda_1"), w.exitInitializationMode(), w.set(F_X=1e-310, F_Y=1 / 3, M_3=-4 / 3)]
    w.time = 1 / 3
    for t in (0.7, 1.1, 1.6) if seen[3] == OK else ():
        seen += [w.step_to(t), w.bits(), w.rates(("lambda_2", "v_y"))(), w.get("X_O", "psi_dot")]
        seen += [bytes(w.jacobian(UNKNOWNS, KNOWNS)), w.set_input_derivatives(("M_1",), ((1e-309,),))]
        if seen[-6] > WARNING:
            break
    return [*seen, w.serialized(), w.texts()]


def exchanged(w: FMU2Wheel, values: Values) -> list[object]:
    w.set(**values)
    seen: list[object] = [w.initialise()]
    if seen[0] <= WARNING:
        seen += [w.decide().terminateSimulation, w.enterContinuousTimeMode()]
        for t in (0.1, 0.2):
            w.place(t, w.x() + 0.01 * w.derivatives())
            seen += [bytes(w.derivatives()), bytes(w.indicators()), w.bits(), bytes(w.jacobian(UNKNOWNS, KNOWNS))]
        seen += [w.event().terminateSimulation]
    return [*seen, w.serialized(), w.texts()]


def answers(slave: FMU2Wheel, master: FMU2Wheel, starts: dict[str, Values] = STARTS) -> list[list[object]]:
    seen = []
    for values in starts.values():
        for loaded_library, way in ((slave, co_simulation), (master, exchanged)):
            with loaded_library.new(logging=True) as w:
                seen.append(way(w, values))
    return seen


def hosted(
    library: Library, modes: Iterator[Mode], in_logger: bool = False, starts: dict[str, Values] = STARTS
) -> list[list[object]]:
    """The answers in these modes, which are left as they are."""
    hosts = [Host(each, modes, in_logger) for each in (library.loaded, loaded(library))]
    found = answers(*(host.library for host in hosts), starts)
    assert [host.changed for host in hosts] == [[], []]
    assert sum(host.heard for host in hosts) > 10
    return found


@pytest.fixture(scope="module")
def plain(library: Library) -> list[list[object]]:
    return answers(library.loaded, loaded(library))


@each_mode
def test_no_bit_of_the_hosts_environment_changes_an_answer_or_is_changed(library: Library, plain, mode: Mode) -> None:
    """A trap that strikes would end this process."""
    assert hosted(library, repeat(mode)) == plain


def changing(seed: int) -> Iterator[Mode]:
    """Every other mode is the default one: what a call has given back must not come back later."""
    random, modes = np.random.default_rng(seed), [DEFAULT] + [MODES[name] for name in MODES if has(name)]
    while True:
        yield modes[random.integers(len(modes))]
        yield DEFAULT if random.random() < 0.5 else modes[random.integers(len(modes))]


@pytest.mark.parametrize("in_logger", [False, True], ids=["between calls", "in the logger too"])
@pytest.mark.parametrize("seed", range(3))
def test_an_environment_that_changes_all_the_time_changes_no_answer(library, plain, seed: int, in_logger: bool) -> None:
    assert hosted(library, changing(seed), in_logger) == plain


def test_in_no_scene_it_does(library: Library) -> None:
    here = answers(library.loaded, loaded(library), SCENES)
    assert all(hosted(library, changing(seed), starts=SCENES) == here for seed in range(5))


@pytest.mark.parametrize(
    "name", ["a slip, a stiff law, a brake", "a pull, a slip, a cubic", "a cubic, BDF, regularized"]
)
def test_a_state_saved_in_one_environment_goes_on_in_others(library: Library, name: str) -> None:
    meeting, host = MEETINGS[name], Host(library.loaded, changing(7))
    with library.wheel(logging=True) as w, host.library.new(logging=True) as other:
        times = [0.05 * k for k in range(1, 13)]
        expected = steps(started(w, meeting), meeting, times)
        started(other, meeting)
        seen = []
        for k in range(0, 12, 3):
            seen += steps(other.back(other.serialized()), meeting, times[k : k + 3])
        assert seen == expected and host.changed == []


# ---- the partner: every bit that the processor has acts on this process ----

LEAST = 2.2250738585072014e-308  # the least normal number
STRIKES = {
    "invalid": lambda: LIBM.sqrt(c_double(-1.0)),
    "denormal": lambda: LIBM.fdim(c_double(5e-324), c_double(0.0)),
    "division by zero": lambda: LIBM.log(c_double(0.0)),
    "overflow": lambda: LIBM.exp(c_double(1000.0)),
    "underflow": lambda: LIBM.exp(c_double(-1000.0)),
    "inexact": lambda: LIBM.fdim(c_double(1.0), c_double(1e-30)),
}


def computed() -> list[object]:
    """Differences of numbers, of which some are denormal; and a third as text, which glibc rounds by the x87's word."""
    pairs = ((1.0, 1e-30), (1.0, -1e-30), (5e-324, 0.0), (1.5 * LEAST, LEAST))
    texts = []
    for number in (1 / 3, 2 / 3):
        text = ctypes.create_string_buffer(32)
        LIBM.snprintf(text, ctypes.c_size_t(32), b"%.3g", c_double(number))
        texts.append(text.value)
    return [*(LIBM.fdim(c_double(a), c_double(b)) for a, b in pairs), *texts]


@each_mode
def test_the_bit_acts(request: pytest.FixtureRequest, mode: Mode) -> None:
    name, here = request.node.callspec.params["mode"], computed()
    if "trap: " not in name:
        enter(mode)
        found, kept = computed(), present()
        enter(DEFAULT)
        assert kept == mode
        assert found != here or "NaN" in name or "bits" in name  # of those the word alone is seen
    elif "x87" not in name:
        child = os.fork()
        if child == 0:
            signal.signal(signal.SIGFPE, signal.SIG_DFL)
            enter(mode)
            STRIKES[name.removeprefix("trap: ")]()
            os._exit(0)
        assert os.WTERMSIG(os.waitpid(child, 0)[1]) == signal.SIGFPE
