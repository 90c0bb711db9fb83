/* A brake whose capacity M follows the pedal, and three controllers.
 *
 *   M' = (M_ref - M) / T_brake,   M_ref = M_pedal (none), or at most M_per_N N (in proportion to the normal force)
 *
 * Anti-lock, from the slip over the speed, (v + R omega_z) / v: build up at rate_build, hold, release at rate_dump
 * until the wheel spins up. The first build-up is the pedal's. No cycle needs a discrete state: one ends as the wheel's
 * slip answers. Slower than v_low the pedal acts alone, and the wheel locks. */
#include <algorithm>

#include "model.hpp"

enum { at_M, at_spin, at_released }; /* N m; rad/s, omega_z with the lag T_spin; N m, all that was released */

void model_derive(const double*, double*) {}

States model_start(const Now& now) {
  States x = States::Zero();
  x[at_spin] = now.u[omega_z];
  return x;
}

static double anti_lock(const double* u, const States& x, double pedal) {
  const double slip = (u[X_B_dot] + u[R] * u[omega_z]) / u[X_B_dot];
  if (slip > u[slip_dump]) return u[omega_z] < x[at_spin] || x[at_M] <= 0 ? 0 : -u[rate_dump];
  if (slip > u[slip_build]) return 0;
  return x[at_released] > 0 ? std::min(u[rate_build], pedal) : pedal;
}

States model_rates(const Now& now, const States& x) {
  const double* u = now.u;
  States x_dot = States::Zero();
  x_dot[at_spin] = (u[omega_z] - x[at_spin]) / u[T_spin];
  if (!reached(now, t_brake)) return x_dot;
  const double most = u[control] == 1 ? std::min(u[M_pedal], u[M_per_N] * u[lambda_3]) : u[M_pedal];
  const double pedal = (most - x[at_M]) / u[T_brake];
  x_dot[at_M] = u[control] == 2 && u[X_B_dot] > u[v_low] ? anti_lock(u, x, pedal) : pedal;
  x_dot[at_released] = std::max(-x_dot[at_M], 0.0);
  return x_dot;
}

void model_outputs(const Now&, const States& x, double* y) { y[M_brake] = std::max(x[at_M], 0.0); }
