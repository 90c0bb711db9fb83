"""Which branch of the contact holds: Filippov's rule, and the margins that end a branch.

sigma: the sign of w_z while the wheel rolls, 0 while w_z is held at zero (exact law).
ground: +1 while the ground pushes (N > 0), -1 while it pulls (two-sided contact, N < 0).
While the ground pulls there is no rolling friction (a choice: the paper's -s N sign(w_z) would
then drive the wheel and its zero would repel) and sigma is not watched; pulled_friction =
"magnitude" takes s |N| instead. A brake acts whatever the ground does.
"""

from dataclasses import dataclass
from typing import NamedTuple

from .frames import rotation, slope
from .model import Inputs, Wheel, released
from .motion import OMEGA_Z, State, respond
from .newton_euler import Contact, Law, axle_moment, stick_margins

CLEAR, PUSH, ROLL = 0, 1, 2  # positions in Switch.margins; held: ROLL towards +, ROLL + 1 towards -
Side = tuple[float, float]

# N counts as changed in sign beyond this fraction of m (g + |w|^2 (r_0 + r)): rounding leaves about
# 1e-15 of it, so that a wheel without weight rolling straight (N = 0 for ever) has no transitions.
N_ROUNDING = 1e-12


class Mode(NamedTuple):
    """One smooth branch of the motion."""

    sigma: int
    ground: int


@dataclass(frozen=True)
class Options:
    """How solve() treats contact and time.

    keep_contact False: N = 0 ends the run (lift-off).  flat: the sine of theta at which the wheel counts as flat and
    the run ends; None: not watched.
    """

    rtol: float = 1e-13
    keep_contact: bool = True
    flat: float | None = 1e-6
    pulled_friction: str = "none"


class Switch:
    """Chooses and watches the modes of one wheel."""

    def __init__(self, wheel: Wheel, inputs: Inputs, options: Options) -> None:
        self.contact = Contact(wheel)
        self.inputs = inputs
        self.options = options
        self.brakes = inputs.brake is not released
        self.switches = wheel.s > 0 or self.brakes
        self._pull = {"none": 0.0, "magnitude": -wheel.s}[options.pulled_friction]

    def _s(self, ground: int) -> float:
        return self.contact.wheel.s if ground > 0 else self._pull

    def watched(self, ground: int) -> bool:
        """True where sigma switches: exact law, and a friction to switch."""
        return self.switches and (self.brakes or self._s(ground) != 0)

    def law(self, mode: Mode, t: float) -> Law:
        """The friction branch of a mode, with the brake's capacity at t."""
        s, brake = self._s(mode.ground), self.inputs.brake(t)
        if not self.watched(mode.ground):
            return Law(s, brake=brake)
        return Law(s, mode.sigma, hold=mode.sigma == 0, brake=brake)

    def choose(self, t: float, y: State, ground: int | None = None) -> Mode:
        """The mode in which the motion goes on from (t, y); w_z = 0 exactly asks Filippov's rule.

        At w_z = 0: held if |tau| <= s N + brake; else w_z takes the sign of -tau, tau the holding moment.
        """
        values = y.tolist()
        answer = respond(self.contact, self.inputs, t, values)[1]
        if ground is None:
            ground = 1 if answer.N_0 + self._rounding(values[4:7]) >= 0 else -1
        w_z = values[OMEGA_Z]
        if w_z or not self.watched(ground):
            return Mode((w_z > 0) - (w_z < 0), ground)
        rising, falling = stick_margins(self.law(Mode(0, ground), t), answer)
        return Mode(1 if rising < 0 else -1 if falling < 0 else 0, ground)

    def _rounding(self, w: list[float]) -> float:
        wheel = self.contact.wheel
        spin = (w[0] ** 2 + w[1] ** 2 + w[2] ** 2) * (wheel.r_0 + wheel.r)
        return N_ROUNDING * wheel.m * (wheel.g + spin)

    def margins(self, mode: Mode, side: Side, t: float, y: State) -> tuple[list[float], Side]:
        """[not flat, ground as it is, friction branch ...], each positive while the mode lasts.

        side: e2 in body axes shortly before; where e2 has turned over since, the wheel has passed
        flat, and s = sin(theta) counts as negative. Returns the side here as well.
        """
        values = y.tolist()
        n = rotation(*values[:4])[2]
        ux, uy, s = slope(n)
        over = -1.0 if ux * side[0] + uy * side[1] < 0 else 1.0
        clear = 1.0 if self.options.flat is None else over * s - self.options.flat
        answer = respond(self.contact, self.inputs, t, values)[1]
        law = self.law(mode, t)
        if law.s * abs(answer.N_1) >= 1:
            raise RuntimeError(f"the contact is indeterminate at t = {t!r} s: s |dN/dtau| >= 1")
        N = answer.N_0 + axle_moment(law, answer) * answer.N_1
        found = [clear, mode.ground * N + self._rounding(values[4:7])]
        if law.hold:
            found += stick_margins(law, answer)
        elif self.watched(mode.ground):
            found.append(mode.sigma * values[OMEGA_Z])
        return found, (over * ux, over * uy)

    def after(self, mode: Mode, margin: int, t: float, y: State) -> Mode:
        """The mode after margin number `margin` has fallen to zero at (t, y)."""
        if margin == PUSH:
            return self.choose(t, y, -mode.ground)
        if mode.sigma == 0:
            return Mode(1 if margin == ROLL else -1, mode.ground)
        return self.choose(t, y, mode.ground)
