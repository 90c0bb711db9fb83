"""Independent reference solution of the torus wheel (the paper's (1)-(33)), rolling and sliding.

Newton-Euler with a unit quaternion in body axes; no constraint is solved in advance. It shares no formulation
with the product, which works with Euler angles in the non-spinning frame and with system (24).
"""

from .integrate import solve, solve_stiffly
from .model import Inputs, Road, Start, Wheel
from .motion import Accelerations, accelerations
from .outputs import Ending, Solution

__all__ = [
    "Accelerations",
    "Ending",
    "Inputs",
    "Road",
    "Solution",
    "Start",
    "Wheel",
    "accelerations",
    "solve",
    "solve_stiffly",
]
