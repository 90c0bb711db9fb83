"""fmi2SerializeFMUstate: another process reads the bytes and continues over the next events with the same bits."""

import subprocess
import sys

from unit import FMU, read, verdict, wheel

unit = wheel(s=0.03)
if len(sys.argv) > 2:
    unit.setFMUstate(unit.deSerializeFMUstate(bytes.fromhex(sys.argv[2])))
    unit.doStep(1.2, 0.8)
    sys.exit(print(read(unit, "X_O", "theta", "phi_dot", "lambda_3")))
unit.doStep(0.0, 1.2)
state = bytes(unit.serializeFMUstate(unit.getFMUstate()))
unit.doStep(1.2, 0.8)
other = subprocess.check_output([sys.executable, __file__, FMU, state.hex()], text=True).strip()
verdict(other == str(read(unit, "X_O", "theta", "phi_dot", "lambda_3")), f"{len(state)} bytes, at 2 s {other}")
