/* Quantities read off a motion, whatever formulation computed it: energy, contact point, force of the ground in wheel
 * axes, required friction coefficient, rates of the reactions, residuals of the constraints (19) and (32). Fixed axes
 * unless said. */
#include <math.h>

#include "carrier.h"

double wheel_height(const WheelParameters* wheel, double theta) { return wheel->r_0 * sin(theta) + wheel->r; }

double wheel_energy(const WheelParameters* wheel, const WheelKinematics* k) {
  double s = sin(k->theta), sin_phi = sin(k->phi), cos_phi = cos(k->phi);
  /* omega = [Q]{beta_dot}, (8), body axes */
  double omega_x = k->psi_dot * s * sin_phi + k->theta_dot * cos_phi;
  double omega_y = k->psi_dot * s * cos_phi - k->theta_dot * sin_phi;
  double v_squared = k->X_O_dot * k->X_O_dot + k->Y_O_dot * k->Y_O_dot + k->Z_O_dot * k->Z_O_dot;
  double turning =
      wheel->J_x * omega_x * omega_x + wheel->J_y * omega_y * omega_y + wheel->J_z * k->omega_z * k->omega_z;
  return 0.5 * (wheel->m * v_squared + turning) +
         wheel->m * (wheel->g * k->Z_O - wheel->g_X * k->X_O - wheel->g_Y * k->Y_O);
}

/* The contact lies r_0 cos(theta) to the right of O: across e1, on the side of (sin(psi), -cos(psi)). */
WheelContact wheel_contact(const WheelParameters* wheel, const WheelKinematics* k) {
  double sin_psi = sin(k->psi), cos_psi = cos(k->psi);
  double right = wheel->r_0 * cos(k->theta), right_dot = -wheel->r_0 * sin(k->theta) * k->theta_dot;
  return (WheelContact){
      .X_C = k->X_O + right * sin_psi,
      .Y_C = k->Y_O - right * cos_psi,
      .X_C_dot = k->X_O_dot + right_dot * sin_psi + right * k->psi_dot * cos_psi,
      .Y_C_dot = k->Y_O_dot - right_dot * cos_psi + right * k->psi_dot * sin_psi,
  };
}

void wheel_horizontal_force(const WheelKinematics* k, const double lambda[3], double force[2]) {
  double sin_psi = sin(k->psi), cos_psi = cos(k->psi);
  force[0] = lambda[0] * cos_psi + lambda[1] * sin_psi;
  force[1] = lambda[1] * cos_psi - lambda[0] * sin_psi;
}

void wheel_horizontal_force_rates(const WheelKinematics* k, const double lambda[3], const double lambda_dot[3],
                                  double force_dot[2]) {
  double force[2];
  wheel_horizontal_force(k, lambda, force);
  wheel_horizontal_force(k, lambda_dot, force_dot);
  force_dot[0] += k->psi_dot * force[1];
  force_dot[1] -= k->psi_dot * force[0];
}

double wheel_required_friction(const double lambda[3]) {
  if (lambda[2] <= 0) return INFINITY;
  return sqrt(lambda[0] * lambda[0] + lambda[1] * lambda[1]) / lambda[2];
}

double wheel_required_friction_rate(const double lambda[3], const double lambda_dot[3]) {
  double mu = wheel_required_friction(lambda), N = lambda[2];
  if (mu == 0) return 0;
  return (lambda[0] * lambda_dot[0] + lambda[1] * lambda_dot[1]) / (mu * N) / N - mu * lambda_dot[2] / N;
}

/* brake / (brake + s N); a ground that pulls has no friction. Without any capacity there is no tau, and the share is
 * that of the first brake to come. */
static double brake_share(const WheelAxleMoment* now, double* capacity) {
  *capacity = now->brake + now->s * fmax(now->N, 0);
  return *capacity > 0 ? now->brake / *capacity : 1;
}

double wheel_brake_moment(const WheelAxleMoment* now) {
  double capacity, share = brake_share(now, &capacity);
  return now->tau * share;
}

double wheel_brake_moment_rate(const WheelAxleMoment* now, const WheelAxleMoment* rate) {
  double capacity, share = brake_share(now, &capacity);
  if (!(capacity > 0)) return rate->tau;
  double rolling_rate = now->N > 0 ? rate->s * now->N + now->s * rate->N : 0;
  double share_rate = (rate->brake * (1 - share) - share * rolling_rate) / capacity;
  return rate->tau * share + now->tau * share_rate;
}

/* weight * (lambda, tau) at y + h y_dot, added to out. */
static void add_reaction(const WheelFormulation* form, const WheelScene* scene, const double* y, const double* y_dot,
                         double h, double weight, WheelReactionRates* out) {
  double moved[WHEEL_MAX_STATES];
  WheelDynamics dynamics;
  for (int i = 0; i < form->states; ++i) moved[i] = y[i] + h * y_dot[i];
  form->dynamics(scene, moved, &dynamics);
  for (int i = 0; i < 3; ++i) out->lambda_dot[i] += weight * dynamics.lambda[i];
  out->tau_dot += weight * dynamics.tau;
}

