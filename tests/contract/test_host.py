"""Any host: results, messages and bits do not depend on its floating-point environment, which no call changes."""

import os
import signal
from copy import copy
from ctypes import c_double

import pytest
from support.host import HOSTS, LIBM, Host, present, trap

from wheelfmu.fmu.driver import OK, WARNING
from wheelfmu.truth.motion import feed
from wheelfmu.truth.scenes import FORCED, KINDS, SCENES, Scene
from wheelfmu.truth.schedule import Schedule
from wheelfmu.truth.sliding import SLIDES

JUMP = Schedule(((0.0, {"M_3": (0, 40), "M_brake": 3.0, "F_Y": 20.0}),))
ALL = SCENES | SLIDES | {f"start of {name}": Scene(start) for name, start in KINDS.items()}
ALL |= {f"forced {start}": Scene(start) for start in FORCED}
ALL |= {"weightless": Scene({"g": 0.0, "keep_contact": True}), "jump": Scene({"s": 0.01, "mu_max": 0.5}, 1.0, JUMP)}
ALL |= {"weightless, jump": Scene({"g": 0.0, "s": 0.01, "keep_contact": True}, 1.0, JUMP)}
ALL |= {"tiny": Scene({"X_O_start": 1e-310, "psi_dot_start": -1e-310})}
ALL |= {"refused": Scene({"m": -1 / 3, "omega_s": -0.1})}
UNKNOWNS, KNOWNS = ("lambda_1", "lambda_3", "theta_ddot", "tau_brake", "mu_required"), ("M_1", "F_Z", "M_brake")


def slopes(w) -> list[tuple[int, bytes]]:
    """Directional derivatives, by inputs and, before the run, by parameters."""
    found = []
    for known in (*KNOWNS, "m", "theta_start"):
        values = (c_double * len(UNKNOWNS))()
        arguments = w.refer(*UNKNOWNS), len(UNKNOWNS), w.refer(known), 1, [1.0], values
        found.append((w.ask("GetDirectionalDerivative", *arguments), bytes(values)))
    return found


def co_simulation(w, scene: Scene) -> list[object]:
    """All that a scene answers, from the first call to the last."""
    w.set(**scene.start)
    seen = [w.setupExperiment(1e-3 / 3, 0.0, 1e3), w.enterInitializationMode(), *slopes(w)]
    seen += [feed(w, scene.inputs, 0.0), w.exitInitializationMode()]
    end = min(scene.duration, 1.5)
    for t in (end / 3, end * 2 / 3, end) if seen[-1] == OK else ():
        seen += [w.bits(), w.rates(("lambda_1", "tau_brake", "slip_x"))(), *slopes(w), w.step_to(t)]
        if seen[-1] > WARNING:
            break
    return [*seen, w.serialized(), w.terminate(), w.reset(), w.texts()]


def exchange(w, scene: Scene) -> list[object]:
    w.set(**scene.start)
    seen = [w.initialise()]
    if seen[0] == OK:
        seen += [w.decide().terminateSimulation, w.enterContinuousTimeMode()]
        for t in (0.1, 0.2):
            w.place(t, w.x() + 0.01 * w.derivatives())
            seen += [bytes(w.derivatives()), bytes(w.indicators()), w.bits(), *slopes(w)]
        seen += [w.enterEventMode(), w.decide().terminateSimulation]
    return [*seen, w.serialized(), w.texts()]


def answers(library, scene: Scene) -> list[object]:
    found = []
    for way in (co_simulation, exchange):
        loaded = copy(library)
        loaded.kind = int(way is co_simulation)
        with loaded.new(logging=True) as w:
            found += way(w, scene)
    return found


@pytest.mark.parametrize("host", HOSTS)
def test_every_scene_answers_the_same_bits_and_messages_whatever_the_host_and_leaves_it_as_it_was(library, host):
    """Traps would end this process."""
    here = Host(library.loaded, HOSTS[host])
    for name, scene in ALL.items():
        assert answers(here.library, scene) == answers(library.loaded, scene), name
        assert here.changed == [], name
    assert here.heard > len(ALL)


def differences() -> list[float]:
    """1 - tiny, 1 + tiny, least - 0."""
    return [LIBM.fdim(c_double(a), c_double(b)) for a, b in ((1.0, 1e-30), (1.0, -1e-30), (5e-324, 0.0))]


def test_each_of_the_environments_acts():
    """The partner: the C library computes something else in it, or ends its process."""
    plain, before = differences(), present()
    for name in HOSTS.keys() - {"traps"}:
        HOSTS[name]()
        found = differences()
        LIBM.fesetenv(before)
        assert found != plain, name
    child = os.fork()
    if child == 0:
        signal.signal(signal.SIGFPE, signal.SIG_DFL)
        trap()
        LIBM.log(c_double(-1.0))
        os._exit(0)
    assert os.WTERMSIG(os.waitpid(child, 0)[1]) == signal.SIGFPE
