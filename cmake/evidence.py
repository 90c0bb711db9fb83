"""What wheel.fmu carries as evidence (layered standard FMI-LS-REF), written by the library that was just built.

With nothing but Python's own modules: for each parameter set an SSV file and the result of 10 s, one serialized state
with what must come out of it, and the manifest that names them.
"""

from __future__ import annotations

import argparse
import csv
from ctypes import (
    CDLL,
    CFUNCTYPE,
    Structure,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_size_t,
    c_uint,
    c_void_p,
    create_string_buffer,
)
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

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
LOGGER = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)


class Callbacks(Structure):
    _fields_ = [("logger", LOGGER), *((name, c_void_p) for name in ("allocate", "free", "finished", "environment"))]


class Wheel:
    """One instance of the library; every call but the last step of a run has to succeed."""

    def __init__(self, library: CDLL, description: ElementTree.Element) -> None:
        self.library = library
        self.variables = {v.get("name"): v for v in description.iter("ScalarVariable")}
        self.callbacks = Callbacks(LOGGER(lambda *_: None))
        library.fmi2Instantiate.restype = c_void_p
        guid = description.get("guid", "").encode()
        self.instance = c_void_p(library.fmi2Instantiate(b"evidence", 1, guid, None, byref(self.callbacks), 0, 0))

    def call(self, name: str, *arguments: object) -> None:
        status = getattr(self.library, f"fmi2{name}")(self.instance, *arguments)
        if status > 1:
            raise RuntimeError(f"fmi2{name} gave status {status}")

    def references(self, names: tuple[str, ...]) -> object:
        return (c_uint * len(names))(*(int(self.variables[name].get("valueReference", "")) for name in names))

    def kind(self, name: str) -> str:
        return "Integer" if self.variables[name][0].tag == "Enumeration" else self.variables[name][0].tag

    def set(self, **values: float) -> None:
        for name, value in values.items():
            c_type = c_double if self.kind(name) == "Real" else c_int
            self.call(f"Set{self.kind(name)}", self.references((name,)), c_size_t(1), byref(c_type(value)))

    def start(self, values: dict[str, float]) -> None:
        self.set(**values)
        self.call("SetupExperiment", 1, c_double(1e-8), c_double(0), 0, c_double(0))
        self.call("EnterInitializationMode")
        self.call("ExitInitializationMode")

    def step(self, t: float, to: float) -> None:
        self.call("DoStep", c_double(t), c_double(to - t), 1)

    def read(self) -> list[float]:
        values = (c_double * len(OUTPUTS))()
        self.call("GetReal", self.references(OUTPUTS), c_size_t(len(OUTPUTS)), values)
        return list(values)

    def serialized(self) -> bytes:
        state, size = c_void_p(), c_size_t()
        self.call("GetFMUstate", byref(state))
        self.call("SerializedFMUstateSize", state, byref(size))
        content = create_string_buffer(size.value)
        self.call("SerializeFMUstate", state, content, size)
        self.call("FreeFMUstate", byref(state))
        return content.raw


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
            wheel.step(t, t + STEP)
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


def state(library: CDLL, description: ElementTree.Element, folder: Path) -> None:
    """The paper's wheel with friction at 1.2 s, and its outputs at 2 s, over a stick and a release, to the bit."""
    wheel = Wheel(library, description)
    wheel.start({"s": 0.03})
    wheel.step(0.0, STATE_AT)
    (folder / "state.bin").write_bytes(wheel.serialized())
    wheel.step(STATE_AT, STATE_TO)
    write_csv(folder / "state_out.csv", [("time", *OUTPUTS), (STATE_TO, *map(repr, wheel.read()))])


def write(library: CDLL, description: ElementTree.Element, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    related = [("application/x-srmd-meta-data", "credibility.srmd", "meta-data", "Use, validity, verification")]
    related.append(
        ("application/vnd.cyclonedx+json", "sbom.cdx.json", "other", "Bill of materials of what is linked in")
    )
    for name, (text, values) in SETS.items():
        wheel = Wheel(library, description)
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
    write(CDLL(str(arguments.library)), ElementTree.parse(arguments.description).getroot(), arguments.output)


if __name__ == "__main__":
    main()
