// The laws of the contact: rolling resistance, the start and the end of a slide.
//
// decide_contact asks whether the wheel grips. If so, decide_mode chooses the mode. If not, begin_slide
// chooses the direction of the slip and the mode, each of which depends on the other.
#include "law.hpp"

#include <algorithm>
#include <cmath>

namespace wheel {
namespace {

constexpr WheelFriction frictionless = {WHEEL_FRICTIONLESS, 0, 0}, held = {WHEEL_HELD, 0, 0};
WheelFriction rolling(bool forward) { return {WHEEL_ROLLING, forward ? 1.0 : -1.0, 0}; }

// (moment that would hold the wheel) => rolling against it
WheelFriction released_from(const Hold& hold) { return rolling(!(hold.tau > 0)); }

// (coefficient of rolling resistance, m, whether a brake is in use) => whether a moment can resist the spin
bool resists(double s, bool braked) { return s != 0 || braked; }

// (scene, braked: whether a brake is in use, y) => the mode
WheelFriction mode_at(const Setup& setup, const WheelScene& scene, bool braked, const double* y) {
  if (!resists(scene.wheel.s, braked)) return frictionless;
  const double omega_z = y[WHEEL_OMEGA_3];
  const bool regularized = setup.friction_law == regularized_law;
  const bool outside = setup.has_layer() && std::fabs(omega_z) > layer_edge(setup);
  if (regularized && !outside) return {WHEEL_REGULARIZED, 0, setup.omega_s};
  if (omega_z != 0) return rolling(omega_z > 0);
  const Hold hold = hold_at(setup, scene, y);
  return hold.reserve >= 0 ? held : released_from(hold);
}

// Whether the modes of a wheel that starts to slide are tried one by one, held first. That is where it has no spin, and
// rolling resistance or a brake.
bool may_be_held(const Setup& setup, const InForce& in_force, const double* y) {
  return resists(in_force.road.s, in_force.inputs.braked) && setup.friction_law == exact_law && y[WHEEL_OMEGA_3] == 0;
}

// (scene, y) => the slip as it would be without friction
WheelSlip free_slip(WheelScene scene, const double* y) {
  scene.ground = WHEEL_GROUND_PULLS;
  return wheel_slip(&scene, y, 0);
}

// Whether a mode of a wheel without spin agrees with the motion that it gives.
bool agrees(const Setup& setup, const WheelScene& scene, const double* y) {
  if (scene.friction.kind == WHEEL_HELD) return hold_at(setup, scene, y).reserve >= 0;
  return scene.friction.sigma * dynamics_of(setup, scene, y).omega_z_dot >= 0;
}

// Whether the carrier neither turns nor is asked to.
bool rests(const Demand& demand, const double* y) {
  return demand.value(variable::psi_dot_guide) == 0 && demand.value(variable::theta_dot_guide) == 0 &&
         y[WHEEL_OMEGA_1] == 0 && y[WHEEL_OMEGA_2] == 0;
}

WheelMotion motion_of(const Setup& setup, WheelContactMode contact, const double* y) {
  WheelKinematics k;
  formulation_of(setup, contact).kinematics(&setup.wheel, y, &k);
  const double u = contact == WHEEL_SLIDES ? y[WHEEL_SLIP] : 0;
  const double slip_x = u * std::cos(y[WHEEL_CHI]), slip_y = u * std::sin(y[WHEEL_CHI]);
  return {k.psi, k.theta, k.phi, k.psi_dot, k.theta_dot, k.phi_dot, k.X_O, k.Y_O, slip_x, slip_y};
}

// (y) => y after a jump of the carrier to the rates asked for: the limit of ever steeper ramps of its rates
// (docs/equations.md). The ramp takes no time. In it
//   only a brake that presses at this instant acts;
//   a wheel that is held, or rests in a regularized law, has the reserve that holding leaves;
//   a wheel outside the layer of a regularized law has the whole law, because it may enter the layer.
void jump_to_guide_rates(const Setup& setup, const Demand& demand, const WheelScene& scene, double* y) {
  if (rests(demand, y)) return;
  WheelMotion motion = motion_of(setup, scene.contact, y);
  WheelScene ramp = scene;
  ramp.friction = mode_at(setup, scene, scene.load.brake > 0, y);
  const bool may_rest = ramp.friction.kind == WHEEL_HELD || ramp.friction.kind == WHEEL_REGULARIZED;
  const double hold = may_rest ? hold_at(setup, scene, y).reserve : 0;
  if (setup.friction_law == regularized_law && ramp.friction.kind == WHEEL_ROLLING)
    ramp.friction = {WHEEL_REGULARIZED, 0, setup.omega_s};
  wheel_jump(&ramp, hold, demand.value(variable::psi_dot_guide), demand.value(variable::theta_dot_guide), &motion);
  start_state(formulation_of(setup, scene.contact), setup.wheel, motion, y);
}

}  // namespace

void start_guide_rates(const Setup& setup, const Demand& demand, double* y) {
  if (rests(demand, y)) return;
  WheelMotion motion = motion_of(setup, setup.first_contact, y);
  motion.psi_dot = demand.value(variable::psi_dot_guide);
  motion.theta_dot = demand.value(variable::theta_dot_guide);
  start_state(formulation_of(setup, setup.first_contact), setup.wheel, motion, y);
}

void enforce(const Setup& setup, const Demand& demand, double t, double* y, InForce& in_force) {
  in_force.take_over(setup, road_asked(demand), t, demand.inputs);
  if (setup.steered) jump_to_guide_rates(setup, demand, in_force.scene_at(t), y);
  decide_contact(setup, t, y, in_force);
}

void decide_contact(const Setup& setup, double t, double* y, InForce& in_force) {
  const bool slips_on = in_force.slides() && y[WHEEL_SLIP] > least_slip(setup, t);
  if (!setup.can_slide() || slips_on) return decide_mode(setup, t, y, in_force);
  if (in_force.slides()) y[WHEEL_SLIP] = y[WHEEL_CHI] = 0;
  in_force.set_contact(WHEEL_GRIPS);
  decide_mode(setup, t, y, in_force);
  if (grip_left(setup, in_force, t, y) >= 0) return;
  // N depends on the horizontal force: a wheel that would lift off while it grips may press the road while it slides.
  // It lifts off where the road would have to pull in both cases.
  const WheelScene scene = in_force.scene_at(t);
  const bool lifts_off = rates_of(setup, scene, y).N < 0 && free_slip(scene, y).N < 0;
  if (!lifts_off || setup.keep_contact) begin_slide(setup, t, y, in_force);
}

void decide_mode(const Setup& setup, double t, const double* y, InForce& in_force) {
  in_force.set_mode(mode_at(setup, in_force.scene_at(t), in_force.inputs.braked, y));
}

WheelFriction braked_mode(const Setup& setup, const WheelScene& scene, const double* y) {
  return mode_at(setup, scene, true, y);
}

void release(const Setup& setup, double t, const double* y, InForce& in_force) {
  in_force.set_mode(released_from(hold_at(setup, in_force.scene_at(t), y)));
}

void begin_slide(const Setup& setup, double t, double* y, InForce& in_force) {
  in_force.set_contact(WHEEL_SLIDES);
  WheelScene scene = in_force.scene_at(t);
  const auto take = [&](const WheelFriction& mode) {
    in_force.set_mode(mode);
    scene.friction = mode;
    y[WHEEL_SLIP] = 2 * least_slip(setup, t);
    y[WHEEL_CHI] = first_direction(scene, y);
  };
  if (may_be_held(setup, in_force, y)) {
    for (const WheelFriction& mode : {held, rolling(true), rolling(false)}) {  // the last where none agrees
      take(mode);
      if (agrees(setup, scene, y)) break;
    }
  } else {
    take(mode_at(setup, scene, in_force.inputs.braked, y));
  }
}

double first_direction(const WheelScene& scene, const double* y) {
  const double chi = wheel_slip_direction(&scene, y);
  if (!std::isnan(chi)) return chi;
  const WheelSlip free = free_slip(scene, y);
  return wheel_angle_of(free.growth, free.turn);
}

double least_slip(const Setup& setup, double t) {
  CONSTANT(double, part, 0.01, "of the tolerance", "where a slide ends: a small part of the error that is allowed");
  CONSTANT(double, roundings, 128, "roundings of time", "the digits of an instant that a falling slip needs");
  return setup.slip_scale * (part * setup.tolerance + roundings * solver::rounding_at(t) / setup.time_scale);
}

double grip_left(const Setup& setup, const InForce& in_force, double t, const double* y) {
  CONSTANT(double, rounding, 1e-12, "1", "of mu_max N");
  CONSTANT(double, rounding_of_zero, 1e-15, "weights", "of a tangential force of zero");
  const WheelDynamics dynamics = dynamics_of(setup, in_force.scene_at(t), y);
  const double* lambda = dynamics.lambda;
  const double mu_max = std::fmax(in_force.road.mu_max, rounding_of_zero), full = setup.weight;
  const double X = lambda[0] / full / mu_max, Y = lambda[1] / full / mu_max;
  const double N = lambda[2] / full * (1 + rounding) + rounding_of_zero / mu_max;
  return N * std::fabs(N) - (X * X + Y * Y);
}

Hold hold_at(const Setup& setup, WheelScene scene, const double* y) {
  CONSTANT(double, rounding_of_capacity, 1e-12, "1", "where rounding alone decides, the wheel stays held");
  CONSTANT(double, rounding_of_tau, 1e-13, "weight times length", "the same without a capacity");
  scene.friction = held;
  const WheelDynamics dynamics = dynamics_of(setup, scene, y);
  const double capacity = wheel_axle_capacity(scene.wheel.s, dynamics.lambda[2], scene.load.brake);
  const double rounding = rounding_of_capacity * capacity + rounding_of_tau * setup.weight * setup.length;
  return {dynamics.tau, capacity + rounding - std::fabs(dynamics.tau)};
}

}  // namespace wheel
