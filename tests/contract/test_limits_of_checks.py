"""The other side of a check: what is still taken and what is not any more of the caller's clock, on both sides of the
time reached and of the stop time; warnings where they must not appear; how many digits a message writes.
"""

import os
import re
import shutil
import subprocess
import sys
from math import pi

import numpy as np
import pytest
from support.bounds import within

from wheelfmu.fmu.driver import DISCARD, ERROR, LAST_SUCCESSFUL_TIME, OK, FMU2Wheel, Values
from wheelfmu.truth.exchange import exchange
from wheelfmu.truth.motion import Library
from wheelfmu.truth.scenes import AT_REST, GENERAL, PAPER, PULLED, SWINGS
from wheelfmu.truth.sliding import ROAD, THROWN, gripping_torque

WEIGHT = PAPER.m * PAPER.g
sides = pytest.mark.parametrize("side", [1, -1])

# ---- the clock ----


@sides
@pytest.mark.parametrize("start", [0.0, 0.5, -0.5, 1e3, -1e3, 1e7])
@pytest.mark.parametrize("h", [1e-3, 1.0, 100.0])
def test_a_step_may_begin_off_the_time_reached_by_a_billionth_of_it_and_the_rounding_of_times(wheel, side, start, h):
    """1e-9 h + 1e-13 (|t| + |time reached|); it ends where the caller says."""
    off = side * (1e-9 * h + 2e-13 * abs(start))
    for share, status in ((0.8, OK), (1.25, ERROR), (50.0, ERROR)):
        w = wheel().start(start=start)
        before = w.serialized()
        t = start + share * off
        assert w.ask("DoStep", t, h, 0) == status, share
        if status == OK:
            assert w.status(LAST_SUCCESSFUL_TIME) == t + h
        else:
            assert "the FMU has reached" in w.said() and w.serialized() == before


@pytest.mark.parametrize("stop", [1.0, -5.0, 1e4, -1e-3])
def test_a_step_may_pass_the_stop_time_by_a_billionth_of_times(wheel, stop):
    """1e-9 (|t| + |stop|)."""
    for share, status in ((-3.0, OK), (0.0, OK), (0.8, OK), (1.25, ERROR), (10.0, ERROR)):
        w = wheel().start(start=stop - 0.125, stop=stop)
        end = stop + share * 2e-9 * abs(stop)
        assert w.ask("DoStep", stop - 0.125, end - (stop - 0.125), 0) == status, share
        assert status == OK or "the stop time is" in w.said()


def test_a_stop_time_of_zero_has_no_rounding_and_one_at_the_start_allows_no_step(wheel):
    for end, status in ((0.0, OK), (1e-12, ERROR)):
        w = wheel().start(start=-0.5, stop=0.0)
        assert w.ask("DoStep", -0.5, 0.5 + end, 0) == status
    w = wheel().start(start=2.0, stop=2.0)
    assert (w.step(0.0), w.step(1e-3)) == (OK, ERROR)


def test_a_step_of_no_length_is_taken_and_one_below_zero_is_not(wheel):
    w = wheel().start()
    assert [w.ask("DoStep", 0.0, h, 0) for h in (0.0, -0.0, -5e-324, -1e-300)] == [OK, OK, ERROR, ERROR]


# ---- warnings where they must not appear ----

FULL = gripping_torque(PAPER, 1.0)  # N m, with which an upright wheel needs mu = 1
GRIP = "more than a dry road gives"


def texts_of(w: FMU2Wheel) -> str:
    return " ".join(w.texts())


