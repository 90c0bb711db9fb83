// The phases of a run, what is in force with the law of friction, and how far it has come. Plain numbers: a run is
// restored by assignment.
#pragma once

#include "setup.hpp"
#include "solver.hpp"

namespace wheel {

// From the first parameter to the end: from the phase follows what can be read, what a step does, and which functions
// of FMI may be called (fmi/legality.hpp). Their order counts: the three functions below compare.
enum class Phase : int {
  created,          // parameters are being set
  initializing,     // initialization has begun; no initial state belongs to the present parameters yet
  faulty,           // the same, and the faults of the present parameters have been logged
  initial,          // the initial state belongs to the present parameters
  at_start,         // initialization has ended, and no step has been made
  stepping,         // the solver steps through the motion
  unfolded,         // the motion is read from the orbit; nothing is integrated
  event_mode,       // model exchange: the law of friction is decided
  continuous_time,  // model exchange: the caller's solver moves the states
  ended,            // the model has ended, by an event
  closed,           // the caller has ended the run
  broken,           // a step has failed; the state is that before it
  without_start,    // initialization has failed: there is no state
};
inline constexpr int phase_count = static_cast<int>(Phase::without_start) + 1;

constexpr bool has_begun(Phase p) { return p >= Phase::at_start; }
constexpr bool is_running(Phase p) { return p >= Phase::at_start && p <= Phase::continuous_time; }
constexpr bool has_state(Phase p) { return p >= Phase::initial && p != Phase::without_start; }

// What can happen at an instant that is not known beforehand: the names of the rows of the table in events.cpp. Of two
// at the same instant the later one counts.
enum class Event : int {
  none,
  changes_layer,  // omega_z enters or leaves the layer of a regularized law
  spin_changes,   // omega_z reaches zero, or friction and brake can no longer hold it there
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

// What acts on the wheel: road, inputs and observed events, the contact and the law of friction, and the scene that
// follows for the equations. Without a law until one is decided.
class InForce {
 public:
  Road road = {};  // as it was asked for
  Inputs inputs;
  bool below[event_count] = {};  // for each observed event: its value has fallen below zero and has not risen since

  InForce() = default;
  // Before anything is set: on a level road without inputs.
  explicit InForce(const Setup& setup) : scene_(setup.scene) {}
  // Road and inputs, in force from t on, and the scene that follows from them, from `below` and from the setup. A
  // mu_max set below mu_slide counts for both.
  void take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials);
  void cross(Event event) {
    below[static_cast<int>(event)] = !is_below(event);
    set_ground();
  }
  void set_law(const WheelFriction& law) { scene_.friction = law; }
  void set_contact(WheelContactMode contact) { scene_.contact = contact; }

  bool is_below(Event event) const { return below[static_cast<int>(event)]; }
  const WheelFriction& law() const { return scene_.friction; }
  WheelContactMode contact() const { return scene_.contact; }
  bool slides() const { return contact() == WHEEL_SLIDES; }
  double mu_slide() const { return scene_.mu_slide; }

  // Until it is asked for at another instant: most inputs are constant, and a copy costs as much as an evaluation.
  const WheelScene& scene_at(double t) const {
    if (inputs.varies) inputs.set_load_at(t, scene_.load);
    return scene_;
  }

 private:
  void set_ground() { scene_.ground = is_below(Event::lost_contact) ? WHEEL_GROUND_PULLS : WHEEL_GROUND_PRESSES; }

  mutable WheelScene scene_ = {};  // its load: that at the instant asked for last
};

// What the caller has set since the last step. It is in force from the next step on; a reading shows it at once.
enum class News : unsigned char {
  none,   // nothing
  stays,  // nothing; the demand holds each input where it arrived in the step, in which one varied
  set,    // something
};

struct Run {
  Phase phase = Phase::created;
  Event ended_by = Event::none;
  News news = News::none;
  InForce in_force;
  double t = 0;            // s, clock of the run: the instant reached
  double y_time = 0;       // s, clock of the run: the instant of y
  double last_change = 0;  // s, clock of the run: when an input or a tunable parameter last changed
  double grip_due = 0;     // s, clock of the run: from when on mu_required is looked at; infinite after its warning
  double y[max_states] = {};
  double x[WHEEL_EULER_STATES] = {};  // model exchange: the caller's states, from which y follows
  bool observed[event_count] = {};    // has occurred, and was logged
  long long transitions = 0;          // of the friction, rolling and sliding
  solver::Counters counted = {};      // before the solver was last started from nothing
};

// The counts of a run, those of the solver at work included.
inline solver::Counters counters_of(const Run& run, const solver::Solver& solver) {
  const solver::Counters& a = run.counted;
  const solver::Counters b = run.phase == Phase::stepping ? solver.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

}  // namespace wheel
