// The phases of a run, what is in force, and how far it has come. Plain numbers: a run is restored by assignment.
#pragma once

#include <algorithm>
#include <cassert>

#include "setup.hpp"
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

constexpr bool has_begun(Phase p) { return p >= Phase::at_start; }
constexpr bool is_running(Phase p) { return p >= Phase::at_start && p <= Phase::continuous_time; }
constexpr bool has_state(Phase p) { return p >= Phase::initial && p != Phase::without_start; }

// What can happen at an instant that is not known beforehand. These are the names of the rows of the table in
// events.cpp. In co-simulation the later one in this list counts of two events at
// the same instant; in model exchange all count.
enum class Event : int {
  none,
  changes_layer,  // omega_z enters or leaves the layer of a regularized law
  spin_changes,   // omega_z reaches zero, or rolling resistance and brake can no longer hold it
  lost_grip,      // the wheel needs a friction coefficient above mu_max
  slip_ends,      // the slip falls to zero
  lost_contact,   // N falls below zero, or rises above it while the ground pulls
  jams,           // no N satisfies the equations of the sliding wheel
  lies_flat,
  count
};
inline constexpr int event_count = static_cast<int>(Event::count);

// The road, which may change during a run.
struct Road {
  double s, mu_max, mu_slide, slope, slope_direction;
  bool operator==(const Road&) const = default;
};

inline Road road_asked(const Demand& demand) {
  const double* v = demand.parameters;
  return {v[variable::s], v[variable::mu_max], v[variable::mu_slide], v[variable::slope], v[variable::slope_direction]};
}

// What acts on the wheel, and the scene that follows from it for the equations: plain numbers.
class InForce {
 public:
  // Written by take_over and set_below, and where a saved state is read.
  Road road = {};  // as it was asked for
  Inputs inputs;
  bool below[event_count] = {};  // of each observed event: its value lies below zero

  InForce() = default;
  // The state before anything is set: a level road, no inputs and no mode.
  explicit InForce(const Setup& setup);
  // Road and inputs are in force from t on. A mu_max that was set below mu_slide counts for both.
  void take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials);
  // The value of an observed event has fallen below zero, or has risen above it.
  void set_below(Event event, bool below_zero);
  // Decided in law.cpp: the mode of rolling, and whether the wheel grips or slides.
  void set_mode(const WheelFriction& mode) { scene_.friction = mode; }
  void set_contact(WheelContactMode contact) { scene_.contact = contact; }

  bool is_below(Event event) const { return below[static_cast<int>(event)]; }
  const WheelFriction& mode() const { return scene_.friction; }
  WheelContactMode contact() const { return scene_.contact; }
  bool slides() const { return scene_.contact == WHEEL_SLIDES; }
  WheelGround ground() const { return scene_.ground; }
  double mu_slide() const { return scene_.mu_slide; }

  WheelScene scene_at(double t) const { return inputs.varies ? loaded_at(t) : scene_; }
  // The same, which is copied into `room` only where an input varies.
  const WheelScene& scene_at(double t, WheelScene& room) const { return inputs.varies ? room = loaded_at(t) : scene_; }

 private:
  WheelScene loaded_at(double t) const {
    WheelScene scene = scene_;
    inputs.set_load_at(t, scene.load);
    return scene;
  }

  WheelScene scene_ = {};  // with the load at the instant from which the inputs count
};

// How the demand differs from what is in force. For example, the caller sets F_X = 1 N with the derivative 10 N/s
// (`set`: a reading shows it at once), and steps by 0.1 s (`nothing` within the step). At its end the demand has F_X
// = 2 N without a derivative (`ended_slopes`), while a reading still has the slope of the step. If the caller sets F_X
// = 2 N once more, the slope has ended (`set`).
enum class Pending : unsigned char { nothing, ended_slopes, set };

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
  double x[WHEEL_EULER_STATES] = {};  // model exchange: the caller's states, from which y follows
  bool logged[event_count] = {};      // of each event that is observed: it has occurred, and was logged
  long long transitions = 0;          // between held and rolling to either side, and between rolling and sliding
  solver::Counters counted = {};      // all but those of the solver at work

  // Whether a reading shows what was set since the last step.
  bool shows_demand() const { return pending == Pending::set; }

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
  // Model exchange: another instant, at which the caller's states stay until they are set.
  void set_time_alone(double time) { t = y_time_ = time; }

 private:
  double y_time_ = 0;  // s, clock of the run
  double y_[max_states] = {};
};

// All counts of a run.
inline solver::Counters counters_of(const Run& run, const solver::Solver& solver) {
  const solver::Counters& a = run.counted;
  const solver::Counters b = run.phase == Phase::stepping ? solver.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

}  // namespace wheel
