"""The one driver of the built FMU, for tests and reports: an instance of either kind whose every status is seen.

Names, frames and units are those of modelDescription.xml, where the value references are looked up. The ctypes
signatures are those of fmpy; the status is returned where fmpy would raise.
"""

from collections.abc import Callable, Iterable, Sequence
from contextlib import AbstractContextManager
from copy import copy
from ctypes import byref, c_char, c_double, c_int, c_size_t
from math import comb, factorial
from typing import Any, NamedTuple, Self

import numpy as np
from fmpy.fmi2 import FMU2Model, FMU2Slave, fmi2CallbackFunctions, fmi2EventInfo, fmi2FMUstate
from fmpy.fmi2 import fmi2CallbackLoggerTYPE as Logger
from fmpy.model_description import ModelDescription
from numpy.typing import NDArray

MODEL_EXCHANGE, CO_SIMULATION = range(2)
OK, WARNING, DISCARD, ERROR, FATAL = range(5)
DO_STEP_STATUS, PENDING_STATUS, LAST_SUCCESSFUL_TIME, TERMINATED = range(4)
HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
CHOICES = {"formulation": {"automatic": 1, "reduced": 2, "multibody": 3}}
CHOICES |= {"friction_law": {"exact": 1, "regularized": 2}}
CHOICES |= {"method": {"automatic": 1, "adams": 2, "bdf": 3, "runge_kutta": 4}}
STATES = ("X_O", "Y_O", "psi", "theta", "phi", "theta_dot", "psi_dot", "omega_z")
DERIVATIVES = ("X_O_dot", "Y_O_dot", "psi_dot", "theta_dot", "phi_dot", "theta_ddot", "psi_ddot", "omega_z_dot")
INDICATORS = ("spin_changes", "lost_grip", "lost_contact", "lies_flat")  # the first of the events of model exchange

Array = NDArray[np.float64]
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


def as_array(pointer: Any, argument: Any) -> Any:
    """A sequence as an array of the type that is pointed to, bytes as they are; all else unchanged."""
    if isinstance(argument, bytes):
        return (c_char * len(argument)).from_buffer_copy(argument)
    if isinstance(argument, list | tuple | np.ndarray):
        return (pointer._type_ * len(argument))(*argument)
    return argument


