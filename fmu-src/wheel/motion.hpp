// The wheel in motion as an initial-value problem for the solver: y' = f(t, y), its error weights, and the functions
// whose fall below zero is an event. Reduced or multibody state, see wheel_equations.h.
#pragma once

#include "events.hpp"

namespace wheel {

// What the functions of the problem read besides time and state.
struct Owner {
  const Setup* setup;
  InForce* in_force;
};

// What is watched goes with what is in force. The owner stays where it is as long as the problem is in use.
solver::Problem problem_of(Owner& owner);

// What follows from an event for the motion alone: `in_force` is changed, nothing is counted or logged.
Consequence pass_on_orbit(void* owner, int event, double t, double* y);

}  // namespace wheel
