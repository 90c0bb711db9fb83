"""Slides at the extremes: hardly any friction to 20, light and heavy wheels, thin discs and fat tori, fast spins,
tiny slips.

What must hold of any slide without inputs: the energy falls, the road pushes against the slip with mu_slide N, both
formulations take the same way. SI; a wheel's own time is sqrt((r_0 + r) / g).
"""

from math import pi, sqrt

import numpy as np
import pytest
from robustness.sweep import similar
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import DISCARD, OK
from wheelfmu.truth.motion import Library, Run
from wheelfmu.truth.motion import run as attempt

TOLERANCE = 1e-8
THROWN = {"slip_x_start": -1.5, "slip_y_start": 0.8, "phi_dot_start": -6.0}
STATES = ("X_O", "Y_O", "theta", "psi_dot", "phi_dot", "slip_x", "slip_y")

EXTREMES: dict[str, dict[str, float]] = {
    **{f"mu = {mu:g}": {"mu_max": mu, "mu_slide": mu, **THROWN} for mu in (1e-9, 1e-4, 0.05, 2.0, 20.0)},
    **{f"mu_max = {mu:g}": {"mu_max": mu, "mu_slide": 0.5 * mu, **THROWN} for mu in (1e-6, 1.0)},
    **{f"m = {m:g} kg": {**THROWN, **similar(1.0, m)} for m in (1e-6, 1e6)},
    **{f"m = {m:g} kg, the paper's J": {**THROWN, "m": m} for m in (1e-3, 1e4)},
    "thin disc": {**THROWN, "r": 0.0},
    "fat torus": {**THROWN, "r": 3.0, "J_x": 90.0, "J_y": 90.0, "J_z": 90.0},
    "rod": {**THROWN, "J_x": 1.8, "J_y": 0.9, "J_z": 0.9},
    **{f"spin {spin:g} rad/s": {**THROWN, "phi_dot_start": -spin} for spin in (1e-9, 100.0, 1e3)},
    **{f"slip {u:g} m/s": {**THROWN, "slip_x_start": u, "slip_y_start": -u} for u in (1e-10, 1e-5, 100.0)},
    "across alone": {"slip_y_start": -3.0},
    "rolling resistance": {**THROWN, "s": 0.1},
    "steep": {**THROWN, "slope": 1.2, "slope_direction": 0.7},
    "near flat": {**THROWN, "theta_start": 0.05},
}


def thrown(library: Library, name: str, formulation: int) -> Run:
    """1 s, or until it ends."""
    values = {"mu_max": 0.4, "mu_slide": 0.35, **EXTREMES[name], "formulation": formulation}
    return library.simulate(np.linspace(0, 1, 101), TOLERANCE, **values)


def force_error(run: Run, mu: float) -> float:
    """Of the road's force beside mu N against the slip, over mu N."""
    slides = (run["contact_mode"] == 1) & (np.hypot(run["slip_x"], run["slip_y"]) > 0)
    slip, force = (np.array([run[f"{what}_x"], run[f"{what}_y"]])[:, slides] for what in ("slip", "lambda"))
    N = run["lambda_3"][slides]
    return float(np.abs((force / N + mu * slip / np.hypot(*slip)) / mu).max(initial=0.0))


@pytest.mark.parametrize("name", EXTREMES)
def test_an_extreme_slide_loses_energy_obeys_coulomb_and_is_the_same_in_both_formulations(library, name: str) -> None:
    mu = EXTREMES[name].get("mu_slide", 0.35)
    runs = [thrown(library, name, formulation) for formulation in (2, 3)]
    for run in runs:
        assert run.status in (OK, DISCARD), run.messages[-1:]
        assert (run["contact_mode"] == 1).any()
        if "slope" not in EXTREMES[name]:  # where E takes no account of the height along the road
            E = run["E"]
            within(float(np.diff(E).max(initial=0.0)) / np.abs(E).max(), TOLERANCE, "gain of energy, relative")
        within(force_error(run, mu), 512 * EPSILON, "force off friction, relative")
        beyond(force_error(run, 0.9 * mu), 1e-2, "force off nine tenths of friction, relative")
        within(run.counters["n_steps"], 2e4, "number of steps")
    assert (runs[0].end is None) == (runs[1].end is None)
    last = min(len(run.t) for run in runs) - 1
    for column in STATES:
        size = max(1.0, float(np.abs(runs[0][column]).max()))
        apart = absolute_error(runs[1][column][:last], runs[0][column][:last]) / size
        bound = (100 if name in ("near flat", "rod") else 10) * TOLERANCE
        within(apart, bound, f"{column} of the formulations apart, relative")


# ---- random wheels, every kind of extreme at once ----


def extreme_slide(random: np.random.Generator) -> dict[str, float]:
    """Sizes over six decades, a coefficient over ten, slips over twelve; rates in the wheel's own."""
    scale, mass = 10 ** random.uniform(-3, 3), 10 ** random.uniform(-3, 3)
    a, b, c = random.uniform(0.05, 0.9, 3)
    r_0 = 0.3 * scale
    r = r_0 * random.choice([0.0, 10 ** random.uniform(-2, 0.5)])
    own, I = sqrt((r_0 + r) / 9.81), mass * (r_0 + r) ** 2  # noqa: E741
    mu = 10 ** random.uniform(-8, 1.3)
    start = {"m": mass, "r_0": r_0, "r": r, "J_x": I * (b + c), "J_y": I * (a + c), "J_z": I * (a + b)}
    start |= {"mu_max": mu, "mu_slide": mu * random.choice([1.0, random.uniform(0.3, 1)])}
    start |= {"s": r_0 * random.choice([0.0, 10 ** random.uniform(-6, -1)])}
    start |= {"theta_start": random.uniform(0.3, pi - 0.3)}
    rates = ("psi_dot_start", "theta_dot_start", "phi_dot_start")
    start |= dict(zip(rates, random.normal(0, 1, 3) / own, strict=True))
    slip = (r_0 + r) / own * 10 ** random.uniform(-12, 1)
    start |= dict(zip(("slip_x_start", "slip_y_start"), slip * random.normal(0, 1, 2), strict=True))
    return {name: float(value) for name, value in start.items()} | {"own": own}


@pytest.mark.parametrize("block", range(4))
def test_random_extreme_slides_end_or_go_on_in_bounded_steps(library: Library, block: int) -> None:
    random, slid = np.random.default_rng(60 + block), 0
    for k in range(40):
        start = extreme_slide(random)
        own, choice = start.pop("own"), {"formulation": 2 + k % 2, "keep_contact": bool(k % 4 > 1)}
        tolerance = float(10 ** -random.uniform(4, 12))
        done = attempt(library, start | choice, np.linspace(0, 4 * own, 9), tolerance)
        if not done.columns:  # jammed, or lifted off, at the start
            continue
        assert done.status <= OK + 1 or done.end is not None, (start | choice, tolerance, done.messages[-1:])
        assert done.counters["n_steps"] < 1e5, (start | choice, tolerance)
        assert all(np.isfinite(done[name]).all() for name in STATES)
        slid += bool((done["contact_mode"] == 1).any())
    beyond(slid, 20, "wheels that slide")
