"""Model exchange, call by call: states to the bit, derivatives, snapshots, endings, refusals."""

from ctypes import byref, c_double

import numpy as np
import pytest
from contract.call_states import EXCHANGE, call
from contract.test_foreign_states import AT_START, STEPPING, UNFOLDED, forged
from equations.multibody_transcription import omega_z_dot, solved
from equations.paper_transcription import Paper, times
from support import equations as eq
from support.bounds import beyond, within
from support.driver import DISCARD, ERROR, OK
from support.exchange import DERIVATIVES, STATES, FMU2Exchange, Run, exchange, loaded, no_inputs
from support.motion import Library

GENERAL = {"J_x": 0.7, "J_y": 1.2, "slope": 0.2, "slope_direction": 0.7, "psi_dot_start": 0.5, "F_X": 3.0, "M_2": 0.4}
ODD = np.array([0.1, -0.2, 0.3, 1.1, 0.7, 0.9, 1 / 3, -1.7])  # a state off every symmetry


def at_odd(library: Library, **values: float) -> FMU2Exchange:
    wheel = exchange(library, **{**GENERAL, **values})
    wheel.place(0.3, ODD)
    return wheel


def test_states_are_read_back_to_the_bit_also_after_a_restored_state(library: Library) -> None:
    with at_odd(library) as wheel, exchange(library) as other:
        assert (wheel.x() == ODD).all()
        assert wheel.get(*STATES) == ODD.tolist()
        assert (other.back(wheel.serialized()).x() == ODD).all()
        assert other.bits() == wheel.bits()
        assert (other.derivatives() == wheel.derivatives()).all()
        wheel.place(0.3, np.nextafter(ODD, np.inf))
        assert other.bits() != wheel.bits()


def test_the_derivatives_are_the_variables_of_that_name(library: Library) -> None:
    with at_odd(library, s=0.02) as wheel:
        assert wheel.derivatives().tolist() == wheel.get(*DERIVATIVES)
        beyond(np.abs(wheel.derivatives() - wheel.get(*reversed(DERIVATIVES))).max(), 1, "in another order")


def test_a_state_in_a_phase_of_co_simulation_is_refused(library: Library) -> None:
    with exchange(library) as wheel:
        blob = wheel.serialized()
        for phase in (AT_START, STEPPING, UNFOLDED):
            assert wheel.restore(forged(wheel, blob, phase=phase)) == ERROR, phase
        assert wheel.restore(forged(wheel, blob)) == OK  # the partner


def test_a_restored_wheel_goes_on_with_the_same_bits(library: Library) -> None:
    with exchange(library, s=0.03) as wheel, exchange(library) as other:
        Run(wheel, 1e-9, no_inputs).to(2.0)
        assert wheel.get("n_events")[0] > 2
        blob = wheel.serialized()
        ends = []
        for restored in (wheel, other):
            run = Run(restored.back(blob), 1e-9, no_inputs)
            run.t = 2.0
            restored.place(2.0, restored.x())
            run.to(4.0)
            ends.append(restored.bits())
        run.to(4.5)
        assert ends[0] == ends[1] != other.bits()


def test_a_state_of_one_kind_is_refused_by_the_other(library: Library) -> None:
    with exchange(library) as wheel, library.wheel(logging=True) as slave:
        assert slave.start().restore(wheel.serialized()) == ERROR
        assert "other kind" in slave.sentences[-1]
        assert wheel.restore(slave.serialized()) == ERROR
        slave.by(0.1)


def accelerations(constants: dict, load: dict, x: np.ndarray) -> np.ndarray:
    """The eight derivatives by the transcription of the paper's (24), for real or complex states."""
    scene = eq.table(eq.Scene, 1)
    for name, value in constants.items():
        scene["wheel"][name] = value
    scene["friction"]["kind"], scene["friction"]["omega_s"] = eq.FRICTIONLESS, 1
    X, Y, psi, theta, phi, theta_dot, psi_dot, omega_z = x
    phi_dot = omega_z - psi_dot * np.cos(theta)
    y = np.array([[X, Y, 0, psi, theta, phi, 0, 0, 0, psi_dot, theta_dot, phi_dot]])
    paper = Paper(scene["wheel"], y)
    y[:, 6:9] = -times(paper.B[..., 3:], y[:, 9:])  # rolling, (19)
    paper = Paper(scene["wheel"], y)
    q = solved(paper, scene, {name: np.array([value]) for name, value in load.items()})
    return np.array([y[0, 6], y[0, 7], psi_dot, theta_dot, phi_dot, q[0, 4], q[0, 3], omega_z_dot(paper, q, scene)[0]])


