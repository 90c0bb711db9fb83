/* Newton-Euler equations of a body on hubs; vehicle.hpp has the axes and the hub's law. */
#include "vehicle.hpp"

#include <cmath>
#include <numbers>

using Eigen::Quaterniond;

static Quaterniond quaternion(const States& x) { return {x[at_q], x[at_q + 1], x[at_q + 2], x[at_q + 3]}; }

Body::Body(const States& x)
    : R(quaternion(x).normalized().toRotationMatrix()),
      r(x.segment<3>(at_r)),
      v(x.segment<3>(at_v)),
      w(x.segment<3>(at_w)) {}

void Body::pull(const Vector3d& arm, const Vector3d& f, const Vector3d& moment) {
  F += R * f;
  M += arm.cross(f) + moment;
}

States standing(const double* u, const Vector3d& r) {
  States x = States::Zero();
  x.segment<3>(at_r) = r;
  x[at_q] = std::cos(u[psi_start] / 2);
  x[at_q + 3] = std::sin(u[psi_start] / 2);
  x.segment<3>(at_v) = u[v_start] * Vector3d(std::cos(u[psi_start]), std::sin(u[psi_start]), 0);
  x[at_psi] = u[psi_start];
  return x;
}

void derive_gravity(const double* u, double* d) {
  d[at_g] = -u[g] * std::sin(u[slope]) * std::cos(u[slope_direction]);
  d[at_g + 1] = -u[g] * std::sin(u[slope]) * std::sin(u[slope_direction]);
  d[at_g + 2] = -u[g] * std::cos(u[slope]);
}

/* With u = n e1 and w = n e2: e3 x n = -w e1 + u e2. */
Hub read_hub(const Now& now, const Body& body, int i, const Vector3d& p, Steer steer) {
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
States model_rates(const Now& now, const States& x) {
  Body body(x);
  States x_dot = States::Zero();
  x_dot.segment<3>(at_r) = body.v;
  if (!reached(now, t_couple)) return x_dot;
  const Hubs hubs = read_hubs(now, body);
  for (const Hub& hub : hubs)
    body.pull(hub.arm, -hub.f, -body.R.transpose() * (hub.M_1 * hub.e1 + hub.M_2 * hub.e2 + hub.M_3 * hub.e3));
  act_further(now, hubs, body, x_dot);
  const Vector3d J(now.u[J_1], now.u[J_2], now.u[J_3]);
  const Quaterniond turned = quaternion(x) * Quaterniond(0, body.w[0], body.w[1], body.w[2]);
  x_dot.segment<4>(at_q) << turned.w() / 2, turned.vec() / 2;
  x_dot.segment<3>(at_v) = body.F / now.u[m_B] + Vector3d(now.d + at_g);
  x_dot.segment<3>(at_w) = (body.M - body.w.cross(J.cwiseProduct(body.w))).cwiseQuotient(J);
  x_dot[at_psi] = body.R.row(2).dot(body.w);
  return x_dot;
}

/* The integrated heading is within half a turn of the one that R gives, which is wrapped. */
Vector3d write_outputs(const States& x, const Body& body, const Hubs& hubs, const Vector3d& point, double* y) {
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
