"""A solver of fmu-src/solver as Python sees it, through probe.cpp, on problems with closed forms."""

import ctypes
from collections import namedtuple
from ctypes import CFUNCTYPE, POINTER, Structure, c_char_p, c_double, c_int, c_longlong, c_size_t, c_void_p

import numpy as np

METHODS = {"adams": 0, "bdf": 1, "runge_kutta": 2}
PROBLEMS = {  # the state at t = 0
    **{"harmonic": (1.0, 0.0), "stiff": (2.0, 0.0)},
    **{"clock": (0.0,), "explosive": (1.0,), "ending": (1.0,)},
}
STATES = 8  # those beyond the problem's own rest at zero
STEPPED, EVENT, FAILED = range(3)
WATCH = CFUNCTYPE(c_double, c_double, POINTER(c_double))
# Begin of the last step, time known, instant and name of the event; counts since the start.
Progress = namedtuple("Progress", "begin known instant event steps rhs jacobians roots restarts")


class Setting(Structure):
    _fields_ = (
        *(("kind", c_int), ("method", c_int), ("parameter", c_double), ("tolerance", c_double)),
        *(("longest_step", c_double), ("y", c_double * STATES), ("each_step", WATCH), ("by_margin", WATCH)),
        *(("extremes", POINTER(c_double)), ("extreme_count", c_int)),
    )


class Solver:
    """At t = 0. each_step, by_margin: functions of (t, y) that are watched, events 1 and 2; extremes: instants."""

    def __init__(
        self, library, method, problem="harmonic", parameter=0.0, tolerance=1e-8, longest_step=1.0,
        each_step=None, by_margin=None, extremes=(),
    ):  # fmt: skip
        self.library, y = library, PROBLEMS[problem]
        self.states = len(y)
        self.setting = Setting(
            list(PROBLEMS).index(problem), METHODS[method], parameter, tolerance, longest_step, (c_double * STATES)(*y),
            WATCH(each_step or 0), WATCH(by_margin or 0), (c_double * len(extremes))(*extremes), len(extremes),
        )  # fmt: skip
        for name, result in (("new", c_void_p), ("failure", c_char_p), ("save", c_size_t)):
            getattr(library, f"probe_{name}").restype = result
        self.probe = c_void_p(library.probe_new(ctypes.byref(self.setting)))
        self.start()

    def __del__(self):
        self.library.probe_free(self.probe)

    def __getattr__(self, name):
        """A function of probe.cpp that takes numbers alone: start, stop_before, limit_first_step, resume."""
        function = getattr(self.library, f"probe_{name}")
        return lambda *numbers: function(self.probe, *map(c_double, numbers))

    def run(self, t, most=1_000_000):
        """Steps until t is known or something else than a step happens; which."""
        return self.library.probe_run(self.probe, c_double(t), c_longlong(most))

    def step(self):
        return self.run(np.inf, 1)

    def read(self, t):
        y = (c_double * STATES)()
        self.library.probe_read(self.probe, c_double(t), y)
        return y[: self.states]

    def restart(self, t, y):
        self.library.probe_restart(self.probe, c_double(t), (c_double * STATES)(*y))

    @property
    def now(self):
        now = (c_double * len(Progress._fields))()
        self.library.probe_progress(self.probe, now)
        return Progress(*now)

    @property
    def failure(self):
        return self.library.probe_failure(self.probe).decode()

    def save(self):
        bytes_ = ctypes.create_string_buffer(self.library.probe_save(self.probe, None))
        self.library.probe_save(self.probe, bytes_)
        return bytes_.raw

    def restore(self, history):
        return bool(self.library.probe_restore(self.probe, history, c_size_t(len(history))))


def harmonic(t):
    """The solution of the problem of that name."""
    return np.array([np.cos(t), -np.sin(t)])
