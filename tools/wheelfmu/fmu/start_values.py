"""The arguments of ./scripts/run: checked against modelDescription.xml, or to be read again by what draws the results.

Gives the arguments of `fmpy simulate`: times, the variables to record, with all that was set, so that a figure can say
what was run, and start values in SI, which an input keeps. It needs no package, so that `--help` works
before anything is installed.
"""

from __future__ import annotations

from itertools import chain

from wheelfmu.fmu.presets import UPRIGHT, interval, preset, scale, spin, thrown, wheels
from wheelfmu.fmu.values import Fault, Variable, single, suggestion, variables

PAPER_S = 0.03  # m, (29)
ROWS = 10_000_000  # of a table, at most: some gigabytes

RUN = {
    "stop_time": Variable("stop_time", "run", "Real", "s", "10", "0", "", "End of the runs, above 0"),
    "output_interval": Variable("output_interval", "run", "Real", "s", "0.01", "0", "", "Time between rows, above 0"),
}
CHECKS = {"estimate": "1", "methods": "2", "no": "3"}
ABOUT_CHECK = "After the run: 1 estimate (of the error), 2 methods (error over time of each), 3 no (neither)"
CHECK = Variable("error", "run", "Integer", "", CHECKS["estimate"], "", "", ABOUT_CHECK)
ABOUT_SPEED = "Initial speed, forward: upright, along X, from the origin, unless the start values are given"
SPEED = Variable("v", "run", "Real", "m/s", "", "", "", ABOUT_SPEED)


def known() -> dict[str, Variable]:
    return variables("parameter", "input") | RUN | {"v": SPEED, "error": CHECK}


def usage() -> str:
    """The presets and all names."""
    presets = [f"  {name:20s}{wheel['title']}" for name, wheel in wheels().items()]
    rows = [f"  {v.name:16s}{v.unit:8s}{v.start:>22s}   {v.description}" for v in known().values()]
    return "\n".join([*presets, "", "The values that can be given:", *rows])


def values(arguments: list[str]) -> dict[str, str]:
    """What is given, by name, in SI; of a preset also friction and times, in proportion to its radius."""
    takes, names = known(), wheels()
    found, typed = {}, []
    for argument in arguments:
        name, equals, text = argument.partition("=")
        if not equals and name in names:
            typed.append(("A preset wheel", name))
        elif not equals:
            meant = suggestion(name, dict.fromkeys(names, ""))
            raise Fault(f'"{argument}" is neither name=value nor a preset wheel.{meant} See ./scripts/run --help.')
        elif name not in takes:
            meant = suggestion(name, {n: v.description for n, v in takes.items()})
            raise Fault(f'wheel.fmu has no parameter or input "{name}".{meant} ./scripts/run --help lists them.')
        else:
            typed.append((name, text))
    given = single(typed)
    wheel = given.pop("A preset wheel", "")
    given = {name: takes[name].value_of(text) for name, text in given.items()}
    if wheel:
        body = preset(wheel)
        body |= {"s": PAPER_S * scale(body, m=1)}
        body["stop_time"] = float(f"{10 * scale(body, s=1):.2g}")
        found = {name: repr(value) for name, value in (body | thrown(wheel)).items()}
    found |= rolling(given, takes, found)
    if float(found.get("s", 1)) <= 0:
        raise Fault("s must be above 0 here: the scene without rolling resistance is drawn beside it anyway.")
    own = {name: takes[name].number_of(found.get(name, v.start)) for name, v in variables("parameter").items()}
    if "output_interval" not in found:
        longest = float(RUN["output_interval"].start) * min(1.0, scale(own, s=1))
        found["output_interval"] = repr(interval(own, longest))
    stop, apart = (float(found.get(name, v.start)) for name, v in RUN.items())
    if apart > stop / 2:
        raise Fault(f"output_interval = {apart:g} s is too long: at least two have to fit into the {stop:g} s.")
    if stop / apart > ROWS:
        words = f"stop_time = {stop:g} s with a row every {apart:g} s would give {stop / apart:.0e} rows"
        raise Fault(f"{words}, more than {ROWS:.0e}: give a longer output_interval.")
    return found


def rolling(given: dict[str, str], takes: dict[str, Variable], wheel: dict[str, str]) -> dict[str, str]:
    """What is given, with a vehicle's start in the place of a speed."""
    if "v" not in given:
        return given
    if "phi_dot_start" in given:
        raise Fault("phi_dot_start follows from v: leave one of the two out.")
    start = {name: repr(value) for name, value in UPRIGHT.items()} | {n: x for n, x in given.items() if n != "v"}
    names = ("r_0", "r", "theta_start", "psi_dot_start")
    size = (float((wheel | start).get(name, takes[name].start)) for name in names)
    return start | {"phi_dot_start": repr(spin(float(given["v"]), *size))}


def command(found: dict[str, str]) -> list[str]:
    """Arguments of `fmpy simulate`; the figures and the page need outputs, energy, friction, and all that was set."""
    wanted = ("E", "mu_required", "contact_mode", "friction_mode", "n_events")
    outputs = [v.name for v in variables().values() if v.causality != "local" or v.name in wanted]
    start = {"s": str(PAPER_S)} | {name: x for name, x in found.items() if name != "error"}
    times = [f"--{name.replace('_', '-')}={start.pop(name, v.start)}" for name, v in RUN.items()]
    return [*times, "--output-variables", *outputs, "--start-values", *chain(*start.items())]
