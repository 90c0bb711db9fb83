// One wheel: what the caller has set, what follows from it, what is in force and how far it has come, and the solution
// as far as it is known; and its run from the parameters to the end. Each function that changes a wheel names in its
// header what it writes. The run has its own clock, zero at the start, so that a start time of 1e9 s costs no digits.
#pragma once

#include <cstddef>
#include <optional>

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

struct Wheel {
  Wheel(const Reporter& to, Kind kind) : reporter(to), demand(kind) {}

  const Reporter& reporter;
  Demand demand;
  Setup setup = {};  // of the demand, from the first state on
  Run run;
  // The solution: steps of the solver, or the orbit of a wheel that is unfolded.
  solver::Solver solver;
  orbit::Orbit orbit;
  Shape orbit_shape;              // of `orbit`; it is entered where it is the present run's
  const char* failure = nullptr;  // why the last step failed; null: see the solver
  long long endings = 0;          // logged, of all runs since the last reset, those that a state led back from included
  std::optional<Reading> reading;  // of the instant reached; dropped by each call that may change the wheel

  double time() const { return demand.start_time + run.t; }  // the caller's
  bool has_ended() const { return run.ended_by != Event::none; }
};

// Whether a variable is a rate of a carrier that does not turn.
inline bool rests(const Wheel& wheel, unsigned variable) {
  const bool guides = variable >= variable::psi_dot_guide && variable < stored_count;
  return guides && is_running(wheel.run.phase) && !wheel.setup.turns();
}

// wheel.cpp: from the parameters to the end.

// The state at the instant reached; writes run.y.
const double* state_now(Wheel& wheel);

// The initial state from the present parameters, true if it exists. Else one message per fault. Writes setup and run,
// demand.news and orbit.
bool prepare(Wheel& wheel, const Reporter& reporter);

// What acts at the instant reached, with what was set since the last step; y: a copy of run.y, whose slip it writes.
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
// The run ends at the instant reached, by an event.
void end_run(Wheel& wheel, Event event);
// The caller ends the run.
void close(Wheel& wheel);

// Parameters and inputs as they were set; calculated variables at the instant reached, where what was set takes effect
// at once.
double value_of(Wheel& wheel, unsigned variable);

// motion.cpp: co-simulation.

// To t, s, own clock. `stepped`: it was reached; `event`: the run ended at run.t; `failed`: the state is that before
// the call.
[[nodiscard]] solver::Outcome advance(Wheel& wheel, double t);

// problem.cpp: the initial-value problem y' = f(t, y) that a run poses to the solver, with its error weights and the
// functions whose fall below zero is an event. Reduced or multibody state, see wheel_equations.h.

// Of setup and what is in force; the functions that are watched go with what is in force. The wheel stays where it is
// as long as the problem is in use.
solver::Problem problem_of(Wheel& wheel);
// What follows from an event for the motion alone: what is in force is changed, nothing is counted or logged.
solver::Consequence pass_on_orbit(void* wheel, int event, double t, double* y);
// What solves the motion that is not unfolded: collocation where the direction of a slip or omega_z settles at once.
solver::Method method_of(const Setup& setup, const InForce& in_force);

// logbook.cpp: what a run counts and logs: events that are observed, changes of the friction and of the contact, its
// end.

// The run stands at an event that does not end it: what follows is in force, counted and logged. Writes run.in_force,
// run.y and the counts.
solver::Consequence pass_event(Wheel& wheel, Event event);
// An observed event at t, s, own clock: the first of a run is logged.
void observe(Wheel& wheel, Event event, double t);
// Counts and logs what has changed since `before`, by an event or by what was set: between held, positive and negative
// spin, and between rolling and sliding. A wheel that still slides where its slip ends has started to slide anew.
void log_changes(Wheel& wheel, const InForce& before, Event by = Event::none);
// Once per run, where a loaded wheel on a road without a limit is found to need a friction coefficient above 1, at t at
// the latest, s, own clock. Looks a few times in the wheel's own time, so that it costs nothing noticeable. Writes
// run.grip_due.
void look_at_grip(Wheel& wheel, double t);
// Where a road that was set, with the scene and y of a reading, makes the wheel jam: the reading has no force that
// satisfies the equations, and the next step ends the run.
void warn_of_jam(const Wheel& wheel, const WheelScene& ahead, const double* y);
// Of an ending; of very many, as of a search that goes back and tries again, the first ones alone. Writes endings.
void log_ending(Wheel& wheel, Event event);
// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const InForce& now, Event event);

// exchange.cpp: model exchange. The caller's own solver moves the states, those of wheel_euler; an input acts from the
// instant at which it is set; the law of friction is decided anew at events only.

inline constexpr int state_count = WHEEL_REDUCED_STATES;
// One for each event of the table that can occur in model exchange.
int indicator_count();
// The place of a variable among the states, or -1.
int state_index_of(unsigned variable);

// What was set is in force at once, except for the law, which the event mode decides. Outside of it another road asks
// for another law at once. Writes run.in_force, run.transitions and demand.news.
void apply_at_once(Wheel& wheel);

// Out: state_count numbers, or indicator_count() margins. A solver may try states beyond flat: there rates and margins
// are those of the flat wheel, which are finite. Rates, margins and events write run.counted.
void states(Wheel& wheel, double* x);
void nominals(Wheel& wheel, double* x);
void derivatives(Wheel& wheel, double* x_dot);
void indicators(Wheel& wheel, double* z);
bool has_event(Wheel& wheel);

// Event mode: the law that holds from here on. True where the motion bends here, a state or the law: some solvers go on
// from a step that they took under the old law, unless the states are called new. Where the model ends here, the run
// does. Writes run.
bool decide(Wheel& wheel);

// Whether a run can begin: model exchange has no way to report an end at the start. Else a message.
bool starts_inside(const Wheel& wheel);

// slopes.cpp: derivatives of calculated variables, by time along the motion, or by one known, which is an input or a
// state at the present instant, or, before the run, a parameter.

// d/dt at the present instant, while the law and the sign of N last, under inputs that follow their polynomials.
void read_rates(Wheel& wheel, const unsigned* outputs, std::size_t count, double* out);

// Adds seed times the derivative by `known` to sums[k] of each of the unknowns, `count` of them. All unknowns are read
// in one pass. What depends on inputs only through time has the derivative zero. False where no initial states lie near
// a parameter. Before the run it writes setup and run, and leaves the initial state of the present parameters.
bool add_slopes(Wheel& wheel, unsigned known, double seed, const unsigned* unknowns, std::size_t count, double* sums);

// snapshot.cpp: the complete state of a wheel as portable bytes: a header (mark, size, checksum), then numbers of 8
// bytes each, then the solver's own history.

// They write run.y.
std::size_t state_size(Wheel& wheel);
void save_state(Wheel& wheel, unsigned char* bytes);

// Null, or why the bytes are no state of such a wheel, or damaged: by mark, size and checksum.
const char* fault_of(Kind kind, const unsigned char* bytes, std::size_t size);
// Null, or what is wrong with the bytes: everything is then as it was, unless it is the solver's history, without which
// the run has failed. Writes all but the reporter.
const char* load_state(Wheel& wheel, const unsigned char* bytes, std::size_t size);

}  // namespace wheel
