"""The wheel's equations from Python: wheel_equations.h through ctypes.

The structs are read from the header (fmu-src/equations/wheel_equations.h), which has frames and units: accelerations
and the ground's force at a state, in SI. `./scripts/run` or `./scripts/build` builds the library; the environment
variable WHEEL_BUILD names its folder where that is another than build/release.
"""

import ctypes
import re
from collections.abc import Callable, Iterator
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char_p, c_double, c_int
from keyword import iskeyword
from typing import Any

import numpy as np

from .paths import ROOT, build_folder

NO_LAW, FRICTIONLESS, ROLLING, HELD, REGULARIZED = range(5)
LAWS = {"frictionless": FRICTIONLESS, "rolling": ROLLING, "held": HELD, "regularized": REGULARIZED}
OMEGA_3, SLIP, CHI = 3, 8, 9  # places in a state y: of omega_z, |u|, chi
HEADER = ROOT / "fmu-src" / "equations" / "wheel_equations.h"


def read_header(text: str) -> dict[str, Any]:
    """The structs by their names without Wheel, as ctypes has them."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    enums = re.findall(r"typedef enum Wheel(\w+)", text)
    types: dict = {"void": None, "double": c_double, "int": c_int, **dict.fromkeys(enums, c_int)}
    for name, body in re.findall(r"typedef struct Wheel(\w+) \{(.*?)\} Wheel\1;", text, re.DOTALL):
        types[name] = type(name, (Structure,), {"_fields_": list(fields_of(body, types))})
    return types


def fields_of(body: str, types: dict[str, type]) -> Iterator[tuple[str, type]]:
    """What a struct declares: a string, pointers to functions, numbers, arrays, structs; `lambda` becomes `lambda_`."""
    for line in body.split(";")[:-1]:
        kind, rest = re.fullmatch(r"\s*(?:const )?(?:Wheel)?(\w+\*?) (.*)", line, re.DOTALL).groups()
        if kind == "char*":
            yield rest, c_char_p
        elif rest.startswith("("):
            name, arguments = re.fullmatch(r"\(\*(\w+)\)\((.*)\)", rest, re.DOTALL).groups()
            kinds = re.findall(r"(?:Wheel)?(\w+)(\*?) \w+(?:,|$)", arguments)
            yield name, CFUNCTYPE(types[kind], *(POINTER(types[of]) if star else types[of] for of, star in kinds))
        else:
            for name, length in re.findall(r"(\w+)(?:\[(\d)\])?", rest):
                member = types[kind] * int(length) if length else types[kind]
                yield f"{name}_" if iskeyword(name) else name, member


TYPES = read_header(HEADER.read_text(encoding="utf-8"))
Parameters, Load, Friction = map(TYPES.__getitem__, ("Parameters", "Load", "Friction"))
Scene, Motion = TYPES["Scene"], TYPES["Motion"]
Kinematics, Dynamics, Contact = map(TYPES.__getitem__, ("Kinematics", "Dynamics", "Contact"))
Slip, Formulation = map(TYPES.__getitem__, ("Slip", "Formulation"))
DOUBLES = POINTER(c_double)

BUILD = build_folder()
if not (found := [*BUILD.glob("libwheel_equations.*")]):
    raise FileNotFoundError(f"{BUILD} holds no libwheel_equations: run ./scripts/build first.")
LIBRARY = ctypes.CDLL(str(found[0]))
FORMULATIONS = ("reduced", "multibody", "sliding", "multibody_sliding")
REDUCED, MULTIBODY, SLIDING, MULTIBODY_SLIDING = (Formulation.in_dll(LIBRARY, f"wheel_{name}") for name in FORMULATIONS)
for function in (LIBRARY.wheel_reduced_state, LIBRARY.wheel_euler_rates, LIBRARY.wheel_euler_kinematics):
    function.restype = None
for function in (
    LIBRARY.wheel_energy,
    LIBRARY.wheel_required_friction,
    LIBRARY.wheel_required_friction_rate,
    LIBRARY.wheel_height,
):
    function.restype = c_double
LIBRARY.wheel_height.argtypes = [POINTER(Parameters), c_double]
LIBRARY.wheel_set_slope.argtypes = [POINTER(Parameters), c_double, c_double, c_double]
LIBRARY.wheel_contact.restype = Contact
LIBRARY.wheel_scene.restype = Scene
LIBRARY.wheel_slip.restype, LIBRARY.wheel_slip_direction.restype = Slip, c_double
LIBRARY.wheel_slip.argtypes = [POINTER(Scene), DOUBLES, c_double]
LIBRARY.wheel_slip_direction.argtypes = [POINTER(Scene), DOUBLES]
LIBRARY.wheel_scene.argtypes = [POINTER(Parameters), POINTER(Load), Friction]


def paper_wheel(**changes: float) -> Parameters:
    """The wheel of (27)-(31) without friction, with the named constants changed."""
    return Parameters(**{"m": 20, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_y": 0.9, "J_z": 1.8, "g_n": 9.81} | changes)


def scene(
    wheel: Parameters,
    kind: int = FRICTIONLESS,
    sigma: float = 1,
    omega_s: float = 1e-3,
    force: tuple[float, ...] = (0, 0, 0),
    moment: tuple[float, ...] = (0, 0, 0),
    brake: float = 0,
) -> Scene:
    """By `wheel_scene`, which checks it."""
    load = Load((c_double * 3)(*force), (c_double * 3)(*moment), brake)
    return LIBRARY.wheel_scene(wheel, load, Friction(kind, sigma, omega_s))


def _filled(out: Any, function: Callable, *arguments: object) -> Any:
    """`out`, which the function fills from the arguments; ctypes passes records by their addresses."""
    function(*(x.ctypes.data_as(DOUBLES) if isinstance(x, np.ndarray) else x for x in (*arguments, out)))
    return out


def start(formulation: Formulation, wheel: Parameters, motion: Motion) -> np.ndarray:
    return _filled(np.zeros(formulation.states), formulation.start, wheel, motion)


def derivative(formulation: Formulation, scene: Scene, y: np.ndarray) -> np.ndarray:
    return _filled(np.zeros(formulation.states), formulation.derivative, scene, y)


def kinematics(formulation: Formulation, wheel: Parameters, y: np.ndarray) -> Kinematics:
    return _filled(Kinematics(), formulation.kinematics, wheel, y)


def dynamics(formulation: Formulation, scene: Scene, y: np.ndarray) -> Dynamics:
    return _filled(Dynamics(), formulation.dynamics, scene, y)


def energy(wheel: Parameters, motion: Kinematics) -> float:
    return LIBRARY.wheel_energy(byref(wheel), byref(motion))
