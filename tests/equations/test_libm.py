"""The compiled-in sine and cosine (cmake/libm): sincos has the bits of both, and both are right to the last digit. They
are compiled here alone, because the libraries hide them. The equations' own (angles.c) are right to the last digit too.

No part of the paper.
"""

import ctypes
import math
import subprocess
from ctypes import byref, c_double

import numpy as np
import pytest
from support.bounds import EPSILON, beyond, within

from wheelfmu.fmu import equations as eq
from wheelfmu.fmu.paths import ROOT, build_folder


@pytest.fixture(scope="module")
def libm(tmp_path_factory) -> ctypes.CDLL:
    folder, fetched = tmp_path_factory.mktemp("libm"), build_folder() / "_libm"
    sources = [ROOT / "cmake" / "libm" / "trigonometry.c", fetched / "k_rem_pio2.c"]
    options = ["-O2", "-ffp-contract=off", "-w", "-shared", "-fPIC", f"-I{ROOT / 'cmake' / 'libm'}", f"-I{fetched}"]
    subprocess.run(["cc", *options, *sources, "-lm", "-o", folder / "libm.so"], check=True)
    code = ctypes.CDLL(str(folder / "libm.so"))
    for name in ("sin", "cos"):
        function = getattr(code, name)
        function.restype, function.argtypes = c_double, [c_double]
    code.sincos.argtypes = [c_double, ctypes.c_void_p, ctypes.c_void_p]
    return code


def angles() -> np.ndarray:
    """Of all sizes, beside multiples of pi/2, where most digits cancel, and beside the limits between the cases."""
    random = np.random.default_rng(1)
    sizes = 10.0 ** random.uniform(-300, 300, 2000) * random.choice([-1, 1], 2000)
    usual = random.uniform(-1000, 1000, 20_000)
    beside = np.outer(np.arange(-200, 200) * np.pi / 4, [1 - 2**-52, 1, 1 + 2**-52]).ravel()
    return np.hstack([sizes, usual, beside, 0.0, -0.0, 5e-324, 2.0**19 * np.pi / 2, 1.7e308])


def both(libm: ctypes.CDLL, x: float) -> tuple[float, float]:
    sine, cosine = c_double(), c_double()
    libm.sincos(x, byref(sine), byref(cosine))
    return sine.value, cosine.value


def test_sincos_has_the_bits_of_sin_and_cos(libm):
    x = angles()
    merged = np.array([both(libm, value) for value in x])
    alone = np.array([(libm.sin(value), libm.cos(value)) for value in x])
    assert merged.tobytes() == alone.tobytes()
    assert merged.tobytes() != alone[:, ::-1].tobytes()
    assert all(math.isnan(value) for x in (math.inf, -math.inf, math.nan) for value in both(libm, x))


def units(found: list[float], expected: list[float]) -> float:
    """Largest difference in units in the last place."""
    return float(np.max(np.abs(np.subtract(found, expected)) / np.spacing(np.abs(expected))))


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_sine_and_cosine_are_those_of_the_system_but_for_the_last_digit(libm, name):
    x, function, expected = angles(), getattr(libm, name), getattr(math, name)
    known = [expected(value) for value in x]
    # Each of the two is less than a unit from the truth.
    within(units([function(value) for value in x], known), 2, f"{name} beside the system's, units in the last place")
    beyond(units([function(value) for value in np.nextafter(x, np.inf)], known), 2, f"{name} of the next double")


class Sines(ctypes.Structure):
    _fields_ = (("sine", c_double), ("cosine", c_double))


def test_those_of_the_equations_are_those_of_the_system_but_for_the_last_digit():
    sines = eq.LIBRARY.wheel_sines
    sines.restype, sines.argtypes = Sines, [c_double]
    x = angles()
    for name, known in (("sine", np.vectorize(math.sin)), ("cosine", np.vectorize(math.cos))):
        found = [getattr(sines(value), name) for value in x]
        within(units(found, known(x)), 2, f"{name} beside the system's, units in the last place")
        beyond(units(found, known(np.nextafter(x, np.inf))), 2, f"{name} of the next double")
    assert all(math.isnan(getattr(sines(value), name)) for value in (math.inf, math.nan) for name in ("sine", "cosine"))


def test_an_angle_less_whole_turns_has_its_sine_and_cosine_to_the_last_digit_after_any_turns():
    less = eq.LIBRARY.wheel_less_turns
    less.restype, less.argtypes = c_double, [c_double]
    random = np.random.default_rng(4)
    far = 10.0 ** random.uniform(-3, 12, 2000) * random.choice([-1, 1], 2000)
    home = np.array([less(x) for x in far])
    within(np.abs(home).max(), np.pi * (1 + EPSILON), "angle, rad")
    sines = [np.array([f(x) for x in angles]) for angles in (far, home) for f in (math.sin, math.cos)]
    within(np.abs(np.subtract(sines[:2], sines[2:])).max(), 4 * EPSILON, "sine and cosine apart")
    rounded = np.remainder(far, 2 * np.pi)  # the partner: 2 pi as a double
    beyond(np.abs(np.sin(rounded) - sines[0]).max(), 1e-6, "sine of the angle less rounded turns apart")
