"""Scenes as data: the paper's two, and those that the shared tables do not cover."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin

from .model import Inputs, Start, Wheel

WHEEL, START, ALONE = Wheel(), Start(), Inputs()  # the paper's free wheel


@dataclass(frozen=True)
class Scene:
    """A wheel, its start, its inputs, and how long it runs (s)."""

    wheel: Wheel = WHEEL
    start: Start = START
    inputs: Inputs = ALONE
    duration: float = 10.0


PUSHED = Inputs(
    force=lambda t: (3 * sin(2 * t), 2 * cos(3 * t), -5 * sin(t)),
    moment=lambda t: (0.3 * cos(t), 0.2 * sin(2 * t), 0.5 * sin(3 * t)),
)
BRAKED = Inputs(moment=lambda t: (0.0, 0.0, 4.0 if t < 0.3 else -2.0), jumps=(0.3,))
GENERAL = {"J_x": 0.7, "J_y": 1.2, "J_z": 1.8}

SCENES = {
    "free": Scene(),
    "friction": Scene(Wheel(s=0.03)),
    "fast rolling": Scene(start=Start(phi_dot=-60.0), duration=1.0),
    "fast spin the other way": Scene(Wheel(s=0.001), Start(phi_dot=60.0), duration=1.0),
    "near flat": Scene(start=Start(theta=pi / 6, psi_dot=0.1, phi_dot=0.0), duration=2.0),
    "thin disc": Scene(Wheel(r=0.0, s=0.01), duration=5.0),
    "general inertia": Scene(Wheel(**GENERAL), duration=5.0),
    "general inertia, friction": Scene(Wheel(**GENERAL, s=0.03), duration=5.0),
    "light friction": Scene(Wheel(s=1e-4), duration=5.0),
    "heavy friction": Scene(Wheel(**GENERAL, s=0.2), duration=5.0),
    "past upright": Scene(Wheel(s=0.03), Start(theta=1.9, psi_dot=0.5, phi_dot=3.0), duration=5.0),
    "pushed": Scene(Wheel(**GENERAL, s=0.01), inputs=PUSHED, duration=5.0),
    "braked": Scene(Wheel(s=0.01), inputs=BRAKED, duration=2.0),
}
