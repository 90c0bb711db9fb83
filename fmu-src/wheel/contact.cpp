// Where the wheel begins and ceases to slide, and in which direction.
#include "contact.hpp"

#include <cmath>

#include "law.hpp"

namespace wheel {
namespace {

// The laws to try where the wheel starts to slide: without spin, with rolling friction or brake, first that it is held.
bool may_be_held(const Setup& setup, const InForce& now, const double* y) {
  const bool some = now.scene.wheel.s != 0 || now.inputs.braked;
  return some && setup.friction_law == exact_law && y[setup.formulation->spin_index] == 0;
}

// Whether a law of a wheel without spin agrees with the motion that it gives.
bool agrees(const Setup& setup, const WheelScene& scene, const double* y) {
  if (scene.friction.kind == WHEEL_HELD) return holding_reserve(setup, scene, y) >= 0;
  WheelDynamics dynamics;
  setup.sliding->dynamics(&scene, y, &dynamics);
  return scene.friction.sigma * dynamics.omega_z_dot >= 0;
}

}  // namespace

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

double first_direction(const WheelScene& scene, const double* reduced) {
  const double chi = wheel_slip_direction(&scene, reduced);
  if (!std::isnan(chi)) return chi;
  WheelScene pulled = scene;
  pulled.ground = WHEEL_GROUND_PULLS;
  const WheelSlip free = wheel_slip(&pulled, reduced, 0);
  return wheel_angle_of(free.growth, free.turn);
}

void begin_slide(const Setup& setup, double t, double* y, InForce& now) {
  double reduced[WHEEL_MAX_STATES];
  setup.formulation->reduce(y, reduced);
  now.scene.contact = WHEEL_SLIDES;
  WheelScene scene = now.scene_at(t);
  const auto take = [&](const WheelFriction& law) {
    scene.friction = now.scene.friction = law;
    y[setup.sliding->slip_index] = 2 * least_slip(setup, t);
    y[setup.sliding->slip_index + 1] = first_direction(scene, reduced);
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

}  // namespace wheel
