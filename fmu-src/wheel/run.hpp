// What is in force, and how far a run has come. Plain numbers: a run is restored by assignment.
#pragma once

#include "event.hpp"
#include "inputs.hpp"
#include "phase.hpp"
#include "problem.hpp"
#include "wheel_equations.h"

namespace wheel {

// Where omega_z stands in the layer of a stiff regularized law: outside of it, where the law is the exact one; on its
// way through; or kept inside by friction and brake, where alone the motion is stiff.
enum class Layer : int { none, outside, passing, sticking };

// What acts on the wheel.
struct InForce {
  // Its load is that at the origin of the inputs.
  WheelScene scene = {.wheel = {}, .friction = {}, .load = {}, .ground = WHEEL_GROUND_PRESSES};
  Inputs inputs;
  Layer layer = Layer::none;

  bool pulls() const { return scene.ground == WHEEL_GROUND_PULLS; }
  void change_contact() { scene.ground = pulls() ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS; }

  WheelScene scene_at(double t) const {
    WheelScene scene_then = scene;
    if (inputs.varies) scene_then.load = inputs.load_at(t);
    return scene_then;
  }
};

// Pulls of the ground that are told one by one; a rule that no communication grid changes.
inline constexpr long long told_pulls = 100;

struct Run {
  Phase phase = Phase::created;
  Event ended_by = Event::none;
  InForce in_force;
  double t = 0;            // s, own clock: the instant reached
  double last_change = 0;  // s, own clock: when an input or a tunable parameter last changed
  double y[WHEEL_MAX_STATES] = {};
  long long pulls = 0;            // with keep_contact: how often the ground began to pull
  double last_pull = 0;           // s, own clock: when it last did
  long long transitions = 0;      // of the friction
  solver::Counters counted = {};  // before the solver was last started from nothing
};

}  // namespace wheel
