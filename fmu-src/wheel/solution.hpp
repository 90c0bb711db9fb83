// What solves the motion, and the solution as far as it is known: steps of the solver, or the orbit of a wheel that is
// unfolded.
#pragma once

#include "motion.hpp"
#include "orbit.hpp"
#include "solver.hpp"

namespace wheel {

// What shapes the motion on an orbit: the parameters without heading, roll angle and place of the start, which are zero
// here, and the tolerance.
struct Shape {
  double parameters[first_input] = {}, tolerance = 0;  // 0: no orbit
  bool operator==(const Shape&) const = default;
};

struct Solution {
  static constexpr double none = -1;

  Owner owner = {};  // of the solver's problem
  solver::Solver solver;
  orbit::Orbit orbit;
  Shape orbit_shape;              // of `orbit`
  double orbit_until = none;      // s, own clock: how far `orbit` is the present run's and can be read
  const char* failure = nullptr;  // why the last call failed; null: the solver knows
};

// The state at the instant reached.
const double* state_now(Run& run, const Solution& solution);
// The counts of the run: those of the solver at work and those before it was last started from nothing.
solver::Counters counters_of(const Run& run, const Solution& solution);
// To a phase without further steps: the solution is not needed any more.
void freeze(Run& run, const Solution& solution, Phase phase);

// on_orbit.cpp: whether the motion is unfolded. Builds the orbit of the run from its start, or keeps that of an earlier
// run of the same shape. False: the solver has to step through the motion.
bool enter_orbit(const Setup& setup, const Demand& demand, Run& run, Solution& solution);
// Counts and logs what is observed on the orbit up to t, s, own clock.
void observe_orbit(const Setup& setup, const orbit::Orbit& orbit, double t, Run& run, const Reporter& reporter);

}  // namespace wheel
