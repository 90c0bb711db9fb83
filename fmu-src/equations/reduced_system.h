/* The reduced equations of the wheel for any principal moments of inertia. Carrier frame e1, e2, e3.
 *
 * Newton and Euler about O, with the reaction R (carrier) eliminated: m a = F + R and dH/dt = M + c x R + tau e3,
 * where c = (0, -rho, -eta) points from O to the contact. docs/equations.md derives every line. */
#ifndef WHEEL_REDUCED_SYSTEM_H
#define WHEEL_REDUCED_SYSTEM_H

#include <math.h>

#include "wheel_equations.h"

/* The state of the reduced form. */
enum { THETA, OMEGA_1, OMEGA_2, OMEGA_3, PSI, PHI, X_O, Y_O };

typedef struct Heading {
  double sin_psi, cos_psi;
} Heading;

/* Geometry and velocity of O at one state; components along e1, e2, e3. */
typedef struct Carrier {
  double sin_theta, cos_theta;
  double rho, eta; /* contact below O along e2, r_0 + r sin(theta), and along e3, r cos(theta) */
  double omega_1, omega_2, omega_3;
  double Omega_3; /* psi_dot cos(theta), third component of the carrier's own angular velocity */
  double psi_dot, phi_dot;
  double v_1, v_2, v_3; /* v_O = omega x (r_0 e2 + r e_Z), e_Z vertical: rolling without slip */
} Carrier;

/* The inertia diag(J_x, J_y, J_z) of the body axes seen from the carrier, which it turns against by phi:
 *   [ I_11  p     0   ]
 *   [ p     I_22  0   ]    I_11, I_22 = (J_x + J_y)/2 +- q,  q = D cos(2 phi), p = D sin(2 phi), D = (J_x - J_y)/2
 *   [ 0     0     J_z ]    p = q = 0 where J_x = J_y */
typedef struct Inertia {
  double I_11, I_22, p, q;
} Inertia;

/* The terms of Newton's and Euler's equations without omega_dot: the force k = m b - F, N (b: acceleration of O without
 * its part in omega_dot, F: external force, weight included), and the external less the gyroscopic moment, N m. */
typedef struct Drift {
  double k_1, k_2, k_3;
  double M_1, M_2, M_3;
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
  double tilting, alpha;      /* change of omega_1_dot and of N per unit of tau: 0 where p = 0 */
} System;

/* The law of friction at one instant: tau = -(grip N + brake), or, if held, the tau that keeps omega_3 constant. */
typedef struct AxleLaw {
  int held;
  int branch_kept; /* the grip stays where N < 0 */
  double grip;     /* m, s kappa */
  double brake;    /* N m, capacity of the brake times kappa */
} AxleLaw;

typedef struct Accelerations {
  double omega_1_dot, omega_2_dot, omega_3_dot;
  double N;   /* normal force */
  double tau; /* moment of ground and brake about the axle */
} Accelerations;

static inline Heading heading_of(double psi) { return (Heading){.sin_psi = sin(psi), .cos_psi = cos(psi)}; }

static inline Carrier carrier_of(const WheelParameters* w, const double* y) {
  Carrier c = {.sin_theta = sin(y[THETA]), .cos_theta = cos(y[THETA])};
  c.omega_1 = y[OMEGA_1];
  c.omega_2 = y[OMEGA_2];
  c.omega_3 = y[OMEGA_3];
  c.rho = w->r_0 + w->r * c.sin_theta;
  c.eta = w->r * c.cos_theta;
  c.psi_dot = c.omega_2 / c.sin_theta;
  c.Omega_3 = c.psi_dot * c.cos_theta;
  c.phi_dot = c.omega_3 - c.Omega_3;
  c.v_1 = c.eta * c.omega_2 - c.rho * c.omega_3;
  c.v_2 = -(c.eta * c.omega_1);
  c.v_3 = c.rho * c.omega_1;
  return c;
}

static inline Inertia inertia_of(const WheelParameters* w, double phi) {
  if (w->J_x == w->J_y) return (Inertia){.I_11 = w->J_x, .I_22 = w->J_x};
  double mean = 0.5 * (w->J_x + w->J_y), D = 0.5 * (w->J_x - w->J_y);
  double q = D * cos(2.0 * phi), p = D * sin(2.0 * phi);
  return (Inertia){.I_11 = mean + q, .I_22 = mean - q, .p = p, .q = q};
}

/* Drift under the weight's part across the road alone. H: angular momentum about O. */
static inline Drift drift_of(const WheelParameters* w, const Inertia* I, const Carrier* c) {
  double b_1 = c->omega_1 * (w->r_0 * c->omega_2 - c->eta * c->phi_dot);
  double b_2 = w->r * c->sin_theta * (c->omega_1 * c->omega_1) + c->Omega_3 * c->v_1 - c->omega_1 * c->v_3;
  double b_3 = c->eta * (c->omega_1 * c->omega_1) + c->omega_1 * c->v_2 - c->omega_2 * c->v_1;
  double H_1 = I->I_11 * c->omega_1 + I->p * c->omega_2;
  double H_2 = I->p * c->omega_1 + I->I_22 * c->omega_2;
  double H_3 = w->J_z * c->omega_3;
  Drift d = {
      .k_1 = w->m * b_1,
      .k_2 = w->m * (b_2 + w->g * c->sin_theta),
      .k_3 = w->m * (b_3 + w->g * c->cos_theta),
      .M_1 = c->Omega_3 * H_2 - c->omega_2 * H_3,
      .M_2 = c->omega_1 * H_3 - c->Omega_3 * H_1,
      .M_3 = c->omega_2 * H_1 - c->omega_1 * H_2,
  };
  if (w->J_x != w->J_y) { /* the inertia itself turns against the carrier */
    d.M_1 += 2.0 * c->phi_dot * (I->p * c->omega_1 - I->q * c->omega_2);
    d.M_2 -= 2.0 * c->phi_dot * (I->q * c->omega_1 + I->p * c->omega_2);
  }
  return d;
}

