/* Quarter car: a sprung mass B above the wheel's centre O, linked to it by springs and dampers without mass; hub motor
 * and brake. B does not turn; the wheel's own wheel carrier (`guided`) keeps the axle. Fixed axes X, Y, Z, Z up.
 *
 *   F   = k (r_B - r_O - (0, 0, l_0)) + c (v_B - v_O)         link force on the wheel, each axis its own k, c
 *   m_B a_B = -F - m_B g (sin(slope) cos(slope_direction), sin(slope) sin(slope_direction), cos(slope))
 *
 * From t_drive on the hub motor gives M_drive, M_3 about the axle. From t_brake on the brake's capacity M follows the
 * pedal,
 *
 *   M' = (M_ref - M) / T_brake,   M_ref = M_pedal, or at most M_per_N N (in proportion to the normal force),
 *
 * or the anti-lock controller, by the slip over the speed, (v + R omega_z) / v: build up at rate_build, hold, release
 * at rate_dump until the wheel spins up. The first build-up is the pedal's. No cycle needs a discrete state: one ends
 * as the wheel's slip answers. Slower than v_low the pedal acts alone, and the wheel locks.
 *
 * Before t_couple the links carry nothing and B only runs on: a master that begins with all inputs at zero, as fmpy's
 * SSP simulation does, then does no harm. */
#include <algorithm>
#include <cmath>

#include "model.hpp"

using Eigen::Vector3d;

enum { at_r = 0, at_v = 3, at_M = 6, at_spin, at_released }; /* M, released so far: N m; omega_z with the lag T_spin */

void model_derive(const double*, double*) {}

States model_start(const Now& now) {
  States x = States::Zero();
  x.segment<3>(at_r) = Vector3d(now.u + X_B_start);
  x[at_v] = now.u[v_start];
  x[at_spin] = now.u[omega_z];
  return x;
}

static Vector3d link_force(const Now& now, const States& x) {
  const double* u = now.u;
  const Vector3d k(u[k_h], u[k_h], u[k_v]), c(u[c_h], u[c_h], u[c_v]), rest(0, 0, u[l_0]);
  if (!reached(now, t_couple)) return Vector3d::Zero();
  return k.cwiseProduct(x.segment<3>(at_r) - Vector3d(u + X_O) - rest) +
         c.cwiseProduct(x.segment<3>(at_v) - Vector3d(u + X_O_dot));
}

/* Rate of the capacity by the controller; `pedal` is that by the pedal. */
static double anti_lock(const double* u, const States& x, double pedal) {
  const double slip = (x[at_v] + u[R] * u[omega_z]) / x[at_v];
  if (slip > u[slip_dump]) return u[omega_z] < x[at_spin] || x[at_M] <= 0 ? 0 : -u[rate_dump];
  if (slip > u[slip_build]) return 0;
  return x[at_released] > 0 ? std::min(u[rate_build], pedal) : pedal;
}

static double capacity_rate(const Now& now, const States& x) {
  const double* u = now.u;
  if (!reached(now, t_brake)) return 0;
  const double most = u[control] == 1 ? std::min(u[M_pedal], u[M_per_N] * u[lambda_3]) : u[M_pedal];
  const double pedal = (most - x[at_M]) / u[T_brake];
  return u[control] == 2 && x[at_v] > u[v_low] ? anti_lock(u, x, pedal) : pedal;
}

States model_rates(const Now& now, const States& x) {
  const double* u = now.u;
  States x_dot = States::Zero();
  x_dot.segment<3>(at_r) = x.segment<3>(at_v);
  x_dot[at_M] = capacity_rate(now, x);
  x_dot[at_spin] = (u[omega_z] - x[at_spin]) / u[T_spin];
  x_dot[at_released] = std::max(-x_dot[at_M], 0.0);
  if (!reached(now, t_couple)) return x_dot;
  const double along = std::sin(u[slope]) * std::cos(u[slope_direction]);
  const double across = std::sin(u[slope]) * std::sin(u[slope_direction]);
  x_dot.segment<3>(at_v) = -link_force(now, x) / u[m_B] - u[g] * Vector3d(along, across, std::cos(u[slope]));
  return x_dot;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  Vector3d::Map(y + F_X) = link_force(now, x);
  Vector3d::Map(y + X_B) = x.segment<3>(at_r);
  Vector3d::Map(y + X_B_dot) = x.segment<3>(at_v);
  y[M_3] = reached(now, t_drive) ? u[M_drive] : 0;
  y[M_brake] = std::max(x[at_M], 0.0);
}
