// The one list of events, which happen at instants that are not known beforehand: when each can occur, its margin, and
// what follows. Stepping, the unfolded wheel, model exchange and snapshots work from this table (events.cpp).
#pragma once

#include "constant.hpp"
#include "in_force.hpp"

namespace wheel {

using solver::Consequence;

CONSTANT(double, spin_error, 1e-3, "of the scale of rates", "beyond zero by less, a spin is an error of the solver");

// (y of a held wheel) => whether its spin is more than an error of the solver: it has been set
inline bool has_left_hold(const Setup& setup, const double* y) {
  return std::fabs(y[WHEEL_OMEGA_3]) / setup.rate_scale > spin_error;
}

inline int all_states(const InForce&) { return -1; }

// A row by itself is enough for the solver and for snapshots. These rows are named elsewhere too:
//   spin_changes   in exchange.cpp: a spin that the caller has set is not this event
//   lies_flat      in exchange.cpp: its margin alone is asked for beyond flat; in logbook.cpp: a hint
//   lost_contact   in in_force.cpp and exchange.cpp: it decides the side of the ground; in logbook.cpp: a hint
//   jams           in motion.cpp, setting.cpp and logbook.cpp: a start, or what was set, at which the wheel jams
struct EventRow {
  Event event;
  // Whether it can occur, given what is in force. An event after which the motion goes on may not change it for any
  // row: the solver keeps its list until it starts anew.
  bool (*can_occur)(const Setup& setup, const InForce& in_force);
  // A row has one of two values, scaled to about one, which falls below zero at the event. It is smooth, but for that
  // of a jam, of a slip far from its end and of a spin that was set, which jump away from zero. The quick one depends
  // on the state and on the normal force N alone, which come with the rates: the solver looks at it only where it comes
  // near zero. The value of an observed event changes its sign again and again.
  double (*value)(const Setup& setup, const InForce& in_force, double t, const double* y) = nullptr;
  double (*quick_value)(const Setup& setup, const double* y, double N) = nullptr;
  bool needs_N = true;  // the quick value does
  // The only state that the value reads, below zero where it reads all.
  int (*state)(const InForce& in_force) = all_states;
  double rounding = 0;            // where there is an observation: a value beyond zero by less does not count
  bool in_model_exchange = true;  // it can occur in model exchange, and has an event indicator there
  bool (*ends)(const Setup& setup) = nullptr;  // whether it ends the run; null: it never does
  // A row with this function bends the motion: it decides what is in force from here on. In y it may set omega_3 to
  // exactly zero, or the slip, and no other state. A row without it bends the motion only by bends_friction.
  void (*follow)(const Setup& setup, double t, double* y, InForce& in_force) = nullptr;
  bool bends_friction = false;  // it bends the motion where friction acts
  bool slides_anew = false;     // a wheel that slides after it has started to slide anew
  // For messages, as plain text: the reason why the run has ended, which follows "the wheel"; the parameter's value at
  // the end of that text, if there is one; and the observation, which follows the instant.
  const char* ending = nullptr;
  double (*limit)(const InForce& in_force) = nullptr;
  const char* observation = nullptr;
};

inline constexpr int row_count = event_count - 1;
extern const EventRow event_rows[row_count];  // in the order of Event
inline const EventRow& event_row(Event event) { return event_rows[static_cast<int>(event) - 1]; }
inline bool ends_run(const EventRow& row, const Setup& setup) { return row.ends && row.ends(setup); }
// Logged where it first occurs in a run.
inline bool is_observed(const EventRow& row, const Setup& setup) { return row.observation && !ends_run(row, setup); }

// Puts in force what follows from an event that does not end the run. An event that is only observed changes its
// side alone. pass_event (transitions.hpp) does it for a run, and counts and logs too. follow_on_orbit
// (posed_problem.hpp) does it ahead of the run. After a motion in which no event was followed, set_sides finds those
// that are observed.
Consequence follow_event(const EventRow& row, const Setup& setup, double t, double* y, InForce& in_force);

// (row, t, y) => its margin
double margin_of(const EventRow& row, const Setup& setup, const InForce& in_force, double t, const double* y);

// (y, its normal force N) => least margin of the rows with a quick value that can occur
double least_margin(const Setup& setup, const InForce& in_force, const double* y, double N);

// (t, y) => which observed events lie below zero, after a motion in which they were not followed
void set_sides(const Setup& setup, double t, const double* y, InForce& in_force);

}  // namespace wheel
