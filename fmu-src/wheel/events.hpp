// The one list of what can happen at an instant that is not known beforehand: when it can occur, its margin, and what
// follows. Stepping, the unfolded wheel, model exchange and snapshots work from this table (events.cpp).
#pragma once

#include <cmath>
#include <numbers>

#include "run.hpp"

namespace wheel {

// Angle from lying flat, rad, below which the wheel counts as flat: at the paper's scale about 1e-8 s before theta = 0.
inline constexpr double flat_angle = 1e-7;

inline constexpr double upright = 0.5 * std::numbers::pi;  // rad
// rad, from the side that is nearer.
inline double angle_from_flat(double theta) { return upright - std::fabs(theta - upright); }

using solver::Consequence;

// omega_z over the scale of rates: beyond zero by less, a spin is the error of the solver that brought it there.
inline constexpr double spin_error = 1e-3;

struct EventRow {
  Event event;
  // Whether it can occur, given what is in force.
  bool (*can_occur)(const Setup& setup, const InForce& now);
  // Smooth, scaled to about one, and positive until the event. An observed event has the other sign after it, up to
  // its next change of sign.
  double (*value)(const Setup& setup, const InForce& now, double t, const double* y);
  double rounding = 0;     // of an observed event: a value beyond zero by less does not count
  bool by_margin = false;  // `least_margin` counts it in: the solver looks at it only where that comes near zero
  bool exchanged = true;   // it can occur in model exchange, and has an event indicator there
  bool (*ends)(const Setup& setup) = nullptr;  // whether it ends the run; null: it never does
  // What follows where it does not end the run: what is in force from here on, the state (a rate of zero exactly), and
  // whether the motion goes on as before. An event that is only observed has `observe`.
  Consequence (*follow)(const Setup& setup, Event event, double t, double* y, InForce& now) = nullptr;
  // Messages with the numbers that fill them. What has ended the run, to stand behind "the wheel": mu_max. The end of
  // the run: that text, the instant, theta. Model exchange cannot start: N, the coefficient of friction that is needed,
  // mu_max. It is observed: the instant; and at the end how often it occurred, how many of these were logged, the last
  // instant.
  const char *ending = nullptr, *ended = nullptr, *refused = nullptr, *observed = nullptr, *summary = nullptr;
};

// An event that is counted and logged, but changes nothing.
Consequence observe(const Setup& setup, Event event, double t, double* y, InForce& now);

inline constexpr int row_count = event_count - 1;
extern const EventRow event_rows[row_count];
inline const EventRow& row_of(Event event) { return event_rows[static_cast<int>(event) - 1]; }
inline bool ends_run(const EventRow& row, const Setup& setup) { return row.ends && row.ends(setup); }
// Counted, and logged where it occurs.
inline bool is_observed(const EventRow& row, const Setup& setup) { return row.observed && !ends_run(row, setup); }

double margin_of(const EventRow& row, const Setup& setup, const InForce& now, double t, const double* y);

// The values of the rows `by_margin`: rad from where the wheel counts as flat, and N over the weight.
inline double height_of(const Setup& setup, const double* y) {
  return angle_from_flat(y[setup.formulation->tilt_index]) - flat_angle;
}
inline double pressure_of(const Setup& setup, double N) { return N / setup.weight; }
inline constexpr double pressure_rounding = 1e-9;
// The least of their margins, at the state y where the normal force is N.
inline double least_margin(const Setup& setup, const InForce& now, const double* y, double N) {
  const double height = height_of(setup, y);
  const double contact = pressure_of(setup, now.pulls() ? -N : N) + pressure_rounding;
  return height < contact ? height : contact;
}

// Observed events that lie below zero at t and y, from a motion in which they were not followed.
void place_observed(const Setup& setup, double t, const double* y, InForce& now);

// The run stands at an event that does not end it: what follows is in force, counted and logged.
Consequence pass_event(const Setup& setup, Event event, Run& run, const Reporter& reporter);

// Counts an observed event at t, s, own clock; the first `logged_one_by_one` of each are logged, a rule that no
// communication grid changes.
inline constexpr long long logged_one_by_one = 100;
void count_event(const Setup& setup, Event event, double t, Run& run, const Reporter& reporter);

// Counts and logs a change between held, positive and negative spin since the law `before`.
void log_transition(const Setup& setup, const WheelFriction& before, Run& run, const Reporter& reporter);
// At the end of a run: the observed events that were not logged one by one.
void log_summaries(const Setup& setup, const Run& run, const Reporter& reporter);
// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const Setup& setup, Event event);

}  // namespace wheel
