// The law of friction after Filippov, and the choice of the method.
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

// The law apart from layers; `braked`: the brake is in use.
WheelFriction friction_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y) {
  if (scene.wheel.s == 0 && !braked) return {WHEEL_FRICTIONLESS, 0, 0};
  if (setup.friction_law == regularized_law) return {WHEEL_REGULARIZED, 0, setup.omega_s};
  const double omega_z = y[setup.formulation->spin_index];
  if (omega_z != 0) return {WHEEL_ROLLING, omega_z > 0 ? 1.0 : -1.0, 0};
  const Held held = held_at(setup, scene, y);
  return held.reserve >= 0 ? WheelFriction{WHEEL_HELD, 0, 0} : against(held);
}

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

// The laws to try where the wheel loses its grip: without spin, with rolling friction or brake, first that it is held.
bool may_be_held(const Setup& setup, const InForce& now, const double* y) {
  const bool some = now.scene.wheel.s != 0 || now.inputs.braked;
  return some && setup.friction_law == exact_law && y[setup.formulation->spin_index] == 0;
}

// Whether a law of a wheel without spin agrees with the motion that it gives.
bool agrees(const Setup& setup, const WheelScene& scene, const double* y) {
  if (scene.friction.kind == WHEEL_HELD) return held_at(setup, scene, y).reserve >= 0;
  WheelDynamics dynamics;
  setup.sliding->dynamics(&scene, y, &dynamics);
  return scene.friction.sigma * dynamics.omega_z_dot >= 0;
}

}  // namespace

void let_act(const Setup& setup, const Road& road, double t, const Polynomials& inputs, InForce& now) {
  now.road = road;
  now.scene.wheel = setup.wheel;
  now.scene.wheel.s = road.s;
  if (road.slope != 0) wheel_set_slope(&now.scene.wheel, setup.wheel.g, road.slope, road.slope_direction);
  now.scene.mu_slide = std::fmin(road.mu_slide, road.mu_max);
  now.scene.load = load_of(inputs);
  now.inputs.take_over(t, inputs);
}

void put_in_force(const Setup& setup, const Demand& demand, double t, double* y, InForce& now) {
  let_act(setup, road_asked(demand), t, demand.inputs, now);
  now.layer = Layer::none;
  setup.sliding ? decide_contact(setup, t, y, now) : decide_law(setup, t, y, now);
}

void decide_contact(const Setup& setup, double t, double* y, InForce& now) {
  if (now.slides() && y[setup.sliding->slip_index] > least_slip(setup, t)) return decide_law(setup, t, y, now);
  if (now.slides()) setup.sliding->grip(&now.scene.wheel, y);
  now.scene.contact = WHEEL_GRIPS;
  decide_law(setup, t, y, now);
  if (!(grip_left(setup, now, t, y) >= 0)) begin_slide(setup, t, y, now);
}

double first_direction(const Setup& setup, const WheelScene& scene, const double* reduced) {
  const double chi = setup.sliding->slip_direction(&scene, reduced);
  if (!std::isnan(chi)) return chi;
  WheelScene pulled = scene;
  pulled.ground = WHEEL_GROUND_PULLS;
  const WheelSlip free = setup.sliding->slip(&pulled, reduced, 0);
  return wheel_angle_of(free.growth, free.turn);
}

void begin_slide(const Setup& setup, double t, double* y, InForce& now) {
  double reduced[WHEEL_MAX_STATES];
  setup.formulation->reduce(y, reduced);
  now.scene.contact = WHEEL_SLIDES;
  WheelScene scene = now.scene_at(t);
  const auto take = [&](const WheelFriction& law) {
    scene.friction = now.scene.friction = law;
    y[setup.sliding->slip_index] = first_slip(setup, t);
    y[setup.sliding->slip_index + 1] = first_direction(setup, scene, reduced);
  };
  if (may_be_held(setup, now, y)) {
    for (const WheelFriction& law : {WheelFriction{WHEEL_HELD, 0, 0}, {WHEEL_ROLLING, 1, 0}, {WHEEL_ROLLING, -1, 0}}) {
      take(law);
      if (agrees(setup, scene, y)) break;
    }
  } else {
    take(friction_at(setup, scene, now.inputs.braked, y));
    decide_law(setup, t, y, now);
  }
}

double least_slip(const Setup& setup, double t) {
  constexpr double part = 0.01, roundings = 128;
  return setup.slip_scale * (part * setup.tolerance + roundings * solver::rounding_at(t) / setup.own_time);
}

double first_slip(const Setup& setup, double t) { return 2 * least_slip(setup, t); }

// Rounding is relative to mu_max N, and that of a tangential force of zero.
double grip_left(const Setup& setup, const InForce& now, double t, const double* y) {
  constexpr double rounding = 1e-12, rounding_of_zero = 1e-15;
  const WheelScene scene = now.scene_at(t);
  WheelDynamics dynamics;
  setup.formulation->dynamics(&scene, y, &dynamics);
  const double* lambda = dynamics.lambda;
  const double mu_max = std::fmax(now.road.mu_max, rounding_of_zero), full = setup.weight;
  const double X = lambda[0] / full / mu_max, Y = lambda[1] / full / mu_max;
  const double N = lambda[2] / full * (1 + rounding) + rounding_of_zero / mu_max;
  return N * std::fabs(N) - (X * X + Y * Y);
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

solver::Method method_of(const Setup& setup, const InForce& now) {
  const bool regularized = now.scene.friction.kind == WHEEL_REGULARIZED;
  if (now.layer == Layer::sticking || (setup.method == bdf_method && regularized)) return solver::Method::bdf;
  if (now.slides()) return solver::Method::collocation;
  if (setup.method == bdf_method) return solver::Method::bdf;
  return setup.method == adams_method ? solver::Method::adams : solver::Method::runge_kutta;
}

bool is_unfoldable(const Setup& setup, const InForce& in_force) {
  return setup.unfolds && in_force.scene.friction.kind == WHEEL_FRICTIONLESS && !in_force.inputs.loaded &&
         !in_force.slides() && in_force.road.slope == 0;
}

}  // namespace wheel
