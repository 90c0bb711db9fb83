"""What wheel.fmu carries as evidence (layered standard FMI-LS-REF), written by the library that was just built.

For each parameter set an SSV file and the result of 10 s, one serialized state with what must come out of it, and the
manifest that names them.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

MODELICA = {"m": 2, "r_0": 0.3, "r": 0, "J_x": 0.12, "J_y": 0.12, "J_z": 0.06, "g": 9.80665, "phi_dot_start": -5}
MODELICA |= {
    "theta_start": 1.5707963267948966,
    "theta_dot_start": 1,
    "psi_start": 0,
    "X_O_start": 0.2,
    "Y_O_start": 0.2,
}
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
TORQUE = -1.0  # N m, constant
OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
STEP, STOP, STATE_AT, STATE_TO = 0.1, 10.0, 1.2, 2.0  # s
LAYER = 'fmi-ls:fmi-ls-name="org.fmi-standard.fmi-ls-ref" fmi-ls:fmi-ls-version="1.0.0-alpha.1"'
WHAT = "Layered Standard providing information on related files included in an FMU."


class Wheel:
    """One instance of the library, by FMPy: every call has to succeed."""

    def __init__(self, library: Path, description: Path) -> None:
        root = ElementTree.parse(description).getroot()
        self.variables = {v.get("name"): v for v in root.iter("ScalarVariable")}
        place = {"unzipDirectory": str(library.resolve().parent), "libraryPath": str(library.resolve())}
        self.fmu = FMU2Slave(guid=root.get("guid"), modelIdentifier="wheel", instanceName="evidence", **place)
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda *_: None)
        self.fmu.instantiate(callbacks=self.callbacks)

    def __enter__(self) -> Wheel:
        return self

    def __exit__(self, *_: object) -> None:
        self.fmu.freeInstance()

    def kind(self, name: str) -> str:
        return "Integer" if self.variables[name][0].tag == "Enumeration" else self.variables[name][0].tag

    def reference(self, name: str) -> int:
        return int(self.variables[name].get("valueReference", ""))

    def set(self, **values: float) -> None:
        for name, value in values.items():
            getattr(self.fmu, f"set{self.kind(name)}")([self.reference(name)], [value])

    def start(self, values: dict[str, float]) -> None:
        self.set(**values)
        self.fmu.setupExperiment(tolerance=1e-8, startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def read(self) -> list[float]:
        return self.fmu.getReal([self.reference(name) for name in OUTPUTS])


def write_csv(path: Path, rows: list[tuple[object, ...]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def result(wheel: Wheel, name: str, values: dict[str, float]) -> list[tuple[object, ...]]:
    """10 s at tolerance 1e-8, ten digits."""
    wheel.start(values)
    if name == "driven":
        wheel.set(M_3=TORQUE)
    rows: list[tuple[object, ...]] = [("time", *OUTPUTS)]
    for k in range(round(STOP / STEP) + 1):
        t = k * STEP
        rows.append((f"{t:.1f}", *(f"{value:.10g}" for value in wheel.read())))
        if k < round(STOP / STEP):
            wheel.fmu.doStep(t, t + STEP - t)
    return rows


def parameter_set(wheel: Wheel, name: str, values: dict[str, float]) -> str:
    """SSV 1.0."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    space = 'xmlns:ssv="http://ssp-standard.org/SSP1/SystemStructureParameterValues"'
    lines += [f'<ssv:ParameterSet {space} version="1.0" name="{name}">', "  <ssv:Parameters>"]
    for variable, value in values.items():
        shown = str(value).lower() if isinstance(value, bool) else repr(value)
        lines.append(
            f'    <ssv:Parameter name="{variable}"><ssv:{wheel.kind(variable)} value="{shown}"/></ssv:Parameter>'
        )
    return "\n".join([*lines, "  </ssv:Parameters>", "</ssv:ParameterSet>", ""])


def manifest(related: list[tuple[str, str, str, str]]) -> str:
    """fmi-ls-manifest.xml out of (type, file, role, description)."""
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    space = 'xmlns:fmi-ls="http://fmi-standard.org/fmi-ls-manifest"'
    lines.append(f"<fmiReferences {space} {LAYER} fmi-ls:fmi-ls-description={quoteattr(WHAT)}>")
    for kind, file, role, text in related:
        lines.append(f'  <Related type="{kind}" source="{file}" role="{role}" description={quoteattr(text)}/>')
    return "\n".join([*lines, "</fmiReferences>", ""])


def state(library: Path, description: Path, folder: Path) -> None:
    """The paper's wheel with friction at 1.2 s, and its outputs at 2 s, over a stick and a release, to the bit."""
    with Wheel(library, description) as wheel:
        wheel.start({"s": 0.03})
        wheel.fmu.doStep(0.0, STATE_AT)
        kept = wheel.fmu.getFMUstate()
        (folder / "state.bin").write_bytes(bytes(wheel.fmu.serializeFMUstate(kept)))
        wheel.fmu.freeFMUstate(kept)
        wheel.fmu.doStep(STATE_AT, STATE_TO - STATE_AT)
        write_csv(folder / "state_out.csv", [("time", *OUTPUTS), (STATE_TO, *map(repr, wheel.read()))])


def write(library: Path, description: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    related = [("application/x-srmd-meta-data", "credibility.srmd", "meta-data", "Use, validity, verification")]
    related.append(
        ("application/vnd.cyclonedx+json", "sbom.cdx.json", "other", "Bill of materials of what is linked in")
    )
    for name, (text, values) in SETS.items():
        with Wheel(library, description) as wheel:
            (folder / f"{name}.ssv").write_text(parameter_set(wheel, name, values), encoding="utf-8")
            write_csv(folder / f"{name}_out.csv", result(wheel, name, values))
        related.append(("application/x-ssp-parameter-set", f"{name}.ssv", "parameter", text))
        related.append(("text/csv", f"{name}_out.csv", "result", f"{name}.ssv, 10 s, tolerance 1e-8, steps of 0.1 s"))
    write_csv(folder / "driven_in.csv", [("time", "M_3"), (0, TORQUE), (STOP, TORQUE)])
    related.append(("text/csv", "driven_in.csv", "testcase", "Constant torque for driven.ssv"))
    state(library, description, folder)
    related.append(("application/octet-stream", "state.bin", "serialized-state", "paper_friction.ssv at 1.2 s"))
    related.append(("text/csv", "state_out.csv", "result", "Outputs at 2 s after state.bin, to the bit"))
    (folder / "fmi-ls-manifest.xml").write_text(manifest(related), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--library", type=Path, required=True)
    parser.add_argument("--description", type=Path, required=True, help="modelDescription.xml")
    parser.add_argument("--output", type=Path, required=True, help="folder")
    arguments = parser.parse_args()
    write(arguments.library, arguments.description, arguments.output)


if __name__ == "__main__":
    main()
