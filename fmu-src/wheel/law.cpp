// The law of friction after Filippov.
#include "law.hpp"

#include <algorithm>
#include <cmath>

namespace wheel {
namespace {

// A wheel that is held: the moment about the axle, N m, and what of the capacity s N + M_brake is left, N m.
struct Held {
  double tau, reserve;
};

Held held_at(const Setup& setup, const WheelScene& scene, const double* y) {
  constexpr double rounding_of_capacity = 1e-12, rounding_of_tau = 1e-13;
  WheelScene trial = scene;
  trial.friction = {WHEEL_HELD, 0, 0};
  WheelDynamics held;
  formulation_of(setup, scene).dynamics(&trial, y, &held);
  const double capacity = scene.wheel.s * std::max(held.lambda[2], 0.0) + scene.load.brake;
  const double rounding = rounding_of_capacity * capacity + rounding_of_tau * setup.weight * setup.length;
  return {held.tau, capacity + rounding - std::fabs(held.tau)};
}

// Rolling against the moment that would hold the wheel.
WheelFriction against(const Held& held) { return {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0}; }

void enter_layer(const Setup& setup, const WheelScene& scene, const double* y, InForce& now) {
  const double omega_z = y[setup.formulation->spin_index];
  if (std::fabs(omega_z) > layer_edge(setup)) {
    now.layer = Layer::outside;
    now.scene.friction = {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  } else {
    now.layer = holding_reserve(setup, scene, y) >= 0 ? Layer::sticking : Layer::passing;
    now.scene.friction = {WHEEL_REGULARIZED, 0, setup.omega_s};
  }
}

}  // namespace

WheelFriction friction_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y) {
  if (scene.wheel.s == 0 && !braked) return {WHEEL_FRICTIONLESS, 0, 0};
  if (setup.friction_law == regularized_law) return {WHEEL_REGULARIZED, 0, setup.omega_s};
  const double omega_z = y[setup.formulation->spin_index];
  if (omega_z != 0) return {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  const Held held = held_at(setup, scene, y);
  return held.reserve >= 0 ? WheelFriction{WHEEL_HELD, 0, 0} : against(held);
}

void let_act(const Setup& setup, const Road& road, double t, const Polynomials& inputs, InForce& now) {
  now.road = road;
  now.scene.wheel = setup.wheel;
  now.scene.wheel.s = road.s;
  if (road.slope != 0) wheel_set_slope(&now.scene.wheel, setup.wheel.g, road.slope, road.slope_direction);
  now.scene.mu_slide = std::fmin(road.mu_slide, road.mu_max);
  now.scene.guided = setup.guided;
  now.scene.load = load_of(inputs);
  now.inputs.take_over(t, inputs);
}

void decide_law(const Setup& setup, double t, const double* y, InForce& now, bool released) {
  WheelScene scene = now.scene_at(t);
  scene.friction = released ? against(held_at(setup, scene, y)) : friction_at(setup, scene, now.inputs.braked, y);
  now.scene.friction = scene.friction;
  const bool stiff = can_stiffen(setup, now) && softness_of(setup, scene, y) < 0;
  if (stiff || now.layer != Layer::none) enter_layer(setup, scene, y, now);
}

bool can_stiffen(const Setup& setup, const InForce& now) {
  const bool asked = setup.method == automatic_method && setup.kind == Kind::co_simulation;
  return asked && now.layer == Layer::none && now.scene.friction.kind == WHEEL_REGULARIZED;
}

// The fastest decay of the law is that at omega_z = 0: (s N + M_brake) / omega_s over the spin inertia, to be compared
// with the wheel's own time scale; below the limit DOP853 alone is faster (docs/results/stability.md).
double softness_of(const Setup& setup, const WheelScene& scene, const double* y) {
  constexpr double stiff = 1000;
  const WheelParameters& wheel = scene.wheel;
  const double inertia = wheel.J_z + wheel.m * setup.length * setup.length;
  double y_dot[WHEEL_MAX_STATES];
  const double N = std::max(setup.weight, formulation_of(setup, scene).derivative(&scene, y, y_dot));
  return 1 - (wheel.s * N + scene.load.brake) / (setup.omega_s * inertia) * setup.own_time / stiff;
}

double holding_reserve(const Setup& setup, const WheelScene& scene, const double* y) {
  return held_at(setup, scene, y).reserve;
}

}  // namespace wheel
