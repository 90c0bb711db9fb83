"""Which call is legal in which state: FMI 2.0, transcribed by hand into two tables, not taken from the FMU's sources.

"step in progress" and "step canceled" are left out: a synchronous FMU is never seen in them. "fatal" is never reached.
Every call here has arguments that are sound by themselves, so that the state alone decides.
"""

import csv
from ctypes import CFUNCTYPE, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p, create_string_buffer
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi2 import fmi2EventInfo
from support import driver
from support.driver import DISCARD, ERROR, OK, FMU2Wheel
from support.exchange import INDICATORS


def read(name: str) -> dict[str, set[str]]:
    """The states in which each function is legal."""
    with Path(__file__).with_name(name).open(newline="", encoding="utf-8") as file:
        return {row.pop("function"): {state for state, cross in row.items() if cross} for row in csv.DictReader(file)}


TABLE = read("call_states.csv")  # section 4.2.4
STATES = ("instantiated", "initialization", "step complete", "step failed", "terminated", "error")
EXCHANGE = read("call_states_exchange.csv")  # section 3.2.3, in instances of that kind alone

# What follows the component: pointers raw, as no signature is declared for a slave.
_EXCHANGE_ARGUMENTS = {
    "fmi2NewDiscreteStates": (byref(fmi2EventInfo()),),
    "fmi2CompletedIntegratorStep": (1, byref(c_int()), byref(c_int())),
    "fmi2SetTime": (c_double(1.0),),
    "fmi2SetContinuousStates": ((c_double * 8)(0, 0, 0, 1.2, 0, 0, 0, -2.0), c_size_t(8)),
    **{function: ((c_double * 8)(), c_size_t(8)) for function in EXCHANGE if function.startswith("fmi2Get")},
    "fmi2GetEventIndicators": ((c_double * len(INDICATORS))(), c_size_t(len(INDICATORS))),
}


def bring_to(w: FMU2Wheel, state: str) -> FMU2Wheel:
    """From instantiated to one of STATES; what was logged on the way is dropped."""
    if state == "initialization":
        w.initializing()
    elif state == "step failed":  # a plain drop: flat on the ground after 0.59 s
        assert w.start(theta_start=float(np.radians(75)), phi_dot_start=0.0).step(10.0) == DISCARD
    elif state != "instantiated":
        assert w.start().step_to(0.5) == OK
    if state == "terminated":
        assert w.terminate() == OK
    if state == "error":  # a torque beyond all numbers: the solver gives up
        assert (w.set(M_3=1e300), w.step(0.1)) == (OK, ERROR)
    w.take_messages()
    return w


def call(w: FMU2Wheel, function: str, null: bool = False) -> int:
    """Calls one function of TABLE with sound arguments, inputs at their present value; `null`: on no instance."""
    component = None if null else w.component
    if function not in EXCHANGE:
        return getattr(w, function)(component, *_arguments(w)[function])
    raw = CFUNCTYPE(c_int)((function, w.dll))
    return raw(c_void_p(component), *_EXCHANGE_ARGUMENTS.get(function, ()))


def _arguments(w: FMU2Wheel) -> dict[str, tuple[Any, ...]]:
    """Behind the component: the arguments of every function of co-simulation."""
    force, reaction, count, flag = (
        (c_uint * 1)(w.references[name]) for name in ("F_X", "lambda_3", "n_steps", "keep_contact")
    )
    zero, real, integer, first = (c_double * 1)(0.0), (c_double * 1)(), (c_int * 1)(), (c_int * 1)(1)
    state, blob, size = w.snapshot(), w.serialized(), c_size_t()
    buffer = create_string_buffer(blob, len(blob))
    return {
        "fmi2SetDebugLogging": (1, 0, None),
        "fmi2SetupExperiment": (0, 0.0, 0.0, 0, 0.0),
        **dict.fromkeys(("fmi2EnterInitializationMode", "fmi2ExitInitializationMode"), ()),
        **dict.fromkeys(("fmi2Terminate", "fmi2Reset", "fmi2CancelStep"), ()),
        "fmi2GetReal": (reaction, 1, real),
        "fmi2GetInteger": (count, 1, integer),
        "fmi2GetBoolean": (flag, 1, integer),
        "fmi2SetReal": (force, 1, zero),
        **{f"fmi2{name}": (None, 0, None) for name in ("SetInteger", "SetBoolean", "GetString", "SetString")},
        "fmi2GetFMUstate": (byref(state),),
        "fmi2SetFMUstate": (state,),
        "fmi2FreeFMUstate": (byref(state),),
        "fmi2SerializedFMUstateSize": (state, byref(size)),
        "fmi2SerializeFMUstate": (state, buffer, len(blob)),
        "fmi2DeSerializeFMUstate": (buffer, len(blob), byref(state)),
        "fmi2GetDirectionalDerivative": (reaction, 1, force, 1, zero, real),
        "fmi2SetRealInputDerivatives": (force, 1, first, zero),
        "fmi2GetRealOutputDerivatives": (reaction, 1, first, real),
        "fmi2DoStep": (w.time, 0.0, 0),
        "fmi2GetStatus": (driver.DO_STEP_STATUS, byref(c_int())),
        "fmi2GetRealStatus": (driver.LAST_SUCCESSFUL_TIME, byref(c_double())),
        "fmi2GetIntegerStatus": (driver.DO_STEP_STATUS, byref(c_int())),  # there is none to tell: Discard
        "fmi2GetBooleanStatus": (driver.TERMINATED, byref(c_int())),
        "fmi2GetStringStatus": (driver.PENDING_STATUS, byref(c_char_p())),
    }
