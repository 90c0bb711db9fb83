"""The one driver of the built FMU, for tests and reports: an instance whose every status is seen.

Names, frames and units are those of modelDescription.xml, where the value references are looked up. Built on fmpy's
FMU2Slave, whose ctypes signatures it uses; it returns the status where fmpy would raise.
"""

from collections.abc import Callable, Iterable, Sequence
from copy import copy
from ctypes import byref, c_double, c_int, c_size_t, c_uint, create_string_buffer
from math import comb, factorial
from typing import Any, NamedTuple, Self

import numpy as np
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2FMUstate
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

OK, WARNING, DISCARD, ERROR, FATAL, PENDING = range(6)
DO_STEP_STATUS, PENDING_STATUS, LAST_SUCCESSFUL_TIME, TERMINATED = range(4)
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
CHOICES = {
    "formulation": {"automatic": 1, "reduced": 2, "multibody": 3},
    "friction_law": {"exact": 1, "regularized": 2},
    "method": {"automatic": 1, "adams": 2, "bdf": 3, "runge_kutta": 4},
}
C_TYPES = {"Real": ("Real", c_double), "Boolean": ("Boolean", c_int)}  # all others are read and set as integers

Value = float | str | bool
Values = dict[str, Value]


def shifted(coefficients: Sequence[float], by: float) -> list[float]:
    """The same polynomial about another origin: four coefficients."""
    c = [*coefficients, 0.0, 0.0, 0.0, 0.0][:4]
    return [sum(comb(n, k) * c[n] * by ** (n - k) for n in range(k, 4)) for k in range(4)]


class Message(NamedTuple):
    status: int
    category: str
    text: str


class State(bytes):
    """A serialized state, and the time of the instance that it was taken of."""

    time = 0.0