@pytest.mark.parametrize(("share", "road", "warned"), [
    (1.02, {}, True),
    (0.98, {}, False),
    (1.02, {"mu_max": 5.0}, False),
    (1.02, {"mu_max": 5.0, "mu_slide": 4.0}, False),
    (0.98, {"s": 0.01}, False),
])  # fmt: skip
@sides
def test_the_grip_of_a_dry_road_is_warned_of_beyond_it_on_a_road_without_a_limit_alone(
    wheel, side, share, road, warned
):
    w = wheel().start(**AT_REST, **road).put(M_3=side * share * FULL).to(0.2)
    assert (GRIP in texts_of(w)) == warned
    blob = w.serialized()
    assert GRIP not in texts_of(wheel().back(blob).to(0.6)) and GRIP not in texts_of(w.to(0.6))


@pytest.mark.parametrize("h", [0.001, 0.01, 0.3, 1.2])
def test_the_grip_of_a_dry_road_is_warned_of_soon_in_the_wheels_own_time_whatever_the_step(wheel, h):
    """In a brake that grows by 100 N m/s and exceeds the grip from 0.2 s on; test_messages.py has the coefficient."""
    w = wheel().start(theta_start=pi / 2, phi_dot_start=-60.0)
    for k in range(max(1, round(0.3 / h))):
        w.give({"M_brake": (FULL - 20 + 100 * k * h, 100.0)}).by(h)
    assert GRIP in (text := w.said())
    scale = np.sqrt((PAPER.r_0 + PAPER.r) / PAPER.g)
    late = scale / 16 + min(h, 0.6 * scale)  # it looks so often, at the ends of steps, of which none is longer
    assert 0.2 <= float(text.split()[2]) <= 0.2 + late


@pytest.mark.parametrize(("share", "warned"), [(0.98, False), (1.02, True)])
@sides
def test_the_grip_that_a_turn_of_the_carrier_needs_is_warned_of_without_any_load(wheel, side, share, warned):
    """On a circle at 10 m/s."""
    w = wheel().start(guided=True, psi_start=0.0, theta_start=pi / 2, phi_dot_start=-10 / (PAPER.r_0 + PAPER.r))
    w.put(psi_dot_guide=side * share * PAPER.g / 10).by(0.2)
    assert (GRIP in texts_of(w)) == warned


@pytest.mark.parametrize(("spin", "warned"), [(-1.0, False), (-60.0, True)])
def test_the_grip_is_that_of_one_instant_in_a_step_in_which_the_load_grows(wheel, spin, warned):
    """The slow wheel is held long before its brake could ask for so much."""
    w = wheel().start(guided=True, psi_start=0.0, theta_start=1.5, phi_dot_start=spin).give({"M_brake": (0.0, 100.0)})
    assert (GRIP in texts_of(w.by(30.0))) == warned


def test_the_grip_of_a_wheel_that_nothing_loads_is_never_warned_of(wheel):
    """Down a slope it needs tan(slope) / (1 + m R^2 / J_z)."""
    steep = {**AT_REST, "psi_start": 0.0, "slope": 1.3}
    w, loaded = wheel().start(**steep).to(0.2), wheel().start(**steep, F_X=1e-6).to(0.2)
    assert w.get("mu_required")[0] > 1.3 and w.texts() == []
    assert GRIP in texts_of(loaded)  # the partner


def test_a_warning_names_an_instant_of_the_step_that_logs_it(wheel):
    """Under a constant load the solution is known far beyond it."""
    w, named = wheel().start(**PULLED, s=0.01, F_X=1e-6), []
    for _ in range(100):
        named += [(w.time, float(text.split()[2]), w.time - 1e-3) for text in w.by(1e-3).texts()]
    assert len(named) == 2 and all(reached >= t >= before for reached, t, before in named)


UPRIGHT = "exactly upright"
TIPPED: list[tuple[Values, bool]] = [
    ({}, True),
    ({"theta_start": pi / 2 + 3e-15}, False),
    ({"theta_start": pi / 2 - 1e-9}, False),
    ({"theta_dot_start": 1e-9}, False),
    ({"psi_dot_start": 1e-9}, False),
]


