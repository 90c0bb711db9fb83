"""Which call is legal in which state: FMI 2.0, section 4.2.4, transcribed by hand and not taken from the FMU's sources.

"step in progress" and "step canceled" are left out: a synchronous FMU is never seen in them. "fatal" is never reached.
Every call here has arguments that are sound by themselves, so that the state alone decides.
"""

from ctypes import CFUNCTYPE, byref, c_char_p, c_double, c_int, c_size_t, c_uint, c_void_p, create_string_buffer
from typing import Any

import numpy as np
from fmpy.fmi2 import fmi2EventInfo
from support import driver
from support.driver import DISCARD, ERROR, OK, FMU2Wheel

STATES = ("instantiated", "initialization", "step complete", "step failed", "terminated", "error")

_EVERYWHERE = set(STATES)
_READING = {"initialization", "step complete", "step failed", "terminated", "error"}
_SETTING = {"instantiated", "initialization", "step complete"}
_STATUS = {"step complete", "step failed", "terminated"}

TABLE: dict[str, set[str]] = {
    "fmi2SetDebugLogging": _EVERYWHERE,
    "fmi2SetupExperiment": {"instantiated"},
    "fmi2EnterInitializationMode": {"instantiated"},
    "fmi2ExitInitializationMode": {"initialization"},
    "fmi2Terminate": {"step complete", "step failed"},
    "fmi2Reset": _EVERYWHERE,
    **{f"fmi2Get{kind}": _READING for kind in ("Real", "Integer", "Boolean", "String")},
    **{f"fmi2Set{kind}": _SETTING for kind in ("Real", "Integer", "Boolean", "String")},
    **{f"fmi2{verb}FMUstate": _EVERYWHERE for verb in ("Get", "Set", "Free", "Serialize", "DeSerialize")},
    "fmi2SerializedFMUstateSize": _EVERYWHERE,
    "fmi2GetDirectionalDerivative": _READING,
    "fmi2SetRealInputDerivatives": _SETTING,
    "fmi2GetRealOutputDerivatives": _READING - {"initialization"},
    "fmi2DoStep": {"step complete"},
    "fmi2CancelStep": set(),
    **{f"fmi2Get{kind}Status": _STATUS for kind in ("", "Real", "Integer", "Boolean", "String")},
}
# Section 3.2.3, where each function of model exchange is legal in an instance of that kind; in co-simulation none is.
_RUNNING = {"event mode", "continuous-time mode"}
_EXCHANGING = {"initialization mode", "terminated"} | _RUNNING
EXCHANGE: dict[str, set[str]] = {
    "fmi2EnterEventMode": {"continuous-time mode"},
    "fmi2NewDiscreteStates": {"event mode"},
    "fmi2EnterContinuousTimeMode": {"event mode"},
    "fmi2CompletedIntegratorStep": {"continuous-time mode"},
    "fmi2SetTime": _RUNNING,
    "fmi2SetContinuousStates": {"continuous-time mode"},
    **{f"fmi2Get{name}": _EXCHANGING for name in ("ContinuousStates", "NominalsOfContinuousStates", "Derivatives")},
    "fmi2GetEventIndicators": _EXCHANGING,
}
TABLE |= dict.fromkeys(EXCHANGE, set())

# What follows the component: pointers raw, as no signature is declared for a slave.
_EXCHANGE_ARGUMENTS = {
    "fmi2NewDiscreteStates": (byref(fmi2EventInfo()),),
    "fmi2CompletedIntegratorStep": (1, byref(c_int()), byref(c_int())),
    "fmi2SetTime": (c_double(1.0),),
    "fmi2SetContinuousStates": ((c_double * 8)(0, 0, 0, 1.2, 0, 0, 0, -2.0), c_size_t(8)),
    **{function: ((c_double * 8)(), c_size_t(8)) for function in EXCHANGE if function.startswith("fmi2Get")},
    "fmi2GetEventIndicators": ((c_double * 3)(), c_size_t(3)),
}


def bring_to(w: FMU2Wheel, state: str) -> FMU2Wheel:
    """From instantiated to one of STATES; what was logged on the way is dropped."""
    if state == "initialization":
        assert (w.setupExperiment(), w.enterInitializationMode()) == (OK, OK)
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
