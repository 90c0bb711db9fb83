// One wheel: what the caller has set, what follows from it, what is in force and how far it has come, and the solution
// as far as it is known. Each function that changes a wheel names in its header what it writes.
#pragma once

#include "orbit.hpp"
#include "reading.hpp"

namespace wheel {

// What shapes the motion on an orbit: the parameters without heading and roll angle of the start, which are zero here,
// and the tolerance.
struct Shape {
  double parameters[first_input] = {}, tolerance = 0;  // 0: no orbit
  bool operator==(const Shape&) const = default;
};

// Steps of the solver, or the orbit of a wheel that is unfolded.
struct Solution {
  static constexpr double none = -Demand::never;

  solver::Solver solver;
  orbit::Orbit orbit;
  Shape orbit_shape;              // of `orbit`
  double orbit_until = none;      // s: how far `orbit` is the present run's and can be read
  const char* failure = nullptr;  // why the last call failed; null: the solver knows
};

struct Wheel {
  Wheel(const Reporter& to, Kind kind) : reporter(to), demand(kind) {}

  const Reporter reporter;
  Demand demand;
  Setup setup = {};  // of the demand, from the first state on
  Run run;
  Solution solution;
  double y_ahead[WHEEL_MAX_STATES] = {};  // of a reading: run.y with the slip that follows from what was set
  long long endings = 0;  // logged, of all runs since the last reset, those that a state led back from included
};

// The state at the instant reached; writes run.y.
const double* state_now(Wheel& wheel);

// Whether the wheel stands, and its energy and reactions are finite.
bool is_inside(Reading& now);

// The initial state from the present parameters, true if it exists. Else one message per fault. Writes setup and run,
// demand.changed and solution.orbit_until.
bool prepare(Wheel& wheel, const Reporter& reporter);

// The instant reached, with what was set since the last step. Writes run.y and y_ahead.
Present present(Wheel& wheel);
// What acts there; y: a copy of run.y, whose slip it writes.
InForce in_force_now(const Wheel& wheel, double* y);

}  // namespace wheel
