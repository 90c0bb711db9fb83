// The phases of a run, from the first parameter to the end: one enumeration, from which follows what can be read, what
// a step does, and which functions of FMI may be called (fmi/legality.hpp).
#pragma once

namespace wheel {

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
  failed,           // a step has failed; the state is that before it
  without_start,    // initialization has failed: there is no state
  count
};

constexpr bool has_begun(Phase p) { return p >= Phase::at_start; }
constexpr bool is_running(Phase p) { return p >= Phase::at_start && p <= Phase::continuous_time; }
constexpr bool has_state(Phase p) { return p >= Phase::initial && p != Phase::without_start; }

}  // namespace wheel
