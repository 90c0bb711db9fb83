// What the solver asks: right-hand side, error weights, watched functions.
#include "motion.hpp"

#include <cmath>
#include <limits>

namespace wheel {

double angle_from_flat(double theta) {
  constexpr double upright = 1.5707963267948966;
  return upright - std::fabs(theta - upright);
}

namespace {

const Owner& of(void* owner) { return *static_cast<const Owner*>(owner); }

// Zero where the wheel lies flat, rad.
double height(const Setup& setup, const double* y) {
  return angle_from_flat(y[setup.formulation->tilt_index]) - flat_angle;
}

// N over the weight, or its negative while the ground pulls.
double contact(const Owner& owner, double N) {
  constexpr double rounding = 1e-9;
  return (owner.in_force.pulls() ? -N : N) / owner.setup.weight + rounding;
}

double derivative(void* owner, double t, const double* y, double* y_dot) {
  const auto& [setup, now] = of(owner);
  const auto rates = [&](const WheelScene& scene) { return setup.formulation->derivative(&scene, y, y_dot); };
  const double N = now.inputs.varies ? rates(now.scene_at(t)) : rates(now.scene);
  double sum = 0;
  for (int i = 0; i < setup.formulation->states; ++i) sum += y_dot[i];
  if (!std::isfinite(sum)) return std::numeric_limits<double>::quiet_NaN();
  const double high = height(setup, y), pressed = contact(of(owner), N);
  return high < pressed ? high : pressed;
}

// The states' own rounding is a floor: no step has to be more exact than the numbers can express. The regularized law
// turns errors of omega_z into moments over its width omega_s: the spin must be known to a fraction of that width.
void weights(void* owner, double share, const double* y, double* weights) {
  const Setup& setup = of(owner).setup;
  const int states = setup.formulation->states, spin = setup.formulation->spin_index;
  constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
  const double slow = share * setup.tolerance;
  const double tolerance = std::fmax(slow * share_at(setup, y[spin]), std::fmin(slow, rounding));
  double scales[WHEEL_MAX_STATES];
  scales_at(setup, y[spin], scales);
  for (int i = 0; i < states; ++i) weights[i] = 1 / (tolerance * scales[i] + rounding * std::fabs(y[i]));
  if (of(owner).in_force.scene.friction.kind != WHEEL_REGULARIZED) return;
  const double part = 10 * std::sqrt(tolerance);
  const double layer = part * setup.omega_s + tolerance * std::fabs(y[spin]);
  weights[spin] = 1 / (std::fmin(tolerance * scales[spin], layer) + rounding * std::fabs(y[spin]));
}

double spin_watched(void* owner, double, const double* y) {
  const auto& [setup, in_force] = of(owner);
  return in_force.scene.friction.sigma * y[setup.formulation->spin_index];
}

double holding_watched(void* owner, double t, const double* y) {
  const auto& [setup, in_force] = of(owner);
  return holding_margin(setup, in_force.scene_at(t), y);
}

double outside_watched(void* owner, double t, const double* y) {
  return spin_watched(owner, t, y) - layer_edge(of(owner).setup);
}

double inside_watched(void* owner, double, const double* y) {
  const Setup& setup = of(owner).setup;
  return layer_edge(setup) - std::fabs(y[setup.formulation->spin_index]);
}

double passing_watched(void* owner, double t, const double* y) { return -holding_watched(owner, t, y); }

double stiffness_watched(void* owner, double t, const double* y) {
  const auto& [setup, in_force] = of(owner);
  return layer_margin(setup, in_force.scene_at(t), y);
}

double height_watched(void* owner, double, const double* y) { return height(of(owner).setup, y); }

double contact_watched(void* owner, double t, const double* y) { return contact_margin(of(owner), t, y); }

int extremes(void* owner, double t_lo, double t_hi, double* instants) {
  static_assert(most_extremes <= solver::max_extremes);
  return of(owner).in_force.inputs.extremes(t_lo, t_hi, instants);
}

}  // namespace

double contact_margin(const Owner& owner, double t, const double* y) {
  double y_dot[WHEEL_MAX_STATES];
  const WheelScene scene = owner.in_force.scene_at(t);
  return contact(owner, owner.setup.formulation->derivative(&scene, y, y_dot));
}

solver::Problem problem_of(Owner& owner) {
  constexpr double near = 0.1;  // of the weight, or rad from lying flat
  solver::Problem problem = {};
  problem.states = owner.setup.formulation->states;
  problem.owner = &owner;
  problem.derivative = derivative;
  problem.weights = weights;
  problem.extremes = extremes;
  problem.near = near;
  problem.longest_step = owner.setup.longest_step;
  const auto watch = [&](Event event, double (*value)(void*, double, const double*), bool by_margin) {
    problem.watch({static_cast<int>(event), value, by_margin});
  };
  const WheelFrictionKind law = owner.in_force.scene.friction.kind;
  const Layer layer = owner.in_force.layer;
  problem.passage = layer == Layer::passing;
  const bool stiffens = owner.in_force.inputs.varies && may_need_layer(owner.setup, owner.in_force);
  if (stiffens) watch(Event::layer_changes, stiffness_watched, false);
  if (layer == Layer::outside) watch(Event::layer_changes, outside_watched, false);
  if (layer == Layer::passing) watch(Event::layer_changes, passing_watched, false);
  if (layer > Layer::outside) watch(Event::layer_changes, inside_watched, false);
  if (law == WHEEL_ROLLING && layer == Layer::none) watch(Event::spin_changes, spin_watched, false);
  if (law == WHEEL_HELD) watch(Event::spin_changes, holding_watched, false);
  watch(owner.setup.keep_contact ? Event::contact_changes : Event::lifted_off, contact_watched, true);
  watch(Event::fell_flat, height_watched, true);
  return problem;
}

}  // namespace wheel
