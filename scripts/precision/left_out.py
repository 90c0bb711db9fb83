"""What each omission saves: the same scene with the thing left out, and with it forced. docs/results/work_precision.md.

The tests (tests/contract/test_left_out.py) prove by counters that it is left out; here it is priced.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .builds import Build
from .measure import Record, drive
from .scenes import HEADLINE

ALL_OUTPUTS = (
    *HEADLINE,
    *("Y_O", "Z_O", "psi", "phi", "theta_dot", "X_O_dot", "Y_O_dot", "Z_O_dot"),
    *("omega_z", "lambda_1", "lambda_2", "lambda_3"),
)
# N, a jump the solver must restart for; m, friction that changes the motion by less than its rounding.
SMALL_FORCE, TINY_FRICTION = 1e-2, 1e-15


@dataclass(frozen=True)
class Omission:
    """without, with_: the driver's options of the two runs; values: start values of both."""

    what: str
    forced_by: str
    without: dict[str, Any]
    with_: dict[str, Any]
    values_without: dict[str, float]
    values_with: dict[str, float]


def omissions(build: Build) -> list[Omission]:
    force = build.references["F_X"][1]
    fine: dict[str, Any] = {"step": 1e-3, "stop": 10.0}
    coarse: dict[str, Any] = {"step": 0.1, "stop": 10.0}
    jump = {"jump": f"{force}={SMALL_FORCE}"}
    return [
        Omission("restart at each of 10,000 communication points", "an input that jumps", fine, fine | jump, {}, {}),
        Omission("restart at each of 100 communication points", "an input that jumps", coarse, coarse | jump, {}, {}),
        Omission(
            "taking over an input that did not change", "set to 0 each ms", fine, fine | {"jump": f"{force}=0"}, {}, {}
        ),
        Omission(
            "root function and friction moment", f"s = {TINY_FRICTION:g} m", coarse, coarse, {}, {"s": TINY_FRICTION}
        ),
        Omission("reading the other 12 outputs each ms", "all 16 read", fine, fine | {"outputs": ALL_OUTPUTS}, {}, {}),
        Omission("reading outputs at all each ms", "4 read", fine | {"outputs": ()}, fine, {}, {}),
        Omission("the system (24) where J_x = J_y", "formulation = multibody", coarse, coarse, {}, {"formulation": 3}),
        Omission("Jacobian and Newton iteration", "method = bdf", coarse, coarse, {}, {"method": 3}),
    ]


def row_of(omission: Omission, without: Record, with_: Record) -> dict[str, Any]:
    counts = {name: (without[name], with_[name]) for name in ("n_rhs", "n_roots", "n_jac", "n_restarts")}
    times = {"without": without["solve_best"], "with": with_["solve_best"]}
    return {"what": omission.what, "forced_by": omission.forced_by, **times, **counts}


def price(build: Build, seconds: float = 0.2) -> list[dict[str, Any]]:
    rows = []
    for omission in omissions(build):
        without = drive(build, omission.values_without, seconds=seconds, **omission.without)
        with_ = drive(build, omission.values_with, seconds=seconds, **omission.with_)
        rows.append(row_of(omission, without, with_))
    return rows


def price_of_events(build: Build, seconds: float = 0.3) -> dict[str, float]:
    """Cost of as many restarts as the friction wheel has: its free motion with and without that many jumps of a small
    force, as a share of the friction wheel's time."""
    friction = drive(build, {"s": 0.03}, step=0.1, stop=10.0, seconds=seconds)
    step = 10.0 / friction["n_restarts"] if friction["n_restarts"] else 10.0
    plain = drive(build, {}, step=step, stop=10.0, seconds=seconds)
    force = build.references["F_X"][1]
    jumping = drive(build, {}, step=step, stop=10.0, seconds=seconds, jump=f"{force}={SMALL_FORCE}")
    cost = jumping["solve_best"] - plain["solve_best"]
    return {
        "restarts": friction["n_restarts"],
        "share": cost / friction["solve_best"],
        "each": cost / max(1, jumping["n_restarts"] - plain["n_restarts"]),
        "rhs_each": (jumping["n_rhs"] - plain["n_rhs"]) / max(1, jumping["n_restarts"] - plain["n_restarts"]),
    }