/* The same for a rate of the load, in which lambda and tau are linear: over a long time, so that little is rounded. */
static void add_load_rate(const WheelFormulation* form, const WheelScene* scene, const WheelLoad* rate, const double* y,
                          const double* y_dot, WheelReactionRates* out) {
  const double time = 1024;
  WheelScene then = *scene;
  for (int i = 0; i < 3; ++i) then.load.F[i] += time * rate->F[i];
  for (int i = 0; i < 3; ++i) then.load.M[i] += time * rate->M[i];
  then.load.brake += time * rate->brake;
  add_reaction(form, &then, y, y_dot, 0, 1 / time, out);
  add_reaction(form, scene, y, y_dot, 0, -1 / time, out);
}

/* 1/s, how fast the wheel moves. */
static double rate_of(const WheelFormulation* form, const double* y, const double* y_dot) {
  double swing = fabs(y_dot[OMEGA_1]) + fabs(y_dot[OMEGA_2]) + fabs(y_dot[OMEGA_3]);
  double turning = form->slip_index < 0 ? 0 : fabs(y_dot[CHI]);
  return (fabs(y[OMEGA_1]) + fabs(y[OMEGA_2])) / sin(y[THETA]) + fabs(y[OMEGA_3]) + sqrt(swing) + turning;
}

/* Two parts: the load's rate, and the state's motion by a difference quotient of fourth order, whose step is a small
 * part of the time in which the wheel itself moves. kappa is frozen: its own rate can be large, and acts as a moment
 * about the axle. */
void wheel_reaction_rates(const WheelFormulation* formulation, const WheelScene* scene, const WheelLoad* load_dot,
                          const double* state, WheelReactionRates* out) {
  const WheelFormulation* form = formulation->slip_index < 0 ? &wheel_reduced : &wheel_sliding;
  double y[WHEEL_MAX_STATES], y_dot[WHEEL_MAX_STATES], kappa_moment_dot = 0;
  formulation->reduce(state, y);
  y[PSI] = wheel_less_turns(y[PSI]); /* a small step must not vanish in the rounding of a large angle */
  y[PHI] = wheel_less_turns(y[PHI]);
  WheelScene frozen = *scene;
  WheelLoad rate = {{0}, {0}, 0};
  if (load_dot) rate = *load_dot;
  double N = form->derivative(scene, y, y_dot);
  if (scene->ground == WHEEL_GROUND_BY_FORCE) frozen.ground = N > 0 ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS;
  if (scene->friction.kind == WHEEL_REGULARIZED) {
    double omega_s = scene->friction.omega_s, c = cosh(y[OMEGA_3] / omega_s);
    double s = frozen.ground == WHEEL_GROUND_PULLS ? 0 : scene->wheel.s;
    kappa_moment_dot = -(y_dot[OMEGA_3] / omega_s / c / c) * (s * N + scene->load.brake);
    frozen.friction = (WheelFriction){WHEEL_ROLLING, wheel_kappa(&scene->friction, y[OMEGA_3]), 0};
    rate.M[2] += kappa_moment_dot;
  }
  double pace = rate_of(form, y, y_dot), h = pace > 0 ? 1e-3 / pace : 1;
  *out = (WheelReactionRates){.tau_dot = kappa_moment_dot};
  add_load_rate(form, &frozen, &rate, y, y_dot, out);
  add_reaction(form, &frozen, y, y_dot, h, 8 / (12 * h), out);
  add_reaction(form, &frozen, y, y_dot, -h, -8 / (12 * h), out);
  add_reaction(form, &frozen, y, y_dot, 2 * h, -1 / (12 * h), out);
  add_reaction(form, &frozen, y, y_dot, -2 * h, 1 / (12 * h), out);
}

void wheel_constraint_residuals(const WheelParameters* wheel, const WheelKinematics* k, double* velocity,
                                double* height) {
  double s = sin(k->theta), c = cos(k->theta), sin_psi = sin(k->psi), cos_psi = cos(k->psi);
  double along = wheel->r * c * (k->psi_dot * s) - (wheel->r_0 + wheel->r * s) * k->omega_z;
  double across = (wheel->r_0 * s + wheel->r) * k->theta_dot;
  double X = fabs(k->X_O_dot - (along * cos_psi + across * sin_psi));
  double Y = fabs(k->Y_O_dot - (along * sin_psi - across * cos_psi));
  double Z = fabs(k->Z_O_dot - wheel->r_0 * c * k->theta_dot);
  *velocity = fmax(X, fmax(Y, Z));
  *height = fabs(k->Z_O - wheel_height(wheel, k->theta));
}
