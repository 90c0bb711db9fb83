// What can be read at one instant. Positions and velocities, and accelerations and reactions, are computed when they
// are first asked for and kept; nothing is computed for an output that nobody reads. Fixed axes unless said.
#pragma once

#include <optional>

#include "run.hpp"

namespace wheel {

struct Wheel;

// The scene is that which holds for what follows the instant.
struct Reading {
  Reading() = default;
  // The instant reached, with what was set since the last step. Writes run.y of the wheel.
  explicit Reading(Wheel& wheel);

  const Setup* setup;
  WheelScene scene;
  double y[WHEEL_MAX_STATES];
  solver::Counters counters;
  long long transitions;

  // psi, phi, X_O and Y_O as the state counts them.
  const WheelKinematics& kinematics() {
    if (!kinematics_) formulation_of(*setup, scene).kinematics(&scene.wheel, y, &kinematics_.emplace());
    return *kinematics_;
  }
  const WheelDynamics& dynamics() {
    if (!dynamics_) dynamics_ = dynamics_of(*setup, scene, y);
    return *dynamics_;
  }
  // X_C and Y_C as the state counts X_O and Y_O.
  const WheelContact& contact() {
    if (!contact_) contact_ = wheel_contact(&scene.wheel, &kinematics());
    return *contact_;
  }

  std::optional<WheelKinematics> kinematics_ = {};
  std::optional<WheelDynamics> dynamics_ = {};
  std::optional<WheelContact> contact_ = {};
};

}  // namespace wheel
