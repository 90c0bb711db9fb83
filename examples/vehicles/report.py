"""Writes docs/results/partners.md and docs/results/inputs.md from what was measured; no figure is typed by hand."""

from __future__ import annotations

import platform
import subprocess
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

import numpy as np

from . import ground, inputs
from .build import ROOT
from .driven import RADIUS, TURN, Verdict
from .suspended import COMPARED, LARGE_STEPS, Convergence, drag_share, ends

RESULTS = ROOT / "docs" / "results"
TEMPLATES = Path(__file__).resolve().parent


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A Markdown table."""
    head = list(head)
    lines = [head, ["---"] * len(head), *[[str(cell) for cell in row] for row in rows]]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def write(name: str, **fields: str) -> Path:
    """docs/results/`name` from its template."""
    path = RESULTS / name
    text = (TEMPLATES / f"{name}.in").read_text()
    path.write_text(text.format(footer=footer(), **fields))
    return path


def footer() -> str:
    """Machine and versions."""
    packages = ", ".join(f"{name} {version(name)}" for name in ("FMPy", "numpy", "scipy", "pythonfmu"))
    cpu_info = Path("/proc/cpuinfo")
    models = [line for line in cpu_info.read_text().splitlines() if "model name" in line] if cpu_info.exists() else []
    processor = models[0].split(":", 1)[1].strip() if models else platform.machine()
    compiler = subprocess.run(["cc", "--version"], capture_output=True, text=True).stdout.split("\n")[0]
    return (
        f"\nMeasured on {processor}, {platform.system()}, {compiler}; Python {platform.python_version()}, {packages}."
    )


def drive_table(v: Verdict) -> str:
    """The driven wheel."""
    rows = [
        ("the wheel alone leans by 45 degrees after", f"{v.fall:.2f} s"),
        ("line, last second: largest departure from upright", f"{v.line_tilt:.4f} deg"),
        ("line, last second: largest departure from the heading", f"{v.line_heading:.4f} deg"),
        (f"circle of {RADIUS} m: radius driven in the last turn ({TURN:.1f} s)", f"{v.circle_radius:.4f} m"),
        ("circle: largest departure from a circle", f"{1000 * v.circle_scatter:.2f} mm"),
        ("circle: largest departure from upright", f"{v.circle_tilt:.2f} deg"),
        ("circle: largest error of omega_z", f"{v.speed_error:.2e} rad/s"),
        ("largest M_1 and M_3", f"{v.largest_M_1:.1f} and {v.largest_M_3:.2f} N m"),
        ("smallest normal force", f"{v.lowest_N:.1f} N"),
    ]
    return table(("measured", "value"), rows)


def order_table(found: Convergence) -> str:
    """Errors and observed orders against the communication step."""
    kinds = {"all held": found.held, "positions follow": found.followed, "first derivatives": found.linear}
    head, columns = ["step [ms]"], [[f"{1000 * h:g}" for h in found.steps]]
    for label, errors in kinds.items():
        head += [label, "order"]
        columns += [[f"{e:.2e}" for e in errors], ["", *(f"{order:.2f}" for order in found.orders(errors))]]
    return table(head, zip(*columns, strict=True))


def drag_table(found: Convergence) -> str:
    """The errors of held values beside what the drag of a held position explains."""
    pairs = zip(found.steps, found.held, strict=True)
    rows = [(f"{1000 * h:g}", f"{e:.3f}", f"{drag_share(h):.3f}") for h, e in pairs]
    return table(("step [ms]", "error measured", "share of the speed lost to k v h/2"), rows)


def stability_table(fmus: dict[str, Path]) -> str:
    """Where the coupled run breaks."""
    rows = []
    for h in LARGE_STEPS:
        said = ["breaks" if ends(fmus, h, exchange) else "runs" for exchange in ("held", "derivatives")]
        rows.append((f"{1000 * h:g}", *said))
    return table(("step [ms]", "values held", "with first derivatives"), rows)


def ground_table(fmu: Path) -> dict[str, str]:
    """Standing, breaking away, sand: the table and the log."""
    ramp, sand = ground.ramp(fmu), ground.sand(fmu)
    still, moving = ground.stand(fmu, 0.99), ground.stand(fmu, 1.01)
    of_ramp = np.abs(ramp.table["omega_z"] - ground.ramp_speed(ramp.table["time"])).max()
    of_sand = np.abs(sand.table["omega_z"] - ground.sand_speed(sand.table["time"])).max()
    speeds = [float(np.abs(run.table["omega_z"]).max()) for run in (still, moving)]
    rows = [
        ("standing wheel, torque 0.99 s N for 0.4 s: largest omega_z", f"{speeds[0]:g} rad/s"),
        ("the same, 1.01 s N", f"{speeds[1]:.3e} rad/s"),
        ("torque that grows to s N at 0.505 s, inside a step: error of omega_z", f"{of_ramp:.1e} rad/s"),
        ("s from 0 to 50 mm at 0.5 s: error of omega_z (20 rad/s before)", f"{of_sand:.1e} rad/s"),
    ]
    lines = "\n".join(moving.log + ramp.log)
    return {"ground": table(("measured against the closed form", "value"), rows), "log": lines}


def write_partners(
    fmus: dict[str, Path],
    verdict: Verdict,
    found: Convergence,
    truth: dict[str, np.ndarray],
    package: list[tuple[float, float]],
) -> Path:
    """docs/results/partners.md."""
    return write(
        "partners.md",
        drive=drive_table(verdict),
        orders=order_table(found),
        drag=drag_table(found),
        stability=stability_table(fmus),
        duration=f"{truth['time'][-1]:g}",
        compared=", ".join(COMPARED),
        lowest=f"{truth['lambda_3'].min():.0f}",
        highest=f"{truth['lambda_3'].max():.0f}",
        package=table(("step [ms]", "error"), [(f"{1000 * h:g}", f"{e:.2e}") for h, e in package]),
        **ground_table(fmus["wheel"]),
    )


def write_inputs(outcomes: list[inputs.Outcome]) -> Path:
    """docs/results/inputs.md."""
    known = {o.label: o for o in outcomes}
    once, again = known["constant, set once"], known["constant, set again at every step"]
    same = np.array_equal(once.table, again.table) and (once.steps, once.rhs) == (again.steps, again.rhs)
    rows = [(o.label, o.steps, o.rhs, o.restarts, f"{o.microseconds:.2f}", f"{o.error:.1e}") for o in outcomes]
    return write(
        "inputs.md",
        stop=f"{inputs.STOP:g}",
        step=f"{1000 * inputs.STEP:g}",
        repeats=str(inputs.REPEATS),
        outcomes=table(("inputs", "steps", "right-hand sides", "restarts", "us per doStep", "error"), rows),
        again="changes nothing: same bits, same counts" if same else "CHANGES THE SOLUTION: a fault",
    )
