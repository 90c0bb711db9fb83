// The law of friction after Filippov, and the choice of the method.
#include "law.hpp"

#include <algorithm>
#include <cmath>

namespace wheel {
namespace {

WheelDynamics dynamics_of_held(const Setup& setup, const WheelScene& scene, const double* y) {
  WheelScene trial = scene;
  trial.friction = {WHEEL_HELD, 0, 0};
  WheelDynamics held;
  setup.formulation->dynamics(&trial, y, &held);
  return held;
}

double margin_of(const Setup& setup, const WheelScene& scene, const WheelDynamics& held) {
  constexpr double rounding_of_capacity = 1e-12, rounding_of_tau = 1e-13;
  const double capacity = scene.wheel.s * std::max(held.lambda[2], 0.0) + scene.load.brake;
  const double rounding =
      rounding_of_capacity * capacity + rounding_of_tau * setup.weight * (scene.wheel.r_0 + scene.wheel.r);
  return capacity + rounding - std::fabs(held.tau);
}

// Rolling against the moment that would hold the wheel.
WheelFriction against(const WheelDynamics& held) { return {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0}; }

// The fastest decay of the regularized law: slope (s N + M_brake) / omega_s of the moment at omega_z = 0 over the spin
// inertia, in units of the wheel's own time. Adams and BDF cost the same where it is about 200
// (docs/results/stability.md).
bool is_stiff(const Setup& setup, const WheelScene& scene) {
  constexpr double stiff = 200;
  if (scene.friction.kind != WHEEL_REGULARIZED) return false;
  const WheelParameters& wheel = scene.wheel;
  const double length = wheel.r_0 + wheel.r;
  const double decay =
      (wheel.s * wheel.m * wheel.g + scene.load.brake) / (setup.omega_s * (wheel.J_z + wheel.m * length * length));
  const double own_time = wheel.g > 0 ? std::sqrt(length / wheel.g) : 0;
  return decay * own_time > stiff;
}

}  // namespace

InForce in_force_from(const Setup& setup, const Demand& demand, WheelGround ground, double t, const double* y) {
  InForce next;
  next.scene.ground = ground;
  next.scene.wheel = setup.wheel;
  next.scene.wheel.s = demand.parameters[s];
  next.scene.load = load_of(demand.inputs);
  next.inputs.take_over(t, demand.inputs);
  next.scene.friction = friction_at(setup, next.scene, next.inputs.braked, y);
  return next;
}

WheelFriction friction_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y) {
  if (scene.wheel.s == 0 && !braked) return {WHEEL_FRICTIONLESS, 0, 0};
  if (setup.friction_law == regularized_law) return {WHEEL_REGULARIZED, 0, setup.omega_s};
  const double omega_z = y[setup.formulation->spin_index];
  if (omega_z != 0) return {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  const WheelDynamics held = dynamics_of_held(setup, scene, y);
  if (margin_of(setup, scene, held) >= 0) return {WHEEL_HELD, 0, 0};
  return against(held);
}

WheelFriction released(const Setup& setup, const WheelScene& held, const double* y) {
  return against(dynamics_of_held(setup, held, y));
}

double holding_margin(const Setup& setup, const WheelScene& scene, const double* y) {
  return margin_of(setup, scene, dynamics_of_held(setup, scene, y));
}

bool has_transitions(const WheelFriction& friction) {
  return friction.kind == WHEEL_ROLLING || friction.kind == WHEEL_HELD;
}

solver::Method choose_method(const Setup& setup, const WheelScene& scene, bool jumps) {
  switch (setup.method) {
    case adams_method:
      return solver::Method::adams;
    case bdf_method:
      return solver::Method::bdf;
    case runge_kutta_method:
      return solver::Method::runge_kutta;
    case automatic_method:
      break;
  }
  if (is_stiff(setup, scene)) return solver::Method::bdf;
  return jumps || has_transitions(scene.friction) ? solver::Method::runge_kutta : solver::Method::adams;
}

bool is_unfoldable(const Setup& setup, const InForce& in_force) {
  return setup.unfolds && in_force.scene.friction.kind == WHEEL_FRICTIONLESS && !in_force.inputs.loaded;
}

}  // namespace wheel
