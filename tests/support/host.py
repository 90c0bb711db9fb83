"""A host with another floating-point environment than the default: traps, a rounding mode, flush to zero.

The environment is set for a call of the FMU alone, and for the logger that it calls; Python runs in the default one.
"""

import ctypes
import platform
from collections.abc import Callable
from copy import copy
from typing import Any

from wheelfmu.fmu.driver import FMU2Wheel

LIBM = ctypes.CDLL("libm.so.6")
LIBM.fdim.restype = ctypes.c_double
Words = ctypes.c_uint32 * 16  # fenv_t, and room to spare
# Of fenv_t: the word with the mode of rounding, and in it flush to zero, the unit of the rounding modes, and the flags
# of what has happened, which are no part of the environment here.
WORD, FLUSH, ROUNDING, FLAGS = {"x86_64": (7, 0x8040, 0x400, 0x3F), "aarch64": (0, 1 << 24, 1 << 22, 0)}[
    platform.machine()
]
INVALID, DIVISION, OVERFLOW = {"x86_64": (1, 4, 8), "aarch64": (1, 2, 4)}[platform.machine()]


def trap() -> None:
    LIBM.feenableexcept(INVALID | DIVISION | OVERFLOW)


def flush_to_zero() -> None:
    words = present()
    words[WORD] |= FLUSH
    LIBM.fesetenv(words)


HOSTS: dict[str, Callable[[], Any]] = {
    "traps": trap,
    "downward": lambda: LIBM.fesetround(ROUNDING * (1 if platform.machine() == "x86_64" else 2)),
    "upward": lambda: LIBM.fesetround(ROUNDING * (2 if platform.machine() == "x86_64" else 1)),
    "toward zero": lambda: LIBM.fesetround(ROUNDING * 3),
    "flush to zero": flush_to_zero,
}


def present() -> Any:
    words = Words()
    LIBM.fegetenv(words)
    return words


def controls() -> tuple[int, int, int]:
    """Rounding and traps of both units, flush to zero."""
    return LIBM.fegetround(), LIBM.fegetexcept(), present()[WORD] & ~FLAGS


class Host:
    """Calls every function of the library from `environment`. `changed`: what did not leave it as it was."""

    def __init__(self, loaded: FMU2Wheel, environment: Callable[[], Any]) -> None:
        self.environment, self.changed, self.heard = environment, [], 0
        self.library = copy(loaded)
        self.library._functions = {name: self.around(name, call) for name, call in loaded._functions.items()}
        self.library.on_message = self.hear

    def around(self, name: str, call: Any) -> Any:
        def hosted(*arguments: Any) -> Any:
            own = present()
            self.environment()
            self.controls = controls()
            try:
                return call(*arguments)
            finally:
                self.compare(name)
                LIBM.fesetenv(own)

        hosted.argtypes = call.argtypes
        return hosted

    def hear(self, _message: Any) -> None:
        self.heard += 1
        self.compare("logger")

    def compare(self, name: str) -> None:
        if controls() != self.controls:
            self.changed.append(name)
