"""What a release of wheel.fmu carries as evidence (layered standard FMI-LS-REF), written by the FMU itself under FMPy.

evidence.py FMU FOLDER. For each parameter set an SSV file and the result of 10 s, one serialized state with what must
come out of it, and the manifest that names them; the bytes are the same on every machine. SI units.
"""

from __future__ import annotations

import csv
import shutil
import sys
from math import pi
from pathlib import Path

import fmpy
from jinja2 import Environment

MODELICA = {"m": 2, "r_0": 0.3, "r": 0, "J_x": 0.12, "J_y": 0.12, "J_z": 0.06, "g": 9.80665, "phi_dot_start": -5}
MODELICA |= {"theta_start": pi / 2, "theta_dot_start": 1, "psi_start": 0, "X_O_start": 0.2, "Y_O_start": 0.2}
SETS = {
    "paper_free": ("The paper's wheel without rolling friction", {"s": 0}),
    "paper_friction": ("The paper's wheel with rolling friction", {"s": 0.03}),
    "driven": (
        "Unequal moments of inertia, for the torque in driven_in.csv",
        {"J_x": 0.8, "J_y": 1, "keep_contact": True},
    ),
    "stiff": ("Friction smoothed over 1e-6 rad/s: a stiff law", {"s": 0.03, "friction_law": 2, "omega_s": 1e-6}),
    "modelica": ("RollingWheel of the Modelica Standard Library", {**MODELICA, "keep_contact": True}),
}
OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
INPUTS = {"driven": {"M_3": -1.0}}  # N m, constant
STATE_AT, STATE_TO = 1.2, 2.0  # s, over a stick and a release
HOW = {"relative_tolerance": 1e-8, "record_events": False, "output": OUTPUTS}
PARAMETERS = """<?xml version="1.0" encoding="UTF-8"?>
<ssv:ParameterSet xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"
  version="1.0" name="{{ name }}">
  <ssv:Parameters>
{% for name, value in values.items() %}
    <ssv:Parameter name="{{ name }}"><ssv:{{ types[name] }} value="{{ value | string | lower }}"/></ssv:Parameter>
{% endfor %}
  </ssv:Parameters>
</ssv:ParameterSet>
"""
MANIFEST = """<?xml version="1.0" encoding="UTF-8"?>
<fmiReferences xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest" fmi-ls:fmi-ls-name="org.fmi-standard.fmi-ls-ref"
  fmi-ls:fmi-ls-version="1.0.0-alpha.1"
  fmi-ls:fmi-ls-description="Layered Standard providing information on related files included in an FMU.">
{% for type, source, role, text in related %}
  <Related type="{{ type }}" source="{{ source }}" role="{{ role }}" description="{{ text }}"/>
{% endfor %}
</fmiReferences>
"""
TEMPLATES = Environment(autoescape=True, trim_blocks=True, keep_trailing_newline=True)
RELATED = [
    ("application/x-srmd-meta-data", "credibility.srmd", "meta-data", "Use, validity, verification"),
    ("application/vnd.cyclonedx+json", "sbom.cdx.json", "other", "Bill of materials of what is linked in"),
    ("text/csv", "driven_in.csv", "testcase", "Constant torque for driven.ssv"),
    ("application/octet-stream", "state.bin", "serialized-state", "paper_friction.ssv at 1.2 s"),
    ("text/csv", "state_out.csv", "result", "Outputs at 2 s after state.bin, to the bit"),
]
for name, (text, _) in SETS.items():
    RELATED.append(("application/x-ssp-parameter-set", f"{name}.ssv", "parameter", text))
    RELATED.append(("text/csv", f"{name}_out.csv", "result", f"{name}.ssv, 10 s, tolerance 1e-8, steps of 0.1 s"))


def write_csv(path: Path, *rows: tuple[object, ...]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def state(fmu: str, description: fmpy.model_description.ModelDescription, folder: Path) -> None:
    """The paper's wheel with friction at one instant, and its outputs after one step from there, to the bit."""
    wheel = fmpy.instantiate_fmu(fmu, description)
    fmpy.simulate_fmu(
        fmu, fmu_instance=wheel, start_values={"s": 0.03}, stop_time=STATE_AT, output_interval=STATE_AT,
        terminate=False, set_stop_time=False, **HOW,
    )  # fmt: skip
    kept = wheel.getFMUstate()
    (folder / "state.bin").write_bytes(bytes(wheel.serializeFMUstate(kept)))
    wheel.freeFMUstate(kept)
    wheel.doStep(STATE_AT, STATE_TO - STATE_AT)
    references = {v.name: v.valueReference for v in description.modelVariables}
    read = wheel.getReal([references[name] for name in OUTPUTS])
    write_csv(folder / "state_out.csv", ("time", *OUTPUTS), (STATE_TO, *map(repr, read)))
    wheel.freeInstance()


def write(fmu: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    place = fmpy.extract(str(fmu))
    description = fmpy.read_model_description(place)
    types = {v.name: v.type.replace("Enumeration", "Integer") for v in description.modelVariables}
    for name, (_, values) in SETS.items():
        text = TEMPLATES.from_string(PARAMETERS).render(name=name, values=values, types=types)
        (folder / f"{name}.ssv").write_text(text, encoding="utf-8")
        given = {**values, **INPUTS.get(name, {})}
        run = fmpy.simulate_fmu(place, start_values=given, stop_time=10.0, output_interval=0.1, **HOW)
        rows = [(f"{t:.1f}", *(f"{value:.10g}" for value in row)) for t, *row in run[["time", *OUTPUTS]].tolist()]
        write_csv(folder / f"{name}_out.csv", ("time", *OUTPUTS), *rows)
    (torque,) = INPUTS["driven"].items()
    write_csv(folder / "driven_in.csv", ("time", torque[0]), (0, torque[1]), (10.0, torque[1]))
    state(place, description, folder)
    shutil.rmtree(place)
    manifest = TEMPLATES.from_string(MANIFEST).render(related=RELATED)
    (folder / "fmi-ls-manifest.xml").write_text(manifest, encoding="utf-8")


if __name__ == "__main__":
    write(*map(Path, sys.argv[1:]))
