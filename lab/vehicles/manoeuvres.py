"""The car's manoeuvres, manoeuvres.toml: what they give to its FMUs. Standard library alone; SI units."""

import csv
import runpy
import tomllib
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path
from typing import Any, Self

from wheelfmu.fmu.paths import ROOT

EXAMPLES = ROOT / "examples" / "vehicles"
WHEELS = ("fl", "fr", "rl", "rr")
R, R_0, M_WHEEL, J_X, J_Z, G = 0.35, 0.3, 20.0, 0.9, 1.8, 9.81  # of the wheels; gravity


@cache
def system(name: str = "car") -> dict[str, Any]:
    """FMUs, connections, start values and step of the car, or of quarter_car, as its package has them."""
    return runpy.run_path(str(EXAMPLES / "package.py"))["read"](EXAMPLES / name / f"{name}.toml")


@cache
def presets(model: str) -> dict[str, float]:
    """Values of the parameters of an FMU that may change; of the wheel, those of its road."""
    if model == "wheel":
        return dict.fromkeys(("s", "slope", "slope_direction", "phi_dot_start"), 0.0)
    found: dict[str, float] = {}
    (source,) = EXAMPLES.glob(f"*/{model}.csv")
    rows = source.read_text(encoding="utf-8").splitlines()[2:]
    for kind, name, _, starts, *_ in csv.reader(rows):
        if kind == "parameter":
            for wheel, start in zip(WHEELS, starts.split() * 4, strict=False):  # one of each, or one for all
                found.setdefault(name.format(wheel=wheel), float(start))
    return found


@dataclass(frozen=True)
class Manoeuvre:
    """One run of the car; `given`: parameters by name."""

    title: str
    stop: float
    given: dict[str, float] = field(default_factory=dict)

    def start(self) -> dict[str, dict[str, float]]:
        """The start values of every component."""
        of, values = system(), dict(self.given)
        if "v" in values:
            v = values.pop("v")
            values = {"v_start": v, "v_0": v, "v_1": v, "phi_dot_start": -v / R} | values
        own = {model: {n: x for n, x in values.items() if n in presets(model)} for model in of["fmus"].values()}
        return {name: of["start"][name] | own[model] for name, model in of["fmus"].items()}

    @cached_property
    def values(self) -> dict[str, float]:
        """Of all parameters."""
        start, found = self.start(), {}
        for name, model in system()["fmus"].items():
            found = presets(model) | start[name] | found
        return found

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    def changed(self, **values: float) -> Self:
        """With other parameters, or another stop."""
        stop = values.pop("stop", self.stop)
        return replace(self, stop=stop, given=self.given | values)


MANOEUVRES = {
    name: Manoeuvre(**values)
    for name, values in tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")).items()
}
