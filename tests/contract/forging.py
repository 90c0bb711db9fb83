"""Serialized states word by word: changed, with the checksum made right again. Rows as in wheel/snapshot.cpp."""

import re
import struct

import numpy as np
from support.driver import FMU2Wheel, State, Values
from support.paths import ROOT
from support.schedule import play

HEADER = 3  # words: mark, size, checksum of what follows
SUM = HEADER - 1
CREATED, INITIALIZING, FAULTY, INITIAL, AT_START, STEPPING, UNFOLDED, EVENT_MODE, CONTINUOUS_TIME, ENDED = range(10)
RUN = (ROOT / "fmu-src" / "wheel" / "run.hpp").read_text(encoding="utf-8")
EVENTS = re.findall(r"^ *(\w+),", re.search(r"enum class Event\b.*?\};", RUN, re.DOTALL)[0], re.MULTILINE)
SPIN_CHANGES, LOST_CONTACT, FELL_FLAT = map(EVENTS.index, ("spin_changes", "lost_contact", "fell_flat"))
PASSING, STICKING = 2, 3
RUNS: dict[str, tuple[Values, dict[str, tuple[float, ...]]]] = {
    "unfolded": ({}, {}),
    "Runge-Kutta": ({"s": 0.03}, {}),
    "Adams": ({"method": 2}, {}),
    "BDF": ({"method": 3}, {}),
    "regularized": ({"friction_law": 2, "s": 0.03, "omega_s": 1e-3}, {}),
    "multibody, Adams": ({"formulation": 3}, {}),
    "multibody, Runge-Kutta": ({"formulation": 3, "s": 0.03}, {}),
    "multibody, BDF": ({"formulation": 3, "method": 3}, {}),
    "loaded": ({"s": 0.03}, {"M_3": (0.0, 0.5), "F_Z": (1.0, 2.0, 3.0, 4.0)}),
    "braked, Adams": ({"method": 2}, {"M_brake": (1.0, 2.0)}),
    "held": ({"s": 0.2, "theta_start": np.pi / 2, "phi_dot_start": 0.0}, {"M_3": (0.1,)}),
    "contact kept": ({"s": 0.03, "keep_contact": True}, {}),
    "ended": ({"theta_start": 0.3, "phi_dot_start": 0.0}, {}),
}


def saved(wheel, run: str, stop: float = 0.7) -> State:
    start, inputs = RUNS[run]
    w = wheel().start(**start)
    play(w, [(0.0, inputs)], stop, [0.3])
    return w.serialized()


def checksum(data: bytes) -> int:
    """FNV-1a over words of 64 bits with a mixing shift, as support/bytes.hpp has it."""
    total = 0xCBF29CE484222325
    for (word,) in struct.iter_unpack("<Q", data):
        total = (total ^ word) * 0x100000001B3 % 2**64
        total ^= total >> 29
    return total


def words_of(blob: bytes) -> tuple[int, ...]:
    return struct.unpack(f"<{len(blob) // 8}Q", blob)


def signed(words) -> bytes:
    """The bytes of these words with the checksum right."""
    body = struct.pack(f"<{len(words) - HEADER}Q", *words[HEADER:])
    return struct.pack("<3Q", *words[:SUM], checksum(body)) + body


def as_word(x: float) -> int:
    """A double as it is stored; a whole number is one."""
    return struct.unpack("<Q", struct.pack("<d", x))[0] if isinstance(x, float) else x


def place_of(w: FMU2Wheel, row: str) -> int:
    """The word of a row of the table in wheel/snapshot.cpp."""
    parameters, inputs = w.references["F_X"], 7 * 4
    after = HEADER + parameters
    stop, asked = after + 1, after + 3
    phase = asked + inputs + 2
    of_phase = ("phase", "ended by", "s", "mu_max", "law", "sigma", "layer", "contact", "origin")
    t = phase + len(of_phase) + inputs
    of_events = t + 15  # for each: whether it lies below zero, how often it occurred, when it last did
    contact, flat, transitions = (of_events + 3 * event for event in (LOST_CONTACT, FELL_FLAT, len(EVENTS)))
    places = {"stop time": stop, "tolerance": stop + 1, "slope asked": asked + 1, "kind": phase - 2}
    places |= {name: phase + k for k, name in enumerate(of_phase)}
    places |= {"t": t, "last change": t + 1, "grip due": t + 2, "transitions": transitions}
    places |= {f"y {k}": t + 3 + k for k in range(4)}
    places |= {"below": contact, "pulls": contact + 1, "below flat": flat, "times flat": flat + 1}
    return (places | {f"count {k}": transitions + k for k in range(6)})[row]


def forged(w: FMU2Wheel, blob: bytes, **changes: int | float) -> bytes:
    """The blob with rows changed, whole numbers or doubles, and its checksum set right."""
    words = list(words_of(blob))
    for row, value in changes.items():
        words[place_of(w, row.replace("_", " "))] = as_word(value)
    return signed(words)
