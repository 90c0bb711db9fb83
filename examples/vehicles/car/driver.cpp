/* Equations of the driver. Fixed axes X, Y; angles to the left. The path of a lane change and back begins at the origin
 * along X:
 *
 *   P(p) = (p, width / 2 (tanh((p - x_out) / length) - tanh((p - x_back) / length)))
 *
 * The parameter follows the car, p' = (velocity + k_p (r - P)) t / |dP/dp| with t the path's direction. With e the
 * distance to the left of the path, and the path's curvature kappa taken where the car will be after the lag T_delta:
 *
 *   delta_ref = atan(L (kappa - k_y e - k_psi sin(psi - heading))) + programme
 *   delta'    = (delta_ref - delta) / T_delta
 *   M_drive   = k_v (v_ref - v) + k_i integral (v_ref - v) + programme
 *
 * All programmes rise by q(x) = x^3 (10 - 15 x + 6 x^2), which has continuous second derivatives. Until the car is
 * received the driver neither steers nor holds the speed. */
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model.hpp"

using Eigen::Vector2d;

enum { at_delta, at_integral, at_p };
static constexpr double k_p = 4; /* 1/s */

struct Place {
  Vector2d P, dP; /* of the path; dP by p */
  double kappa;
};

static double left_of(const Vector2d& along, const Vector2d& away) { return along[0] * away[1] - along[1] * away[0]; }

void model_derive(const double* u, double*) {
  if (u[path] != 0 && u[path] != 1) throw std::invalid_argument("path must be 0 or 1.");
}

States model_start(const Now&) { return States::Zero(); }

static double rise(double t, double from, double duration) {
  const double z = std::clamp((t - from) / duration, 0.0, 1.0);
  return z * z * z * (10 - 15 * z + 6 * z * z);
}

static Place place(const double* u, double p) {
  const double a = std::tanh((p - u[x_out]) / u[length]), b = std::tanh((p - u[x_back]) / u[length]);
  const double h = u[width] / 2, l = u[length], dy = h / l * (b * b - a * a);
  const double ddy = 2 * h / (l * l) * (b * (1 - b * b) - a * (1 - a * a));
  return {{p, h * (a - b)}, {1, dy}, ddy / std::pow(std::hypot(1, dy), 3)};
}

static double off_path(const double* u, const Place& at) {
  return received(u, Z_R) ? left_of(at.dP, Vector2d(u[X_R], u[Y_R]) - at.P) / at.dP.norm() : 0;
}

static double steer_rate(const Now& now, const States& x) {
  const double* u = now.u;
  double wanted = u[delta_0] * rise(now.t, u[t_delta], u[ramp_delta]);
  if (u[path] != 0) {
    const Place at = place(u, x[at_p]);
    const double ahead = place(u, x[at_p] + u[T_delta] * u[v] / at.dP.norm()).kappa;
    const double turned = left_of(at.dP, {std::cos(u[psi]), std::sin(u[psi])}) / at.dP.norm();
    wanted += std::atan(u[L] * (ahead - u[k_y] * off_path(u, at) - u[k_psi] * turned));
  }
  return (wanted - x[at_delta]) / u[T_delta];
}

static double p_rate(const double* u, const Place& at) {
  const Vector2d heading(std::cos(u[psi]), std::sin(u[psi])), away = Vector2d(u[X_R], u[Y_R]) - at.P;
  return (u[v] * heading + k_p * away).dot(at.dP) / at.dP.squaredNorm();
}

static double speed_error(const Now& now) {
  const double* u = now.u;
  if (!received(u, Z_R)) return 0;
  return u[v_0] + (u[v_1] - u[v_0]) * rise(now.t, u[t_v], u[ramp_v]) - u[v];
}

States model_rates(const Now& now, const States& x) {
  States x_dot = States::Zero();
  if (!received(now.u, Z_R)) return x_dot;
  x_dot[at_delta] = steer_rate(now, x);
  x_dot[at_integral] = speed_error(now);
  if (now.u[path] != 0) x_dot[at_p] = p_rate(now.u, place(now.u, x[at_p]));
  return x_dot;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const double *u = now.u, t = now.t;
  y[delta] = x[at_delta];
  y[delta_dot] = received(u, Z_R) ? steer_rate(now, x) : 0;
  y[M_drive] = u[k_v] * speed_error(now) + u[k_i] * x[at_integral];
  y[M_drive] += u[M_0] * (rise(t, u[t_on], u[ramp_M]) - rise(t, u[t_off], u[ramp_M]));
  y[M_brake] = u[B_0] * rise(t, u[t_brake], u[ramp_M]);
  y[p] = x[at_p];
  y[off] = u[path] != 0 ? off_path(u, place(u, x[at_p])) : 0;
}
