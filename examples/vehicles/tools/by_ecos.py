"""Runs an SSP package in ecos: python by_ecos.py PACKAGE STEP STOP COMPONENT.VARIABLE... (package ecospy).

Prints the variables' values at the end, one a line. ecos takes the parameter sets that are named.
"""

from __future__ import annotations

import sys

from ecospy import EcosSimulation


def main() -> None:
    """One run."""
    package, step, stop, *wanted = sys.argv[1:]
    with EcosSimulation(float(step), ssp_path=package) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(round(float(stop) / float(step)))
        for name in wanted:
            print(name, repr(simulation.get_real(name.replace(".", "::"))))
        simulation.terminate()


if __name__ == "__main__":
    main()
