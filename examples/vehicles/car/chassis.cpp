/* Equations of the chassis: a rigid body on one hub (mechanics/vehicle.hpp) and strut per wheel.
 *
 * Body axes x forward, y left, z up, origin in the centre of mass B at the height h_B; the hub of wheel i at rest at
 * p = (x_i, y_i, R - h_B). Along x and y of the chassis the hub's bushing holds the wheel; along z the strut, with d
 * the wheel's travel up from rest, e that beyond the free travel, and F_i its share of the weight:
 *
 *   f_z = -(F_i + k d + c d' + k_stop |e| e + k_bar (d - d_other end of the bar))
 *
 * Steering (Ackermann): all wheels turn about one point on the line through the wheels that are not steered. With L
 * from that line to the steered wheels, tan delta_i = (x_i - x_R) tan delta / (L - y_i tan delta). Drive: M_3 = -share
 * M_drive, taken from the chassis. Brake: the chassis carries its moment, tau_brake of the wheel. Until t_couple the
 * chassis runs on straight and each strut gives F_i alone. */
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "vehicle.hpp"

enum { at_share = vehicle_derived, at_x_R = at_share + wheel_count, at_L, derived_count };
static_assert(+derived_count <= +max_derived, "too many wheels");

/* Shares of the weight F_i = p + q x_i + r y_i in balance: sum F_i = m g cos(slope), sum x_i F_i = sum y_i F_i = 0. */
static void weigh(const double* u, double* share) {
  Eigen::Matrix<double, wheel_count, 3> place;
  for (int i = 0; i < wheel_count; ++i) place.row(i) << 1, of_wheel(u, x_each, i), of_wheel(u, y_each, i);
  const Eigen::FullPivLU<Matrix3d> balance(place.transpose() * place);
  if (!balance.isInvertible()) throw std::invalid_argument("The hubs must not lie on one line.");
  Eigen::Map<Eigen::Vector<double, wheel_count>> shares(share);
  shares = place * balance.solve(Vector3d(u[m_B] * u[g] * std::cos(u[slope]), 0, 0));
  if (!(shares.array() > 0).all()) throw std::invalid_argument("The centre of mass must lie between the wheels.");
}

void model_derive(const double* u, double* d) {
  derive_gravity(u, d);
  weigh(u, d + at_share);
  double x[2] = {0, 0}, n[2] = {0, 0};
  for (int i = 0; i < wheel_count; ++i) {
    const int steered = of_wheel(u, steer_each, i) > 0.5;
    x[steered] += of_wheel(u, x_each, i), n[steered] += 1;
  }
  if (n[0] == 0 || n[1] == 0) throw std::invalid_argument("Some wheels must be steered, and some not.");
  d[at_x_R] = x[0] / n[0];
  d[at_L] = x[1] / n[1] - d[at_x_R];
  if (d[at_L] == 0) throw std::invalid_argument("The steered wheels must not stand beside the others.");
}

States model_start(const Now& now) { return standing(now.u, {now.u[X_start], now.u[Y_start], now.u[h_B]}); }

static Steer steering(const Now& now, int i) {
  const double* u = now.u;
  if (!(of_wheel(u, steer_each, i) > 0.5)) return {0, 0};
  const double x = of_wheel(u, x_each, i) - now.d[at_x_R], y = of_wheel(u, y_each, i), L = now.d[at_L];
  const double t = std::tan(u[delta]), across = L - y * t, t_i = x * t / across;
  return {std::atan(t_i), x * L * (1 + t * t) / (across * across) / (1 + t_i * t_i) * u[delta_dot]};
}

/* Spring, damper and stops of one strut; positive where it pushes the wheel down. */
static double strut(const double* u, int i, const Hub& hub) {
  const double d = hub.d[2], e = std::fmax(0, std::fabs(d) - u[travel]);
  return of_wheel(u, k_each, i) * d + of_wheel(u, c_each, i) * hub.d_dot[2] + std::copysign(u[k_stop] * e * e, d);
}

Hubs read_hubs(const Now& now, const Body& body) {
  const double* u = now.u;
  Hubs hubs;
  for (int i = 0; i < wheel_count; ++i) {
    const Vector3d p(of_wheel(u, x_each, i), of_wheel(u, y_each, i), u[R] - u[h_B]);
    Hub& hub = hubs[i] = read_hub(now, body, i, p, steering(now, i));
    hub.M_3 = u[tau_brake_each + i * wheel_inputs] - u[M_drive] * of_wheel(u, drive_each, i);
    if (reached(now, t_couple)) {
      hub.f = -u[k_h] * hub.d - u[c_h] * hub.d_dot;
      hub.f[2] = -strut(u, i, hub);
    }
    hub.f[2] -= now.d[at_share + i];
  }
  for (int i = 0; reached(now, t_couple) && i < wheel_count; ++i) {
    if (bar_partner[i] < 0) continue;
    Hub& other = hubs[bar_partner[i]];
    const double f = of_wheel(u, k_bar_each, i) * (hubs[i].d[2] - other.d[2]);
    hubs[i].f[2] -= f;
    other.f[2] += f;
  }
  return hubs;
}

void act_further(const Now&, const Hubs&, Body&, States&) {}

void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  const Body body(x);
  const Hubs hubs = read_hubs(now, body);
  const Vector3d rear = write_outputs(x, body, hubs, {now.d[at_x_R], 0, u[R] - u[h_B]}, y);
  y[X] = body.r[0], y[Y] = body.r[1], y[Z] = body.r[2];
  y[X_R] = rear[0], y[Y_R] = rear[1];
  y[roll] = std::asin(body.R(2, 1));
  y[pitch] = -std::asin(body.R(2, 0));
  for (int i = 0; i < wheel_count; ++i) {
    y[M_3_each + i * wheel_outputs] = -u[M_drive] * of_wheel(u, drive_each, i);
    y[M_brake_each + i * wheel_outputs] = u[M_brake] * of_wheel(u, brake_each, i);
    y[d_each + i * wheel_locals] = hubs[i].d[2];
    y[delta_each + i * wheel_locals] = steering(now, i).angle;
  }
}
