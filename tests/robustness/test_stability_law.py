"""The regularized law: its error, the choice of method; and ten minutes of weak releases."""

import numpy as np
import pytest
from support.bounds import EPSILON, absolute_error, beyond, within

from wheelfmu.fmu.driver import OK, Array, Values
from wheelfmu.truth.measure import ROUGH as FRICTION
from wheelfmu.truth.measure import TIMES, error_against, law_error
from wheelfmu.truth.motion import Library, Run, run
from wheelfmu.truth.scenes import Scene
from wheelfmu.truth.schedule import Schedule


def law_bound(omega_s: float, tolerance: float) -> float:
    """Error of the law allowed: per rad/s of its width, per tolerance."""
    return 5.0 * omega_s + 100.0 * tolerance


@pytest.fixture(scope="module")
def truth(library: Library) -> Run:
    return run(library, FRICTION, TIMES, 1e-12)


METHODS = ("automatic", "adams", "bdf", "runge_kutta")


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("omega_s", [1e-3, 1e-5, 1e-7, 1e-8])
def test_no_width_is_quietly_wrong(library: Library, truth: Run, omega_s: float, tolerance: float, method: str) -> None:
    bound = law_bound(omega_s, tolerance)
    within(law_error(library, omega_s, tolerance, method), bound, "error of the law / range")
    lighter = run(library, {"s": 0.025}, TIMES, tolerance)
    beyond(error_against(truth, lighter), bound, "error of another friction / range")


@pytest.mark.parametrize("x", [3.0, 6.5, 9.0, 12.0])
@pytest.mark.parametrize("omega_s", [1e-4, 1e-6, 1e-8])
def test_a_spin_that_a_stiff_law_balances_far_out_in_its_layer_stays_there(wheel, omega_s: float, x: float) -> None:
    """Upright and straight: a torque of s N tanh(x) is balanced at omega_z = x omega_s, where the exact law, s N, would
    brake the wheel."""
    capacity = 0.03 * 20 * 9.81
    law = {"friction_law": "regularized", "omega_s": omega_s, "s": 0.03}

    def drift(part: float) -> float:
        w = wheel().start(tolerance=1e-12, theta_start=np.pi / 2, phi_dot_start=x * omega_s, **law)
        return abs(w.put(M_3=part * capacity).to(1.0).get("omega_z")[0] / omega_s - x)

    steep = np.cosh(x) ** 2  # of the width by the torque, whose rounding shifts the balance
    within(drift(np.tanh(x)), min(1e-6, 16 * steep * EPSILON), "drift of the spin in widths of the law")
    beyond(drift(0.5 * np.tanh(x)), 2, "drift under half the torque, in widths")


WIDTHS = np.logspace(1, -6, 29)
GUIDED: Values = {"guided": True, "theta_start": np.pi / 2, "psi_start": 0.0, "phi_dot_start": -3.0, "s": 0.01}


def slowing(brake: float) -> float:
    """By the exact law, rad/s2."""
    return (0.01 * 20 * 9.81 + brake) / (1.8 + 20 * 0.35**2)


def stopping(omega_s: float, a: float, times: Array) -> Array:
    """Upright, from -3 rad/s: sinh(omega_z / omega_s) falls as exp(-a t / omega_s), by its logarithm; rad/s."""
    x = 3.0 / omega_s
    log_sinh = x + np.log1p(-np.exp(-2 * x)) - np.log(2) - a * times / omega_s
    return -omega_s * np.where(log_sinh > 20, log_sinh + np.log(2), np.arcsinh(np.exp(np.minimum(log_sinh, 20))))


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("brake", [0.0, 5.0, 60.0, 200.0])
def test_passage_and_rest_follow_the_closed_form_at_every_width(library: Library, brake: float, tolerance: float):
    """From widths far above the spin to those that only the exact law resolves, at a cost that changes little between
    neighbours."""
    a = slowing(brake)
    times, errors, costs, others = np.linspace(0, 9 / a, 61), {}, [], []
    for omega_s in WIDTHS:
        law = GUIDED | {"M_brake": brake, "friction_law": "regularized", "omega_s": omega_s}
        done, exact = run(library, law, times, tolerance), stopping(omega_s, a, times)
        errors[f"width {omega_s:.2g} rad/s"] = absolute_error(done["omega_z"], exact) / 3
        costs.append(done.counters["n_rhs"])
        others.append(absolute_error(stopping(omega_s, 1.01 * a, times), exact) / 3)
    within(errors, 10 * tolerance, "error of the spin, relative to its start")
    beyond(min(others), 10 * tolerance, "that of a hundredth more friction")
    within(max(np.abs(np.diff(np.log(costs)))), np.log(3), "logarithm of the evaluations, neighbouring widths apart")


