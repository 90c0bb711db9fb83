/* Quarter car: a sprung mass B above the wheel's centre O, linked to it by springs and dampers without mass; hub motor
 * and brake. B does not turn; the wheel's own wheel carrier (`guided`) keeps the axle. Fixed axes X, Y, Z, Z up.
 *
 *   F   = k (r_B - r_O - (0, 0, l_0)) + c (v_B - v_O)         link force on the wheel, each axis its own k, c
 *   m_B a_B = -F - m_B g (0, 0, 1)
 *
 * From t_drive on the hub motor gives M_drive, M_3 about the axle. From t_brake on the brake's capacity M follows the
 * pedal, M' = (M_pedal - M) / T_brake. Until the wheel's centre is received B runs straight on, and the link gives its
 * weight. */
#include "model.hpp"

using Eigen::Vector3d;

enum { at_r = 0, at_v = 3, at_M = 6 }; /* states; M, N m */

void model_derive(const double*, double*) {}

States model_start(const Now& now) {
  States x = States::Zero();
  x.segment<3>(at_r) = Vector3d(now.u + X_B_start);
  x[at_v] = now.u[v_start];
  return x;
}

static Vector3d weight(const double* u) { return {0, 0, -u[m_B] * u[g]}; }

static Vector3d link_force(const double* u, const States& x) {
  if (!received(u, Z_O)) return weight(u);
  const Vector3d k(u[k_h], u[k_h], u[k_v]), c(u[c_h], u[c_h], u[c_v]), rest(0, 0, u[l_0]);
  return k.cwiseProduct(x.segment<3>(at_r) - Vector3d(u + X_O) - rest) +
         c.cwiseProduct(x.segment<3>(at_v) - Vector3d(u + X_O_dot));
}

States model_rates(const Now& now, const States& x) {
  const double* u = now.u;
  States x_dot = States::Zero();
  x_dot.segment<3>(at_r) = x.segment<3>(at_v);
  x_dot.segment<3>(at_v) = (weight(u) - link_force(u, x)) / u[m_B];
  if (reached(now, t_brake)) x_dot[at_M] = (u[M_pedal] - x[at_M]) / u[T_brake];
  return x_dot;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  Vector3d::Map(y + F_X) = link_force(u, x);
  Vector3d::Map(y + X_B) = x.segment<3>(at_r);
  Vector3d::Map(y + X_B_dot) = x.segment<3>(at_v);
  y[M_3] = reached(now, t_drive) ? u[M_drive] : 0;
  y[M_brake] = x[at_M];
}
