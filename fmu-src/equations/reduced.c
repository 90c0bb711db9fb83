/* The reduced formulation, plain C: Newton and Euler about O for any principal moments of inertia, the constraints
 * solved in advance; equivalent to the paper's (24). Non-spinning frame e1, e2, e3, see wheel_equations.h.
 *
 * The reaction R is eliminated from m a = F + R and dH/dt = M + c x R + tau e3, where c = (0, -rho, -eta)
 * points from O to the contact. docs/equations.md derives every line. State and geometry: frame.h. */
#include <math.h>

#include "axle_law.h"
#include "frame.h"

/* The terms of Newton's and Euler's equations without omega_dot: the force k = m b - F, N (b: acceleration of O without
 * its part in omega_dot, F: external force, weight included), and the external less the gyroscopic moment, N m. */
typedef struct Drift {
  double k_1, k_2, k_3;
  Moment M;
} Drift;

/* The equations of motion of (omega_1, omega_2, omega_3):
 *   [ a_11  p     0    ]                [ h_1       ]
 *   [ p     a_22  a_23 ] {omega_dot} =  [ h_2       ]
 *   [ 0     a_23  a_33 ]                [ h_3 + tau ]
 * and, with its first row eliminated, the 2 x 2 system (b_22, a_23; a_23, a_33) with b_2, h_3 + tau. */
typedef struct System {
  double a_23, a_33, b_22, b_2, h_3;
  double inverse_determinant; /* of the 2 x 2 system */
  double omega_1_dot, N;      /* for tau = 0 */
  double tilt_per_tau, alpha; /* change of omega_1_dot and of N per unit of tau: 0 where p = 0 */
} System;

/* (load, inertia, geometry, omega) => k, moment */
INLINED Drift drift_of(const WheelScene* scene, const Inertia* I, const Frame* f) {
  const WheelParameters* w = &scene->wheel;
  double F_1, F_h, F_Z = scene->load.F[2]; /* {F} of (15): along e1, across it, and across the road */
  double b_1 = f->omega_1 * (w->r_0 * f->omega_2 - f->eta * f->phi_dot);
  double b_2 = w->r * f->sin_theta * (f->omega_1 * f->omega_1) + f->Omega_3 * f->v_1 - f->omega_1 * f->v_3;
  double b_3 = f->eta * (f->omega_1 * f->omega_1) + f->omega_1 * f->v_2 - f->omega_2 * f->v_1;
  road_force(scene, f, &F_1, &F_h);
  return (Drift){
      .k_1 = w->m * b_1 - F_1,
      .k_2 = w->m * (b_2 + w->g_n * f->sin_theta) - (f->cos_theta * F_h + f->sin_theta * F_Z),
      .k_3 = w->m * (b_3 + w->g_n * f->cos_theta) - (f->cos_theta * F_Z - f->sin_theta * F_h),
      .M = moment_of(scene, I, f),
  };
}

/* (inertia, geometry, drift) => the system, N for tau = 0 */
INLINED System system_of(const WheelParameters* w, const Inertia* I, const Frame* f, const Drift* d) {
  double rho_2 = w->m * (f->rho * f->rho), eta_2 = w->m * (f->eta * f->eta);
  double inverse = 1.0 / (I->I_11 + (rho_2 + eta_2)); /* 1 / a_11 */
  double h_1 = d->M.M_1 - f->rho * d->k_3 + f->eta * d->k_2;
  double h_2 = d->M.M_2 - f->eta * d->k_1;
  System s = {
      .a_23 = -(w->m * (f->eta * f->rho)),
      .a_33 = w->J_z + rho_2,
      .b_2 = h_2,
      .h_3 = d->M.M_3 + f->rho * d->k_1,
      .omega_1_dot = h_1 * inverse,
  };
  double lift = w->m * w->r_0 * f->cos_theta; /* what a unit of omega_1_dot adds to N */
  double across = I->I_22;                    /* I_22 - p^2 / a_11 > 0 */
  if (I->p != 0) {
    across -= I->p * I->p * inverse;
    s.b_2 -= I->p * inverse * h_1;
  }
  s.b_22 = across + eta_2;
  s.inverse_determinant = 1.0 / (s.b_22 * w->J_z + across * rho_2); /* b_22 a_33 - a_23^2: nothing cancels */
  if (I->p != 0) {
    s.omega_1_dot -= I->p * inverse * ((s.a_33 * s.b_2 - s.a_23 * s.h_3) * s.inverse_determinant);
    s.tilt_per_tau = I->p * inverse * (s.a_23 * s.inverse_determinant);
    s.alpha = lift * s.tilt_per_tau;
  }
  s.N = d->k_2 * f->sin_theta + d->k_3 * f->cos_theta + lift * s.omega_1_dot;
  return s;
}