KINDS = ("rolls", "leans", "slides", "steered", "braked", "braked slide")


def random_passage(kind: str, seed: int) -> tuple[Values, Schedule]:
    """A wheel that passes a regularized law of any width, or stays inside, under inputs that vary."""
    random = np.random.default_rng([KINDS.index(kind), seed])
    start = {"friction_law": "regularized", "omega_s": 10 ** random.uniform(-4, 0.5), "s": random.uniform(0.005, 0.04)}
    start |= {"theta_start": random.uniform(1.47, 1.67), "phi_dot_start": random.uniform(-3, 3), "psi_start": 0.3}
    inputs: dict[str, tuple[float, ...]] = {}
    if kind in ("rolls", "leans"):
        start |= {"psi_dot_start": random.uniform(-2, 2), "theta_dot_start": random.uniform(-0.3, 0.3)}
    if kind == "leans":
        start["theta_start"] = random.uniform(0.9, 1.4)
    if kind == "slides":
        start |= {"mu_max": 0.6, "mu_slide": random.uniform(0.2, 0.5), "theta_start": random.uniform(1.1, 1.5)}
        start |= {"slip_x_start": random.uniform(-2, 2), "slip_y_start": random.uniform(-1, 1)}
    if kind in ("steered", "braked slide"):
        start |= {"guided": True, "theta_start": random.uniform(1.3, 1.8)}
    if kind == "steered":
        inputs = {
            "psi_dot_guide": (0, *random.uniform(-1, 1, 3)),
            "theta_dot_guide": (0, *random.uniform(-0.2, 0.2, 2)),
        }
    if kind in ("braked", "braked slide"):
        inputs = {"M_brake": (random.uniform(0, 50), random.uniform(-40, 100)), "M_3": (random.uniform(-10, 10), 10.0)}
    if kind == "braked slide":
        start |= {"mu_max": 0.6, "mu_slide": 0.4, "phi_dot_start": random.uniform(-20, -3)}
    return start, Schedule(((0.0, inputs),))