def complex_jacobian(constants: dict, load: dict, x: np.ndarray) -> np.ndarray:
    """d derivatives / d (states, F_X, M_2) by complex steps."""
    h, columns = 1e-30, []
    for k in range(8):
        columns.append(accelerations(constants, load, x + 1j * h * np.eye(8)[k]).imag / h)
    for name, entry in (("F", 0), ("M", 1)):
        moved = {key: np.array(value, complex) for key, value in load.items()}
        moved[name][entry] += 1j * h
        columns.append(accelerations(constants, moved, x.astype(complex)).imag / h)
    return np.array(columns).T


@pytest.mark.parametrize("theta", [1.1, 0.02], ids=["odd", "nearly flat"])
def test_directional_derivatives_agree_with_complex_steps_through_the_papers_system(library: Library, theta) -> None:
    wheel = eq.paper_wheel(J_x=0.7, J_y=1.2)
    eq.LIBRARY.wheel_set_slope(byref(wheel), 9.81, 0.2, 0.7)
    constants = {name: getattr(wheel, name) for name, _ in eq.Parameters._fields_}
    load = {"F": np.array([3.0, 0, 0]), "M": np.array([0, 0.4, 0]), "brake": np.array(0.0)}
    x = np.where(ODD == 1.1, theta, ODD)
    want = complex_jacobian(constants, load, x)
    with at_odd(library) as w:
        w.place(0.3, x)
        got = w.jacobian(DERIVATIVES, (*STATES, "F_X", "M_2"))
    within(np.abs(got - want).max() / np.abs(want).max(), 2e-10, "Jacobian")
    beyond(np.abs(got * (1 + 1e-6) - want).max() / np.abs(want).max(), 2e-7, "Jacobian, a millionth larger")


@pytest.mark.parametrize("law", [{"s": 0.03}, {"s": 0.03, "friction_law": 2, "omega_s": 0.01, "M_brake": 1.0}])
def test_directional_derivatives_of_outputs_are_their_differences_under_every_law(library: Library, law: dict) -> None:
    outputs = ("X_O_dot", "lambda_1", "lambda_3", "tau", "X_C", "E", "omega_z_dot")
    with at_odd(library, **law) as wheel:
        slow = ODD + np.array([0, 0, 0, 0, 0, 0, 0, ODD[-1] * (0.002 / 1.7 - 1)])  # inside the layer of the law
        wheel.place(0.3, slow)
        got = wheel.jacobian(outputs, STATES)
        for k, name in enumerate(STATES):
            h = 1e-6 * (1e-2 if name == "omega_z" else 1)
            sides = []
            for sign in (1, -1):
                wheel.place(0.3, slow + sign * h * np.eye(8)[k])
                sides.append(np.array(wheel.get(*outputs)))
            want = (sides[0] - sides[1]) / (2 * h)
            within(np.abs(got[:, k] - want).max() / (1 + np.abs(want).max()), 1e-5, "column of the Jacobian")
            if want.any():
                beyond(np.abs(1.01 * got[:, k] - want).max(), 1e-3, "column, a hundredth larger")


def test_state_and_friction_may_be_set_at_any_time_and_the_law_follows(library: Library) -> None:
    with exchange(library) as wheel:
        frictionless = wheel.derivatives()
        assert wheel.set(s=0.03) == OK
        assert wheel.get("friction_mode") == [-1]
        assert (wheel.derivatives() != frictionless).any()
        assert wheel.set(theta=1.2, psi_dot=0.4, omega_z=0.5) == OK
        assert wheel.get("theta", "psi_dot", "omega_z", "friction_mode") == [1.2, 0.4, 0.5, 1]
        assert wheel.set(phi_dot=1.0) == ERROR
        assert wheel.set(m=21.0) == ERROR


def test_a_held_wheel_stays_at_exactly_zero(library: Library) -> None:
    with exchange(library, s=0.03, theta_start=np.pi / 2, phi_dot_start=0.0) as wheel:
        assert wheel.get("friction_mode") == [0]
        x = wheel.x()
        assert wheel.derivatives()[-1] == 0
        assert wheel.indicators()[0] == pytest.approx(0.03 / 0.35)  # s N over m g (r_0 + r)
        wheel.place(0.1, x + np.array([0, 0, 0, 0, 0, 0, 0, 1e-19]))
        assert wheel.event().valuesOfContinuousStatesChanged == 1
        assert wheel.x()[-1] == 0


