"""The car's manoeuvres over their full length as one set of equations, kept as tables: tests/car_NAME.csv.

    PYTHONPATH=tools:examples/vehicles:tests python -m vehicles.car_table [NAME...]

writes them again, which takes some minutes. The tests integrate a part of them once more.
"""

from __future__ import annotations

import sys

import numpy as np
from reference.tables import read_table, write_table
from scipy.integrate import solve_ivp

from . import errors, monolithic_car
from .layout import COMPARED, MANOEUVRES, TOO_FAST, WHEELS
from .options import EXAMPLES, Manoeuvre

FOLDER = EXAMPLES / "tests"
GRID = 0.25  # s
TOLERANCE = 1e-10  # relative and absolute, of each step
OF_WHEELS = tuple(f"{w}.{n}" for w in WHEELS for n in ("lambda_3", "omega_z"))
COLUMNS = ("time", *COMPARED, "X_R", "Y_R", "delta", "a_y", "beta", *OF_WHEELS)
NAMES = tuple(name for name in MANOEUVRES if name != TOO_FAST.name)


def integrate(manoeuvre: Manoeuvre, stop: float | None = None, tolerance: float = TOLERANCE) -> dict[str, np.ndarray]:
    """The manoeuvre, or its begin up to `stop` [s], on the grid."""
    times = np.arange(round((stop or manoeuvre.stop) / GRID) + 1) * GRID
    found = monolithic_car.solve(manoeuvre, times, tolerance)
    return {name: found[name] for name in COLUMNS}


def read(name: str) -> dict[str, np.ndarray]:
    """A manoeuvre from its table; columns as those of car.Run."""
    return dict(zip(COLUMNS, read_table(str(FOLDER / f"car_{name}")).values(), strict=True))


def apart(table: dict[str, np.ndarray], truth: dict[str, np.ndarray]) -> dict[str, float]:
    """Error of each compared variable."""
    every, count = round(GRID / (table["time"][1] - table["time"][0])), len(truth["time"])
    assert np.allclose(table["time"][::every][:count], truth["time"]), "the run has other instants than the table"
    on_grid = {name: table[name][::every][:count] for name in COMPARED}
    return errors.apart(on_grid, truth, COMPARED)


def lift_off(manoeuvre: Manoeuvre) -> tuple[str, float]:
    """Which wheel lifts off first, and when [s], in a manoeuvre without friction that is too fast for the car."""
    system, sigma = monolithic_car.Car(manoeuvre), np.full(len(WHEELS), -1.0)

    def normal_forces(t: float, y: np.ndarray) -> np.ndarray:
        return system.answer(t, y, sigma)[1].force[:, 2]

    def lowest(t: float, y: np.ndarray, _sigma: np.ndarray) -> float:
        return float(normal_forces(t, y).min())

    lowest.terminal = True
    found = solve_ivp(
        system.rate, (0, manoeuvre.stop), system.start(), "DOP853", events=lowest, args=(sigma,),
        rtol=1e-8, atol=1e-8, max_step=0.05,
    )  # fmt: skip
    if not found.t_events[0].size:
        raise RuntimeError(f"{manoeuvre.name}: no wheel lifts off.")
    at = float(found.t_events[0][0])
    return list(WHEELS)[int(normal_forces(at, found.y_events[0][0]).argmin())], at


def main() -> None:
    """The tables named, or all."""
    for name in sys.argv[1:] or NAMES:
        write_table(FOLDER / f"car_{name}.csv", integrate(MANOEUVRES[name]))
        print(f"car_{name}.csv")


if __name__ == "__main__":
    main()
