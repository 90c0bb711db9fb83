// The phases of a run, and how far it has come. Plain numbers: a run is restored by assignment.
#pragma once

#include <algorithm>
#include <cassert>

#include "in_force.hpp"
#include "solver.hpp"

namespace wheel {

// From the first parameter to the end. The phase decides what can be read, what a step does, and which functions of FMI
// may be called (fmi/legality.hpp). The order counts: the three functions below compare.
//
//   created -> initializing <-> faulty, initial     a parameter is set; the parameters are checked
//   initial -> at_start -> stepping or unfolded     co-simulation; a step with new inputs ends an unfolded motion
//   initial -> event_mode <-> continuous_time       model exchange
//   any of these -> ended, closed, broken           and without_start, where initialization fails
//
// A reset leads back to `created`, and a restored state to the phase in which it was saved.
enum class Phase : int {
  created,          // parameters are being set
  initializing,     // initialization has begun; no initial state belongs to the present parameters yet
  faulty,           // the same, and the faults of the present parameters have been logged
  initial,          // the initial state belongs to the present parameters
  at_start,         // initialization has ended, and no step has been made
  stepping,         // the solver steps through the motion
  unfolded,         // the motion is read from the orbit; nothing is integrated
  event_mode,       // model exchange: the mode of rolling is decided
  continuous_time,  // model exchange: the caller's solver moves the states
  ended,            // the model has ended, by an event
  closed,           // the caller has ended the run
  broken,           // a step has failed, and the state is that before it; or a restored history was no solution
  without_start,    // initialization has failed: there is no state
};
inline constexpr int phase_count = static_cast<int>(Phase::without_start) + 1;

constexpr bool has_left_initialization(Phase p) { return p >= Phase::at_start; }
constexpr bool is_running(Phase p) { return p >= Phase::at_start && p <= Phase::continuous_time; }
constexpr bool has_state(Phase p) { return p >= Phase::initial && p != Phase::without_start; }

// How the demand differs from what is in force. For example, the caller sets F_X = 1 N with the derivative 10 N/s
// (`set`: a reading shows it at once), and steps by 0.1 s (`nothing` within the step). At its end the demand has F_X
// = 2 N without a derivative (`ended_derivatives`), while a reading still has that of the step. Whatever is set then,
// be it the mu_max that it has, is what follows, and the derivative of F_X has ended for a reading too (`set`).
enum class Pending : unsigned char { nothing, ended_derivatives, set };

class Run {
 public:
  Phase phase = Phase::created;
  Event ended_by = Event::none;
  Pending pending = Pending::nothing;
  bool can_slide = false;  // mu_slide was above 0 at the start: whatever it is later, the wheel can slide
  InForce in_force;
  double t = 0;            // s, clock of the run: the instant reached
  double last_change = 0;  // s, clock of the run: when an input or a tunable parameter last changed
  double grip_due = 0;     // s, clock of the run: from when on mu_required is looked at; infinite after its warning
  bool logged[event_count] = {};  // of each event that is observed: it has occurred, and was logged
  long long transitions = 0;      // see transitions.hpp
  solver::Counters counted = {};  // all but those of the solver at work

  // The state at t. A communication step along a motion that is known already moves t alone, and the state lags behind.
  // Every longer way begins with update_state (wheel.hpp), which brings it to t: a step that asks more of the solution,
  // an event, an end, a snapshot.
  double* y() {
    assert(!lags());
    return y_;
  }
  const double* y() const {
    assert(!lags());
    return y_;
  }
  bool lags() const { return y_time_ != t; }
  const double* latest_y() const { return y_; }  // even if it lags
  // (y at t)
  void set_y(const double* y) {
    std::copy_n(y, max_states, y_);
    y_time_ = t;
  }

  // Model exchange: the caller's states, from which y follows. They stay until they are set, whatever the time is.
  const double* x() const { return x_; }
  void set_x(const double* x) {
    std::copy_n(x, WHEEL_EULER_STATES, x_);
    wheel_reduced_state(x_, y_);
    y_time_ = t;
  }
  // rad/s, omega_z in x and y
  void set_spin(double spin) { x_[WHEEL_EULER_OMEGA_Z] = y_[WHEEL_OMEGA_3] = spin; }
  void set_time_alone(double time) { t = y_time_ = time; }

 private:
  double y_time_ = 0;  // s, clock of the run
  double y_[max_states] = {};
  double x_[WHEEL_EULER_STATES] = {};
};

// All counts of a run.
inline solver::Counters counters_of(const Run& run, const solver::Solver& solver) {
  const solver::Counters& a = run.counted;
  const solver::Counters b = run.phase == Phase::stepping ? solver.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

}  // namespace wheel