@pytest.mark.parametrize("theta", [0.0, -0.1, np.pi, 3.3])
def test_trial_states_beyond_flat_have_finite_derivatives_and_an_event(library: Library, theta: float) -> None:
    with exchange(library, s=0.03) as wheel:
        x = wheel.x()
        x[STATES.index("theta")] = theta
        wheel.place(0.1, x)
        assert np.isfinite(wheel.derivatives()).all()
        assert wheel.indicators()[1] <= 0 and wheel.wants_event()
        assert wheel.event().terminateSimulation
        # Some importers enter continuous-time mode before they heed the event info: the wheel can be read there,
        # and has still ended.
        assert wheel.fmi2EnterContinuousTimeMode(wheel.component) == OK
        assert np.isfinite(wheel.derivatives()).all()
        assert wheel.fmi2SetTime(wheel.component, 0.2) == ERROR


def test_a_wheel_off_the_ground_at_the_start_is_a_fault_of_initialization(library: Library) -> None:
    wheel = loaded(library).new(logging=True)
    assert wheel.set(F_Z=500.0, theta_start=np.pi / 2, phi_dot_start=0.0) == OK
    assert wheel.initialise() == ERROR
    assert wheel.sentences[-1] == "The ground does not press on the wheel at the start: N = -303.8 N."
    wheel.close()


def test_the_multibody_form_is_refused_with_a_sentence(library: Library) -> None:
    wheel = loaded(library).new(logging=True)
    assert wheel.set(formulation="multibody") == OK
    assert wheel.initialise() == ERROR
    assert wheel.sentences[-1].startswith("formulation = 3 (multibody): model exchange needs")
    wheel.close()


def test_calls_of_the_other_kind_are_refused(library: Library) -> None:
    told, slave = "{} belongs to {}; this instance was made for {}.", library.wheel(logging=True)
    assert loaded(library).fmi2SetTime(slave.component, 0.0) == ERROR
    assert slave.sentences[-1] == told.format("fmi2SetTime", "model exchange", "co-simulation")
    slave.close()
    with exchange(library, logging=True) as wheel:
        assert wheel.fmi2DoStep(wheel.component, 0.0, 0.1, 0) == ERROR
        assert wheel.sentences[-1] == told.format("fmi2DoStep", "co-simulation", "model exchange")
        assert wheel.set_input_derivatives(["F_X"], [[1.0]]) == ERROR


def brought_to(library: Library, state: str) -> FMU2Exchange:
    wheel = loaded(library).new()
    steps = (
        ("initialization mode", lambda: (wheel.setupExperiment(), wheel.enterInitializationMode())),
        ("event mode", lambda: (wheel.exitInitializationMode(),)),
        ("continuous-time mode", lambda: (wheel.fmi2EnterContinuousTimeMode(wheel.component),)),
        ("terminated", lambda: (wheel.terminate(),)),
    )
    for name, step in steps if state != "instantiated" else ():
        assert set(step()) == {OK}
        if name == state:
            break
    return wheel


@pytest.mark.parametrize("state", ["instantiated", *sorted(EXCHANGE["fmi2GetDerivatives"])])
def test_each_function_is_legal_exactly_where_the_standard_says(library: Library, state: str) -> None:
    for function, states in EXCHANGE.items():
        with brought_to(library, state) as wheel:
            assert (call(wheel, function) == OK) == (state in states), function


def test_wrong_arrays_and_numbers_are_refused_and_change_nothing(library: Library) -> None:
    with at_odd(library) as wheel:
        assert wheel.fmi2SetContinuousStates(wheel.component, (c_double * 7)(), 7) == ERROR
        assert wheel.fmi2GetDerivatives(wheel.component, None, 8) == ERROR
        assert wheel.fmi2GetEventIndicators(wheel.component, (c_double * 4)(), 4) == ERROR
        assert wheel.fmi2SetContinuousStates(wheel.component, (c_double * 8)(*[np.nan] * 8), 8) == DISCARD
        assert wheel.fmi2SetTime(wheel.component, np.inf) == ERROR
        assert wheel.fmi2CompletedIntegratorStep(wheel.component, 1, None, None) == ERROR
        assert (wheel.x() == ODD).all()


def test_nominal_values_are_the_scales_of_the_error(library: Library) -> None:
    nominals = (c_double * 8)()
    with exchange(library) as wheel:
        assert wheel.fmi2GetNominalsOfContinuousStates(wheel.component, nominals, 8) == OK
    assert all(value > 0 for value in nominals)
    assert list(nominals)[:5] == pytest.approx([1.05, 1.05, 3, 1, 3])  # m: three heights of the upright wheel; rad
