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

// What acts on the wheel, and the scene that follows from it for the equations. Plain numbers, each with one writer.
struct InForce {
  // By take_over: the road as it was asked for, and the inputs.
  Road road = {};
  Inputs inputs;
  // By cross, for each event that is observed: its value has fallen below zero and has not risen since.
  bool below[event_count] = {};
  // Contact and law by law.cpp, which decides them; until then there is no law. The rest follows from the above, with
  // the load at the instant from which the inputs count.
  WheelScene scene = {};

  InForce() = default;
  // Before anything is set: on a level road without inputs.
  explicit InForce(const Setup& setup) : scene(setup.scene) {}
  // Road and inputs, in force from t on, and the scene that follows. A mu_max set below mu_slide counts for both.
  void take_over(const Setup& setup, const Road& asked, double t, const Polynomials& polynomials);
  // The value of an observed event changes its sign.
  void cross(Event event);

  bool is_below(Event event) const { return below[static_cast<int>(event)]; }
  const WheelFriction& law() const { return scene.friction; }
  bool slides() const { return scene.contact == WHEEL_SLIDES; }

  WheelScene scene_at(double t) const {
    WheelScene at_t = scene;
    if (inputs.varies) inputs.set_load_at(t, at_t.load);
    return at_t;
  }
};

// How the demand differs from what is in force. A reading shows at once what was set, and the next step begins with it.
enum class Pending : unsigned char {
  nothing,
  held_inputs,  // by the end of a step alone: the inputs varied in it, and the demand holds them where they arrived
  set,          // by the caller
};

struct Run {
  Phase phase = Phase::created;
  Event ended_by = Event::none;
  Pending pending = Pending::nothing;
  bool can_slide = false;  // mu_slide was above 0 at the start: whatever it is later, the wheel can slide
  InForce in_force;
  double t = 0;  // s, clock of the run: the instant reached
  // The state at y_time, s, clock of the run. It lags behind t while steps go on that nobody reads: update_state brings
  // it to t. Each step begins with that, so whatever has to do with an event or a start finds it at t.
  double y_time = 0;
  double y[max_states] = {};
  double last_change = 0;  // s, clock of the run: when an input or a tunable parameter last changed
  double grip_due = 0;     // s, clock of the run: from when on mu_required is looked at; infinite after its warning
  double x[WHEEL_EULER_STATES] = {};  // model exchange: the caller's states, from which y follows
  bool logged[event_count] = {};      // of each event that is observed: it has occurred, and was logged
  long long transitions = 0;          // of the friction, rolling and sliding
  solver::Counters counted = {};      // all but those of the solver at work
};

// The counts of a run, those of the solver at work included.
inline solver::Counters counters_of(const Run& run, const solver::Solver& solver) {
  const solver::Counters& a = run.counted;
  const solver::Counters b = run.phase == Phase::stepping ? solver.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

}  // namespace wheel
