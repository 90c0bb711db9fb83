"""The paper's free wheel (27)-(33), set rolling by its system (24) with one of its misprints kept: for the proofs in
test_errata.py and the picture of docs/errata.md. SciPy; the state is (q, q_dot) of (25).
"""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp

from wheelfmu.fmu import equations as eq
from wheelfmu.truth.paper_transcription import Paper, paper_table, set_rolling

WHEEL = paper_table()


def papers_start() -> np.ndarray:
    return set_rolling(WHEEL, np.array(eq.PAPER_START))


@cache
def rolled(end: float, *printed: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Instants, states and energies of the free wheel, with the named misprints of Paper kept.

    Ends early where O reaches the ground: Z_O = 0.
    """

    def rate(_t: float, y: np.ndarray) -> np.ndarray:
        return Paper(WHEEL, y, printed).rate

    def above_ground(_t: float, y: np.ndarray) -> float:
        return y[2]

    above_ground.terminal = True  # type: ignore[attr-defined]
    times_out = np.linspace(0, end, 501)
    run = solve_ivp(rate, (0, end), papers_start(), "DOP853", times_out, events=above_ground, rtol=1e-9, atol=1e-9)
    return run.t, run.y.T, Paper(WHEEL, run.y.T).energy
