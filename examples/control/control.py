"""wheel.fmu for a control engineer: linearized, stabilized, and steered optimally, through model exchange.

    python control.py wheel.fmu FOLDER       (or ./scripts/example control)

Three parts, a picture each: eigenvalues of straight rolling over the spin against the closed form of the critical spin;
a linear-quadratic regulator from the same matrices, in co-simulation; an optimal control problem solved by CasADi.
Straight rolling: upright, along X, omega_z < 0. SI units.
"""

import sys
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import casadi as ca
import matplotlib.pyplot as plt
import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from scipy.linalg import solve_continuous_are
from scipy.optimize import bisect

with suppress(ImportError):  # of the project; a copy of this folder has matplotlib's own look
    from diagrams import style

    style.use_style()
    plt.rcParams["axes.prop_cycle"] = plt.cycler(color=[style.BLUE, style.VERMILLION])

STATES = ("X_O", "Y_O", "psi", "theta", "phi", "theta_dot", "psi_dot", "omega_z")
DERIVATIVES = ("X_O_dot", "Y_O_dot", "psi_dot", "theta_dot", "phi_dot", "theta_ddot", "psi_ddot", "omega_z_dot")
OFF = ("Y_O", "psi", "theta", "theta_dot", "psi_dot", "omega_z")  # what the regulator holds
MOMENTS = ("M_1", "M_2", "M_3")
UPRIGHT = {"theta_start": np.pi / 2, "psi_start": 0.0, "X_O_start": 0.0}
J_x, J_z, m, r_0, R, g = 0.9, 1.8, 20.0, 0.3, 0.35, 9.81  # the paper's wheel
BOUNDS = np.array([10.0, 6.0])  # N m, of |M_1| and |M_3| in the optimal control problem
CRITICAL = np.sqrt(m * g * r_0 * J_x / (J_z * (J_z + m * R**2)))  # rad/s, below it straight rolling is unstable


@contextmanager
def instance(folder: str, kind: str, **values: float):
    """An instance for "ModelExchange" or "CoSimulation" with these start values, initialized."""
    description = read_model_description(folder)
    references = {v.name: v.valueReference for v in description.modelVariables}
    fmu = instantiate_fmu(folder, description, kind)
    fmu.setReal([references[name] for name in values], list(values.values()))
    fmu.setupExperiment()
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    try:
        yield fmu, references
    finally:
        fmu.terminate()
        fmu.freeInstance()


def linearized(folder: str, omega_z: float, inputs: tuple[str, ...] = ()) -> tuple[np.ndarray, np.ndarray]:
    """A = d derivatives / d states and B = d derivatives / d inputs of straight rolling."""
    with instance(folder, "ModelExchange", **UPRIGHT, phi_dot_start=omega_z) as (fmu, reference):
        unknowns = [reference[name] for name in DERIVATIVES]
        columns = [fmu.getDirectionalDerivative(unknowns, [reference[name]], [1.0]) for name in (*STATES, *inputs)]
    matrix = np.array(columns).T
    return matrix[:, : len(STATES)], matrix[:, len(STATES) :]


def draw_eigenvalues(folder: str) -> str:
    """The real parts over the spin, and the spin at which the largest vanishes, by bisection."""

    def real_parts(spin: float) -> np.ndarray:
        return np.linalg.eigvals(linearized(folder, -spin)[0]).real

    spins = np.linspace(0.5, 5, 91)
    values = [real_parts(spin) for spin in spins]
    _, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
    axes.plot(np.repeat(spins, len(STATES)), np.ravel(values), ".", ms=3, label="real parts, by wheel.fmu")
    axes.axvline(CRITICAL, color="C1", label="critical spin, closed form")
    axes.set(xlabel=r"spin $|\omega_z|$ [rad/s]", ylabel="real part of the eigenvalues [1/s]")
    axes.set_title("Straight rolling, linearized")
    axes.legend()
    spin = bisect(lambda spin: real_parts(spin).max() - 1e-4, 1.0, 5.0)
    return f"critical spin: {spin:.6f} rad/s by the eigenvalues, {CRITICAL:.6f} rad/s by the closed form"


def regulator(folder: str, omega_z: float) -> np.ndarray:
    """Gains on OFF for M_1, M_2, M_3, from the Riccati equation."""
    kept = [STATES.index(name) for name in OFF]
    A, B = linearized(folder, omega_z, MOMENTS)
    A, B = A[np.ix_(kept, kept)], B[kept]
    weight = np.diag([100.0, 30.0, 100.0, 1.0, 1.0, 10.0])
    effort = np.diag([0.01, 0.1, 0.1])
    return np.linalg.solve(effort, B.T @ solve_continuous_are(A, B, weight, effort))


def rolled(folder: str, gains: np.ndarray | None, spin: float, h: float = 0.01, stop: float = 6.0) -> np.ndarray:
    """t, Y_O and the lean in degrees, in co-simulation; the controller reads and sets once per step of h, s."""
    begin = {**UPRIGHT, "theta_start": np.pi / 2 - 0.15, "Y_O_start": 0.3, "phi_dot_start": spin}
    rows = []
    with instance(folder, "CoSimulation", **begin) as (fmu, reference):
        observed, moments = ([reference[n] for n in names] for names in (OFF, MOMENTS))
        for t in np.arange(0, stop, h):
            z = np.array(fmu.getReal(observed)) - [0, 0, np.pi / 2, 0, 0, spin]
            rows.append((t, z[0], np.degrees(z[2])))
            if abs(z[2]) > 1.5:
                break  # it lies nearly flat
            if gains is not None:
                fmu.setReal(moments, list(-gains @ z))
            fmu.doStep(t, h)
    return np.array(rows).T


