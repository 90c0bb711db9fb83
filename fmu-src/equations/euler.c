/* The formulation of model exchange: the reduced equations in the paper's variables, Euler angles and their rates.
 * State y = X_O, Y_O, psi, theta, phi, theta_dot, psi_dot, omega_z; fixed axes, SI. Nothing of it is computed anew when
 * it is read, so a state that was set is read back to the bit. Domain: 0 < theta < pi, see wheel_equations.h. */
#include <math.h>
#include <string.h>

#include "wheel_equations.h"

enum { X_O, Y_O, PSI, THETA, PHI, THETA_DOT, PSI_DOT, SPIN };

static void reduce(const double* y, double* reduced) {
  reduced[WHEEL_THETA] = y[THETA];
  reduced[WHEEL_OMEGA_1] = y[THETA_DOT];
  reduced[WHEEL_OMEGA_2] = y[PSI_DOT] * sin(y[THETA]);
  reduced[WHEEL_OMEGA_3] = y[SPIN];
  reduced[WHEEL_PSI] = y[PSI];
  reduced[WHEEL_PHI] = y[PHI];
  reduced[WHEEL_X_O] = y[X_O];
  reduced[WHEEL_Y_O] = y[Y_O];
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  (void)wheel;
  double spin = motion->phi_dot + motion->psi_dot * cos(motion->theta);
  const double same[] = {motion->X_O, motion->Y_O,       motion->psi,     motion->theta,
                         motion->phi, motion->theta_dot, motion->psi_dot, spin};
  memcpy(y, same, sizeof same);
}

/* psi_dot = omega_2 / sin(theta), differentiated. */
static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  double reduced[WHEEL_REDUCED_STATES], rates[WHEEL_REDUCED_STATES];
  reduce(y, reduced);
  double N = wheel_reduced.derivative(scene, reduced, rates);
  y_dot[X_O] = rates[WHEEL_X_O];
  y_dot[Y_O] = rates[WHEEL_Y_O];
  y_dot[PSI] = y[PSI_DOT];
  y_dot[THETA] = y[THETA_DOT];
  y_dot[PHI] = y[SPIN] - y[PSI_DOT] * cos(y[THETA]);
  y_dot[THETA_DOT] = rates[WHEEL_OMEGA_1];
  y_dot[PSI_DOT] = (rates[WHEEL_OMEGA_2] - y[THETA_DOT] * y[PSI_DOT] * cos(y[THETA])) / sin(y[THETA]);
  y_dot[SPIN] = rates[WHEEL_OMEGA_3];
  return N;
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  double reduced[WHEEL_REDUCED_STATES];
  reduce(y, reduced);
  wheel_reduced.kinematics(wheel, reduced, out);
  out->psi_dot = y[PSI_DOT];
  out->phi_dot = y[SPIN] - y[PSI_DOT] * cos(y[THETA]);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  double reduced[WHEEL_REDUCED_STATES];
  reduce(y, reduced);
  wheel_reduced.dynamics(scene, reduced, out);
}

const WheelFormulation wheel_euler = {
    .states = WHEEL_REDUCED_STATES,
    .start = start,
    .derivative = derivative,
    .spin_index = SPIN,
    .tilt_index = THETA,
    .slip_index = -1,
    .kinematics = kinematics,
    .dynamics = dynamics,
};