@pytest.mark.parametrize(("values", "warned"), TIPPED)
def test_that_a_wheel_fell_from_exactly_upright_is_warned_of_where_nothing_but_rounding_tipped_it(
    wheel, values, warned
):
    w = wheel().start(**{**AT_REST, **values})
    assert w.step(100.0) == DISCARD
    text = texts_of(w)
    assert "lies flat" in text and (UPRIGHT in text) == warned


def test_other_ends_of_an_upright_wheel_are_no_falls(wheel):
    w = wheel().start(**AT_REST, mu_max=0.3).put(M_3=-90.0)
    assert w.step(1.0) == DISCARD and "needs a friction" in texts_of(w)
    lifted = wheel().start(**AT_REST).put(F_Z=2 * WEIGHT)
    assert lifted.step(1.0) == DISCARD
    text = texts_of(lifted)
    assert UPRIGHT not in text and "F_Z > 0 lifts the wheel" in text


LIFTS: list[tuple[Values, dict[str, tuple[float, ...]], str, bool]] = [
    ({}, {"F_Z": (0.0, 500.0)}, "lifted off", True),
    (SWINGS, {}, "lifted off", False),
    (SWINGS, {"F_Z": (-20.0,)}, "lifted off", False),
    ({"mu_max": 0.3}, {"F_Z": (20.0,)}, "needs a friction", False),
]


@pytest.mark.parametrize(("values", "inputs", "end", "warned"), LIFTS)
def test_the_sign_of_F_Z_is_pointed_out_where_it_has_lifted_the_wheel_alone(wheel, values, inputs, end, warned):
    w = wheel().start(**values).give(inputs)
    assert w.step(2.0) == DISCARD
    text = texts_of(w)
    assert end in text and ("F_Z > 0 lifts" in text) == warned


GUIDE: list[tuple[Values, bool]] = [
    ({"guided": True}, True),
    ({"guided": True, "psi_start": 1e-9}, False),
    ({"guided": True, "theta_start": 1.3089}, False),
    ({}, False),
    ({"guided": True, "psi_dot_start": 1.0}, False),  # refused: one message, of the fault
]


@pytest.mark.parametrize(("values", "warned"), GUIDE)
def test_the_start_of_a_guided_wheel_is_warned_of_where_it_is_the_papers_and_sound(wheel, values, warned):
    w = wheel().initializing(**values)
    for s in (0.01, 0.02):
        w.put(s=s).get_one("theta_ddot")  # the start is computed, and again
    assert "keeps the paper's" not in texts_of(w)
    w.exitInitializationMode()
    assert texts_of(w).count("keeps the paper's") == warned


def test_a_change_to_another_law_is_no_transition_and_is_not_logged(wheel):
    w = wheel(logging=True).start(s=0.02, phi_dot_start=-6.0).to(0.1)
    for s in (0.0, 0.02, 0.01, 0.0):
        w.put(s=s).to(w.time + 0.01)
    assert w.put(M_brake=1.0).to(0.2).put(M_brake=0.0).to(0.3).texts() == [] and w.get("n_events") == [0]
    law = {"s": 0.03, "friction_law": 2}
    for omega_s in (0.1, 1e-6):
        w = wheel(logging=True).start(omega_s=omega_s, **law).to(3.0)
        assert w.texts() == [] and w.get("n_events") == [0]
    held = wheel(logging=True).start(s=0.02, **AT_REST).to(0.1)  # the partner
    assert "release" in texts_of(held.put(M_3=9.0).to(0.2)) and held.get("n_events") == [1]


@pytest.mark.parametrize("keep", [True, False])
def test_a_pull_is_logged_where_the_ground_may_pull_alone(wheel, keep):
    w = wheel().start(keep_contact=keep, **SWINGS, s=0.01)
    w.step(1.0)
    text = texts_of(w)
    assert ("pulls" in text) == keep and ("lifted off" in text) == (not keep)


def test_model_exchange_warns_of_nothing_on_the_way(library: Library) -> None:
    with exchange(library, **AT_REST, M_3=-3 * FULL) as w:
        for k in range(5):
            w.place(0.05 * k, w.x() + 0.05 * w.derivatives())
            w.event()
        assert w.get("mu_required")[0] > 1 and w.texts() == []


