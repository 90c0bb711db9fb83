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

// Positive inside the model: the angle of the wheel from lying flat, rad, and, unless contact is kept, N over the
// weight. A force that is negative only by rounding does not count.
double margin(const Motion& motion, const double* y, double N) {
  constexpr double rounding = 1e-9;
  const double height = angle_from_flat(y[motion.formulation->tilt_index]) - flat_angle;
  const double contact = N / motion.weight + rounding;
  return motion.keep_contact || height < contact ? height : contact;
}

double derivative(void* owner, double t, const double* y, double* y_dot) {
  Motion& motion = of(owner);
  const double N = motion.formulation->derivative(&scene_at(motion, t), y, y_dot);
  double sum = 0;
  for (int i = 0; i < motion.formulation->states; ++i) sum += y_dot[i];
  return std::isfinite(sum) ? margin(motion, y, N) : std::numeric_limits<double>::quiet_NaN();
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

// Positive while the friction mode lasts: omega_z times the mode's sign; for a held wheel the part of s N + M_brake
// that holding it leaves unused.
double event(void* owner, double t, const double* y) {
  Motion& motion = of(owner);
  const WheelFriction& friction = motion.scene.friction;
  if (friction.kind == WHEEL_ROLLING) return friction.sigma * y[motion.formulation->spin_index];
  WheelDynamics held;
  motion.formulation->dynamics(&scene_at(motion, t), y, &held);
  return holding_margin(motion.scene, held, motion.weight);
}

double boundary(void* owner, double t, const double* y) {
  Motion& motion = of(owner);
  if (motion.keep_contact) return margin(motion, y, 0);
  return margin(motion, y, normal_force(owner, t, y) * motion.weight);
}

int bends(void* owner, double t_lo, double t_hi, double* instants) {
  static_assert(Inputs::most_extremes <= solver::max_bends);
  return of(owner).inputs.extremes(t_lo, t_hi, instants);
}

}  // namespace

solver::Problem problem_of(Motion& motion) {
  constexpr double near = 0.1;  // of the weight, or rad from lying flat
  solver::Problem problem = {};
  problem.states = motion.formulation->states;
  problem.owner = &motion;
  problem.derivative = derivative;
  problem.weights = weights;
  problem.event = event;
  problem.boundary = boundary;
  problem.bends = bends;
  problem.near = near;
  problem.longest_step = motion.longest_step;
  return problem;
}

double normal_force(void* owner, double t, const double* y) {
  Motion& motion = of(owner);
  double y_dot[WHEEL_MAX_STATES];
  return motion.formulation->derivative(&scene_at(motion, t), y, y_dot) / motion.weight;
}

}  // namespace wheel
