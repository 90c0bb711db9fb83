/* What the reduced forms share, rolling and sliding: the state, geometry and velocity in the non-spinning frame e1, e2,
 * e3 (wheel_equations.h), and the inertia seen from it. For the files of this folder alone. */
#ifndef WHEEL_FRAME_H
#define WHEEL_FRAME_H

#include <math.h>
#include <string.h>

#include "wheel_equations.h"

typedef double Two __attribute__((vector_size(2 * sizeof(double)))); /* side by side in the processor */

/* Geometry and velocity of O at one state; components along e1, e2, e3. */
typedef struct Frame {
  double sin_theta, cos_theta, sin_psi, cos_psi;
  double rho, eta; /* contact below O along e2, r_0 + r sin(theta), and along e3, r cos(theta) */
  double omega_1, omega_2, omega_3;
  double Omega_3; /* psi_dot cos(theta), third component of the frame's angular velocity */
  double psi_dot, phi_dot;
  double v_1, v_2, v_3; /* v_O = omega x (r_0 e2 + r e_Z), e_Z vertical: rolling without slip */
} Frame;

/* The inertia diag(J_x, J_y, J_z) of the body axes seen from the frame, which it turns against by phi:
 *   [ I_11  p     0   ]
 *   [ p     I_22  0   ]    I_11, I_22 = (J_x + J_y)/2 +- q,  q = D cos(2 phi), p = D sin(2 phi), D = (J_x - J_y)/2
 *   [ 0     0     J_z ]    p = q = 0 where J_x = J_y */
typedef struct Inertia {
  double I_11, I_22, p, q;
} Inertia;

/* N m, components along e1, e2, e3. */
typedef struct Moment {
  double M_1, M_2, M_3;
} Moment;

typedef struct Accelerations {
  double omega_1_dot, omega_2_dot, omega_3_dot;
  double N;   /* normal force */
  double tau; /* moment of ground and brake about the axle */
} Accelerations;

/* Sine and cosine of an angle. */
typedef struct Sines {
  double sine, cosine;
} Sines;
Sines wheel_sines(double angle);

/* What a caller does not read is not computed, and what it gives as a constant is not asked for. */
#define INLINED __attribute__((always_inline)) static inline

/* (theta, omega_1, omega_2, omega_3, psi) => geometry, v_O, the rates of the angles */
INLINED Frame frame_of(const WheelParameters* w, const double* y) {
  Sines theta = wheel_sines(y[WHEEL_THETA]), psi = wheel_sines(y[WHEEL_PSI]);
  Frame f = {.sin_theta = theta.sine, .cos_theta = theta.cosine, .sin_psi = psi.sine, .cos_psi = psi.cosine};
  f.omega_1 = y[WHEEL_OMEGA_1];
  f.omega_2 = y[WHEEL_OMEGA_2];
  f.omega_3 = y[WHEEL_OMEGA_3];
  f.rho = w->r_0 + w->r * f.sin_theta;
  f.eta = w->r * f.cos_theta;
  f.psi_dot = f.omega_2 / f.sin_theta;
  f.Omega_3 = f.psi_dot * f.cos_theta;
  f.phi_dot = f.omega_3 - f.Omega_3;
  f.v_1 = f.eta * f.omega_2 - f.rho * f.omega_3;
  f.v_2 = -(f.eta * f.omega_1);
  f.v_3 = f.rho * f.omega_1;
  return f;
}

/* (J_x, J_y, phi) => I_11, I_22, p, q */
static inline Inertia inertia_of(const WheelParameters* w, double phi) {
  if (w->J_x == w->J_y) return (Inertia){.I_11 = w->J_x, .I_22 = w->J_x};
  double mean = 0.5 * (w->J_x + w->J_y), D = 0.5 * (w->J_x - w->J_y);
  Sines twice = wheel_sines(2.0 * phi);
  double q = D * twice.cosine, p = D * twice.sine;
  return (Inertia){.I_11 = mean + q, .I_22 = mean - q, .p = p, .q = q};
}

/* (load, inertia, omega) => the external moment less that by which the wheel resists being turned with its axle; H:
 * angular momentum about O */
