/* The reduced formulation (J_x = J_y), plain C: four numbers close the dynamics, the rest are quadratures.
 * Equivalent to the paper's (24); derivation in docs/equations.md. Carrier frame, see wheel_equations.h.
 * State y = theta, omega_1, omega_2, omega_3, psi, phi, X_O, Y_O. */
#include <math.h>
#include <stddef.h>

#include "wheel_equations.h"

typedef double real;
#define real_of(x) (x)
#define real_value(x) (x)
#define real_sin sin
#define real_cos cos
#define real_tanh tanh
#include "reduced_system.inc"

/* The scene's load in this file's number type, or NULL where there is none. */
static const Load* load_of(const WheelScene* scene, Load* load) {
  if (!scene->loaded) return NULL;
  for (int i = 0; i < 3; ++i) {
    load->F[i] = scene->load.F[i];
    load->M[i] = scene->load.M[i];
  }
  return load;
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  (void)wheel;
  y[0] = motion->theta;
  y[1] = motion->theta_dot;
  y[2] = motion->psi_dot * sin(motion->theta);
  y[3] = motion->phi_dot + motion->psi_dot * cos(motion->theta);
  y[4] = motion->psi;
  y[5] = motion->phi;
  y[6] = motion->X_O;
  y[7] = motion->Y_O;
}

static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  Load load;
  return derivative_of(scene, load_of(scene, &load), y, y_dot);
}

static double closed_derivative(const WheelScene* scene, const double* y, double* y_dot) {
  Carrier c = carrier_of(&scene->wheel, y);
  Load load;
  return closed_derivative_of(scene, load_of(scene, &load), &c, y, y_dot);
}

static Carrier read_pose(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Carrier c = carrier_of(wheel, y);
  out->theta = y[0];
  out->psi = y[4];
  out->phi = y[5];
  out->X_O = y[6];
  out->Y_O = y[7];
  out->Z_O = wheel->r_0 * c.sin_theta + wheel->r;
  out->theta_dot = c.omega_1;
  out->psi_dot = c.psi_dot;
  out->phi_dot = c.omega_3 - c.Omega_3;
  out->omega_z = c.omega_3;
  out->Z_O_dot = wheel->r_0 * c.cos_theta * c.omega_1;
  return c;
}

static void pose(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  (void)read_pose(wheel, y, out);
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Carrier c = read_pose(wheel, y, out);
  horizontal_velocity(wheel, &c, y[4], &out->X_O_dot, &out->Y_O_dot);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const WheelParameters* w = &scene->wheel;
  Carrier c = carrier_of(w, y);
  Load load;
  Motion a = motion_of(scene, load_of(scene, &load), &c, y[4]);
  turn_reaction(&c, &a, y[4], out->lambda);
  out->tau = a.tau;
  out->omega_z_dot = a.omega_3_dot;
  out->theta_ddot = a.omega_1_dot;
  out->psi_ddot = (a.omega_2_dot - c.omega_1 * c.Omega_3) / c.sin_theta;
  out->phi_ddot = a.omega_3_dot - out->psi_ddot * c.cos_theta + c.omega_1 * c.omega_2;
  /* m a = lambda + F + weight */
  out->X_O_ddot = (out->lambda[0] + (scene->loaded ? scene->load.F[0] : 0)) / w->m;
  out->Y_O_ddot = (out->lambda[1] + (scene->loaded ? scene->load.F[1] : 0)) / w->m;
  out->Z_O_ddot = (out->lambda[2] + (scene->loaded ? scene->load.F[2] : 0)) / w->m - w->g;
}

static void stop_spin(const WheelParameters* wheel, double* y) {
  (void)wheel;
  y[3] = 0;
}

/* In rates.cpp, on numbers that carry a derivative. */
void wheel_reduced_reaction_rates(const WheelScene* scene, const WheelLoad* load_dot, const double* y,
                                  double lambda_dot[3]);
void wheel_reduced_jacobian(const WheelScene* scene, const double* y, double* J);

const WheelFormulation wheel_reduced = {
    .name = "reduced",
    .states = WHEEL_REDUCED_STATES,
    .start = start,
    .derivative = derivative,
    .spin_index = 3,
    .tilt_index = 0,
    .kinematics = kinematics,
    .pose = pose,
    .dynamics = dynamics,
    .reaction_rates = wheel_reduced_reaction_rates,
    .jacobian = wheel_reduced_jacobian,
    .stop_spin = stop_spin,
    .closed_states = 6,
    .closed_derivative = closed_derivative,
};
