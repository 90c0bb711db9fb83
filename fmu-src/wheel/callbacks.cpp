// The simulation as the solver's problem: y' = f(t, y) with one event function and one boundary.
#include "callbacks.hpp"

#include <cmath>
#include <limits>

#include "scene.hpp"
#include "simulation.hpp"

namespace wheel {

struct Callbacks {
  static constexpr double upright = 1.5707963267948966, low_tilt = 1.5;  // rad; within 4 degrees of lying flat

  static Simulation& of(void* owner) { return *static_cast<Simulation*>(owner); }

  static bool derivative(void* owner, double t, const double* y, double* y_dot, int wanted) {
    Simulation& sim = of(owner);
    const WheelFormulation& formulation = *sim.formulation_;
    if (sim.inputs_.varies()) sim.inputs_.load_at(t, &sim.scene_);
    const bool all = wanted == formulation.states;
    const double N = (all ? formulation.derivative : formulation.closed_derivative)(&sim.scene_, y, y_dot);
    if (N < sim.lowest_force_) sim.lowest_force_ = N;
    double sum = 0;
    for (int i = 0; i < wanted; ++i) sum += y_dot[i];
    return std::isfinite(sum);
  }

  static void jacobian(void* owner, double t, const double* y, double* J) {
    Simulation& sim = of(owner);
    if (sim.inputs_.varies()) sim.inputs_.load_at(t, &sim.scene_);
    sim.formulation_->jacobian(&sim.scene_, y, J);
  }

  // The states' own rounding is a floor: no step is asked to be more exact than the numbers can say. The regularized
  // law turns errors of omega_z into moments over its width omega_s: the spin must be known to a fraction of that
  // width.
  static void weights(void* owner, const double* y, double* weights) {
    const Simulation& sim = of(owner);
    const double tolerance = local_fraction * sim.tolerance_;
    constexpr double rounding = 32 * std::numeric_limits<double>::epsilon();
    for (int i = 0; i < sim.formulation_->states; ++i)
      weights[i] = 1 / (tolerance * sim.scales_[i] + rounding * std::fabs(y[i]));
    if (sim.scene_.friction.kind == WHEEL_REGULARIZED) {
      const int i = sim.formulation_->spin_index;
      const double share = std::fmin(3e-5, std::sqrt(tolerance));
      const double layer = share * sim.scene_.friction.omega_s + tolerance * std::fabs(y[i]);
      weights[i] = 1 / (std::fmin(tolerance * sim.scales_[i], layer) + rounding * std::fabs(y[i]));
    }
  }

  // Positive while the friction mode lasts: the spin in its sense, or what friction has left to hold it.
  static double event(void* owner, double t, const double* y) {
    Simulation& sim = of(owner);
    if (sim.scene_.friction.kind == WHEEL_ROLLING) return sim.scene_.friction.sigma * y[sim.formulation_->spin_index];
    if (sim.inputs_.varies()) sim.inputs_.load_at(t, &sim.scene_);
    WheelDynamics held;
    sim.formulation_->dynamics(&sim.scene_, y, &held);
    return holding_margin(sim.scene_.wheel, held);
  }

  // The right-hand side has seen a normal force near zero, or the wheel lies low: time to look closely.
  static bool near_boundary(void* owner, const double* y) {
    Simulation& sim = of(owner);
    const bool light = sim.lowest_force_ < 0.1 * sim.weight_;
    sim.lowest_force_ = std::numeric_limits<double>::infinity();
    if (sim.stored_[keep_contact] != 0) watch_contact(sim, light, y);
    return light || std::fabs(y[sim.formulation_->tilt_index] - upright) > low_tilt;
  }

  // With keep_contact a ground that pulls is told, once per excursion.
  static void watch_contact(Simulation& sim, bool light, const double* y) {
    if (!light) {
      sim.lifted_ = false;
      return;
    }
    WheelDynamics now;
    const double t = sim.solver_->known_until();
    if (sim.inputs_.varies()) sim.inputs_.load_at(t, &sim.scene_);
    sim.formulation_->dynamics(&sim.scene_, y, &now);
    const bool pulls = now.lambda[2] < 0;
    if (pulls && !sim.lifted_)
      sim.tell(Topic::warning,
               "The ground pulls at t = %.9f s (N = %.4g N): keep_contact holds a wheel that would have lifted off.",
               sim.start_time_ + t, now.lambda[2]);
    sim.lifted_ = pulls;
  }

  // Positive inside the model: above the ground, and pressed to it unless contact is kept.
  static double boundary(void* owner, double t, const double* y) {
    Simulation& sim = of(owner);
    const double height = std::sin(y[sim.formulation_->tilt_index]) - flat_sine;
    if (sim.stored_[keep_contact] != 0) return height;
    if (sim.inputs_.varies()) sim.inputs_.load_at(t, &sim.scene_);
    WheelDynamics now;
    sim.formulation_->dynamics(&sim.scene_, y, &now);
    constexpr double rounding = 1e-9;  // of the weight: a force that only rounding makes negative is none
    return std::fmin(height, (now.lambda[2] + rounding * sim.weight_) / sim.weight_);
  }
};

integrator::System solver_system(Simulation& simulation) {
  integrator::System system = {};
  system.owner = &simulation;
  system.derivative = Callbacks::derivative;
  system.jacobian = Callbacks::jacobian;
  system.weights = Callbacks::weights;
  system.event = Callbacks::event;
  system.near_boundary = Callbacks::near_boundary;
  system.boundary = Callbacks::boundary;
  return system;
}

}  // namespace wheel
