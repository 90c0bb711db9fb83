/* A hub: what holds a wheel in a body. Bushings along the body's three axes and about the two axes across the axle; the
 * wheel spins freely.
 *
 * The wheel's centre O belongs at the point p of the body, its axle e3 along n = (sin delta, -cos delta, 0), the
 * right-hand side turned by the steer angle delta to the left; both in body axes. With R from body to fixed axes:
 *
 *   a = R^T (r_O - r_B),  d = a - p,  d_dot = R^T (v_O - v_B) - w x a      displacement of O and its rate
 *   f = -k d - c d_dot, each axis its own                                 force on the wheel at O; -f on the body
 *   M = k_a e3 x n - c_a (w_wheel - w - delta_dot z) across e3            moment on the wheel; -M on the body
 *
 * So the link keeps momentum and angular momentum, and d(k d^2 / 2 + k_a (1 - e3 n)) is what it stores. */
#ifndef HUB_H
#define HUB_H

#include "rigid_body.h"

typedef struct Steer {
  double angle, rate; /* rad, rad/s; to the left */
} Steer;

typedef struct Hub {
  double e1[3], e2[3], e3[3];    /* the wheel's carrier axes, fixed axes */
  double arm[3], d[3], d_dot[3]; /* body axes */
  double f[3];                   /* force on the wheel, body axes */
  double M_1, M_2, M_3;          /* moments on the wheel along its carrier axes */
  double bent, turn_rate2;       /* 1 - e3 n; square of the relative angular velocity across the axle */
} Hub;

typedef struct Bushing {
  double k_a, c_a; /* N m/rad, N m s/rad */
} Bushing;

/* Axes, displacement and the moments M_1, M_2 of the bushings; f and M_3 are zero. `pose` holds X_O, Y_O, Z_O, their
 * rates, psi, theta, psi_dot, theta_dot, in this order. */
void hub_read(const double* pose, const Body* body, const double p[3], Steer steer, Bushing bushing, Hub* hub);
/* Force in fixed axes and moments M_1, M_2 on the wheel. */
void hub_load(const Hub* hub, const Body* body, double load[5]);
/* Applies the reactions of f, M_1, M_2, M_3 to the body. */
void hub_react(const Hub* hub, Body* body);

#endif
