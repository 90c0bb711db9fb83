"""Which call is legal in which state: FMI 2.0, transcribed by hand into a table, not taken from the FMU's sources.

"step in progress" and "step canceled" are left out: a synchronous FMU is never seen in them. "fatal" is never reached.
Every call here has arguments that are sound by themselves, so that the state alone decides.
"""

import csv
from ctypes import byref, c_size_t
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.fmi2 import fmi2EventInfo

from wheelfmu.fmu import driver
from wheelfmu.fmu.driver import CO_SIMULATION, DISCARD, ERROR, MODEL_EXCHANGE, OK, FMU2Wheel

KINDS = ("model exchange", "co-simulation")  # at the place of FMI's number
Situation = tuple[int, str]  # kind and state

with Path(__file__).with_name("call_states.csv").open(newline="", encoding="utf-8") as file:
    ROWS = list(csv.DictReader(file))
OF = {row["function"]: row["kind"] for row in ROWS}
STATES = ("instantiated", "initialization mode", "step complete", "step failed", "terminated", "error")  # section 4.2.4
EXCHANGE = ("instantiated", "initialization mode", "event mode", "continuous-time mode", "terminated")  # section 3.2.3
SITUATIONS = [(CO_SIMULATION, state) for state in STATES] + [(MODEL_EXCHANGE, state) for state in EXCHANGE]
TABLE: dict[str, set[Situation]] = {
    row["function"]: {
        (kind, state) for kind, state in SITUATIONS if OF[row["function"]] in ("both", KINDS[kind]) and row[state]
    }
    for row in ROWS
}


def bring_to(w: FMU2Wheel, state: str) -> FMU2Wheel:
    """From instantiated to a state of its kind; what was logged on the way is dropped."""
    assert (w.kind, state) in SITUATIONS
    if state == "initialization mode":
        return w.initializing()
    if state == "instantiated":
        return w
    if state == "step failed":
        assert w.start(theta_start=float(np.radians(75)), phi_dot_start=0.0).step(10.0) == DISCARD
    elif w.kind == MODEL_EXCHANGE:
        assert w.start().decide() and (state == "event mode" or w.enterContinuousTimeMode() == OK)
    else:
        assert w.start().step_to(0.5) == OK
    if state == "terminated":
        assert w.terminate() == OK
    if state == "error":  # a torque beyond all numbers: the solver gives up
        assert (w.set(M_3=1e300), w.step(0.1)) == (OK, ERROR)
    w.take_messages()
    return w


def call(w: FMU2Wheel, function: str) -> int:
    """Calls one function of TABLE with sound arguments, inputs at their present value."""
    return w.ask(function.removeprefix("fmi2"), *sound_arguments(w)[function])


def sound_arguments(w: FMU2Wheel) -> dict[str, tuple[Any, ...]]:
    """Behind the component, for every function; no variable is a string, and no choice can be set while running."""
    force, reaction, count, flag = (w.refer(name) for name in ("F_X", "lambda_3", "n_steps", "keep_contact"))
    state, blob, eight = w.snapshot(), w.serialized(), [0, 0, 0, 1.2, 0, 0, 0, -2.0]
    arguments = {"SetDebugLogging": (0, 1, [b"logAll"]), "SetupExperiment": (0, 0.0, 0.0, 0, 0.0)}
    arguments |= {"GetReal": (reaction, 1, [0]), "GetInteger": (count, 1, [0]), "GetBoolean": (flag, 1, [0])}
    arguments |= {"SetReal": (force, 1, [0]), "SetRealInputDerivatives": (force, 1, [1], [0])}
    arguments |= dict.fromkeys(("SetInteger", "SetBoolean", "GetString", "SetString"), (None, 0, None))
    arguments |= dict.fromkeys(("GetFMUstate", "FreeFMUstate"), (byref(state),)) | {"SetFMUstate": (state,)}
    arguments |= {"SerializedFMUstateSize": (state, byref(c_size_t()))}
    arguments |= {"SerializeFMUstate": (state, bytes(len(blob)), len(blob))}
    arguments |= {"DeSerializeFMUstate": (blob, len(blob), byref(state))}
    arguments |= {"GetDirectionalDerivative": (reaction, 1, force, 1, [0], [0])}
    arguments |= {"GetRealOutputDerivatives": (reaction, 1, [1], [0]), "DoStep": (w.time, 0.0, 0)}
    arguments |= dict.fromkeys(("GetStatus", "GetIntegerStatus"), (driver.DO_STEP_STATUS, [0]))  # no integer: Discard
    arguments |= {"GetRealStatus": (driver.LAST_SUCCESSFUL_TIME, [0]), "GetBooleanStatus": (driver.TERMINATED, [0])}
    arguments |= {"GetStringStatus": (driver.PENDING_STATUS, [None])}
    arguments |= {"NewDiscreteStates": (byref(fmi2EventInfo()),), "CompletedIntegratorStep": (1, [0], [0])}
    arguments |= {"SetTime": (1.0,), "GetEventIndicators": ([0] * w.indicator_count, w.indicator_count)}
    of_states = ("SetContinuousStates", "GetContinuousStates", "GetDerivatives", "GetNominalsOfContinuousStates")
    arguments |= dict.fromkeys(of_states, (eight, 8))
    return {function: arguments.get(function.removeprefix("fmi2"), ()) for function in TABLE}
