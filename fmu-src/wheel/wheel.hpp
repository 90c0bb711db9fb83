// One wheel: what the caller has set, what follows from it, what is in force and how far it has come, and the solution
// as far as it is known; and its run from the parameters to the end. Each function that changes a wheel names in its
// header what it writes. The run has its own clock, zero at the start, so that a start time of 1e9 s costs no digits.
#pragma once

#include "orbit.hpp"
#include "reading.hpp"

namespace wheel {

// What shapes the motion on an orbit: the parameters without heading and roll angle of the start, which are zero here,
// and the tolerance.
struct Shape {
  double parameters[first_input] = {}, tolerance = 0;  // 0: no orbit
  bool slides = false;
  bool operator==(const Shape&) const = default;
};

// Steps of the solver, or the orbit of a wheel that is unfolded.
struct Solution {
  static constexpr double none = -solver::never;

  solver::Solver solver;
  orbit::Orbit orbit;
  Shape orbit_shape;              // of `orbit`
  double orbit_until = none;      // s: how far `orbit` is the present run's and can be read
  const char* failure = nullptr;  // why the last call failed; null: see the solver
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
  Reading reading;        // of the instant reached; forgotten by each call that may change the wheel

  Phase phase() const { return run.phase; }
  Kind kind() const { return demand.kind; }
  double time() const { return demand.start_time + run.t; }  // the caller's
  bool has_ended() const { return run.ended_by != Event::none; }
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

// As new: start values, nothing computed.
void reset(Wheel& wheel);
// stop_time: infinite for none. tolerance <= 0: the default one.
void set_experiment(Wheel& wheel, double start_time, double stop_time, double tolerance);
// Parameters and inputs, with their derivatives, which are checked as a whole by prepare; in a run of model exchange a
// state too, and the law of friction is decided for it.
void set(Wheel& wheel, unsigned variable, double value, int order = 0);
// Before the end of the initialization: the initial state from the present parameters, where it has not been computed,
// true if it exists. Else one message per fault, once.
bool is_prepared(Wheel& wheel);
// The end of initialization: false if there is no initial state.
bool start(Wheel& wheel);
// The caller ends the run.
void close(Wheel& wheel);

// The calculated variables now; inputs just set take effect at once. Valid until the wheel changes.
Reading& reading_of(Wheel& wheel);
double value_of(Wheel& wheel, unsigned variable);

}  // namespace wheel
