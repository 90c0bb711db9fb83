// Decisions taken once, when initialization ends, or when a tunable parameter changes.
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wheel {

WheelParameters parameters_from(const double* v) { return {v[m], v[r_0], v[r], v[J_x], v[J_y], v[J_z], v[g], v[s]}; }

WheelMotion initial_motion(const double* v) {
  return {v[psi_start],       v[theta_start],   v[phi_start], v[psi_dot_start],
          v[theta_dot_start], v[phi_dot_start], v[X_O_start], v[Y_O_start]};
}

const WheelFormulation& choose_formulation(const double* v) {
  const bool symmetric = v[J_x] == v[J_y];
  const int wish = choice_of(v[formulation]);
  const bool reduced = wish == reduced_formulation || (wish == automatic_formulation && symmetric);
  return reduced ? wheel_reduced : wheel_multibody;
}

integrator::Method choose_method(const double* v) {
  const int wish = choice_of(v[method]);
  if (wish != automatic_method) return wish == bdf_method ? integrator::Method::bdf : integrator::Method::adams;
  if (v[s] == 0 || choice_of(v[friction_law]) != regularized_law) return integrator::Method::adams;
  // Fastest decay of the regularized law, slope s N / omega_s of the moment at omega_z = 0 over the spin inertia, in
  // units of the wheel's own time. Where Adams and bdf cost the same: measured in docs/results/stability.md.
  const double length = v[r_0] + v[r];
  const double decay = v[s] * v[m] * v[g] / (v[omega_s] * (v[J_z] + v[m] * length * length));
  constexpr double stiff = 200;
  const double own_time = v[g] > 0 ? std::sqrt(length / v[g]) : 0;
  return decay * own_time > stiff ? integrator::Method::bdf : integrator::Method::adams;
}

double holding_margin(const WheelParameters& wheel, const WheelDynamics& held) {
  constexpr double rounding = 1e-12;
  const double reach = wheel.s * std::max(held.lambda[2], 0.0);
  return reach + rounding * reach - std::fabs(held.tau);
}

WheelFriction friction_at(const double* v, const WheelFormulation& f, const WheelScene& scene, const double* y) {
  if (scene.wheel.s == 0) return {WHEEL_FRICTIONLESS, 0, 0};
  if (choice_of(v[friction_law]) == regularized_law) return {WHEEL_REGULARIZED, 0, v[omega_s]};
  const double omega_z = y[f.spin_index];
  if (omega_z != 0) return {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  WheelScene trial = scene;
  WheelDynamics held;
  trial.friction = {WHEEL_HELD, 0, 0};
  f.dynamics(&trial, y, &held);
  if (holding_margin(scene.wheel, held) >= 0) return trial.friction;
  return {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0};
}

bool watches_event(const WheelScene& scene) {
  return scene.friction.kind == WHEEL_ROLLING || scene.friction.kind == WHEEL_HELD;
}

double time_scale(const WheelParameters& wheel, const WheelKinematics& start) {
  const double length = wheel.r_0 + wheel.r;
  if (wheel.g > 0) return std::sqrt(length / wheel.g);
  const double rate = std::fabs(start.psi_dot) + std::fabs(start.theta_dot) + std::fabs(start.phi_dot);
  return rate > 0 ? 1 / rate : 1;
}

// Measured: 19 steps in the wheel's own time without friction and 42 with it at the tolerance 1e-8, 91 at 1e-12 in the
// multibody form; 6 per radian of a fast spin. Rates no wheel has do not count.
long long most_steps(const WheelParameters& wheel, double omega_z, double h) {
  constexpr double in_any_call = 1e6, in_own_time = 500, per_radian = 50, highest_rate = 1e3, fastest_spin = 1e4;
  const double own_rate = std::sqrt(wheel.g / (wheel.r_0 + wheel.r));
  const double rate =
      in_own_time * std::fmin(own_rate, highest_rate) + per_radian * std::fmin(std::fabs(omega_z), fastest_spin);
  return static_cast<long long>(in_any_call + std::fmin(rate * h, 1e15));
}

void error_scales(const WheelParameters& wheel, const WheelFormulation& f, const double* y, double* scales) {
  WheelKinematics start;
  f.kinematics(&wheel, y, &start);
  const double length = wheel.r_0 + wheel.r;
  const double slowest = 1 / time_scale(wheel, start), omega_2 = start.psi_dot * std::sin(start.theta);
  const double tilting = start.theta_dot * start.theta_dot + omega_2 * omega_2;
  const double turn = std::max(slowest, std::sqrt(tilting));
  const double rate = std::max(slowest, std::sqrt(tilting + start.omega_z * start.omega_z));
  const bool reduced = f.states == WHEEL_REDUCED_STATES;
  // psi, phi, X_O, Y_O feed nothing back: their errors do not grow, and may be larger.
  const double reduced_scales[] = {1, turn, turn, rate, 3, 3, 3 * length, 3 * length};
  // The velocity of O is bound to the rates by the constraints: weighed lower, it strays less from them.
  const double speed = 0.15 * slowest * length;
  const double multibody_scales[] = {length, length, length, 1, 1, 1, speed, speed, speed, turn, turn, rate};
  std::copy_n(reduced ? reduced_scales : multibody_scales, f.states, scales);
}

}  // namespace wheel
