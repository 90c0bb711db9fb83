// What a run counts and logs of its events: those that are observed, the changes of the friction, and its end.
#pragma once

#include "events.hpp"
#include "wheel.hpp"

namespace wheel {

// The run stands at an event that does not end it: what follows is in force, counted and logged. Writes run.in_force,
// run.y and the counts.
Consequence pass_event(Wheel& wheel, Event event);

// Counts an observed event at t, s, own clock; the first `logged_one_by_one` of each are logged, a rule that no
// communication grid changes.
inline constexpr long long logged_one_by_one = 100;
void count_event(Wheel& wheel, Event event, double t);

// Counts and logs a change between held, positive and negative spin since the law `before`.
void log_transition(Wheel& wheel, const WheelFriction& before);
// The same between rolling and sliding since `slid`; goes_on: the slip has not ended, so that a wheel that still slides
// has not started to slide anew.
void log_contact(Wheel& wheel, bool slid, bool goes_on);
// Once per run, where mu_required is found above 1 at t, s, own clock, and y, and mu_max sets no limit. Looks a few
// times in the wheel's own time, so that it costs nothing noticeable. Writes run.grip_due.
void warn_of_grip(Wheel& wheel, double t, const double* y);

// Where a road that was set, with the scene and y of a reading, makes the wheel jam: the reading has no force that
// satisfies the equations, and the next step ends the run.
void warn_of_jam(const Wheel& wheel, const WheelScene& ahead, const double* y);

// Of an ending; of very many, as of a search that goes back and tries again, the first ones alone. Writes endings.
void log_ending(Wheel& wheel, Event event);

// At the end of a run: the observed events that were not logged one by one.
void log_summaries(const Wheel& wheel);

// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const InForce& now, Event event);

}  // namespace wheel
