/* The reduced formulation, plain C: eight states, constraints solved in advance. Equivalent to the paper's (24);
 * derivation in docs/equations.md. Carrier frame, see wheel_equations.h.
 * State y = theta, omega_1, omega_2, omega_3, psi, phi, X_O, Y_O. */
#include <string.h>

#include "friction.h"
#include "reduced_system.h"

/* One state under a scene's load, ready for a law of friction. Inlined: what a caller does not read is not computed. */
typedef struct Instant {
  Carrier carrier;
  Heading heading;
  Drift drift;
  System system;
} Instant;

__attribute__((always_inline)) static inline Instant instant_of(const WheelScene* scene, const double* y) {
  const WheelParameters* w = &scene->wheel;
  Inertia inertia = inertia_of(w, y[PHI]);
  Instant now = {.carrier = carrier_of(w, y), .heading = heading_of(y[PSI])};
  now.drift = drift_of(w, &inertia, &now.carrier);
  add_load(&now.drift, &now.carrier, &now.heading, &scene->load, w->m * w->g_X, w->m * w->g_Y);
  now.system = system_of(w, &inertia, &now.carrier, &now.drift);
  return now;
}

static inline AxleLaw law_of(const WheelScene* scene, double omega_3) {
  double kappa = kappa_of(&scene->friction, omega_3);
  return (AxleLaw){
      .held = scene->friction.kind == WHEEL_HELD,
      .branch_kept = scene->ground == WHEEL_GROUND_PRESSES,
      .grip = scene->ground == WHEEL_GROUND_PULLS ? 0.0 : scene->wheel.s * kappa,
      .brake = scene->load.brake * kappa,
  };
}

/* Horizontal velocity of O: v_1 along e1 and Z_O omega_1 across it. */
static inline void set_velocity(const WheelParameters* w, const Carrier* c, const Heading* h, double* X, double* Y) {
  double across = (w->r_0 * c->sin_theta + w->r) * c->omega_1;
  *X = c->v_1 * h->cos_psi + across * h->sin_psi;
  *Y = c->v_1 * h->sin_psi - across * h->cos_psi;
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  (void)wheel;
  y[THETA] = motion->theta;
  y[OMEGA_1] = motion->theta_dot;
  y[OMEGA_2] = motion->psi_dot * sin(motion->theta);
  y[OMEGA_3] = motion->phi_dot + motion->psi_dot * cos(motion->theta);
  y[PSI] = motion->psi;
  y[PHI] = motion->phi;
  y[X_O] = motion->X_O;
  y[Y_O] = motion->Y_O;
}

static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  Instant now = instant_of(scene, y);
  AxleLaw law = law_of(scene, y[OMEGA_3]);
  Accelerations a = move(&now.system, &law);
  y_dot[THETA] = now.carrier.omega_1;
  y_dot[OMEGA_1] = a.omega_1_dot;
  y_dot[OMEGA_2] = a.omega_2_dot;
  y_dot[OMEGA_3] = a.omega_3_dot;
  y_dot[PSI] = now.carrier.psi_dot;
  y_dot[PHI] = now.carrier.phi_dot;
  set_velocity(&scene->wheel, &now.carrier, &now.heading, &y_dot[X_O], &y_dot[Y_O]);
  return a.N;
}

static Carrier read_pose(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Carrier c = carrier_of(wheel, y);
  out->theta = y[THETA];
  out->psi = y[PSI];
  out->phi = y[PHI];
  out->X_O = y[X_O];
  out->Y_O = y[Y_O];
  out->Z_O = wheel->r_0 * c.sin_theta + wheel->r;
  out->theta_dot = c.omega_1;
  out->psi_dot = c.psi_dot;
  out->phi_dot = c.phi_dot;
  out->omega_z = c.omega_3;
  out->Z_O_dot = wheel->r_0 * c.cos_theta * c.omega_1;
  return c;
}

static void pose(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  (void)read_pose(wheel, y, out);
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Carrier c = read_pose(wheel, y, out);
  Heading heading = heading_of(y[PSI]);
  set_velocity(wheel, &c, &heading, &out->X_O_dot, &out->Y_O_dot);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  const WheelParameters* w = &scene->wheel;
  Instant now = instant_of(scene, y);
  const Carrier* c = &now.carrier;
  AxleLaw law = law_of(scene, y[OMEGA_3]);
  Accelerations a = move(&now.system, &law);
  reaction_of(w, c, &now.heading, &now.drift, &a, out->lambda);
  out->tau = a.tau;
  out->omega_z_dot = a.omega_3_dot;
  out->theta_ddot = a.omega_1_dot;
  out->psi_ddot = (a.omega_2_dot - c->omega_1 * c->Omega_3) / c->sin_theta;
  out->phi_ddot = a.omega_3_dot - out->psi_ddot * c->cos_theta + c->omega_1 * c->omega_2;
  /* m a = lambda + F + weight */
  out->X_O_ddot = (out->lambda[0] + scene->load.F[0]) / w->m + w->g_X;
  out->Y_O_ddot = (out->lambda[1] + scene->load.F[1]) / w->m + w->g_Y;
  out->Z_O_ddot = (out->lambda[2] + scene->load.F[2]) / w->m - w->g;
}

static void stop_spin(const WheelParameters* wheel, double* y) {
  (void)wheel;
  y[OMEGA_3] = 0;
}

