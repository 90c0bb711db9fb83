"""The wheel's equations from Python: wheel_equations.h through ctypes.

Names, order, frames and units are those of the header (fmu-src/equations/wheel_equations.h): accelerations and the
ground's force at a state, in SI. `./scripts/run` or `./scripts/build` builds the library; the environment variable
WHEEL_BUILD names its folder where that is another than build/release.
"""

from __future__ import annotations

import ctypes
import os
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char_p, c_double, c_int
from pathlib import Path

import numpy as np

NO_LAW, FRICTIONLESS, ROLLING, HELD, REGULARIZED = range(5)
LAWS = {"frictionless": FRICTIONLESS, "rolling": ROLLING, "held": HELD, "regularized": REGULARIZED}


def doubles(*names: str) -> list[tuple[str, type]]:
    return [(name, c_double) for name in names]


class Parameters(Structure):
    _fields_ = doubles("m", "r_0", "r", "J_x", "J_y", "J_z", "g", "s", "g_X", "g_Y")


class Load(Structure):
    _fields_ = [("F", c_double * 3), ("M", c_double * 3), *doubles("brake")]


class Friction(Structure):
    _fields_ = [("kind", c_int), *doubles("sigma", "omega_s")]


class Scene(Structure):
    _fields_ = [("wheel", Parameters), ("friction", Friction), ("load", Load), ("ground", c_int)]


class Motion(Structure):
    _fields_ = doubles("psi", "theta", "phi", "psi_dot", "theta_dot", "phi_dot", "X_O", "Y_O")


class Kinematics(Structure):
    _fields_ = doubles(
        *("X_O", "Y_O", "Z_O", "psi", "theta", "phi", "X_O_dot", "Y_O_dot", "Z_O_dot"),
        *("psi_dot", "theta_dot", "phi_dot", "omega_z"),
    )


class Dynamics(Structure):
    _fields_ = [
        *doubles("X_O_ddot", "Y_O_ddot", "Z_O_ddot", "psi_ddot", "theta_ddot", "phi_ddot"),
        *doubles("omega_z_dot"),
        ("lambda_", c_double * 3),
        *doubles("tau"),
    ]


class ReactionRates(Structure):
    _fields_ = [("lambda_dot", c_double * 3), *doubles("tau_dot")]


class Contact(Structure):
    _fields_ = doubles("X_C", "Y_C", "X_C_dot", "Y_C_dot")


DOUBLES = POINTER(c_double)


class Formulation(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("states", c_int),
        ("start", CFUNCTYPE(None, POINTER(Parameters), POINTER(Motion), DOUBLES)),
        ("derivative", CFUNCTYPE(c_double, POINTER(Scene), DOUBLES, DOUBLES)),
        ("spin_index", c_int),
        ("tilt_index", c_int),
        ("kinematics", CFUNCTYPE(None, POINTER(Parameters), DOUBLES, POINTER(Kinematics))),
        ("pose", CFUNCTYPE(None, POINTER(Parameters), DOUBLES, POINTER(Kinematics))),
        ("dynamics", CFUNCTYPE(None, POINTER(Scene), DOUBLES, POINTER(Dynamics))),
        ("rates", CFUNCTYPE(None, POINTER(Scene), POINTER(Load), DOUBLES, POINTER(ReactionRates))),
        ("response", CFUNCTYPE(None, POINTER(Scene), POINTER(Load), DOUBLES, POINTER(ReactionRates))),
        ("stop_spin", CFUNCTYPE(None, POINTER(Parameters), DOUBLES)),
    ]


def load_library() -> ctypes.CDLL:
    build = Path(os.environ.get("WHEEL_BUILD", Path(__file__).resolve().parents[2] / "build" / "release"))
    (path, *_) = [*build.glob("libwheel_equations.*"), build]
    if path == build:
        raise FileNotFoundError(f"{build} holds no libwheel_equations: run ./scripts/build first.")
    return ctypes.CDLL(str(path))


LIBRARY = load_library()
REDUCED = Formulation.in_dll(LIBRARY, "wheel_reduced")
EULER = Formulation.in_dll(LIBRARY, "wheel_euler")
MULTIBODY = Formulation.in_dll(LIBRARY, "wheel_multibody")
LIBRARY.wheel_energy.restype = c_double
LIBRARY.wheel_required_friction.restype = c_double
LIBRARY.wheel_height.restype = c_double
LIBRARY.wheel_height.argtypes = [POINTER(Parameters), c_double]
LIBRARY.wheel_set_slope.argtypes = [POINTER(Parameters), c_double, c_double, c_double]
LIBRARY.wheel_contact.restype = Contact
LIBRARY.wheel_scene.restype = Scene
LIBRARY.wheel_scene.argtypes = [POINTER(Parameters), POINTER(Load), Friction]


def paper_wheel(**changes: float) -> Parameters:
    """The wheel of (27)-(31) without friction, with the named constants changed."""
    constants = {"m": 20, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_y": 0.9, "J_z": 1.8, "g": 9.81}
    return Parameters(**{**constants, **changes})


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


def start(formulation: Formulation, wheel: Parameters, motion: Motion) -> np.ndarray:
    y = np.zeros(formulation.states)
    formulation.start(byref(wheel), byref(motion), y.ctypes.data_as(DOUBLES))
    return y


def derivative(formulation: Formulation, scene: Scene, y: np.ndarray) -> np.ndarray:
    y_dot = np.zeros(formulation.states)
    formulation.derivative(byref(scene), y.ctypes.data_as(DOUBLES), y_dot.ctypes.data_as(DOUBLES))
    return y_dot


def kinematics(formulation: Formulation, wheel: Parameters, y: np.ndarray) -> Kinematics:
    out = Kinematics()
    formulation.kinematics(byref(wheel), y.ctypes.data_as(DOUBLES), byref(out))
    return out


def dynamics(formulation: Formulation, scene: Scene, y: np.ndarray) -> Dynamics:
    out = Dynamics()
    formulation.dynamics(byref(scene), y.ctypes.data_as(DOUBLES), byref(out))
    return out


def rates(formulation: Formulation, scene: Scene, y: np.ndarray, load_dot: Load | None = None) -> ReactionRates:
    """Rates of lambda and tau along the motion; without load_dot the load is constant."""
    out = ReactionRates()
    change = byref(load_dot) if load_dot is not None else None
    formulation.rates(byref(scene), change, y.ctypes.data_as(DOUBLES), byref(out))
    return out


def energy(wheel: Parameters, motion: Kinematics) -> float:
    return LIBRARY.wheel_energy(byref(wheel), byref(motion))
