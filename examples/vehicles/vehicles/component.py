"""One FMU of a system: loaded, instantiated and freed by FMPy; its messages, and how it ended."""

import shutil
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from ctypes import byref, c_double
from dataclasses import dataclass, field
from pathlib import Path

from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE, fmi2LastSuccessfulTime
from fmpy.simulation import apply_start_values


@dataclass(eq=False)
class Ended(Exception):  # noqa: N818 - an ending, such as a wheel's lift-off, is no error
    """A component ended the run at `time` [s]; `message`: the FMU's."""

    component: str
    time: float
    message: str


def let_go_of_python(fmu: FMU2Slave) -> None:
    """For FMUs of pythonfmu 0.7.0, whose library keeps a shared pointer to its interpreter. When the process ends, the
    pointer's destructor and then the library's own each release it: the second writes into freed memory. Released here,
    it is empty by then; the instance keeps a separate pointer."""
    if release := getattr(fmu.dll, "finalizePythonInterpreter", None):
        release()


@dataclass
class Component:
    """One FMU: its name in the system, its file, and the start values of its parameters."""

    name: str
    path: Path
    start: dict[str, float] = field(default_factory=dict)
    fmu: FMU2Slave | None = field(default=None, init=False)

    def load(self) -> None:
        """Unpack, instantiate and initialize up to initialization mode; a ValueError has the FMU's message."""
        self.folder, self.log = extract(str(self.path)), []
        self.description = read_model_description(self.folder)
        self.variable = {v.name: v for v in self.description.modelVariables}
        self.references(self.start)  # a name that does not exist
        of = {"guid": self.description.guid, "modelIdentifier": self.description.coSimulation.modelIdentifier}
        self.fmu = FMU2Slave(unzipDirectory=self.folder, instanceName=self.name, **of)
        callbacks = fmi2CallbackFunctions()  # fmpy's own logger serves one instance per process
        callbacks.logger = fmi2CallbackLoggerTYPE(lambda _e, _n, _s, _c, text: self.log.append(text.decode()))
        self.fmu.instantiate(callbacks=callbacks)
        self.fmu.setupExperiment(startTime=0.0)
        self.asked(apply_start_values, self.fmu, self.description, self.start)
        self.asked(self.fmu.enterInitializationMode)

    def asked(self, function: Callable, *arguments: object) -> None:
        """Calls a function of the FMU; where it refuses, a ValueError with its last message."""
        try:
            function(*arguments)
        except FMICallException as refusal:
            raise ValueError(f"{self.name}: {self.last_message(str(refusal))}") from refusal

    def last_message(self, otherwise: str) -> str:
        """FMI 2.0 doubles the characters % and # of a message."""
        return self.log[-1].replace("%%", "%").replace("##", "#") if self.log else otherwise

    def free(self) -> None:
        """End the run and remove the unpacked files."""
        if self.fmu:
            let_go_of_python(self.fmu)
            self.fmu.freeInstance()
            shutil.rmtree(self.folder, ignore_errors=True)

    def references(self, names: Iterable[str]) -> list[int]:
        """Value references of variables."""
        if unknown := [name for name in names if name not in self.variable]:
            raise ValueError(f"{self.name} has no variable {unknown[0]}.")
        return [self.variable[name].valueReference for name in names]

    def feeds(self, output: str) -> list[str]:
        """Inputs on which an output depends directly; undeclared dependencies mean all."""
        declared = {u.variable.name: u.dependencies for u in self.description.outputs}.get(output)
        inputs = [v for v in self.description.modelVariables if v.causality == "input"]
        return [v.name for v in (inputs if declared is None else declared)]

    def ended(self, t: float) -> Ended:
        """How it ended the run in a step from t on."""
        last = c_double(t)
        self.fmu.dll.fmi2GetRealStatus(self.fmu.component, fmi2LastSuccessfulTime, byref(last))
        return Ended(self.name, last.value, self.last_message("it refused a call"))


@contextmanager
def loaded(*components: Component) -> Iterator[None]:
    """With the components in initialization mode; they are freed in the end."""
    with ExitStack() as stack:
        for component in components:
            stack.callback(component.free)
            component.load()
        yield
