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
// The same between grip and sliding since `slid`; goes_on: the slip has not ended, so that a wheel that still slides
// has not lost its grip anew.
void log_contact(Wheel& wheel, bool slid, bool goes_on);
// At the end of a run: the observed events that were not logged one by one.
void log_summaries(const Wheel& wheel);

// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const Setup& setup, Event event);

}  // namespace wheel
