"""fmi2GetFMUstate and fmi2SetFMUstate across events: a stick and a release come again with the same bits."""

from unit import read, references, verdict, wheel

unit, ends = wheel(s=0.03), []
unit.doStep(0.0, 1.2)
before, passed = unit.getFMUstate(), unit.getInteger(references("n_events"))[0]
for _ in range(2):
    unit.setFMUstate(before)
    unit.doStep(1.2, 0.2, False)  # the state before it may be set again
    ends.append((*read(unit, "X_O", "theta", "phi_dot", "lambda_3"), *unit.getInteger(references("n_events"))))
events = ends[0][-1] - passed
unit.freeFMUstate(before)
verdict(ends[0] == ends[1] and events == 2, f"{events} events, theta = {ends[1][1]!r} both times")
