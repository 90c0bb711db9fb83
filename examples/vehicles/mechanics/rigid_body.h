/* A rigid body with six degrees of freedom: position and velocity of its centre of mass B in fixed axes (Z up), a unit
 * quaternion, and the angular velocity in body axes (x forward, y left, z up, principal axes of inertia). */
#ifndef RIGID_BODY_H
#define RIGID_BODY_H

enum { body_r = 0, body_q = 3, body_v = 7, body_w = 10, body_states = 13 };

typedef struct Body {
  double R[3][3]; /* body axes to fixed axes */
  double r[3], v[3];
  double w[3];       /* angular velocity, body axes */
  double w_fixed[3]; /* the same, fixed axes */
  double F[3];       /* sum of forces, fixed axes, without the weight */
  double M[3];       /* sum of moments about B, body axes */
} Body;

typedef struct Track {
  double X, Y, psi, v, omega; /* m, rad, m/s along the heading, rad/s; psi is not wrapped */
} Track;

/* Standing level at r with this heading and the velocity `speed` along it. */
void body_place(double* x, const double r[3], double heading, double speed);
/* The pose that the states x describe; F and M are cleared. The quaternion need not be exactly of unit length. */
void body_read(const double* x, Body* body);
/* How the point p of the body (body axes) moves. `near`: the heading to within half a turn. */
Track body_track(const Body* body, const double p[3], double near);
/* A force f (body axes) at the point `arm` from B (body axes). */
void body_pull(Body* body, const double arm[3], const double f[3]);
/* Acceleration of gravity in fixed axes, on a road that rises by `slope` towards `direction`. */
void gravity(double g, double slope, double direction, double a[3]);
/* Rates of the states from F and M: Newton, Euler, and the quaternion's kinematics. J: principal moments; g: gravity.
 */
void body_rates(const double* x, const Body* body, double m, const double J[3], const double g[3], double* x_dot);

#endif
