"""The wheel, its start and its inputs, as plain data (reference solution, no frame).

Symbols, defaults and units are those of the paper's (27)-(33); SI throughout.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, inf, nextafter, pi, sin

Vector = tuple[float, float, float]
ZERO: Vector = (0.0, 0.0, 0.0)


def no_input(_t: float) -> Vector:
    """The input that is never set."""
    return ZERO


def released(_t: float) -> float:
    """The brake that is never set, N m."""
    return 0.0


@dataclass(frozen=True)
class Wheel:
    """Parameters (27)-(31): any principal central moments; the body z axis is the axle; the road may slope."""

    m: float = 20.0
    r_0: float = 0.3
    r: float = 0.05
    J_x: float = 0.9
    J_y: float = 0.9
    J_z: float = 1.8
    g: float = 9.81
    s: float = 0.0
    slope: float = 0.0  # rad, of the road, which stays the plane Z = 0: the weight tilts
    slope_direction: float = 0.0  # rad, where the road rises in X-Y

    @property
    def gravity(self) -> Vector:
        """Acceleration of a free fall, fixed axes."""
        along = -self.g * sin(self.slope)
        return (along * cos(self.slope_direction), along * sin(self.slope_direction), -self.g * cos(self.slope))


@dataclass(frozen=True)
class Start:
    """Pose and Euler rates (32), (33); Z_O and the velocity of O follow from the contact."""

    psi: float = pi / 2
    theta: float = 5 * pi / 12
    phi: float = 0.0
    psi_dot: float = 0.0
    theta_dot: float = 0.0
    phi_dot: float = -2.0
    X_O: float = -0.3 * cos(5 * pi / 12)
    Y_O: float = 0.0


@dataclass(frozen=True)
class Inputs:
    """External load besides the weight.

    force: (F_X, F_Y, F_Z) at O in fixed axes, N.  moment: (M_1, M_2, M_3) along the non-spinning axes
    e1 (line of nodes), e2 (up the slope), e3 (axle), N.m.  brake: capacity of a dry brake about the axle, N.m, >= 0.
    jumps: instants at which one of them jumps or has a kink; all are read as continuous from the right.
    """

    force: Callable[[float], Vector] = no_input
    moment: Callable[[float], Vector] = no_input
    jumps: tuple[float, ...] = field(default=())
    brake: Callable[[float], float] = released

    def before(self, stop: float) -> "Inputs":
        """The same inputs up to a jump at `stop`: there and later, their values just before it."""
        if not self.jumps:
            return self
        last, force, moment, brake = nextafter(stop, -inf), self.force, self.moment, self.brake
        held = released if brake is released else lambda t: brake(min(t, last))
        return Inputs(lambda t: force(min(t, last)), lambda t: moment(min(t, last)), brake=held)


@dataclass(frozen=True)
class Road:
    """Coulomb's law: grip up to mu_max N, mu_slide N against the slip. mu_max = 0: an icy road without any friction;
    infinite: the wheel rolls whatever that needs, also on a ground that pulls.

    slip: velocity at the start of the wheel's material point at the contact, along e1 and to the left of it, m/s.
    """

    mu_max: float = inf
    mu_slide: float = inf
    slip: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Options:
    """How solve() treats contact and time.

    keep_contact False: N = 0 ends the run (lift-off).  flat: the sine of theta at which the wheel counts as flat and
    the run ends; None: not watched.  omega_s > 0: the regularized law of rolling resistance, of this width.
    pulled: rolling resistance on a ground that pulls, as a part of s |N|.  None is a choice: the paper's -s N sign(w_z)
    would then drive the wheel and its zero would repel.
    """

    rtol: float = 1e-13
    keep_contact: bool = True
    flat: float | None = 1e-6
    omega_s: float = 0.0
    pulled: float = 0.0
