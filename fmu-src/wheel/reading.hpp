// What can be read at one instant: positions, velocities, accelerations, reactions and their rates. Each group is
// computed when it is first asked for and kept until the instant or the inputs change; nothing is computed for an
// output that nobody reads. Fixed axes unless said.
#pragma once

#include "run.hpp"

namespace wheel {

struct Solution;

// The instant to read; scene and inputs are those that hold for what follows it.
struct Present {
  const WheelFormulation* formulation;
  const double* y;
  WheelScene scene;
  const Polynomials* inputs;
  const Run* run = nullptr;  // its counts, with those of its solution
  const Solution* solution = nullptr;
};

// Rates along the motion: of the ground's force in fixed axes and of the moment about the axle, N/s and N m/s, and of
// the force along e1 and across it.
struct ReactionRates : WheelReactionRates {
  double lambda_x_dot, lambda_y_dot;
};

class Reading {
 public:
  // `version`: counts the changes of instant and inputs.
  void set(const Present& now, long long version = none) {
    now_ = now;
    have_ = 0;
    version_ = version;
  }
  bool is_of(long long version) const { return version_ == version; }

  const WheelScene& scene() const { return now_.scene; }
  const WheelKinematics& pose();  // all of the kinematics but X_O_dot and Y_O_dot
  const WheelKinematics& kinematics();
  const WheelDynamics& dynamics();
  // N, the ground's: along e1 (0) or across it (1).
  double horizontal_force(int axis);
  const ReactionRates& reaction_rates();
  // How the reactions answer a change of the load alone, per unit of it.
  ReactionRates response(const WheelLoad& load_dot);
  const WheelContact& contact();
  int friction_mode();
  solver::Counters counters() const;
  long long transitions() const { return now_.run->transitions; }  // of the friction

 private:
  enum : unsigned { have_pose = 1, have_kinematics = 2, have_dynamics = 4, have_rates = 8, have_contact = 16 };
  bool missing(unsigned part);

  static constexpr long long none = -1;
  Present now_ = {};
  long long version_ = none;
  unsigned have_ = 0;
  WheelKinematics kinematics_ = {};
  WheelDynamics dynamics_ = {};
  ReactionRates rates_ = {};
  WheelContact contact_ = {};
};

}  // namespace wheel