class FMU2Wheel(FMU2Slave):
    """One instance, or the loaded library of which `new` makes them. Its name starts with FMU2 because fmpy chooses the
    functions to load by that."""

    def __init__(self, folder: str, description: ModelDescription):
        super().__init__(
            guid=description.guid, unzipDirectory=folder, modelIdentifier=description.coSimulation.modelIdentifier
        )
        self.variables = {v.name: v for v in description.modelVariables}
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        outputs = [v for v in description.modelVariables if v.causality in ("output", "local")]
        self.reals = [v.name for v in outputs if v.type == "Real"]
        self.integers = [v.name for v in outputs if v.type == "Integer"]
        self.on_message: Callable[[Message], None] | None = None
        self.time = 0.0

    def new(self, logging: bool = False, name: str = "wheel") -> Self:
        """An instance, instantiated; fmpy looks up the functions once, for all instances."""
        instance = copy(self)
        instance.instanceName, instance.messages = name, []
        instance.instantiate(callbacks=instance.own_callbacks(), loggingOn=logging)
        return instance

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Frees the instance; the library stays loaded."""
        if self.component:
            self.fmi2FreeInstance(self.component)
        self.component = None

    def own_callbacks(self) -> fmi2CallbackFunctions:
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(self.keep_message)
        return callbacks

    def keep_message(self, _: Any, name: bytes, status: int, category: bytes, text: bytes) -> None:
        assert name.decode() == self.instanceName
        self.messages.append(Message(status, category.decode(), text.decode()))
        if self.on_message:
            self.on_message(self.messages[-1])

    def _call(self, fname: str, *args: Any) -> Any:
        return self._functions[fname](*args)

    def take_messages(self) -> list[Message]:
        """What was logged since the last call of this function."""
        messages, self.messages = self.messages, []
        return messages

    def said(self) -> str:
        """The only message since the last call of this function or of take_messages."""
        (message,) = self.take_messages()
        return message.text

    @property
    def sentences(self) -> list[str]:
        """The messages as a user reads them: FMI 2.0 doubles the characters % and #."""
        return [message.text.replace("%%", "%").replace("##", "#") for message in self.messages]

    def start(self, start: float = 0.0, stop: float | None = None, tolerance: float | None = None, **values: Value):
        """From instantiated to the first communication point, all accepted; returns itself."""
        assert self.set(**values) == OK
        assert self.initialise(tolerance, start, stop) in (OK, WARNING)
        return self

    def initialise(
        self,
        tolerance: float | None = None,
        start: float = 0.0,
        stop: float | None = None,
        set_inputs: Callable[[], int] = lambda: OK,
    ) -> int:
        """From instantiated to the first communication point, inputs set on the way: the worst status, or that of the
        first refusal."""
        self.time, worst = start, OK
        calls = (lambda: self.setupExperiment(tolerance, start, stop), self.enterInitializationMode, set_inputs)
        for call in (*calls, self.exitInitializationMode):
            worst = max(worst, call())
            if worst > WARNING:
                break
        return worst

    def initializing(self, **values: Value) -> Self:
        """From instantiated into initialization mode, all accepted; returns itself."""
        assert (self.set(**values), self.setupExperiment(), self.enterInitializationMode()) == (OK, OK, OK)
        return self

    def c_type(self, name: str) -> tuple[str, type]:
        return C_TYPES.get(self.variables[name].type, ("Integer", c_int))

    def c_references(self, names: Sequence[str]) -> Any:
        return (c_uint * len(names))(*(self.references[name] for name in names))

    def set(self, **values: Value) -> int:
        """Values by name, each with the function of its type, a choice by its name or number; the worst status."""
        status = OK
        for name, value in values.items():
            kind, c_type = self.c_type(name)
            number = CHOICES[name][value] if isinstance(value, str) else value
            call = getattr(self, f"fmi2Set{kind}")
            status = max(status, call(self.component, self.c_references([name]), 1, (c_type * 1)(number)))
        return status

    def set_input_derivatives(self, names: Sequence[str], derivatives: Sequence[Sequence[float]]) -> int:
        """derivatives: a row for each order from the first on, a column for each input."""
        count = len(names) * len(derivatives)
        orders = (c_int * count)(*(order + 1 for order in range(len(derivatives)) for _ in names))
        values = (c_double * count)(*(float(value) for row in derivatives for value in row))
        references = self.c_references([*names] * len(derivatives))
        return self.fmi2SetRealInputDerivatives(self.component, references, count, orders, values)

    def get(self, *names: str) -> list[float]:
        """Values by name, each read by its own call."""
        return [self.get_one(name)[1] for name in names]

    def get_one(self, name: str) -> tuple[int, float]:
        kind, c_type = self.c_type(name)
        value = (c_type * 1)()
        call = getattr(self, f"fmi2Get{kind}")
        status = call(self.component, self.c_references([name]), 1, value)
        return status, value[0]

    def reader(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that reads these real variables by one call."""
        values, references = (c_double * len(names))(), self.c_references(names)
        return lambda: (self.fmi2GetReal(self.component, references, len(names), values), list(values))[1]

    def rates(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that reads the first derivatives of these outputs by one call."""
        values, references, orders = (c_double * len(names))(), self.c_references(names), (c_int * len(names))()
        orders[:] = [1] * len(names)
        call = self.fmi2GetRealOutputDerivatives
        return lambda: (call(self.component, references, len(names), orders, values), list(values))[1]

    def jacobian(self, unknowns: Sequence[str], knowns: Sequence[str]) -> NDArray[np.float64]:
        """d unknown / d known, by one directional derivative per known."""
        columns = []
        for known in knowns:
            values = (c_double * len(unknowns))()
            references = self.c_references(unknowns), self.c_references([known])
            call, seed = self.fmi2GetDirectionalDerivative, (c_double * 1)(1)
            assert call(self.component, references[0], len(unknowns), references[1], 1, seed, values) == OK
            columns.append(list(values))
        return np.array(columns).T

    def read(self, names: Sequence[str]) -> bytes:
        """Real variables by one call, as bits."""
        values = (c_double * len(names))()
        assert self.fmi2GetReal(self.component, self.c_references(names), len(names), values) == OK
        return bytes(values)

    def bits(self) -> bytes:
        """Every output and local variable, the counters too."""
        numbers = self.getInteger([self.references[name] for name in self.integers])
        return self.read(self.reals) + bytes((c_int * len(numbers))(*numbers))

    def put(self, **values: Value) -> Self:
        """Values by name, all accepted; returns itself."""
        assert self.set(**values) == OK, self.messages
        return self

    def give(self, inputs: dict[str, Sequence[float]], since: float = 0.0) -> Self:
        """Inputs as polynomials, coefficients of 1, t, t^2, t^3, `since` seconds after their origin; returns itself."""
        table = [shifted(coefficients, since) for coefficients in inputs.values()]
        self.put(**{name: row[0] for name, row in zip(inputs, table, strict=True)})
        orders = [[factorial(k) * row[k] for row in table] for k in (1, 2, 3)]
        assert self.set_input_derivatives([*inputs], orders) == OK
        return self

    def by(self, h: float) -> Self:
        """A step of h, accepted; returns itself."""
        assert self.step(h) == OK, self.messages
        return self

    def to(self, *times: float) -> Self:
        """Steps to each of the times, all accepted; returns itself."""
        for t in times:
            assert self.step_to(t) == OK, self.messages
        return self

    def step(self, h: float) -> int:
        status = self.fmi2DoStep(self.component, self.time, h, 0)
        if status == OK:
            self.time += h
        return status

    def step_to(self, t: float) -> int:
        """To the time t, to the bit where t - time is exact enough to give it back."""
        status = self.fmi2DoStep(self.component, self.time, t - self.time, 0)
        if status <= WARNING:
            self.time = t
        return status

    def run(self, times: Iterable[float]) -> list[bytes]:
        """The bits at each of the times."""
        return [self.to(t).bits() for t in times]

    def snapshot(self) -> fmi2FMUstate:
        state = fmi2FMUstate()
        assert self.fmi2GetFMUstate(self.component, byref(state)) == OK
        return state

    def serialized(self) -> State:
        """The present state as bytes."""
        state, size = self.snapshot(), c_size_t()
        assert self.fmi2SerializedFMUstateSize(self.component, state, byref(size)) == OK
        blob = create_string_buffer(size.value)
        assert self.fmi2SerializeFMUstate(self.component, state, blob, size) == OK
        assert self.fmi2FreeFMUstate(self.component, byref(state)) == OK
        taken = State(blob.raw)
        taken.time = self.time
        return taken

    def restore(self, blob: bytes) -> int:
        """Puts the instance into a serialized state, and its time to that of the state where that is known; the status
        of reading the bytes, or else of setting the state."""
        state = fmi2FMUstate()
        status = self.fmi2DeSerializeFMUstate(self.component, create_string_buffer(blob, len(blob)), len(blob), state)
        assert bool(state) == (status == OK)
        if status != OK:
            return status
        status = self.fmi2SetFMUstate(self.component, state)
        self.fmi2FreeFMUstate(self.component, byref(state))
        self.time = getattr(blob, "time", self.time)
        return status

    def back(self, blob: bytes) -> Self:
        """In a serialized state, accepted; returns itself."""
        assert self.restore(blob) == OK, self.messages
        return self

    def status(self, kind: int) -> Any:
        """fmi2GetStatus, fmi2GetRealStatus or fmi2GetBooleanStatus, whichever answers this kind."""
        call, c_type = {
            DO_STEP_STATUS: (self.fmi2GetStatus, c_int),
            LAST_SUCCESSFUL_TIME: (self.fmi2GetRealStatus, c_double),
            TERMINATED: (self.fmi2GetBooleanStatus, c_int),
        }[kind]
        value = c_type(-1)
        assert call(self.component, kind, byref(value)) == OK
        return value.value
