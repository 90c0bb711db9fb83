// What can be read at one instant: positions, velocities, accelerations, reactions. Each group is
// computed when it is first asked for and kept until the instant or the inputs change; nothing is computed for an
// output that nobody reads. Fixed axes unless said.
#pragma once

#include "run.hpp"
#include "variables.hpp"

namespace wheel {

// The instant to read; the scene is that which holds for what follows it.
struct Present {
  const Setup* setup;
  const double* y;
  WheelScene scene;
  const Run* run = nullptr;  // its counts, with those of the solver
  const solver::Solver* solver = nullptr;
};

class Reading {
 public:
  void set(const Present& now) {
    now_ = now;
    have_ = 0;
    is_set_ = true;
  }
  // The instant or what acts there changes.
  void forget() { is_set_ = false; }
  bool is_set() const { return is_set_; }

  const Setup& setup() const { return *now_.setup; }
  // psi, phi, X_O and Y_O as the state counts them.
  const WheelKinematics& kinematics();
  const WheelDynamics& dynamics();
  // N, the ground's: along e1 (0) or across it (1).
  double horizontal_force(int axis);
  // m/s, of the wheel's material point at the contact: along e1 (0) or across it (1).
  double slip(int axis) const;
  int contact_mode() const { return now_.scene.contact; }
  Force force();
  double brake_moment();          // N m, the brake's part of tau
  double guide_moment(int axis);  // N m, the hub carrier's on the wheel: about e1 (0) or e2 (1)
  const WheelContact& contact();  // X_C and Y_C as the state counts X_O and Y_O
  double energy();                // J, of the whole X_O and Y_O
  int friction_mode();
  solver::Counters counters() const { return counters_of(*now_.run, *now_.solver); }
  long long transitions() const { return now_.run->transitions; }  // of the friction

 private:
  enum : unsigned { have_kinematics = 1, have_dynamics = 2, have_contact = 4 };
  bool missing(unsigned part);
  const WheelFormulation& formulation() const { return formulation_of(*now_.setup, now_.scene); }

  Present now_ = {};
  bool is_set_ = false;
  unsigned have_ = 0;
  WheelKinematics kinematics_ = {};
  WheelDynamics dynamics_ = {};
  WheelContact contact_ = {};
};

}  // namespace wheel
