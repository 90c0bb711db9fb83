"""Independent reference solution of the rolling torus wheel (the paper's (1)-(33)).

Newton-Euler with a unit quaternion in body axes, all reactions unknown; it shares no formulation
with the product, which works with Euler angles in the carrier frame and with system (24).
"""

from .integrate import solve
from .model import Inputs, Start, Wheel
from .motion import Accelerations, accelerations
from .outputs import Ending, Solution

__all__ = ["Accelerations", "Ending", "Inputs", "Solution", "Start", "Wheel", "accelerations", "solve"]
