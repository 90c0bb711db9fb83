"""Many instances at once: interleaved, in threads, from changing threads; each has the bits it has alone. (The fuzzer's
sanitizer finds what an instance leaves behind.)"""

import locale
from concurrent.futures import ThreadPoolExecutor
from ctypes import byref
from pathlib import Path

import numpy as np
import pytest
from fmpy.fmi2 import fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

from wheelfmu.fmu.driver import ERROR, OK
from wheelfmu.truth.scenes import KINDS

TIMES = np.arange(1, 25) * 0.125
SETTINGS = [values | {"phi_dot_start": -2.0 - 0.1 * k} for k in range(4) for values in KINDS.values()]


@pytest.fixture
def alone(wheel) -> list[list[bytes]]:
    return [wheel().start(**values).run(TIMES) for values in SETTINGS]


def test_interleaved_in_any_order_each_instance_has_the_bits_it_has_alone(wheel, alone):
    rng = np.random.default_rng(17)
    wheels = [wheel() for _ in SETTINGS]
    bits: list[list[bytes]] = [[] for _ in SETTINGS]
    for k in rng.permutation(len(SETTINGS)):
        wheels[k].start(**SETTINGS[k])
    for k in rng.permutation(np.repeat(np.arange(len(SETTINGS)), len(TIMES))):
        bits[k] += wheels[k].run([TIMES[len(bits[k])]])
    assert bits == alone
    assert len({each[-1] for each in bits}) == len(SETTINGS)


def test_in_threads_each_instance_has_the_bits_it_has_alone(wheel, alone):
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(lambda values: wheel().start(**values).run(TIMES), SETTINGS)) == alone


def test_creation_stepping_and_freeing_may_each_happen_in_another_thread(wheel, alone):
    def in_a_thread(work):
        with ThreadPoolExecutor(1) as pool:
            return pool.submit(work).result()

    w = in_a_thread(wheel)
    in_a_thread(lambda: w.start(**SETTINGS[1]))
    assert in_a_thread(lambda: w.run(TIMES[:12])) + in_a_thread(lambda: w.run(TIMES[12:])) == alone[1]
    in_a_thread(w.close)
    assert w.component is None


def test_a_thousand_instances_live_side_by_side_and_can_be_freed_in_any_order(wheel):
    w = wheel()

    def make(count: int) -> list[int | None]:
        return [w.fmi2Instantiate(b"one of many", 1, w.guid.encode(), None, None, 0, 0) for _ in range(count)]

    made = make(1000)
    assert len(set(made)) == 1000 and None not in made
    shuffled = [int(component) for component in np.random.default_rng(23).permutation(made)]
    freed, kept = shuffled[:500], shuffled[500:]
    for component in freed:
        w.fmi2FreeInstance(component)
    assert {w.fmi2Reset(component) for component in kept} == {OK}
    again = make(100)
    assert None not in again
    for component in (*kept, *again):
        w.fmi2FreeInstance(component)
    w.start().by(1.0)


OTHERS = ((0, b"{0}"), (1, b"{00000000-0000-0000-0000-000000000000}"), (1, b""))  # kind and GUID
WRONG = [(name, 1, None, "the instance name is missing or blank") for name in (b"", b" \t", None)]
WRONG += [(b"wheel", *other, "the GUID differs from this FMU") for other in OTHERS]
# Outside of the enumeration: under the sanitizers, to read such a number as its type is a fault.
WRONG += [(b"wheel", kind, None, "the type is not known") for kind in (2, 7, -1, 2**31 - 1)]


@pytest.mark.parametrize(("name", "kind", "guid", "why"), WRONG)
def test_an_instantiation_that_is_wrong_is_refused_with_the_reason(wheel, name, kind, guid, why):
    w, logged = wheel(), []
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = fmi2CallbackLoggerTYPE(lambda environment, instance, *message: logged.append(message))
    guid = w.guid.encode() if guid is None else guid
    assert w.fmi2Instantiate(name, kind, guid, None, byref(callbacks), 0, 0) is None
    ((status, category, text),) = logged
    assert (status, category) == (ERROR, b"logStatusError")
    assert text.startswith(b"fmi2Instantiate: " + why.encode()) and text.endswith(b".")
    assert w.fmi2Instantiate(name, kind, guid, None, None, 0, 0) is None  # nobody to tell: still refused
    assert w.fmi2Instantiate(b"wheel", 1, None, None, byref(callbacks), 0, 0) is None


URIS = [None, "", "file:///x", "file:/x/", "file:////x", "file:///a b/é/", "file:///no/resources", "C:\\x", "%s%n#"]


@pytest.mark.parametrize("uri", URIS)
def test_any_resource_location_will_do(wheel, uri):
    w = wheel()
    component = w.fmi2Instantiate(b"wheel", 1, w.guid.encode(), None if uri is None else uri.encode(), None, 1, 0)
    assert component is not None
    w.fmi2FreeInstance(component)


def test_version_and_platform_are_those_of_the_standard(wheel):
    assert (wheel().getVersion(), wheel().getTypesPlatform()) == ("2.0", "default")


def test_the_environment_of_the_process_is_left_alone(wheel, tmp_path, monkeypatch):
    """Rounding mode, working directory and locale after a run with events, errors and an ending."""

    def environment():
        return Path.cwd(), locale.setlocale(locale.LC_ALL), np.geterr(), 1.0 / 3.0, np.float64(1e-310) / 2

    monkeypatch.chdir(tmp_path)
    before = environment()
    w = wheel(logging=True).start(s=0.03).to(3.0)
    assert (w.set(M_3=1e300), w.step(1.0)) == (OK, ERROR)
    assert environment() == before and before[-1] == 5e-311  # no flush to zero
    assert list(tmp_path.iterdir()) == []
