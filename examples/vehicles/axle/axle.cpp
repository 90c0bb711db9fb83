/* Equations of the axle: a rigid beam on two hubs (mechanics/vehicle.hpp).
 *
 * Body axes x forward, y left, z up, origin in the centre of mass B, which lies `a` ahead of the axle's line; the hubs
 * at p = (-a, +-b, 0). Each hub carries half of the weight without being displaced. The torque M of a wheel acts
 * between the wheel and the beam; a support against the horizon keeps the beam from turning about the axle:
 *
 *   M_support = (m_B g a - k_p s - c_p w u) u,   u = x cross Z,   s = x Z, the sine of the pitch, nose up
 *
 * x and Z are the beam's forward axis and the road's normal, g the part of gravity along it; m_B g a is what the weight
 * ahead of the axle needs. Until t_couple the beam runs on straight and the hubs carry the weight alone. */
#include "vehicle.hpp"

enum { at_loss = vehicle_states };

void model_derive(const double* u, double* d) { derive_gravity(u, d); }

States model_start(const Now& now) {
  const double* u = now.u;
  const Vector3d ahead(u[a] * std::cos(u[psi_start]), u[a] * std::sin(u[psi_start]), 0);
  States x = standing(u, Vector3d(u[X_start], u[Y_start], u[R]) + ahead);
  x.segment<3>(at_v) += u[omega_start] * Vector3d::UnitZ().cross(ahead);
  x[at_w + 2] = u[omega_start];
  return x;
}

/* The weight along the road's normal, negative, and the share of a hub. */
static double weight(const Now& now) { return now.u[m_B] * now.d[at_g + 2]; }
static double share(const Now& now) { return weight(now) / wheel_count; }

Hubs read_hubs(const Now& now, const Body& body) {
  const double* u = now.u;
  Hubs hubs;
  for (int i = 0; i < wheel_count; ++i) {
    hubs[i] = read_hub(now, body, i, {-u[a], i ? -u[b] : u[b], 0}, {});
    hubs[i].M_3 = -of_wheel(u, M_each, i);
    if (reached(now, t_couple)) hubs[i].f = -u[k] * hubs[i].d - u[c] * hubs[i].d_dot;
    hubs[i].f[2] += share(now);
  }
  return hubs;
}

/* The support, and the work of all dampers. */
void act_further(const Now& now, const Hubs& hubs, Body& body, States& x_dot) {
  const double* u = now.u;
  const Vector3d axis = Vector3d::UnitX().cross(body.R.row(2).transpose());
  const double rate = body.w.dot(axis);
  body.M += (-weight(now) * u[a] - u[k_p] * body.R(2, 0) - u[c_p] * rate) * axis;
  x_dot[at_loss] = u[c_p] * rate * rate;
  for (const Hub& hub : hubs) x_dot[at_loss] += u[c] * hub.d_dot.squaredNorm() + u[c_a] * hub.turn_rate2;
}

/* Kinetic and potential energy; the constant shares of the weight, and the support's moment, are potentials too. */
static double energy(const Now& now, const Body& body, const Hubs& hubs) {
  const double* u = now.u;
  const double pitch = body.R(2, 0);
  const Vector3d J(u[J_1], u[J_2], u[J_3]), above = body.r - Vector3d(0, 0, u[R]);
  double e = u[m_B] * (body.v.squaredNorm() / 2 - above.dot(Vector3d(now.d + at_g)));
  e += J.dot(body.w.cwiseAbs2()) / 2 + u[k_p] * pitch * pitch / 2 + weight(now) * u[a] * pitch;
  for (const Hub& hub : hubs) e += u[k] * hub.d.squaredNorm() / 2 + u[k_a] * hub.bent - share(now) * hub.d[2];
  return e;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const Body body(x);
  const Hubs hubs = read_hubs(now, body);
  const Vector3d middle = write_outputs(x, body, hubs, {-now.u[a], 0, 0}, y);
  for (int i = 0; i < wheel_count; ++i) y[M_3_each + i * wheel_outputs] = hubs[i].M_3;
  y[X] = middle[0], y[Y] = middle[1];
  y[E] = energy(now, body, hubs);
  y[W_loss] = x[at_loss];
}
