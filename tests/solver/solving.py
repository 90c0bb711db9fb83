"""A solver of fmu-src/solver as Python sees it, through probe.cpp, on problems with closed forms."""

import ctypes
from collections import namedtuple
from copy import copy
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_longlong, c_void_p

import numpy as np

METHODS = {"adams": 0, "bdf": 1, "runge_kutta": 2, "collocation": 3}
# The state at t = 0.
PROBLEMS = {"harmonic": (1.0, 0.0), "clock": (0.0,), "explosive": (1.0,), "ending": (1.0,), "wave": (0.0,)}
PROBLEMS |= {"settling": (0.0, 0.0, 1.0, 0.0), "falling": (1.0, 0.0, 1.0, 0.0), "steep": (0.0, 0.0, 1.0, 0.0)}
STATES = 8  # those beyond the problem's own rest at zero
STEPPED, EVENT, FAILED = range(3)
WATCH = CFUNCTYPE(c_double, c_double, POINTER(c_double))
# Begin of the last step, time known; counts since the start; which function fell last.
Progress = namedtuple("Progress", "begin known steps rhs roots fallen")
EACH_STEP, LATER_LISTED, QUICK = 1, 2, 3


class Setting(Structure):
    _fields_ = (
        *(("kind", c_int), ("method", c_int), ("tolerance", c_double)),
        *(("longest_step", c_double), ("y", c_double * STATES)),
        *((name, WATCH) for name in ("watched", "later_listed", "quick")),
        *(("extremes", POINTER(c_double)), ("extreme_count", c_int)),
    )


class Solver:
    """At t = 0. each_step, later_listed, quick: watched functions of (t, y), in this order; extremes: instants."""

    def __init__(
        self, library, method, problem="harmonic", tolerance=1e-8, longest_step=1.0, each_step=None, extremes=(),
        later_listed=None, quick=None,
    ):  # fmt: skip
        self.library, y = library, PROBLEMS[problem]
        self.states = len(y)
        self.setting = Setting(
            list(PROBLEMS).index(problem), METHODS[method], tolerance, longest_step, (c_double * STATES)(*y),
            *(WATCH(function or 0) for function in (each_step, later_listed, quick)),
            (c_double * len(extremes))(*extremes), len(extremes),
        )  # fmt: skip
        for name, result in (("new", c_void_p), ("failure", c_char_p)):
            getattr(library, f"probe_{name}").restype = result
        self.probe = c_void_p(library.probe_new(ctypes.byref(self.setting)))

    def __del__(self):
        self.library.probe_free(self.probe)

    def run(self, t, most=1_000_000):
        """Steps until t is known or something else than a step happens; which."""
        return self.library.probe_run(self.probe, c_double(t), c_longlong(most))

    def step(self):
        return self.run(np.inf, 1)

    def read(self, t):
        y = (c_double * STATES)()
        self.library.probe_read(self.probe, c_double(t), y)
        return y[: self.states]

    def limit_first_step(self, dt):
        self.library.probe_limit_first_step(self.probe, c_double(dt))

    def resume(self):
        """After an event that changes nothing."""
        self.library.probe_resume(self.probe)

    def restart(self, t, y):
        self.library.probe_restart(self.probe, c_double(t), (c_double * STATES)(*y))

    def copied(self):
        """Another solver of the same setting with this one's history, by way of bytes."""
        other = copy(self)
        other.probe = c_void_p(self.library.probe_new(ctypes.byref(self.setting)))
        assert self.library.probe_copy(self.probe, other.probe)
        return other

    @property
    def now(self):
        now = (c_double * len(Progress._fields))()
        self.library.probe_progress(self.probe, now)
        return Progress(*now)

    @property
    def failure(self):
        return self.library.probe_failure(self.probe).decode()


def harmonic(t):
    """The solution of the problem of that name."""
    return np.array([np.cos(t), -np.sin(t)])
