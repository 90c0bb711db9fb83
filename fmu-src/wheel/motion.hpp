// A run in motion: the initial-value problem y' = f(t, y) that it poses, with its error weights and the functions whose
// fall below zero is an event; what solves it; and one communication step of co-simulation. Reduced or multibody state,
// see wheel_equations.h. Times in s on the own clock.
#pragma once

#include "events.hpp"
#include "orbit.hpp"

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

// What shapes the motion on an orbit: the parameters without heading, roll angle and place of the start, which are zero
// here, and the tolerance.
struct Shape {
  double parameters[first_input] = {}, tolerance = 0;  // 0: no orbit
  bool operator==(const Shape&) const = default;
};

// The solution as far as it is known: steps of the solver, or the orbit of a wheel that is unfolded.
struct Solution {
  static constexpr double none = -1;

  Owner owner = {};  // of the solver's problem
  solver::Solver solver;
  orbit::Orbit orbit;
  Shape orbit_shape;              // of `orbit`
  double orbit_until = none;      // s: how far `orbit` is the present run's and can be read
  const char* failure = nullptr;  // why the last call failed; null: the solver knows
};

// The state at the instant reached.
const double* state_now(Run& run, const Solution& solution);
// The counts of the run: those of the solver at work and those before it was last started from nothing.
solver::Counters counters_of(const Run& run, const Solution& solution);

// To t. `stepped`: it was reached; `event`: the run ended at run.t; `failed`: the state is that before the call.
solver::Outcome advance(const Setup& setup, Demand& demand, Run& run, Solution& solution, const Reporter& reporter,
                        double t);
// To a phase without further steps: the solution is not needed any more.
void freeze(Run& run, const Solution& solution, Phase phase);
// The run ends at the instant reached, by an event.
void end_run(const Setup& setup, Event event, Run& run, const Solution& solution, const Reporter& reporter);

}  // namespace wheel
