// What a run decides about itself: its initial state, and law and method from its parameters and inputs at an instant.
#pragma once

#include "simulation.hpp"

namespace wheel {

// Motion, law and state at t = 0 from the parameters and the pending inputs; nothing of an earlier run is left.
void set_initial_state(State& state);

// Inputs and tunable parameters that are pending take effect at state.t, where the wheel has the state y: load, law of
// friction, method, and whether the motion can be unfolded.
void take_changes(State& state, const double* y);

// The scene as it will be when the pending changes have taken effect.
WheelScene pending_scene(const State& state);

// The law of friction that holds as soon as the brake is in use.
WheelFriction braked_friction(const State& state, const WheelScene& scene, const double* y);

}  // namespace wheel
