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
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "model.hpp"

using Eigen::Matrix3d, Eigen::Quaterniond, Eigen::Vector3d;

/* The body's states come first, then its heading; the derived quantities begin with gravity in fixed axes. */
enum { at_r = 0, at_q = 3, at_v = 7, at_w = 10, at_psi = 13, vehicle_states };
enum { at_g = 0, vehicle_derived = 3 };

inline Quaterniond quaternion(const States& x) { return {x[at_q], x[at_q + 1], x[at_q + 2], x[at_q + 3]}; }

struct Body {
  explicit Body(const States& x)
      : R(quaternion(x).normalized().toRotationMatrix()),
        r(x.segment<3>(at_r)),
        v(x.segment<3>(at_v)),
        w(x.segment<3>(at_w)) {}

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

/* By the example: the hubs with their forces and moments; until t_couple they carry the weight alone. */
Hubs read_hubs(const Now& now, const Body& body);
/* By the example: what else acts on the body, and the rates of further states. */
void act_further(const Now& now, const Hubs& hubs, Body& body, States& x_dot);

/* Level at r with the heading psi_start, rolling at v_start. */
inline States standing(const double* u, const Vector3d& r) {
  States x = States::Zero();
  x.segment<3>(at_r) = r;
  x[at_q] = std::cos(u[psi_start] / 2);
  x[at_q + 3] = std::sin(u[psi_start] / 2);
  x.segment<3>(at_v) = u[v_start] * Vector3d(std::cos(u[psi_start]), std::sin(u[psi_start]), 0);
  x[at_psi] = u[psi_start];
  return x;
}

/* On a road that rises by `slope`. */
inline void derive_gravity(const double* u, double* d) {
  d[at_g] = -u[g] * std::sin(u[slope]) * std::cos(u[slope_direction]);
  d[at_g + 1] = -u[g] * std::sin(u[slope]) * std::sin(u[slope_direction]);
  d[at_g + 2] = -u[g] * std::cos(u[slope]);
}

/* Wheel i in its hub at the point p: axes, displacement and the moments M_1, M_2 of the bushings; f and M_3 are zero,
 * as are, until t_couple, the moments. With u = n e1 and w = n e2: e3 x n = -w e1 + u e2. */
inline Hub read_hub(const Now& now, const Body& body, int i, const Vector3d& p, Steer steer) {
  const double* pose = now.u + X_O_each + i * wheel_inputs; /* X_O Y_O Z_O, their rates, then: */
  const double heading = pose[6], lean = pose[7], heading_dot = pose[8], lean_dot = pose[9];
  const double sp = std::sin(heading), cp = std::cos(heading), st = std::sin(lean), ct = std::cos(lean);
  const double k = reached(now, t_couple) ? now.u[k_a] : 0, c = reached(now, t_couple) ? now.u[c_a] : 0;
  Hub hub;
  hub.e1 = {cp, sp, 0}, hub.e2 = {-ct * sp, ct * cp, st}, hub.e3 = {st * sp, -st * cp, ct};
  hub.arm = body.R.transpose() * (Vector3d(pose) - body.r);
  hub.d = hub.arm - p;
  hub.d_dot = body.R.transpose() * (Vector3d(pose + 3) - body.v) - body.w.cross(hub.arm);
  const Vector3d n = body.R * Vector3d(std::sin(steer.angle), -std::cos(steer.angle), 0);
  const Vector3d turn = body.R * (body.w + Vector3d(0, 0, steer.rate));
  const double rate_1 = lean_dot - turn.dot(hub.e1), rate_2 = heading_dot * st - turn.dot(hub.e2);
  hub.M_1 = -k * n.dot(hub.e2) - c * rate_1;
  hub.M_2 = k * n.dot(hub.e1) - c * rate_2;
  hub.turn_rate2 = rate_1 * rate_1 + rate_2 * rate_2;
  hub.bent = (n - hub.e3).squaredNorm() / 2;
  return hub;
}

/* J w' = M - w x J w;  q' = q (0, w) / 2; until t_couple the body runs on straight. */
inline States model_rates(const Now& now, const States& x) {
  Body body(x);
  States x_dot = States::Zero();
  x_dot.segment<3>(at_r) = body.v;
  if (!reached(now, t_couple)) return x_dot;
  const Hubs hubs = read_hubs(now, body);
  for (const Hub& hub : hubs) {
    body.F -= body.R * hub.f;
    body.M -= hub.arm.cross(hub.f) + body.R.transpose() * (hub.M_1 * hub.e1 + hub.M_2 * hub.e2 + hub.M_3 * hub.e3);
  }
  act_further(now, hubs, body, x_dot);
  const Vector3d J(now.u[J_1], now.u[J_2], now.u[J_3]);
  const Quaterniond turned = quaternion(x) * Quaterniond(0, body.w[0], body.w[1], body.w[2]);
  x_dot.segment<4>(at_q) << turned.w() / 2, turned.vec() / 2;
  x_dot.segment<3>(at_v) = body.F / now.u[m_B] + Vector3d(now.d + at_g);
  x_dot.segment<3>(at_w) = (body.M - body.w.cross(J.cwiseProduct(body.w))).cwiseQuotient(J);
  x_dot[at_psi] = body.R.row(2).dot(body.w);
  return x_dot;
}

/* Outputs: F and M_1, M_2 of each wheel; psi, v, omega at a point of the body, whose place is returned. The integrated
 * heading is within half a turn of the one that R gives, which is wrapped. */
inline Vector3d write_outputs(const States& x, const Body& body, const Hubs& hubs, const Vector3d& point, double* y) {
  for (int i = 0; i < wheel_count; ++i) {
    const Vector3d force = body.R * hubs[i].f;
    double* of = std::copy_n(force.data(), 3, y + F_X_each + i * wheel_outputs);
    of[0] = hubs[i].M_1, of[1] = hubs[i].M_2;
  }
  const double heading = std::atan2(body.R(1, 0), body.R(0, 0));
  const Vector3d velocity = body.v + body.R * body.w.cross(point);
  y[psi] = x[at_psi] + std::remainder(heading - x[at_psi], 2 * std::numbers::pi);
  y[v] = velocity[0] * std::cos(heading) + velocity[1] * std::sin(heading);
  y[omega] = body.R.row(2).dot(body.w);
  return body.r + body.R * point;
}
