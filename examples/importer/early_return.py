"""fmi2Discard, fmi2LastSuccessfulTime, fmi2Terminated: the wheel lies flat at 0.59275 s, within a step."""

from fmpy.fmi1 import FMICallException
from unit import read, verdict, wheel

DISCARD, LAST_SUCCESSFUL_TIME, TERMINATED = 2, 2, 3
unit, status = wheel(phi_dot_start=0.0), 0
unit.doStep(0.0, 0.5)
try:
    unit.doStep(0.5, 0.5)
except FMICallException as refusal:
    status = refusal.status
end, over = unit.getRealStatus(LAST_SUCCESSFUL_TIME), unit.getBooleanStatus(TERMINATED)
(theta,) = read(unit, "theta")
verdict(status == DISCARD and over and abs(end - 0.59275) < 1e-5, f"status {status} at {end:.6f} s, theta {theta:.0e}")
