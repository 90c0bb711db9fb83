"""Scenes and set-ups as data, and the names the report reads. SI units; angles in rad."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, pi

HEADLINE = ("X_O", "theta", "phi_dot", "psi_dot")
COUNTERS = ("n_steps", "n_rhs", "n_jac", "n_roots", "n_events", "n_restarts")
POINTS = 101  # of the grid, both ends included
TOLERANCES = tuple(10.0**-k for k in range(3, 14))
TARGETS = (1e-4, 1e-6, 1e-8)  # errors at which set-ups are compared

PAPER = {
    **{"m": 20.0, "r_0": 0.3, "r": 0.05, "J_x": 0.9, "J_y": 0.9, "J_z": 1.8, "g": 9.81, "s": 0.0},
    **{"psi_start": pi / 2, "theta_start": 5 * pi / 12, "phi_start": 0.0},
    **{"psi_dot_start": 0.0, "theta_dot_start": 0.0, "phi_dot_start": -2.0},
    **{"X_O_start": -0.3 * cos(5 * pi / 12), "Y_O_start": 0.0},
}


@dataclass(frozen=True)
class Scene:
    """What differs from the paper's free wheel, and how long it runs (s)."""

    name: str
    title: str
    changes: dict[str, float] = field(default_factory=dict)
    stop: float = 10.0

    @property
    def values(self) -> dict[str, float]:
        """All parameters by their name in modelDescription.xml."""
        return {**PAPER, **self.changes}

    @property
    def symmetric(self) -> bool:
        return self.values["J_x"] == self.values["J_y"]

    @property
    def exact_friction(self) -> bool:
        return self.values["s"] > 0 and self.changes.get("friction_law", 1) == 1

    @property
    def regularized(self) -> bool:
        return self.changes.get("friction_law") == 2


SCENES = (
    Scene("free", "Free wheel (the paper's scene)"),
    Scene("friction", "Rolling friction, exact law, s = 0.03 m", {"s": 0.03}),
    Scene("stiff", "Regularized friction, omega_s = 1e-6 rad/s", {"s": 0.03, "friction_law": 2, "omega_s": 1e-6}),
    Scene("fast_spin", "Fast spin, phi_dot = -60 rad/s", {"phi_dot_start": -60.0}, 5.0),
    Scene(
        "near_flat",
        "Near flat, theta from 30 deg down to 1",
        {"theta_start": pi / 6, "psi_dot_start": 0.1, "phi_dot_start": 0.0, "keep_contact": 1},
        5.0,
    ),
    Scene("general_inertia", "General inertia, J_x = 0.7, J_y = 1.2 kg m2", {"J_x": 0.7, "J_y": 1.2}),
)


@dataclass(frozen=True)
class Setup:
    """One way to solve a scene. family: fmu | program (a C++ peer) | python (a peer in scripts/precision/worker.py)."""

    name: str
    family: str
    options: dict[str, float | str] = field(default_factory=dict)

    def key(self, tolerance: float) -> str:
        return f"{self.name}@{tolerance:.0e}"


def fmu_setups(scene: Scene, methods: dict[str, int]) -> list[Setup]:
    """Formulation x method; `methods` are the items of the enumeration in modelDescription.xml."""
    formulations = {"reduced": 2, "multibody": 3} if scene.symmetric else {"multibody": 3}
    setups = [Setup("FMU automatic", "fmu")]
    for formulation, code in formulations.items():
        for method, number in methods.items():
            if method != "automatic":
                setups.append(Setup(f"FMU {formulation} {method}", "fmu", {"formulation": code, "method": number}))
    return setups


def peer_setups(scene: Scene) -> list[Setup]:
    """Peers that can solve the scene as it stands; those that cannot are rows with the reason, from the peer itself."""
    form: dict[str, float | str] = {} if scene.symmetric else {"formulation": 3}
    setups = [Setup("DOP853 C++", "program", {"program": "dop853", **form})]
    setups.append(Setup("DOP853 C++ native", "program", {"program": "dop853_native", **form}))
    setups.append(Setup("heyoka", "python", {"solver": "heyoka"}))
    if scene.exact_friction:
        for naive in ("sign", "tanh"):
            setups += [
                Setup(f"SciPy {m}, {naive}()", "python", {"solver": m, "naive": naive}) for m in ("DOP853", "LSODA")
            ]
        return setups
    for solver in ("dopri5", "fehlberg78", "bulirsch_stoer"):
        setups.append(Setup(f"odeint {solver}", "program", {"program": "odeint", "solver": solver, **form}))
    for solver in ("DOP853", "LSODA", "Radau"):
        setups.append(Setup(f"SciPy {solver}", "python", {"solver": solver, **form}))
    for solver in ("lsoda", "dop853"):
        setups.append(Setup(f"numbalsoda {solver}", "python", {"solver": f"numbalsoda_{solver}", **form}))
    return setups