@pytest.mark.parametrize("kind", KINDS)
def test_passages_of_every_kind_are_right_to_their_growth_at_every_tolerance(library: Library, kind: str) -> None:
    times, errors, others = np.linspace(0, 3, 31), {}, []
    for seed in range(12):
        start, inputs = random_passage(kind, seed)

        def way(tolerance: float, start: Values = start, inputs: Schedule = inputs, **moved: float) -> Array:
            changed = start | {name: start[name] + by for name, by in moved.items()}
            done = run(library, changed, times, tolerance, inputs)
            rows = np.column_stack([done[name] for name in ("X_O", "Y_O", "theta", "omega_z")])
            return rows[: len(rows) - (done.end is not None)]

        def apart(one: Array, other: Array) -> float:
            rows = min(len(one), len(other))
            return absolute_error(one[:rows], other[:rows])

        exact = way(1e-13)
        growth = max(1.0, *(apart(way(1e-13, **{of: 1e-7}), exact) / 1e-7 for of in ("phi_dot_start", "theta_start")))
        for tolerance in (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
            errors[f"seed {seed} at {tolerance:g}"] = apart(way(tolerance), exact) / tolerance / growth
        others.append(apart(way(1e-9, omega_s=0.01 * start["omega_s"]), exact) / 1e-6 / growth)
    within(errors, 10, "error over tolerance and growth")
    beyond(max(others), 10, "that of a width one per cent larger, at 1e-6")


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_a_wheel_that_stays_in_a_wide_law_costs_little_more_than_without_friction(library: Library, tolerance: float):
    def cost(**law: float | str) -> float:
        return run(library, {"s": 0.03, "method": "runge_kutta"} | law, [0.0, 5.0], tolerance).counters["n_rhs"]

    wide = {width: cost(friction_law="regularized", omega_s=width) for width in np.logspace(1, -6, 57)}
    within(max(np.abs(np.diff(np.log([*wide.values()])))), np.log(3), "logarithm of the evaluations, neighbours apart")
    within(wide[0.1] / cost(), 1.8, "evaluations over those under the exact law")
    collocated = cost(friction_law="regularized", omega_s=0.1, method="bdf")
    beyond(collocated / cost(), 1.8, "those of collocation in the whole layer")


def random_law(seed: int) -> tuple[Values, float]:
    """A stiff regularized law on a random wheel: start values and width."""
    random = np.random.default_rng(seed)
    start = {"theta_start": random.uniform(0.8, np.pi - 0.8), "s": random.uniform(0.005, 0.05)}
    start |= dict(zip(("psi_dot_start", "theta_dot_start"), random.normal(0, (1, 0.5)), strict=True))
    start["phi_dot_start"] = random.normal(0, 4)
    return start, 10 ** random.uniform(-6, -5)


@pytest.mark.parametrize("method", METHODS)
def test_a_stiff_law_is_solved_within_its_tolerance(library: Library, method: str) -> None:
    """Against the same law on the reference, where SciPy's LSODA solves it without a layer."""
    times, tolerance, errors, others = np.linspace(0, 3, 31), 1e-8, [], []
    for seed in range(40):
        start, omega_s = random_law(seed)
        law = {**start, "keep_contact": True, "friction_law": "regularized", "method": method}
        solved = Scene({**start, "omega_s": omega_s}).solved_stiffly(times)
        exact = np.column_stack([solved["X_O"], solved["Y_O"]])
        for found, width in ((errors, omega_s), (others, 2 * omega_s)):
            done = run(library, law | {"omega_s": width}, times, tolerance)
            way = np.column_stack([done["X_O"], done["Y_O"]])
            found.append(absolute_error(way, exact[: len(way)]) / np.ptp(exact, axis=0).max() / tolerance)
    within(float(np.median(errors)), 5, "median error over tolerance")
    within(max(errors), 1000, "largest error over tolerance")
    beyond(float(np.median(others)), 5, "median error over tolerance of a law twice as wide")
    beyond(max(others), 1000, "largest error over tolerance of a law twice as wide")


def test_ten_minutes_of_weak_releases_keep_energy_spin_and_cost(library: Library) -> None:
    times = np.linspace(0, 600, 601)
    done = run(library, FRICTION, times, 1e-8)
    assert done.t[-1] == 600 and (done["omega_z"][done["friction_mode"] == 0] == 0).all()
    within(np.diff(done["E"]).max() / done["E"][0], 0, "rise of the energy between two readings, relative")
    free = run(library, {"method": "adams"}, times, 1e-4)
    beyond(np.diff(free["E"]).max() / free["E"][0], 9e-8, "rise without friction, relative")  # at a looser tolerance
    looser = run(library, FRICTION, [0.0, 600.0], 1e-6)
    assert looser.counters["n_events"] == done.counters["n_events"] == len(done.events) > 3000
    rhs = [run(library, FRICTION, [0.0, stop], 1e-8).counters["n_rhs"] for stop in (50.0, 150.0, 500.0, 600.0)]
    within((rhs[3] - rhs[2]) / (rhs[1] - rhs[0]), 1.1, "evaluations, late over early")


def test_a_slide_under_a_narrow_law_is_that_under_the_exact_law(library: Library) -> None:
    """Braked, often to a locked wheel, at a tight tolerance: the spin and the direction of slip both settle at once."""
    random, times, errors, others = np.random.default_rng(4), np.linspace(0, 1, 11), [], []
    for _ in range(40):
        start = {"mu_max": random.uniform(0.1, 0.6), "s": 0.01, "theta_start": random.uniform(0.9, 1.57)}
        start |= {"mu_slide": start["mu_max"] * random.uniform(0.7, 1), "phi_dot_start": random.uniform(-15, 15)}
        start |= {"slip_y_start": random.normal(), "M_brake": random.choice([20.0, 200.0, 1000.0])}
        start |= {"keep_contact": True}
        narrow = {"friction_law": "regularized", "omega_s": 1e-9}
        exact = run(library, start, times, 1e-11)
        errors.append(error_against(exact, run(library, start | narrow, times, 1e-10)))
        others.append(error_against(exact, run(library, start | narrow | {"omega_s": 1e-4}, times, 1e-10)))
    bound = 10 * law_bound(1e-9, 1e-10)
    within(max(errors), bound, "error of the law / range")
    beyond(max(others), bound, "error of a wide law / range")


def evaluations_to_and_fro(wheel, **law: str | float) -> int:
    """Of an upright wheel that a moment turns back twenty times."""
    w = wheel().start(theta_start=np.pi / 2, s=0.01, keep_contact=True, tolerance=1e-8, **law)
    for k in range(20):
        w.set(M_3=20.0 * (-1) ** k)
        assert w.step(0.8 if k else 0.4) == OK
    return w.get("n_rhs")[0]


@pytest.mark.parametrize("omega_s", [1e-7, 1e-8])
def test_after_a_brief_passage_the_steps_are_as_long_as_before_it(wheel, omega_s: float) -> None:
    law = {"friction_law": "regularized", "omega_s": omega_s}
    exact = evaluations_to_and_fro(wheel)
    within((evaluations_to_and_fro(wheel, **law) - exact) / 20, 240, "evaluations of a passage")
    bdf = evaluations_to_and_fro(wheel, **law, method="bdf")
    beyond((bdf - exact) / 20, 240, "evaluations of a passage, collocation and BDF")


# ---- what is tuned counts: a law that becomes stiff is solved by its layer from there on ----


@pytest.mark.parametrize("before", [(), (0.5,)], ids=["before the first step", "during the run"])
@pytest.mark.parametrize("omega_s", [1e-5, 1e-7])
def test_a_coefficient_that_is_tuned_later_costs_no_more_steps(wheel, omega_s, before):
    law = {"friction_law": "regularized", "omega_s": omega_s}
    first = wheel().start(**FRICTION, **law).to(10.0)
    tuned = wheel().start(**law).to(*before).put(**FRICTION).to(10.0)
    within(tuned.get("n_steps")[0] / first.get("n_steps")[0], 1.1, "steps, tuned later over from the start")
    assert min(*first.get("n_jac"), *tuned.get("n_jac")) > 0  # with the first choice kept, 36


@pytest.mark.parametrize("seed", range(40))
def test_a_law_that_becomes_stiff_inside_a_step_costs_what_bdf_costs_on_any_grid(played, seed):
    rng = np.random.default_rng(seed)
    start = {"phi_dot_start": rng.choice([-1, 1]) * rng.uniform(0.2, 4), "theta_start": rng.uniform(1.2, 1.9)}
    start |= {"s": rng.choice([0.0, 0.01]), "omega_s": 10 ** rng.uniform(-8, -3)}
    start |= {"tolerance": 10 ** rng.uniform(-9, -6), "friction_law": "regularized", "keep_contact": True}
    rise, bend = 10 ** rng.uniform(0, 1.3), rng.uniform(0, 2)

    def end(cuts=(), factor=1.0, **choices):
        brake = [(0.0, {"M_brake": (0.0, factor * rise, bend)})]
        return played(brake, 3.0, cuts, ("n_steps", "omega_z", "theta"), **start, **choices)

    bdf = end(method="bdf")
    for count in (0, 1, 30, 300):
        steps, *found = end(np.sort(rng.uniform(0, 3, count)))
        within((steps - count) / bdf[0], 1.5, "steps over those of BDF")  # an input that varies cuts at each point
        within(absolute_error(found, bdf[1:]), 1e-4, "motion off that of BDF, rad/s, rad")
    beyond(absolute_error(end(factor=1.01)[1:], found), 1e-6, "motion off that of a stronger brake")


@pytest.mark.parametrize("seed", [41, 64, 172, 184, 477, 1169])
def test_a_release_from_the_layer_is_as_exact_as_the_tolerance(library: Library, seed: int) -> None:
    """There omega_z leaves its balance within one step, and what is left of it moves the whole motion after it."""
    random, times, columns = np.random.default_rng(seed), np.linspace(0, 4, 21), ("X_O", "Y_O", "theta", "omega_z")
    start = {"theta_start": random.uniform(0.9, np.pi - 0.9), "psi_dot_start": random.normal()}
    start |= {"theta_dot_start": random.normal(0, 0.7), "phi_dot_start": random.normal(0, 4)}
    start |= {"s": random.uniform(0.003, 0.06), "omega_s": 10 ** random.uniform(-5.2, -3.8)}

    def moved(tolerance: float, **changes: float) -> Run:
        return run(library, {"friction_law": 2, **start, **changes}, times, tolerance)

    def distance(other: Run) -> float:
        return max(float(np.abs(other[name] - exact[name]).max() / np.ptp(exact[name])) for name in columns)

    exact = moved(1e-13)
    shifts = ("theta_start", "phi_dot_start", "psi_dot_start")
    growth = max(1.0, *(distance(moved(1e-13, **{name: start[name] + 1e-9})) / 1e-9 for name in shifts))
    within(distance(moved(1e-8)) / 1e-8 / growth, 5, "error / range over tolerance and growth")
