/* Quarter car: a sprung mass B above the wheel's centre O, linked to it by springs and dampers without mass. B does not
 * turn; the wheel's own wheel carrier (`guided`) keeps the axle, the hub motor gives M_3 about it. Fixed axes X, Y, Z,
 * Z up.
 *
 *   F   = k (r_B - r_O - (0, 0, l_0)) + c (v_B - v_O)         link force on the wheel, each axis its own k, c
 *   m_B a_B = -F - m_B g (sin(slope) cos(slope_direction), sin(slope) sin(slope_direction), cos(slope))
 *
 * Before t_couple the links carry nothing and B only runs on: a master that begins with all inputs at zero, as fmpy's
 * SSP simulation does, then does no harm. From t_drive on the hub motor gives M_drive. */
#include <cmath>

#include "model.hpp"

using Eigen::Vector3d;

void model_derive(const double*, double*) {}

States model_start(const Now& now) {
  States x = States::Zero();
  x.head<3>() = Vector3d(now.u + X_B_start);
  x[3] = now.u[v_start];
  return x;
}

static Vector3d link_force(const Now& now, const States& x) {
  const double* u = now.u;
  const Vector3d k(u[k_h], u[k_h], u[k_v]), c(u[c_h], u[c_h], u[c_v]), rest(0, 0, u[l_0]);
  if (!reached(now, t_couple)) return Vector3d::Zero();
  return k.cwiseProduct(x.head<3>() - Vector3d(u + X_O) - rest) +
         c.cwiseProduct(x.segment<3>(3) - Vector3d(u + X_O_dot));
}

States model_rates(const Now& now, const States& x) {
  States x_dot = States::Zero();
  x_dot.head<3>() = x.segment<3>(3);
  if (!reached(now, t_couple)) return x_dot;
  const double* u = now.u;
  const double along = std::sin(u[slope]) * std::cos(u[slope_direction]);
  const double across = std::sin(u[slope]) * std::sin(u[slope_direction]);
  x_dot.segment<3>(3) = -link_force(now, x) / u[m_B] - u[g] * Vector3d(along, across, std::cos(u[slope]));
  return x_dot;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  Vector3d::Map(y + F_X) = link_force(now, x);
  Vector3d::Map(y + X_B) = x.head<3>();
  Vector3d::Map(y + X_B_dot) = x.segment<3>(3);
  y[M_3] = reached(now, t_drive) ? u[M_drive] : 0;
}
