/* A rigid body on hubs, as axle and chassis are.
 *
 * The body has six degrees of freedom: position and velocity of its centre of mass B in fixed axes (Z up), a unit
 * quaternion, and the angular velocity in body axes (x forward, y left, z up, principal axes of inertia). R turns body
 * axes to fixed axes.
 *
 * A hub holds a wheel in the body, by bushings along the body's three axes and about the two axes across the axle; the
 * wheel spins freely. The wheel's centre O belongs at the point p of the body, its axle e3 along
 * n = (sin delta, -cos delta, 0), the right-hand side turned by the steer angle delta to the left; both in body axes.
 *
 *   a = R^T (r_O - r_B),  d = a - p,  d_dot = R^T (v_O - v_B) - w x a      displacement of O and its rate
 *   f = -k d - c d_dot, each axis its own                                 force on the wheel at O; -f on the body
 *   M = k_a e3 x n - c_a (w_wheel - w - delta_dot z) across e3            moment on the wheel; -M on the body
 *
 * So the link keeps momentum and angular momentum, and d(k d^2 / 2 + k_a (1 - e3 n)) is what it stores. */
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "model.hpp"

using Eigen::Matrix3d, Eigen::Vector3d;

/* The body's states come first, then its heading; the derived quantities begin with gravity in fixed axes. */
enum { at_r = 0, at_q = 3, at_v = 7, at_w = 10, at_psi = 13, vehicle_states };
enum { at_g = 0, vehicle_derived = 3 };

struct Body {
  explicit Body(const States& x);
  /* A force f at the point `arm` from B, and a moment; all in body axes. */
  void pull(const Vector3d& arm, const Vector3d& f, const Vector3d& moment);

  Matrix3d R;
  Vector3d r, v;                 /* fixed axes */
  Vector3d w;                    /* body axes */
  Vector3d F = Vector3d::Zero(); /* sum of forces, fixed axes, without the weight */
  Vector3d M = Vector3d::Zero(); /* sum of moments about B, body axes */
};

struct Hub {
  Vector3d e1, e2, e3;           /* the wheel's carrier axes, fixed axes */
  Vector3d arm, d, d_dot;        /* body axes */
  Vector3d f = Vector3d::Zero(); /* force on the wheel, body axes */
  double M_1, M_2, M_3 = 0;      /* moments on the wheel along its carrier axes */
  double bent, turn_rate2;       /* 1 - e3 n; square of the relative angular velocity across the axle */
};

using Hubs = std::array<Hub, wheel_count>;

struct Steer {
  double angle, rate; /* rad, rad/s; to the left */
};

/* A value of wheel i: a parameter by the name of that of each wheel. */
inline double of_wheel(const double* u, int each, int i) { return u[each + i * wheel_parameters]; }

/* Level at r with the heading psi_start, rolling at v_start; the derived gravity on a road that rises by `slope`. */
States standing(const double* u, const Vector3d& r);
void derive_gravity(const double* u, double* d);
/* Wheel i in its hub at the point p: axes, displacement and the moments M_1, M_2 of the bushings; f and M_3 are zero,
 * as are, until t_couple, the moments. */
Hub read_hub(const Now& now, const Body& body, int i, const Vector3d& p, Steer steer);
/* By the example: the hubs with their forces and moments; until t_couple they carry the weight alone. */
Hubs read_hubs(const Now& now, const Body& body);
/* By the example: what else acts on the body, and the rates of further states. */
void act_further(const Now& now, const Hubs& hubs, Body& body, States& x_dot);
/* Outputs: F and M_1, M_2 of each wheel; psi, v, omega at a point of the body, whose place is returned. */
Vector3d write_outputs(const States& x, const Body& body, const Hubs& hubs, const Vector3d& point, double* y);
