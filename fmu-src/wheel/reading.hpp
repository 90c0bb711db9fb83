// What can be read at one instant: positions, velocities, accelerations, reactions. Each group is computed when first
// asked for and kept until the instant or the inputs change; nothing is computed for an output nobody reads.
#pragma once

#include "wheel_equations.h"

namespace wheel {

class Simulation;

struct Counts {
  long long steps, rhs, jacobians, roots, events, restarts;
};

class Reading {
 public:
  Reading() = default;
  Reading(const WheelFormulation& formulation, const Simulation& simulation)
      : formulation_(&formulation), simulation_(&simulation) {}

  // The instant t (own clock, s) of a running solution.
  void move_to(double t) { t_ = t, have_ = 0; }
  // The inputs changed: what depends on them is stale.
  void forget_dynamics() { have_ &= have_state | have_pose | have_kinematics; }
  // A given state at time t instead of the solver's.
  void set_state(double t, const double* y);

  double time() const { return t_; }
  const double* state();
  const WheelScene& scene();
  const WheelKinematics& pose();  // all of it but X_O_dot and Y_O_dot
  const WheelKinematics& kinematics();
  const WheelDynamics& dynamics();
  const double* reaction_rates();
  int friction_mode();
  Counts counters() const;

  long long events = 0;

 private:
  enum : unsigned {
    have_state = 1,
    have_pose = 2,
    have_kinematics = 4,
    have_dynamics = 8,
    have_rates = 16,
    have_scene = 32,
  };
  bool missing(unsigned part);

  const WheelFormulation* formulation_ = nullptr;
  const Simulation* simulation_ = nullptr;
  double t_ = 0;
  unsigned have_ = 0;
  double y_[WHEEL_MAX_STATES] = {};
  WheelScene scene_ = {};
  WheelKinematics kinematics_ = {};
  WheelDynamics dynamics_ = {};
  double rates_[3] = {};
};

}  // namespace wheel