def draw_regulator(folder: str) -> str:
    """A wheel below the critical spin: its largest lean alone, and the lean at the end with the regulator."""
    spin = -1.5
    alone, regulated = rolled(folder, None, spin), rolled(folder, regulator(folder, spin), spin)
    _, axes = plt.subplots(2, 1, figsize=(7.2, 4.4), sharex=True, layout="constrained")
    for ax, k, label in zip(axes, (1, 2), ("off the line, $Y_O$ [m]", r"lean, $\theta - 90°$ [deg]"), strict=True):
        ax.plot(alone[0], alone[k], label="alone")
        ax.plot(regulated[0], regulated[k], label="with the regulator")
        ax.set_ylabel(label)
    axes[0].set_title(rf"Below the critical spin: $|\omega_z|$ = {-spin} rad/s")
    axes[1].set(xlabel="time [s]", yticks=range(-90, 91, 45))
    axes[1].legend(loc="upper right")
    fallen, held = np.abs(alone[2]).max(), abs(regulated[2][-1])
    return f"lean: {fallen:.0f} deg alone, {held:.2g} deg after 6 s with the regulator"


def optimal(folder: str, duration: float = 3.0, intervals: int = 60) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, states and moments M_1, M_3 that bring a leaning wheel upright onto the line Y_O = 0, heading along X.

    Direct transcription by the implicit midpoint rule; CasADi takes the derivatives from the FMU.
    """
    dae = ca.DaeBuilder("wheel", folder, {"debug": False})
    names, u_names = dae.x(), dae.u()
    f = dae.create("f", ["x", "u"], ["ode"])
    opti, h = ca.Opti(), duration / intervals
    x, moments = opti.variable(len(names), intervals + 1), opti.variable(2, intervals)
    scale = ca.DM([0.05 if n == "phi" else 1.0 for n in names])
    begin = {"theta": np.pi / 2 - 0.2, "Y_O": 0.2, "omega_z": -4.0}
    start = ca.DM([begin.get(n, 0.0) for n in names])
    opti.subject_to(x[:, 0] == start)
    load = ca.DM([[n == "M_1", n == "M_3"] for n in u_names])
    for k in range(intervals):
        middle = f((x[:, k] + x[:, k + 1]) / 2, load @ moments[:, k])
        opti.subject_to(scale * (x[:, k + 1] - x[:, k] - h * middle) == 0)
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
    return t, solution.value(x)[[names.index(name) for name in STATES]], solution.value(moments)


def checked(folder: str, t: np.ndarray, x: np.ndarray, moments: np.ndarray) -> np.ndarray:
    """The states at the end when co-simulation follows the moments found."""
    begin = {f"{name}_start": value for name, value in zip(STATES[:-1], x[:-1, 0], strict=True)}
    begin["phi_dot_start"] = x[7, 0] - x[6, 0] * np.cos(x[3, 0])  # omega_z - psi_dot cos(theta)
    with instance(folder, "CoSimulation", **begin) as (fmu, reference):
        for k, h in enumerate(np.diff(t)):
            fmu.setReal([reference["M_1"], reference["M_3"]], list(moments[:, k]))
            fmu.doStep(t[k], h)
        return np.array(fmu.getReal([reference[name] for name in STATES]))


def draw_optimal(folder: str) -> str:
    """The optimum, and how far co-simulation ends from its end: the error of 60 steps of the midpoint rule."""
    t, x, moments = optimal(folder)
    _, axes = plt.subplots(3, 1, figsize=(7.2, 5.8), layout="constrained")
    axes[0].plot(x[0], x[1])
    axes[0].set(xlabel="$X_O$ [m]", ylabel="$Y_O$ [m]", aspect="equal")
    axes[0].set_title("Upright and onto the line, with the least effort")
    axes[1].plot(t, np.degrees(x[3]) - 90, label=r"lean, $\theta - 90°$")
    axes[1].plot(t, np.degrees(x[2]), label=r"heading $\psi$")
    axes[1].set(xlabel="time [s]", ylabel="angle [deg]")
    axes[2].step(t[:-1], moments.T, where="post", label=["$M_1$", "$M_3$"])
    axes[2].set(xlabel="time [s]", ylabel="moment [N m]")
    for part in axes[1:]:
        part.legend()
    off = np.abs(checked(folder, t, x, moments) - x[:, -1])[[1, 2, 3]].max()
    return f"optimal moments, followed in co-simulation: {off:.2g} off the end"


def main() -> None:
    fmu, results = Path(sys.argv[1]), Path(sys.argv[2])
    results.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        extract(fmu, unzipdir=folder)
        for draw in (draw_eigenvalues, draw_regulator, draw_optimal):
            print(draw(folder))
            plt.savefig(results / f"{draw.__name__.removeprefix('draw_')}.png", dpi=200)
    print(f"Pictures are in {results}.")


if __name__ == "__main__":
    main()