/* Whether the ground has friction where the normal force is N. */
static int grips(const WheelScene* scene, double N) {
  return scene->ground == WHEEL_GROUND_PRESSES || (scene->ground == WHEEL_GROUND_BY_FORCE && N > 0);
}

/* The law of friction at y, where the normal force is N. */
static AxleLaw frozen_law(const WheelScene* scene, const double* y, double N) {
  AxleLaw law = law_of(scene, y[OMEGA_3]);
  if (!grips(scene, N)) law.grip = 0;
  return law;
}

/* For a given pose, lambda and tau are linear in the load and in the moments of friction. The law's grip is kept; its
 * `brake` is the rate of the moment that does not follow N. */
static void respond(const WheelScene* scene, const WheelLoad* load_dot, const AxleLaw* law, const double* y,
                    WheelReactionRates* out) {
  const WheelParameters* w = &scene->wheel;
  Inertia inertia = inertia_of(w, y[PHI]);
  Carrier c = carrier_of(w, y);
  Heading heading = heading_of(y[PSI]);
  Drift drift = {0};
  add_load(&drift, &c, &heading, load_dot, 0, 0);
  System system = system_of(w, &inertia, &c, &drift);
  Accelerations a = solve(&system, law);
  reaction_of(w, &c, &heading, &drift, &a, out->lambda_dot);
  out->tau_dot = a.tau;
}

static void response(const WheelScene* scene, const WheelLoad* load_dot, const double* y, WheelReactionRates* out) {
  double y_dot[WHEEL_REDUCED_STATES];
  AxleLaw law = frozen_law(scene, y, derivative(scene, y, y_dot));
  law.brake = kappa_of(&scene->friction, y[OMEGA_3]) * load_dot->brake;
  respond(scene, load_dot, &law, y, out);
}

/* weight * (lambda, tau) at y + h y_dot under a frozen law, added to out. */
static void add_reaction(const WheelScene* scene, const AxleLaw* law, const double* y, const double* y_dot, double h,
                         double weight, WheelReactionRates* out) {
  double moved[WHEEL_REDUCED_STATES], lambda[3];
  for (int i = 0; i < WHEEL_REDUCED_STATES; ++i) moved[i] = y[i] + h * y_dot[i];
  Instant now = instant_of(scene, moved);
  Accelerations a = solve(&now.system, law);
  reaction_of(&scene->wheel, &now.carrier, &now.heading, &now.drift, &a, lambda);
  for (int i = 0; i < 3; ++i) out->lambda_dot[i] += weight * lambda[i];
  out->tau_dot += weight * a.tau;
}

/* Rate of (s N + brake) kappa at a constant N. */
static double moment_rate(const WheelScene* scene, const WheelLoad* load_dot, double N, double omega_3,
                          double omega_3_dot) {
  double rate = kappa_of(&scene->friction, omega_3) * load_dot->brake;
  if (scene->friction.kind != WHEEL_REGULARIZED) return rate;
  double c = cosh(omega_3 / scene->friction.omega_s);
  double kappa_dot = omega_3_dot / scene->friction.omega_s / c / c;
  return rate + kappa_dot * ((grips(scene, N) ? scene->wheel.s * N : 0) + scene->load.brake);
}

/* Three parts: the load's rate and the law's own rate, exact, and the state's motion under a frozen load and law, by a
 * difference quotient of fourth order. Its step is a small part of the time in which the wheel itself moves. */
static void rates(const WheelScene* scene, const WheelLoad* load_dot, const double* state, WheelReactionRates* out) {
  const double turn = 6.283185307179586, share = 1e-3;
  static const WheelLoad constant = {{0}, {0}, 0};
  if (!load_dot) load_dot = &constant;
  double y[WHEEL_REDUCED_STATES], y_dot[WHEEL_REDUCED_STATES];
  memcpy(y, state, sizeof y);
  y[PSI] = remainder(y[PSI], turn); /* a small step must not vanish in the rounding of a large angle */
  y[PHI] = remainder(y[PHI], turn);
  double N = derivative(scene, y, y_dot);
  AxleLaw law = frozen_law(scene, y, N), changing = law;
  changing.brake = moment_rate(scene, load_dot, N, y[OMEGA_3], y_dot[OMEGA_3]);
  respond(scene, load_dot, &changing, y, out);

  double swing = fabs(y_dot[OMEGA_1]) + fabs(y_dot[OMEGA_2]) + fabs(y_dot[OMEGA_3]);
  double rate = (fabs(y[OMEGA_1]) + fabs(y[OMEGA_2])) / sin(y[THETA]) + fabs(y[OMEGA_3]) + sqrt(swing);
  if (rate == 0) return; /* the wheel is at rest and stays so */
  double h = share / rate;
  add_reaction(scene, &law, y, y_dot, h, 8 / (12 * h), out);
  add_reaction(scene, &law, y, y_dot, -h, -8 / (12 * h), out);
  add_reaction(scene, &law, y, y_dot, 2 * h, -1 / (12 * h), out);
  add_reaction(scene, &law, y, y_dot, -2 * h, 1 / (12 * h), out);
}

const WheelFormulation wheel_reduced = {
    "reduced", WHEEL_REDUCED_STATES, start, derivative, OMEGA_3, THETA, kinematics, pose, dynamics, rates, response,
    stop_spin};
