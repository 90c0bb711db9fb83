// One wheel: what the caller has set, what follows from it, what is in force and how far it has come, and the solution
// as far as it is known; and its run from the parameters to the end. Each function that changes a wheel names in its
// header what it writes. The run has a clock, zero at the start, so that a start time of 1e9 s costs no digits.
//
// The other files of this folder, each below those that it needs:
//   reporter, variables, inputs   messages; the table of the variables; inputs as polynomials of time
//   setup, run                    what follows from the parameters; what is in force, and how far the run has come
//   law, events                   how friction and contact are decided; the table of what can happen
//   logbook, posed_problem        messages and counts of events; what the solver asks
//   motion, exchange              one communication step; model exchange
//   slopes, snapshot              derivatives of the variables; the state as bytes
#pragma once

#include <optional>

#include "orbit.hpp"
#include "run.hpp"

namespace wheel {

struct Wheel;

// What can be read at one instant. Positions and velocities, and accelerations and reactions, are computed when they
// are first asked for and kept; nothing is computed for an output that nobody reads. Fixed axes unless said.
// The scene is that which holds for what follows the instant.
struct Reading {
  Reading() = default;
  // The instant reached, with what was set since the last step. Writes run.y of the wheel.
  explicit Reading(Wheel& wheel);

  const Setup* setup;
  WheelScene scene;
  double y[max_states];
  double x[WHEEL_EULER_STATES];  // model exchange: the states, from which y follows
  solver::Counters counters;
  long long transitions;

  // psi, phi, X_O and Y_O as the state counts them.
  const WheelKinematics& kinematics() {
    if (kinematics_) return *kinematics_;
    WheelKinematics& k = kinematics_.emplace();
    setup->exchanged ? wheel_euler_kinematics(&scene.wheel, x, &k)
                     : formulation_of(*setup, scene).kinematics(&scene.wheel, y, &k);
    return k;
  }
  const WheelDynamics& dynamics() {
    if (!dynamics_) dynamics_ = dynamics_of(*setup, scene, y);
    return *dynamics_;
  }
  // X_C and Y_C as the state counts X_O and Y_O.
  WheelContact contact() { return wheel_contact(&scene.wheel, &kinematics()); }

  std::optional<WheelKinematics> kinematics_ = {};
  std::optional<WheelDynamics> dynamics_ = {};
};

// What shapes the motion on an orbit: the parameters without heading, roll angle and place of the start, which are zero
// here, and the tolerance.
struct Shape {
  double parameters[first_input] = {}, tolerance = 0;
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
  Shape orbit_shape;              // for which `orbit` was built; it is entered where it is the present run's
  const char* failure = nullptr;  // why the last step failed; null: see the solver
  long long endings = 0;          // logged, of all runs since the last reset, those that a state led back from included
  std::optional<Reading> reading;  // of the instant reached; dropped by each call that may change the wheel

  double time() const { return demand.start_time + run.t; }  // the caller's
  bool has_ended() const { return run.ended_by != Event::none; }
};

// (variable) => whether it is a rate of a carrier, and one that does not turn
inline bool is_guide_rate(unsigned variable) { return variable >= variable::psi_dot_guide && variable < stored_count; }
inline bool is_idle(const Wheel& wheel, unsigned variable) {
  return is_guide_rate(variable) && is_running(wheel.run.phase) && !wheel.setup.steered();
}

// Whether what is in force acts on from the instant reached: nothing was set since the last step. An input that varied
// in it stays where it arrived, but the carrier still turns as in the step.
inline bool acts_on(const Wheel& wheel) {
  return wheel.demand.news == News::none || (wheel.demand.news == News::stays && wheel.setup.steered());
}

// (run.t) => state there, in run.y
const double* state_now(Wheel& wheel);

// The initial state from the present parameters, true if it exists. Else one message per fault. Writes setup, run,
// demand.slides and demand.news.
bool prepare(Wheel& wheel, const Reporter& reporter);

// (y: a copy of run.y, whose slip it writes) => in force at the instant reached, with what was set since the last step
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

}  // namespace wheel