/* (system, law) => tau; N = N_free + alpha tau. Held: omega_3_dot = 0. */
static inline double axle_moment(const System* s, const AxleLaw* law) {
  if (law->held) return s->a_23 * (s->b_2 / s->b_22) - s->h_3;
  double N = s->N;
  if (s->alpha != 0) N = (N - s->alpha * law->brake) / (1.0 + s->alpha * law->lever);
  return axle_moment_of(law, N);
}

/* (system, law) => omega_dot, N, tau */
static inline Accelerations solve(const System* s, const AxleLaw* law) {
  double tau = axle_moment(s, law), h_3 = s->h_3 + tau;
  return (Accelerations){
      .omega_1_dot = s->omega_1_dot + s->tilt_per_tau * tau,
      .omega_2_dot = (s->a_33 * s->b_2 - s->a_23 * h_3) * s->inverse_determinant,
      .omega_3_dot = law->held ? 0.0 : (s->b_22 * h_3 - s->a_23 * s->b_2) * s->inverse_determinant,
      .N = s->N + s->alpha * tau,
      .tau = tau,
  };
}

/* The same where the ground may pull (N <= 0): then the ground's part of the friction is zero, in the law too. */
INLINED Accelerations move(const System* s, WheelGround ground, AxleLaw law) {
  Accelerations a = solve(s, &law);
  if (a.N > 0 || ground == WHEEL_GROUND_PRESSES || law.lever == 0) return a;
  law.lever = 0;
  return solve(s, &law);
}

/* On a wheel carrier spin is all that is left to move; N from the height of O, r_0 sin(theta) + r. */
INLINED Accelerations move_guided(const WheelScene* scene, const Frame* f, const Drift* d, AxleLaw law) {
  const WheelParameters* w = &scene->wheel;
  double omega_1_dot = scene->load.guide[1], omega_2_dot = guided_rate(f, scene->load.guide[0]);
  double rise = w->r_0 * (f->cos_theta * omega_1_dot - f->sin_theta * (f->omega_1 * f->omega_1)); /* m/s2 */
  double N = w->m * (w->g_n + rise) - scene->load.F[2];
  double h_3 = d->M.M_3 + f->rho * (d->k_1 + w->m * (f->eta * omega_2_dot));
  if (!(N > 0 || scene->ground == WHEEL_GROUND_PRESSES)) law.lever = 0;
  double tau = law.held ? -h_3 : axle_moment_of(&law, N);
  return if_lawful((Accelerations){
      .omega_1_dot = omega_1_dot,
      .omega_2_dot = omega_2_dot,
      .omega_3_dot = law.held ? 0.0 : (h_3 + tau) / (w->J_z + w->m * (f->rho * f->rho)),
      .N = N,
      .tau = tau,
  });
}

/* One state under the scene's loads and laws. */
typedef struct Evaluation {
  Frame frame;
  Drift drift;
  Accelerations accelerations;
} Evaluation;

/* (scene, y) => geometry, drift, accelerations; inlined as the frame is */
INLINED Evaluation evaluate(const WheelScene* scene, const double* y, int guided) {
  const WheelParameters* w = &scene->wheel;
  double kappa = kappa_of(&scene->friction, y[WHEEL_OMEGA_3]); /* first: a call of tanh leaves nothing in registers */
  AxleLaw law = axle_law_of(scene, kappa, scene->ground == WHEEL_GROUND_PULLS);
  Inertia inertia = inertia_of(w, y[WHEEL_PHI]);
  Frame frame = frame_of(w, y);
  Drift drift = drift_of(scene, &inertia, &frame);
  if (guided) return (Evaluation){frame, drift, move_guided(scene, &frame, &drift, law)};
  System system = system_of(w, &inertia, &frame, &drift);
  return (Evaluation){frame, drift, move(&system, scene->ground, law)};
}