static inline Moment moment_of(const WheelScene* scene, const Inertia* I, const Frame* f) {
  const WheelParameters* w = &scene->wheel;
  double H_1 = I->I_11 * f->omega_1 + I->p * f->omega_2;
  double H_2 = I->p * f->omega_1 + I->I_22 * f->omega_2;
  double H_3 = w->J_z * f->omega_3;
  Moment M = {
      .M_1 = f->Omega_3 * H_2 - f->omega_2 * H_3,
      .M_2 = f->omega_1 * H_3 - f->Omega_3 * H_1,
      .M_3 = f->omega_2 * H_1 - f->omega_1 * H_2,
  };
  if (w->J_x != w->J_y) { /* the inertia itself turns against the frame */
    M.M_1 += 2.0 * f->phi_dot * (I->p * f->omega_1 - I->q * f->omega_2);
    M.M_2 -= 2.0 * f->phi_dot * (I->q * f->omega_1 + I->p * f->omega_2);
  }
  M.M_1 += scene->load.M[0];
  M.M_2 += scene->load.M[1];
  M.M_3 += scene->load.M[2];
  return M;
}

/* omega_2_dot, of omega_2 = psi_dot sin(theta). */
static inline double guided_rate(const Frame* f, double psi_ddot) {
  return psi_ddot * f->sin_theta + f->Omega_3 * f->omega_1;
}

/* A horizontal vector, along e1 and to the left of it, in fixed axes. */
static inline void to_fixed(const Frame* f, double along, double left, double* X, double* Y) {
  *X = along * f->cos_psi - left * f->sin_psi;
  *Y = along * f->sin_psi + left * f->cos_psi;
}

/* External force along the road, load and weight. Sine and cosine of psi are needed only where there is one. */
static inline void road_force(const WheelScene* scene, const Frame* f, double* along, double* left) {
  const WheelParameters* w = &scene->wheel;
  double F_X = scene->load.F[0] + w->m * w->g_X, F_Y = scene->load.F[1] + w->m * w->g_Y;
  int none = F_X == 0 && F_Y == 0;
  *along = none ? 0 : F_X * f->cos_psi + F_Y * f->sin_psi;
  *left = none ? 0 : F_Y * f->cos_psi - F_X * f->sin_psi;
}

/* (law, omega_3) => kappa, without a call where its sign is given */
static inline double kappa_of(const WheelFriction* law, double omega_3) {
  return law->kind == WHEEL_ROLLING ? law->sigma : wheel_kappa(law, omega_3);
}

/* NaN where tau is: without a law (WHEEL_NO_LAW) nothing is answered, not even what a wheel carrier gives. */
static inline Accelerations if_lawful(Accelerations a) {
  return isnan(a.tau) ? (Accelerations){NAN, NAN, NAN, NAN, NAN} : a;
}

/* Two numbers in one store: a solver reads them so, and a processor waits where it reads two stores at once. */
static inline void put_pair(double first, double second, double* out) {
  const Two pair = {first, second};
  memcpy(out, &pair, sizeof pair);
}

/* All of y_dot but the velocity of O and the slip. */
static inline void set_rates(const Frame* f, const Accelerations* a, double* y_dot) {
  put_pair(f->omega_1, a->omega_1_dot, y_dot + WHEEL_THETA);
  put_pair(a->omega_2_dot, a->omega_3_dot, y_dot + WHEEL_OMEGA_2);
  put_pair(f->psi_dot, f->phi_dot, y_dot + WHEEL_PSI);
}

/* All of `out` but the horizontal reaction, which is set; m a = lambda + F + weight. */
static inline void set_dynamics(const WheelScene* scene, const Frame* f, const Accelerations* a, WheelDynamics* out) {
  const WheelParameters* w = &scene->wheel;
  out->lambda[2] = a->N;
  out->tau = a->tau;
  out->omega_z_dot = a->omega_3_dot;
  out->theta_ddot = a->omega_1_dot;
  out->psi_ddot = (a->omega_2_dot - f->omega_1 * f->Omega_3) / f->sin_theta;
  out->phi_ddot = a->omega_3_dot - out->psi_ddot * f->cos_theta + f->omega_1 * f->omega_2;
  out->X_O_ddot = (out->lambda[0] + scene->load.F[0]) / w->m + w->g_X;
  out->Y_O_ddot = (out->lambda[1] + scene->load.F[1]) / w->m + w->g_Y;
  out->Z_O_ddot = (out->lambda[2] + scene->load.F[2]) / w->m - w->g_n;
}

#endif
