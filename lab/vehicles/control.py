"""wheel.fmu for a control engineer: linearized, stabilized, and steered optimally, through model exchange.

    python control.py wheel.fmu FOLDER       (or ./scripts/example control)

Three parts, a picture each: eigenvalues of straight rolling over the spin against the closed form of the critical spin;
a linear-quadratic regulator from the same matrices, in co-simulation; an optimal control problem solved by CasADi.
Straight rolling: upright, along X, omega_z < 0. SI units.
"""

import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import casadi as ca
import matplotlib.pyplot as plt
import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from scipy.linalg import solve_continuous_are
from scipy.optimize import bisect

with suppress(ImportError):  # of the project; a copy of this folder has matplotlib's own look
    from wheelfmu.diagrams import style

    style.use_style()
    plt.rcParams["axes.prop_cycle"] = plt.cycler(color=[style.BLUE, style.VERMILLION])

OFF = ("Y_O", "psi", "theta", "theta_dot", "psi_dot", "omega_z")  # what the regulator holds
MOMENTS = ("M_1", "M_2", "M_3")
J_x, J_z, m, r_0, R, g = 0.9, 1.8, 20.0, 0.3, 0.35, 9.81  # the paper's wheel
BOUNDS = np.array([10.0, 6.0])  # N m, of |M_1| and |M_3| in the optimal control problem
CRITICAL = np.sqrt(m * g * r_0 * J_x / (J_z * (J_z + m * R**2)))  # rad/s, below it straight rolling is unstable


@cache
def model(folder: Path) -> ca.DaeBuilder:
    """The FMU for model exchange; its states: X_O, Y_O, psi, theta, phi, theta_dot, psi_dot, omega_z in some order."""
    return ca.DaeBuilder("wheel", str(folder), {"debug": False})


def linearized(folder: Path, omega_z: float) -> list[np.ndarray]:
    """A = d derivatives / d states and B = d derivatives / d inputs of straight rolling, in the order of the model."""
    dae, rolling = model(folder), {"theta": np.pi / 2, "omega_z": omega_z}
    jacobian = dae.create("jacobian", ["x", "u"], ["jac_ode_x", "jac_ode_u"])
    return [matrix.full() for matrix in jacobian([rolling.get(name, 0.0) for name in dae.x()], 0)]


def draw_eigenvalues(folder: Path) -> str:
    """The real parts over the spin, and the spin at which the largest vanishes, by bisection."""

    def real_parts(spin: float) -> np.ndarray:
        return np.linalg.eigvals(linearized(folder, -spin)[0]).real

    spins = np.linspace(0.5, 5, 91)
    values = [real_parts(spin) for spin in spins]
    _, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
    axes.plot(np.repeat(spins, len(values[0])), np.ravel(values), ".", ms=3, label="real parts, by wheel.fmu")
    axes.axvline(CRITICAL, color="C1", label="critical spin, closed form")
    axes.set(xlabel=r"spin $|\omega_z|$ [rad/s]", ylabel="real part of the eigenvalues [1/s]")
    axes.set_title("Straight rolling, linearized")
    axes.legend()
    spin = bisect(lambda spin: real_parts(spin).max() - 1e-4, 1.0, 5.0)
    return f"critical spin: {spin:.6f} rad/s by the eigenvalues, {CRITICAL:.6f} rad/s by the closed form"


def regulator(folder: Path, omega_z: float) -> np.ndarray:
    """Gains on OFF for M_1, M_2, M_3, from the Riccati equation."""
    dae, (A, B) = model(folder), linearized(folder, omega_z)
    kept = [dae.x().index(name) for name in OFF]
    A, B = A[np.ix_(kept, kept)], B[np.ix_(kept, [dae.u().index(name) for name in MOMENTS])]
    weight, effort = np.diag([100.0, 30.0, 100.0, 1.0, 1.0, 10.0]), np.diag([0.01, 0.1, 0.1])
    return np.linalg.solve(effort, B.T @ solve_continuous_are(A, B, weight, effort))


