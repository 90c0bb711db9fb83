"""Runs an SSP package in libcosim: python by_libcosim.py PACKAGE STEP STOP COMPONENT.VARIABLE... (package libcosimpy).

Prints the variables' values at the end, one a line. The step is the one the co-simulation takes.
"""

from __future__ import annotations

import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver


def main() -> None:
    """One run."""
    package, step, stop, *wanted = sys.argv[1:]
    log_output_level(CosimLogLevel.WARNING)  # else libcosim logs each call of its libraries
    execution = CosimExecution.from_ssp_file(package, round(float(step) * 1e9))  # nanoseconds
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    count = round(float(stop) / float(step))
    if not execution.step(count):
        raise RuntimeError(f"libcosim stopped before {stop} s: {execution.status()}")
    for name in wanted:
        component, variable = name.split(".")
        index = execution.slave_index_from_instance_name(component)
        reference = next(v.reference for v in execution.slave_variables(index) if v.name.decode() == variable)
        print(name, repr(observer.last_real_values(index, [reference])[0]))


if __name__ == "__main__":
    main()
