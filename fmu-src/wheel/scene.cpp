// Decisions taken when initialization ends, and again when a tunable parameter or an input changes.
#include "scene.hpp"

#include <algorithm>
#include <cmath>

#include "variables.hpp"

namespace wheel {

WheelParameters parameters_from(const double* v) {
  WheelParameters wheel = {v[m], v[r_0], v[r], v[J_x], v[J_y], v[J_z], v[g], v[s], 0, 0};
  if (v[slope] != 0) wheel_set_slope(&wheel, v[g], v[slope], v[slope_direction]);
  return wheel;
}

WheelMotion initial_motion(const double* v) {
  return {v[psi_start],       v[theta_start],   v[phi_start], v[psi_dot_start],
          v[theta_dot_start], v[phi_dot_start], v[X_O_start], v[Y_O_start]};
}

const WheelFormulation& choose_formulation(const double* v) {
  return choice_of(v[formulation]) == multibody_formulation ? wheel_multibody : wheel_reduced;
}

namespace {

// The fastest decay of the regularized law: slope (s N + M_brake) / omega_s of the moment at omega_z = 0 over the spin
// inertia, in units of the wheel's own time. Adams and BDF cost the same where it is about 200
// (docs/results/stability.md).
bool is_stiff(const double* v, const WheelScene& scene) {
  constexpr double stiff = 200;
  if (scene.friction.kind != WHEEL_REGULARIZED) return false;
  const double length = v[r_0] + v[r];
  const double decay = (v[s] * v[m] * v[g] + scene.load.brake) / (v[omega_s] * (v[J_z] + v[m] * length * length));
  const double own_time = v[g] > 0 ? std::sqrt(length / v[g]) : 0;
  return decay * own_time > stiff;
}

}  // namespace

solver::Method choose_method(const double* v, const WheelScene& scene, bool jumps) {
  switch (choice_of(v[method])) {
    case adams_method:
      return solver::Method::adams;
    case bdf_method:
      return solver::Method::bdf;
    case runge_kutta_method:
      return solver::Method::runge_kutta;
    default:
      break;
  }
  if (is_stiff(v, scene)) return solver::Method::bdf;
  return jumps || has_transitions(scene) ? solver::Method::runge_kutta : solver::Method::adams;
}

bool is_unfoldable(const double* v, const WheelScene& scene, bool loaded) {
  return scene.friction.kind == WHEEL_FRICTIONLESS && !loaded && v[J_x] == v[J_y] && v[slope] == 0 &&
         choice_of(v[formulation]) == automatic_formulation && choice_of(v[method]) == automatic_method;
}

double holding_margin(const WheelScene& scene, const WheelDynamics& held, double weight) {
  constexpr double rounding_of_capacity = 1e-12, rounding_of_tau = 1e-13;
  const double capacity = scene.wheel.s * std::max(held.lambda[2], 0.0) + scene.load.brake;
  const double rounding =
      rounding_of_capacity * capacity + rounding_of_tau * weight * (scene.wheel.r_0 + scene.wheel.r);
  return capacity + rounding - std::fabs(held.tau);
}

WheelFriction friction_at(const double* v, const WheelFormulation& f, const WheelScene& scene, bool braked,
                          double weight, const double* y) {
  if (scene.wheel.s == 0 && !braked) return {WHEEL_FRICTIONLESS, 0, 0};
  if (choice_of(v[friction_law]) == regularized_law) return {WHEEL_REGULARIZED, 0, v[omega_s]};
  const double omega_z = y[f.spin_index];
  if (omega_z != 0) return {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  WheelScene trial = scene;
  WheelDynamics held;
  trial.friction = {WHEEL_HELD, 0, 0};
  f.dynamics(&trial, y, &held);
  if (holding_margin(scene, held, weight) >= 0) return trial.friction;
  return {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0};
}

bool has_transitions(const WheelScene& scene) {
  return scene.friction.kind == WHEEL_ROLLING || scene.friction.kind == WHEEL_HELD;
}

namespace {

double gravity_of(const WheelParameters& wheel) { return std::hypot(wheel.g, wheel.g_X, wheel.g_Y); }

}  // namespace

double time_scale(const WheelParameters& wheel, const WheelKinematics& start) {
  const double length = wheel.r_0 + wheel.r, gravity = gravity_of(wheel);
  const double rate = std::fabs(start.psi_dot) + std::fabs(start.theta_dot) + std::fabs(start.phi_dot);
  if (gravity > 1e-30 * length * rate * rate) return std::sqrt(length / gravity);  // else the weight moves nothing
  return rate > 0 ? 1 / rate : 1;
}

double force_scale(const WheelParameters& wheel, double own_time) {
  const double gravity = gravity_of(wheel);
  const double across = gravity > 0 ? wheel.g / gravity : 1;
  return wheel.m * (wheel.r_0 + wheel.r) / (own_time * own_time) * across;
}

ErrorScales error_scales(const WheelParameters& wheel, const WheelFormulation& f, const double* y) {
  WheelKinematics start;
  f.kinematics(&wheel, y, &start);
  const double length = wheel.r_0 + wheel.r;
  const double slowest = 1 / time_scale(wheel, start), omega_2 = start.psi_dot * std::sin(start.theta);
  const double tilting = std::sqrt(start.theta_dot * start.theta_dot + omega_2 * omega_2);
  const double turn = std::max(slowest, tilting);
  // psi, phi, X_O, Y_O do not feed back into the closed states: their errors do not grow, and may be larger.
  const double reduced[] = {1, turn, turn, turn, 3, 3, 3 * length, 3 * length};
  // The velocity of O is bound to the rates by the constraints: weighed lower, it strays less from them.
  const double speed = 0.15 * slowest * length;
  const double multibody[] = {length, length, length, 1, 1, 1, speed, speed, speed, turn, turn, turn};
  ErrorScales scales = {{}, slowest, tilting};
  std::copy_n(f.states == WHEEL_REDUCED_STATES ? reduced : multibody, f.states, scales.slow);
  return scales;
}

void scales_at(const ErrorScales& scales, const WheelFormulation& f, double omega_z, double* out) {
  std::copy_n(scales.slow, f.states, out);
  const double spin = std::fabs(omega_z);
  if (!(spin > scales.own_rate)) return;
  const double turn = scales.own_rate * scales.own_rate / spin + scales.tilting;  // rad/s, of a nutation
  out[f.tilt_index] = std::fmin(out[f.tilt_index], turn / spin);
  const int last = f.spin_index;  // the three rates of rotation stand together, the spin last
  for (int i = last - 2; i <= last; ++i) out[i] = std::fmin(out[i], turn);
}

double share_at(const ErrorScales& scales, double omega_z) {
  constexpr double many = 12;
  const double spin = std::fabs(omega_z);
  return spin > many * scales.own_rate ? many * scales.own_rate / spin : 1;
}

}  // namespace wheel