def test_a_healthy_start_of_every_kind_is_silent(wheel):
    starts: list[Values] = [{}, {**GENERAL, "s": 0.02}, {**ROAD, **THROWN}, {"friction_law": 2, "s": 0.02}, AT_REST]
    starts += [{"mu_max": 0.9}, {"slope": 0.3}, {"r": 0.0}, {"g": 0.0, "keep_contact": True}, {"psi_start": 1e12}]
    for values in starts:
        assert wheel().start(**values).to(1e-3).texts() == [], values


# ---- digits ----


def test_a_number_is_written_with_the_fewest_digits_from_15_on_that_read_back(wheel):
    random, w, lengths = np.random.default_rng(8), wheel().start(), set()
    numbers = [-float(x) for x in 10 ** random.uniform(-5, 5, 60)] + [-0.1, -1 / 3, -2 / 3, -1e-300, -123456789012345.0]
    for number in numbers:
        assert w.set(s=number) == DISCARD
        (written,) = re.findall(r"s = (\S+): it must", w.said())
        digits = next(digits for digits in (15, 16, 17) if float(f"{number:.{digits}g}") == number)
        assert written == f"{number:.{digits}g}"
        lengths.add(digits)
    assert lengths == {15, 16, 17}


LOCALE = """LC_NUMERIC
decimal_point "<U066B>"
thousands_sep ""
grouping -1
END LC_NUMERIC
"""
LOGS = """
import locale, sys
from ctypes import c_double
from wheelfmu.truth.motion import Library
locale.setlocale(locale.LC_NUMERIC, sys.argv[1])
w = Library(sys.argv[2]).wheel().start()
w.set(s=-0.125), w.set(s=-2.5e-300), w.set(s=-3.0), w.set(F_X=float("nan"))
print(locale.localeconv()["decimal_point"], *w.texts(), sep="\\n")
"""


def test_a_message_has_a_decimal_point_whatever_that_of_the_locale_is(fmu, tmp_path):
    """Also one of two bytes."""
    (tmp_path / "comma").write_text(LOCALE, encoding="ascii")
    localedef = ["localedef", "--no-archive", "-c", "-i", tmp_path / "comma", "-f", "UTF-8", tmp_path / "xx.utf8"]
    if not shutil.which("localedef"):
        pytest.skip("no localedef: this machine makes no locale")
    subprocess.run(localedef, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)  # it warns, status 1
    if not (tmp_path / "xx.utf8" / "LC_NUMERIC").exists():
        pytest.skip("localedef has no character maps (package locales): this machine makes no locale")
    said = {}
    for name in ("C", str(tmp_path / "xx.utf8")):
        command = [sys.executable, "-P", "-c", LOGS, name.rpartition("/")[2], fmu]
        environment = os.environ | {"LOCPATH": str(tmp_path), "PYTHONUTF8": "1"}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
        point, *said[point] = done.stdout.splitlines()
    assert {*said} == {".", "\u066b"}
    assert said["."] == said["\u066b"] and "s = -0.125:" in said["."][0]


@pytest.mark.parametrize("start", [999_990.0, 1_000_010.0, -999_990.0, -1_000_010.0])
def test_an_instant_is_written_to_the_nanosecond_below_a_million_seconds_and_in_full_beyond(wheel, start):
    w, early = wheel(logging=True).start(start=start, s=0.03).to(start + 1.4), wheel(logging=True).start(s=0.03).to(1.4)
    found, near = (re.findall(r"^t = (\S+) s", text)[0] for text in (w.texts()[0], early.texts()[0]))
    within(abs(float(found) - start - float(near)), 1e-9, "instant since the start, s")
    exact = start + 1.225520636
    assert (round(float(found), 9) == float(found)) or abs(exact) >= 1e6
