// What the solver asks: right-hand side, error weights, event, boundary.
#include "motion.hpp"

#include <cmath>
#include <limits>

#include "scene.hpp"

namespace wheel {

double angle_from_flat(double theta) {
  constexpr double upright = 1.5707963267948966;
  return upright - std::fabs(theta - upright);
}

namespace {

Motion& of(void* owner) { return *static_cast<Motion*>(owner); }

const WheelScene& scene_at(Motion& motion, double t) {
  if (motion.inputs.varies) motion.inputs.load_at(t, &motion.scene.load);
  return motion.scene;
}

// Zero where the wheel lies flat, rad.
double height(const Motion& motion, const double* y) {
  return angle_from_flat(y[motion.formulation->tilt_index]) - flat_angle;
}

// N over the weight, or its negative while the ground pulls. What is below zero only by rounding does not count.
double contact(const Motion& motion, double N) {
  constexpr double rounding = 1e-9;
  return (pulls(motion) ? -N : N) / motion.weight + rounding;
}

double derivative(void* owner, double t, const double* y, double* y_dot) {
  Motion& motion = of(owner);
  const double N = motion.formulation->derivative(&scene_at(motion, t), y, y_dot);
  double sum = 0;
  for (int i = 0; i < motion.formulation->states; ++i) sum += y_dot[i];
  if (!std::isfinite(sum)) return std::numeric_limits<double>::quiet_NaN();
  const double high = height(motion, y), pressed = contact(motion, N);
  return high < pressed ? high : pressed;
}

// The states' own rounding is a floor: no step has to be more exact than the numbers can express. The regularized law
// turns errors of omega_z into moments over its width omega_s: the spin must be known to a fraction of that width.
void weights(void* owner, double share, const double* y, double* weights) {
  const Motion& motion = of(owner);
  const int states = motion.formulation->states, spin = motion.formulation->spin_index;
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const double slow = share * motion.tolerance;
  const double tolerance = std::fmax(slow * share_at(motion.scales, y[spin]), std::fmin(slow, rounding));
  double scales[WHEEL_MAX_STATES];
  scales_at(motion.scales, *motion.formulation, y[spin], scales);
  for (int i = 0; i < states; ++i) weights[i] = 1 / (tolerance * scales[i] + rounding * std::fabs(y[i]));
  if (motion.scene.friction.kind != WHEEL_REGULARIZED) return;
  const double part = std::fmin(3e-5, std::sqrt(tolerance));
  const double layer = part * motion.scene.friction.omega_s + tolerance * std::fabs(y[spin]);
  weights[spin] = 1 / (std::fmin(tolerance * scales[spin], layer) + rounding * std::fabs(y[spin]));
}

double spin_watched(void* owner, double, const double* y) {
  const Motion& motion = of(owner);
  return motion.scene.friction.sigma * y[motion.formulation->spin_index];
}

double holding_watched(void* owner, double t, const double* y) {
  Motion& motion = of(owner);
  WheelDynamics held;
  motion.formulation->dynamics(&scene_at(motion, t), y, &held);
  return holding_margin(motion.scene, held, motion.weight);
}

double height_watched(void* owner, double, const double* y) { return height(of(owner), y); }

double contact_watched(void* owner, double t, const double* y) {
  Motion& motion = of(owner);
  double y_dot[WHEEL_MAX_STATES];
  return contact(motion, motion.formulation->derivative(&scene_at(motion, t), y, y_dot));
}

int bends(void* owner, double t_lo, double t_hi, double* instants) {
  static_assert(Inputs::most_extremes <= solver::max_bends);
  return of(owner).inputs.extremes(t_lo, t_hi, instants);
}

}  // namespace

void set_scales(Motion& motion, const double* y) {
  const WheelParameters& wheel = motion.scene.wheel;
  WheelKinematics start;
  motion.formulation->kinematics(&wheel, y, &start);
  const double own_time = time_scale(wheel, start);
  motion.longest_step = 0.5 * own_time;
  motion.weight = force_scale(wheel, own_time);
  motion.scales = error_scales(wheel, *motion.formulation, y);
}

void change_contact(Motion& motion) { motion.scene.ground = pulls(motion) ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS; }

solver::Problem problem_of(Motion& motion) {
  constexpr double near = 0.1;  // of the weight, or rad from lying flat
  solver::Problem problem = {};
  problem.states = motion.formulation->states;
  problem.owner = &motion;
  problem.derivative = derivative;
  problem.weights = weights;
  problem.bends = bends;
  problem.near = near;
  problem.longest_step = motion.longest_step;
  const auto watch = [&](Event event, double (*value)(void*, double, const double*), bool by_margin) {
    problem.watch({static_cast<int>(event), value, by_margin});
  };
  const WheelFrictionKind law = motion.scene.friction.kind;
  if (law == WHEEL_ROLLING) watch(Event::spin_changes, spin_watched, false);
  if (law == WHEEL_HELD) watch(Event::spin_changes, holding_watched, false);
  watch(motion.keep_contact ? Event::contact_changes : Event::lifted_off, contact_watched, true);
  watch(Event::fell_flat, height_watched, true);
  return problem;
}

}  // namespace wheel