def rolled(folder: Path, times: np.ndarray, law: Callable[[int, dict], Sequence[float]], **start: float) -> dict:
    """The states by name at the times, in co-simulation, until the wheel lies nearly flat.

    law(k, states): the moments from times[k] to times[k + 1], of the states at times[k].
    """
    description, names = read_model_description(folder), model(folder).x()
    reference = {v.name: v.valueReference for v in description.modelVariables}
    fmu, rows = instantiate_fmu(folder, description, "CoSimulation"), []
    fmu.setReal([reference[f"{name}_start"] for name in start], list(start.values()))
    fmu.setupExperiment()
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    for k, h in enumerate([*np.diff(times), 0.0]):
        rows.append(fmu.getReal([reference[name] for name in names]))
        now = dict(zip(names, rows[-1], strict=True))
        if h == 0 or abs(now["theta"] - np.pi / 2) > 1.5:
            break
        fmu.setReal([reference[name] for name in MOMENTS], list(law(k, now)))
        fmu.doStep(times[k], h)
    fmu.terminate()
    fmu.freeInstance()
    return dict(zip(names, np.array(rows).T, strict=True))


def leaning(folder: Path, gains: np.ndarray, spin: float, h: float = 0.01, stop: float = 6.0) -> dict[str, np.ndarray]:
    """Time, distance from the line and lean in degrees of a wheel that starts with both; gains: of the regulator."""
    rolling, times = {"theta": np.pi / 2, "omega_z": spin}, np.arange(0, stop + h / 2, h)
    start = {"psi": 0.0, "X_O": 0.0, "theta": np.pi / 2 - 0.15, "Y_O": 0.3, "phi_dot": spin}
    x = rolled(folder, times, lambda _, now: -gains @ [now[n] - rolling.get(n, 0.0) for n in OFF], **start)
    return {"t": times[: len(x["theta"])], "off": x["Y_O"], "lean": 90 - np.degrees(x["theta"])}


def draw_regulator(folder: Path) -> str:
    """A wheel below the critical spin: its largest lean alone, and the lean at the end with the regulator."""
    spin = -1.5
    gains = regulator(folder, spin)
    wheels = {"alone": leaning(folder, 0 * gains, spin), "with the regulator": leaning(folder, gains, spin)}
    _, axes = plt.subplots(2, 1, figsize=(7.2, 4.4), sharex=True, layout="constrained")
    labels = {"off": "off the line, $Y_O$ [m]", "lean": r"lean, $90° - \theta$ [deg]"}
    for ax, (name, label) in zip(axes, labels.items(), strict=True):
        for wheel, x in wheels.items():
            ax.plot(x["t"], x[name], label=wheel)
        ax.set_ylabel(label)
    axes[0].set_title(rf"Below the critical spin: $|\omega_z|$ = {-spin} rad/s")
    axes[1].set(xlabel="time [s]", yticks=range(-90, 91, 45))
    axes[1].legend(loc="lower right")
    fallen, held = (np.abs(x["lean"]) for x in wheels.values())
    return f"lean: {fallen.max():.0f} deg alone, {held[-1]:.2g} deg after 6 s with the regulator"


