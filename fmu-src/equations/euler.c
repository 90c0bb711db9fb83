/* The states of model exchange, x: the paper's variables, Euler angles and their rates, beside the state y of the
 * reduced form. Fixed axes, SI. x is stored and y follows from it: a state that was set is read back to the bit. */
#include <math.h>

#include "wheel_equations.h"

void wheel_euler_states(const double* y, double psi_dot, double* x) {
  x[WHEEL_EULER_X_O] = y[WHEEL_X_O];
  x[WHEEL_EULER_Y_O] = y[WHEEL_Y_O];
  x[WHEEL_EULER_PSI] = y[WHEEL_PSI];
  x[WHEEL_EULER_THETA] = y[WHEEL_THETA];
  x[WHEEL_EULER_PHI] = y[WHEEL_PHI];
  x[WHEEL_EULER_THETA_DOT] = y[WHEEL_OMEGA_1];
  x[WHEEL_EULER_PSI_DOT] = psi_dot;
  x[WHEEL_EULER_OMEGA_Z] = y[WHEEL_OMEGA_3];
}

void wheel_reduced_state(const double* x, double* y) {
  y[WHEEL_THETA] = x[WHEEL_EULER_THETA];
  y[WHEEL_OMEGA_1] = x[WHEEL_EULER_THETA_DOT];
  y[WHEEL_OMEGA_2] = x[WHEEL_EULER_PSI_DOT] * sin(x[WHEEL_EULER_THETA]);
  y[WHEEL_OMEGA_3] = x[WHEEL_EULER_OMEGA_Z];
  y[WHEEL_PSI] = x[WHEEL_EULER_PSI];
  y[WHEEL_PHI] = x[WHEEL_EULER_PHI];
  y[WHEEL_X_O] = x[WHEEL_EULER_X_O];
  y[WHEEL_Y_O] = x[WHEEL_EULER_Y_O];
}

static double phi_dot_of(const double* x) {
  return x[WHEEL_EULER_OMEGA_Z] - x[WHEEL_EULER_PSI_DOT] * cos(x[WHEEL_EULER_THETA]);
}

/* psi_dot = omega_2 / sin(theta), differentiated. */
void wheel_euler_rates(const double* x, const double* y_dot, double* x_dot) {
  double theta = x[WHEEL_EULER_THETA], theta_dot = x[WHEEL_EULER_THETA_DOT], psi_dot = x[WHEEL_EULER_PSI_DOT];
  x_dot[WHEEL_EULER_X_O] = y_dot[WHEEL_X_O];
  x_dot[WHEEL_EULER_Y_O] = y_dot[WHEEL_Y_O];
  x_dot[WHEEL_EULER_PSI] = psi_dot;
  x_dot[WHEEL_EULER_THETA] = theta_dot;
  x_dot[WHEEL_EULER_PHI] = phi_dot_of(x);
  x_dot[WHEEL_EULER_THETA_DOT] = y_dot[WHEEL_OMEGA_1];
  x_dot[WHEEL_EULER_PSI_DOT] = (y_dot[WHEEL_OMEGA_2] - theta_dot * psi_dot * cos(theta)) / sin(theta);
  x_dot[WHEEL_EULER_OMEGA_Z] = y_dot[WHEEL_OMEGA_3];
}

void wheel_euler_kinematics(const WheelParameters* wheel, const double* x, WheelKinematics* out) {
  double y[WHEEL_REDUCED_STATES];
  wheel_reduced_state(x, y);
  wheel_reduced.kinematics(wheel, y, out);
  out->psi_dot = x[WHEEL_EULER_PSI_DOT];
  out->phi_dot = phi_dot_of(x);
}