/* Adds {F} of (15), F turned from fixed axes into the carrier, M already there; and a weight (N) along the road. */
static inline void add_load(Drift* d, const Carrier* c, const Heading* heading, const WheelLoad* load, double weight_X,
                            double weight_Y) {
  double F_X = load->F[0] + weight_X, F_Y = load->F[1] + weight_Y;
  double F_1 = 0, F_h = 0;    /* in the road's plane: along e1 and across it */
  if (F_X != 0 || F_Y != 0) { /* otherwise sine and cosine of psi are not needed */
    F_1 = F_X * heading->cos_psi + F_Y * heading->sin_psi;
    F_h = F_Y * heading->cos_psi - F_X * heading->sin_psi;
  }
  d->k_1 -= F_1;
  d->k_2 -= c->cos_theta * F_h + c->sin_theta * load->F[2];
  d->k_3 -= c->cos_theta * load->F[2] - c->sin_theta * F_h;
  d->M_1 += load->M[0];
  d->M_2 += load->M[1];
  d->M_3 += load->M[2];
}

static inline System system_of(const WheelParameters* w, const Inertia* I, const Carrier* c, const Drift* d) {
  double rho_2 = w->m * (c->rho * c->rho), eta_2 = w->m * (c->eta * c->eta);
  double inverse = 1.0 / (I->I_11 + (rho_2 + eta_2)); /* 1 / a_11 */
  double h_1 = d->M_1 - c->rho * d->k_3 + c->eta * d->k_2;
  double h_2 = d->M_2 - c->eta * d->k_1;
  System s = {
      .a_23 = -(w->m * (c->eta * c->rho)),
      .a_33 = w->J_z + rho_2,
      .b_2 = h_2,
      .h_3 = d->M_3 + c->rho * d->k_1,
      .omega_1_dot = h_1 * inverse,
  };
  double lift = w->m * w->r_0 * c->cos_theta; /* what a unit of omega_1_dot adds to N */
  double turned = I->I_22;                    /* I_22 - p^2 / a_11 > 0 */
  if (I->p != 0) {
    turned -= I->p * I->p * inverse;
    s.b_2 -= I->p * inverse * h_1;
  }
  s.b_22 = turned + eta_2;
  s.inverse_determinant = 1.0 / (s.b_22 * w->J_z + turned * rho_2); /* b_22 a_33 - a_23^2: nothing cancels */
  if (I->p != 0) {
    s.omega_1_dot -= I->p * inverse * ((s.a_33 * s.b_2 - s.a_23 * s.h_3) * s.inverse_determinant);
    s.tilting = I->p * inverse * (s.a_23 * s.inverse_determinant);
    s.alpha = lift * s.tilting;
  }
  s.N = d->k_2 * c->sin_theta + d->k_3 * c->cos_theta + lift * s.omega_1_dot;
  return s;
}

/* Moment about the axle. Rolling: tau = -(grip N + brake) and N = N_free + alpha tau. Held: omega_3_dot = 0. */
static inline double axle_moment(const System* s, const AxleLaw* law) {
  if (law->held) return s->a_23 * (s->b_2 / s->b_22) - s->h_3;
  double N = s->N;
  if (s->alpha != 0) N = (N - s->alpha * law->brake) / (1.0 + s->alpha * law->grip);
  return -(law->grip * N + law->brake);
}

static inline Accelerations solve(const System* s, const AxleLaw* law) {
  double tau = axle_moment(s, law), h_3 = s->h_3 + tau;
  return (Accelerations){
      .omega_1_dot = s->omega_1_dot + s->tilting * tau,
      .omega_2_dot = (s->a_33 * s->b_2 - s->a_23 * h_3) * s->inverse_determinant,
      .omega_3_dot = law->held ? 0.0 : (s->b_22 * h_3 - s->a_23 * s->b_2) * s->inverse_determinant,
      .N = s->N + s->alpha * tau,
      .tau = tau,
  };
}

/* The same where the ground may pull (N <= 0): then the ground's part of the friction is zero. */
static inline Accelerations move(const System* s, AxleLaw* law) {
  Accelerations a = solve(s, law);
  if (a.N > 0 || law->grip == 0 || law->branch_kept) return a;
  law->grip = 0;
  return solve(s, law);
}

/* The reaction R = m a - F turned into fixed axes: lambda_1, lambda_2, lambda_3. */
static inline void reaction_of(const WheelParameters* w, const Carrier* c, const Heading* heading, const Drift* d,
                               const Accelerations* a, double lambda[3]) {
  double R_1 = d->k_1 + w->m * (c->eta * a->omega_2_dot - c->rho * a->omega_3_dot);
  double R_2 = d->k_2 - w->m * (c->eta * a->omega_1_dot);
  double R_3 = d->k_3 + w->m * (c->rho * a->omega_1_dot);
  double R_h = c->cos_theta * R_2 - c->sin_theta * R_3; /* horizontal, across e1 */
  lambda[0] = R_1 * heading->cos_psi - R_h * heading->sin_psi;
  lambda[1] = R_1 * heading->sin_psi + R_h * heading->cos_psi;
  lambda[2] = a->N;
}

#endif