/* (instant) => lambda_1, lambda_2, of R = m a - F turned into fixed axes */
static inline void reaction_of(const WheelParameters* w, const Evaluation* now, double lambda[3]) {
  const Frame* f = &now->frame;
  const Accelerations* a = &now->accelerations;
  double R_1 = now->drift.k_1 + w->m * (f->eta * a->omega_2_dot - f->rho * a->omega_3_dot);
  double R_2 = now->drift.k_2 - w->m * (f->eta * a->omega_1_dot);
  double R_3 = now->drift.k_3 + w->m * (f->rho * a->omega_1_dot);
  double R_h = f->cos_theta * R_2 - f->sin_theta * R_3; /* horizontal, across e1 */
  to_fixed(f, R_1, R_h, &lambda[0], &lambda[1]);
}

/* Horizontal velocity of O: v_1 along e1 and Z_O omega_1 across it. */
static inline void set_velocity(const WheelParameters* w, const Frame* f, double* X, double* Y) {
  to_fixed(f, f->v_1, -(w->r_0 * f->sin_theta + w->r) * f->omega_1, X, Y);
}

static void start(const WheelParameters* wheel, const WheelMotion* motion, double* y) {
  (void)wheel;
  y[WHEEL_THETA] = motion->theta;
  y[WHEEL_OMEGA_1] = motion->theta_dot;
  y[WHEEL_OMEGA_2] = motion->psi_dot * sin(motion->theta);
  y[WHEEL_OMEGA_3] = motion->phi_dot + motion->psi_dot * cos(motion->theta);
  y[WHEEL_PSI] = motion->psi;
  y[WHEEL_PHI] = motion->phi;
  y[WHEEL_X_O] = motion->X_O;
  y[WHEEL_Y_O] = motion->Y_O;
}

/* (scene, y) => y_dot; returns N */
INLINED double rates(const WheelScene* scene, const double* y, double* y_dot, int guided) {
  Evaluation now = evaluate(scene, y, guided);
  double X_dot, Y_dot;
  set_velocity(&scene->wheel, &now.frame, &X_dot, &Y_dot);
  set_rates(&now.frame, &now.accelerations, y_dot);
  put_pair(X_dot, Y_dot, y_dot + WHEEL_X_O);
  return now.accelerations.N;
}

/* Apart, so that nothing of one is computed for the other. */
__attribute__((noinline)) static double guided_rates(const WheelScene* scene, const double* y, double* y_dot) {
  return rates(scene, y, y_dot, 1);
}

static double derivative(const WheelScene* scene, const double* y, double* y_dot) {
  return scene->guided ? guided_rates(scene, y, y_dot) : rates(scene, y, y_dot, 0);
}

static void kinematics(const WheelParameters* wheel, const double* y, WheelKinematics* out) {
  Frame f = frame_of(wheel, y);
  out->theta = y[WHEEL_THETA];
  out->psi = y[WHEEL_PSI];
  out->phi = y[WHEEL_PHI];
  out->X_O = y[WHEEL_X_O];
  out->Y_O = y[WHEEL_Y_O];
  out->Z_O = wheel->r_0 * f.sin_theta + wheel->r;
  out->theta_dot = f.omega_1;
  out->psi_dot = f.psi_dot;
  out->phi_dot = f.phi_dot;
  out->omega_z = f.omega_3;
  out->Z_O_dot = wheel->r_0 * f.cos_theta * f.omega_1;
  set_velocity(wheel, &f, &out->X_O_dot, &out->Y_O_dot);
}

static void dynamics(const WheelScene* scene, const double* y, WheelDynamics* out) {
  Evaluation now = evaluate(scene, y, scene->guided);
  reaction_of(&scene->wheel, &now, out->lambda);
  set_dynamics(scene, &now.frame, &now.accelerations, out);
}

const WheelFormulation wheel_reduced = {
    .states = WHEEL_REDUCED_STATES,
    .start = start,
    .derivative = derivative,
    .kinematics = kinematics,
    .dynamics = dynamics,
};
