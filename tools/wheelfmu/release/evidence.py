"""What a release of wheel.fmu carries as evidence (layered standard FMI-LS-REF), written by the FMU itself under FMPy.

evidence.py FMU FOLDER. For each parameter set an SSV file, unless the FMU has it already, and the result of 10 s, one
serialized state with what must come out of it, and the manifest that names them; the bytes are the same on every
machine. SI units.
"""

from __future__ import annotations

import shutil
import sys
import tomllib
from pathlib import Path

import fmpy
from fmpy.ssp.ssd import read_ssv
from jinja2 import Environment, FileSystemLoader

from wheelfmu.release.fmu import EVIDENCE

HERE = Path(__file__).parent
SETS = tomllib.loads((HERE / "parameter_sets.toml").read_text(encoding="utf-8"))
OUTPUTS = ("X_O", "Y_O", "psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "lambda_3")
STATE_AT, STATE_TO = 1.2, 2.0  # s, over a stick and a release
HOW = {"relative_tolerance": 1e-8, "record_events": False, "output": OUTPUTS}
TEMPLATES = Environment(
    loader=FileSystemLoader(HERE / "templates"), autoescape=True, trim_blocks=True, keep_trailing_newline=True
)


def write_csv(path: Path, *rows: tuple[object, ...]) -> None:
    path.write_text("".join(f"{','.join(map(str, row))}\n" for row in rows), encoding="utf-8")


def state(fmu: str, description: fmpy.model_description.ModelDescription, folder: Path) -> None:
    """The paper's wheel with friction at one instant, and its outputs after one step from there, to the bit."""
    wheel = fmpy.instantiate_fmu(fmu, description)
    until = {"stop_time": STATE_AT, "output_interval": STATE_AT, "terminate": False, "set_stop_time": False}
    fmpy.simulate_fmu(fmu, fmu_instance=wheel, start_values={"s": 0.03}, **until, **HOW)
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
    types = {v.name: v.type for v in description.modelVariables}
    for name, kept in SETS.items():
        given, inputs = kept.get("values"), kept.get("inputs", {})
        file = (folder if given else Path(place) / EVIDENCE) / f"{name}.ssv"
        if given:
            text = TEMPLATES.get_template("set.ssv.j2").render(name=name, values=given, types=types)
            file.write_text(text, encoding="utf-8")
        values = {parameter.name: parameter.value for parameter in read_ssv(file).parameters}
        for variable, value in inputs.items():
            write_csv(folder / f"{name}_in.csv", ("time", variable), (0, value), (10.0, value))
        run = fmpy.simulate_fmu(place, start_values=values | inputs, stop_time=10.0, output_interval=0.1, **HOW)
        rows = [(f"{t:.1f}", *(f"{value:.10g}" for value in row)) for t, *row in run[["time", *OUTPUTS]].tolist()]
        write_csv(folder / f"{name}_out.csv", ("time", *OUTPUTS), *rows)
    state(place, description, folder)
    shutil.rmtree(place)
    manifest = TEMPLATES.get_template("fmi-ls-manifest.xml.j2").render(sets=SETS)
    (folder / "fmi-ls-manifest.xml").write_text(manifest, encoding="utf-8")


if __name__ == "__main__":
    write(*map(Path, sys.argv[1:]))