def optimal(folder: Path, duration: float = 3.0, intervals: int = 60) -> tuple[np.ndarray, dict, Any]:
    """Times, states by name and moments M_1, M_3 that bring a leaning wheel upright onto Y_O = 0, heading along X.

    Direct transcription by the implicit midpoint rule; CasADi takes the derivatives from the FMU.
    """
    dae = model(folder)
    names, f = dae.x(), dae.create("f", ["x", "u"], ["ode"])
    opti, h = ca.Opti(), duration / intervals
    x, moments = opti.variable(len(names), intervals + 1), opti.variable(2, intervals)
    scale = ca.diag([0.05 if n == "phi" else 1.0 for n in names])
    begin = {"theta": np.pi / 2 - 0.2, "Y_O": 0.2, "omega_z": -4.0}
    start = ca.DM([begin.get(n, 0.0) for n in names])
    opti.subject_to(x[:, 0] == start)
    load = ca.DM([[n == "M_1", n == "M_3"] for n in dae.u()])
    middle = f.map(intervals)((x[:, :-1] + x[:, 1:]) / 2, load @ moments)
    opti.subject_to(ca.vec(scale @ (x[:, 1:] - x[:, :-1] - h * middle)) == 0)
    for name, value in {"theta": np.pi / 2, "theta_dot": 0.0, "psi": 0.0, "psi_dot": 0.0, "Y_O": 0.0}.items():
        opti.subject_to(x[names.index(name), -1] == value)
    for row, bound in enumerate(BOUNDS):
        opti.subject_to(opti.bounded(-bound, moments[row, :], bound))
    opti.minimize(h * ca.sumsqr(ca.DM(1 / BOUNDS) * moments))
    t = np.linspace(0, duration, intervals + 1)
    opti.set_initial(x, ca.repmat(start, 1, intervals + 1))
    for name, guess in {"phi": -4.0 * t, "X_O": 4.0 * R * t, "theta": np.pi / 2}.items():
        opti.set_initial(x[names.index(name), :], guess)
    options = {"ipopt.hessian_approximation": "limited-memory", "ipopt.print_level": 0, "ipopt.sb": "yes"}
    opti.solver("ipopt", {**options, "print_time": False})
    solution = opti.solve()
    return t, dict(zip(names, solution.value(x), strict=True)), solution.value(moments)


def followed(folder: Path, t: np.ndarray, x: dict, moments: np.ndarray) -> np.ndarray:
    """How far Y_O, psi and theta are off the optimum's end when co-simulation follows these moments."""
    start = {name: x[name][0] for name in x if name != "omega_z"}
    start["phi_dot"] = x["omega_z"][0] - x["psi_dot"][0] * np.cos(x["theta"][0])
    end = rolled(folder, t, lambda k, _: (moments[0, k], 0.0, moments[1, k]), **start)
    return np.array([end[name][-1] - x[name][-1] for name in ("Y_O", "psi", "theta")])


def draw_optimal(folder: Path) -> str:
    """The optimum, and how far co-simulation ends from its end: the error of 60 steps of the midpoint rule."""
    t, x, moments = optimal(folder)
    _, axes = plt.subplots(3, 1, figsize=(7.2, 5.8), layout="constrained")
    axes[0].plot(x["X_O"], x["Y_O"])
    axes[0].set(xlabel="$X_O$ [m]", ylabel="$Y_O$ [m]", aspect="equal")
    axes[0].set_title("Upright and onto the line, with the least effort")
    axes[1].plot(t, 90 - np.degrees(x["theta"]), label=r"lean, $90° - \theta$")
    axes[1].plot(t, np.degrees(x["psi"]), label=r"heading $\psi$")
    axes[1].set(xlabel="time [s]", ylabel="angle [deg]")
    axes[2].step(t[:-1], moments.T, where="post", label=["$M_1$", "$M_3$"])
    axes[2].set(xlabel="time [s]", ylabel="moment [N m]")
    for part in axes[1:]:
        part.legend()
    off = np.abs(followed(folder, t, x, moments)).max()
    return f"optimal moments, followed in co-simulation: {off:.2g} off the end"


def main() -> None:
    fmu, results = Path(sys.argv[1]), Path(sys.argv[2])
    results.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        extract(fmu, unzipdir=folder)
        for draw in (draw_eigenvalues, draw_regulator, draw_optimal):
            print(draw(Path(folder)))
            plt.savefig(results / f"{draw.__name__.removeprefix('draw_')}.png", dpi=200)
    print(f"Pictures are in {results}.")


if __name__ == "__main__":
    main()