class FMU2Wheel(FMU2Slave, FMU2Model, AbstractContextManager):
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
        self.indicator_count = description.numberOfEventIndicators
        self.messages: list[Message] = []
        self.component: int | None = None
        self.on_message: Callable[[Message], None] | None = None
        self.kind, self.time = CO_SIMULATION, 0.0

    def new(self, logging: bool = False, name: str = "wheel") -> Self:
        """An instance of `kind`, instantiated; fmpy looks up the functions once, for all instances."""
        instance = copy(self)
        instance.instanceName, instance.messages = name, []
        instance.callbacks = fmi2CallbackFunctions(logger=Logger(instance.keep_message))
        arguments = name.encode(), self.kind, self.guid.encode(), None, byref(instance.callbacks), 0, logging
        instance.component = self.fmi2Instantiate(*arguments)
        assert instance.component, instance.messages
        return instance

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Frees the instance; the library stays loaded."""
        if self.component:
            self.fmi2FreeInstance(self.component)
        self.component = None

    def keep_message(self, _: Any, name: bytes, status: int, category: bytes, text: bytes) -> None:
        assert name.decode() == self.instanceName
        self.messages.append(Message(status, category.decode(), text.decode()))
        if self.on_message:
            self.on_message(self.messages[-1])

    def _call(self, fname: str, *args: Any) -> Any:
        return self._functions[fname](*args)

    def ask(self, function: str, *arguments: Any) -> int:
        """The status of fmi2`function` on this instance; sequences become the arrays that it takes."""
        called = self._functions[f"fmi2{function}"]
        return called(self.component, *map(as_array, called.argtypes[1:], arguments))

    def take_messages(self) -> list[Message]:
        """What was logged since the last call of this function."""
        messages, self.messages = self.messages, []
        return messages

    def texts(self) -> list[str]:
        """Those of take_messages."""
        return [message.text for message in self.take_messages()]

    def said(self) -> str:
        """The only message since the last call of this function or of take_messages."""
        (text,) = self.texts()
        return text

    @property
    def sentences(self) -> list[str]:
        """The messages as a user reads them: FMI 2.0 doubles the characters % and #."""
        return [message.text.replace("%%", "%").replace("##", "#") for message in self.messages]

    def start(self, start: float = 0.0, stop: float | None = None, tolerance: float | None = None, **values: Value):
        """From instantiated to the first communication point, all accepted; returns itself."""
        assert self.set(**values) == OK
        assert self.initialise(tolerance, start, stop) in (OK, WARNING)
        return self

    def initialise(self, tolerance=None, start=0.0, stop=None, set_inputs=lambda: OK) -> int:
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

    def refer(self, *names: str) -> list[int]:
        """The value references."""
        return [self.references[name] for name in names]

    def type_of(self, name: str) -> str:
        """Real, Integer or Boolean."""
        return self.variables[name].type

    def set(self, **values: Value) -> int:
        """Values by name, each with the function of its type, a choice by its name or number; the worst status."""
        status = OK
        for name, value in values.items():
            number = CHOICES[name][value] if isinstance(value, str) else value
            status = max(status, self.ask(f"Set{self.type_of(name)}", self.refer(name), 1, [number]))
        return status

    def set_input_derivatives(self, names: Sequence[str], derivatives: Sequence[Sequence[float]]) -> int:
        """derivatives: a row for each order from the first on, a column for each input."""
        orders = [order + 1 for order in range(len(derivatives)) for _ in names]
        values = [float(value) for row in derivatives for value in row]
        return self.ask("SetRealInputDerivatives", self.refer(*names) * len(derivatives), len(values), orders, values)

    def get(self, *names: str) -> list[float]:
        """Values by name, each read by its own call."""
        return [self.get_one(name)[1] for name in names]

    def get_one(self, name: str) -> tuple[int, float]:
        kind = self.type_of(name)
        value = (c_double if kind == "Real" else c_int)()
        return self.ask(f"Get{kind}", self.refer(name), 1, byref(value)), value.value

    def reader(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that reads these real variables by one call."""
        references = self.refer(*names)
        return lambda: self.getReal(references)

    def rates(self, names: Sequence[str]) -> Callable[[], list[float]]:
        """A function that reads the first derivatives of these outputs by one call."""
        references = self.refer(*names)
        return lambda: self.getRealOutputDerivatives(references, [1] * len(references))

    def jacobian(self, unknowns: Sequence[str], knowns: Sequence[str]) -> Array:
        """d unknown / d known, by one directional derivative per known."""
        columns = []
        for known in knowns:
            values = (c_double * len(unknowns))()
            arguments = self.refer(*unknowns), len(unknowns), self.refer(known), 1, [1.0], values
            assert self.ask("GetDirectionalDerivative", *arguments) == OK
            columns.append(list(values))
        return np.array(columns).T

    def read(self, names: Sequence[str]) -> bytes:
        """Real variables by one call, as bits."""
        values = (c_double * len(names))()
        assert self.ask("GetReal", self.refer(*names), len(names), values) == OK
        return bytes(values)

    def bits(self) -> bytes:
        """Every output and local variable, the counters too."""
        numbers = self.getInteger(self.refer(*self.integers))
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
        status = self.ask("DoStep", self.time, h, 0)
        if status == OK:
            self.time += h
        return status

    def step_to(self, t: float) -> int:
        """To the time t, to the bit where t - time is exact enough to give it back."""
        status = self.ask("DoStep", self.time, t - self.time, 0)
        if status <= WARNING:
            self.time = t
        return status

    def run(self, times: Iterable[float]) -> list[bytes]:
        """The bits at each of the times."""
        return [self.to(t).bits() for t in times]

    def snapshot(self) -> fmi2FMUstate:
        state = fmi2FMUstate()
        assert self.ask("GetFMUstate", byref(state)) == OK
        return state

    def free(self, state: fmi2FMUstate) -> None:
        assert self.ask("FreeFMUstate", byref(state)) == OK and not state

    def serialized(self) -> State:
        """The present state as bytes."""
        state, size = self.snapshot(), c_size_t()
        assert self.ask("SerializedFMUstateSize", state, byref(size)) == OK
        blob = (c_char * size.value)()
        assert self.ask("SerializeFMUstate", state, blob, size) == OK
        self.free(state)
        taken = State(blob.raw)
        taken.time = self.time
        return taken

    def restore(self, blob: bytes) -> int:
        """Puts the instance into a serialized state, and its time to that of the state where that is known; the status
        of reading the bytes, or else of setting the state."""
        state = fmi2FMUstate()
        status = self.ask("DeSerializeFMUstate", blob, len(blob), byref(state))
        assert bool(state) == (status == OK)
        if status != OK:
            return status
        status = self.ask("SetFMUstate", state)
        self.free(state)
        self.time = getattr(blob, "time", self.time)
        return status

    def back(self, blob: bytes) -> Self:
        """In a serialized state, accepted; returns itself."""
        assert self.restore(blob) == OK, self.messages
        return self

    def status(self, kind: int) -> Any:
        """fmi2GetStatus, fmi2GetRealStatus or fmi2GetBooleanStatus, whichever answers this kind."""
        value = c_double() if kind == LAST_SUCCESSFUL_TIME else c_int()
        call = {DO_STEP_STATUS: "", LAST_SUCCESSFUL_TIME: "Real", TERMINATED: "Boolean"}[kind]
        assert self.ask(f"Get{call}Status", kind, byref(value)) == OK
        return value.value

    # Model exchange: vectors in the order of STATES, DERIVATIVES and INDICATORS; events that are added come last.

    def vector(self, what: str, size: int = len(STATES)) -> Array:
        values = (c_double * size)()
        assert self.ask(f"Get{what}", values, size) == OK
        return np.array(values)

    def x(self) -> Array:
        return self.vector("ContinuousStates")

    def derivatives(self) -> Array:
        return self.vector("Derivatives")

    def indicators(self) -> Array:
        return self.vector("EventIndicators", self.indicator_count)

    def indicator(self, event: str) -> float:
        return float(self.indicators()[INDICATORS.index(event)])

    def place(self, t: float, x: Array) -> None:
        assert self.ask("SetTime", t) == self.ask("SetContinuousStates", x, len(x)) == OK

    def decide(self) -> fmi2EventInfo:
        """One pass of the event mode, which is enough."""
        info = fmi2EventInfo()
        assert self.ask("NewDiscreteStates", byref(info)) == OK
        assert not info.newDiscreteStatesNeeded
        return info

    def event(self) -> fmi2EventInfo:
        """Into event mode, and out of it unless the model ends."""
        assert self.enterEventMode() == OK
        info = self.decide()
        if not info.terminateSimulation:
            assert self.enterContinuousTimeMode() == OK
        return info

    def wants_event(self) -> bool:
        return self.completedIntegratorStep()[0]
