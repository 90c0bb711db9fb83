"""Runs an SSP package in a tool: python run_package.py TOOL PACKAGE STEP STOP COMPONENT.VARIABLE...

TOOL is fmpy, ecos or libcosim, of the interpreter's packages fmpy, ecospy and libcosimpy.
Prints the variables' values at the end, one a line.
"""

import sys


def by_fmpy(package: str, step: float, stop: float, names: list[str]) -> list[float]:
    """FMPy ignores the sets bound at components; it steps on as long as the time is below the end."""
    from fmpy.ssp.simulation import simulate_ssp
    from fmpy.ssp.ssd import read_ssv

    start = read_ssv(package, "resources/start.ssv")
    rows = simulate_ssp(package, stop_time=stop - step / 2, step_size=step, parameter_set=start)
    return [float(rows[name][-1]) for name in names]


def by_ecos(package: str, step: float, stop: float, names: list[str]) -> list[float]:
    """ecos takes the parameter sets that are named."""
    from ecospy import EcosSimulation

    with EcosSimulation(step, ssp_path=package) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(round(stop / step))
        values = [simulation.get_real(name.replace(".", "::")) for name in names]
        simulation.terminate()
    return values


def by_libcosim(package: str, step: float, stop: float, names: list[str]) -> list[float]:
    """The step is the one the co-simulation takes."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.WARNING)  # else libcosim logs each call of its libraries
    execution = CosimExecution.from_ssp_file(package, round(step * 1e9))  # nanoseconds
    observer, values = CosimObserver.create_last_value(), []
    execution.add_observer(observer)
    if not execution.step(round(stop / step)):
        raise RuntimeError(f"libcosim stopped before {stop} s: {execution.status()}")
    for component, variable in (name.split(".") for name in names):
        index = execution.slave_index_from_instance_name(component)
        reference = next(v.reference for v in execution.slave_variables(index) if v.name.decode() == variable)
        values += observer.last_real_values(index, [reference])
    return values


if __name__ == "__main__":
    tool, package, step, stop, *names = sys.argv[1:]
    values = globals()[f"by_{tool.lower()}"](package, float(step), float(stop), names)
    for name, value in zip(names, values, strict=True):
        print(name, repr(float(value)))
