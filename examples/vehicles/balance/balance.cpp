/* Controller that keeps a slowly rolling wheel from falling and steers it along a line, then a circle.
 *
 *   psi_ref'  = 0 on the line, v / R on the circle, rising over t_bend;  v = r_roll |omega_ref|
 *   theta_ref = pi/2 + (psi_ref' - k_psi (psi - psi_ref)) / a      a wheel turns to the side it leans to
 *   M_1       = k_theta (theta_ref - theta) - c_theta theta'       about e1, the rolling direction
 *   M_3       = -k_omega (omega_z - omega_ref) - k_i integral      about the axle: holds the speed
 *
 * a = J_z omega_ref / J_x is the wheel's gyroscopic gain: without a moment about e2, psi' - a theta is constant near
 * upright, which is how leaning steers. */
#include <algorithm>
#include <cmath>
#include <numbers>

#include "model.hpp"

enum { at_psi_ref, at_integral };

void model_derive(const double*, double*) {}

States model_start(const Now&) { return States::Zero(); }

static double turn(const Now& now) {
  const double* u = now.u;
  return std::clamp((now.t - u[t_circle]) / u[t_bend], 0.0, 1.0) * u[r_roll] * std::abs(u[omega_ref]) / u[R];
}

static double spin_error(const double* u) { return u[phi_dot] + u[psi_dot] * std::cos(u[theta]) - u[omega_ref]; }

States model_rates(const Now& now, const States&) {
  States x_dot = States::Zero();
  x_dot[at_psi_ref] = turn(now);
  x_dot[at_integral] = spin_error(now.u);
  return x_dot;
}

void model_outputs(const Now& now, const States& x, double* y) {
  const double* u = now.u;
  const double theta_ref = std::numbers::pi / 2 + (turn(now) - u[k_psi] * (u[psi] - x[at_psi_ref])) / u[a];
  y[M_1] = u[k_theta] * (theta_ref - u[theta]) - u[c_theta] * u[theta_dot];
  y[M_3] = -u[k_omega] * spin_error(u) - u[k_i] * x[at_integral];
}
