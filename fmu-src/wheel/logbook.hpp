// Messages of a run: events that are observed, warnings, and its end.
#pragma once

#include "wheel.hpp"

namespace wheel {

// (t: s, clock of the run) => caller's time for messages: an event is not found more exactly than to a nanosecond
double shown_time(const Wheel& wheel, double t);
// An event that is observed has occurred at t, s, clock of the run: the first of a run is logged.
void log_observation(Wheel& wheel, Event event, double t);
// Warns once per run where a loaded wheel, on a road without a limit, needs a friction coefficient above 1: at t, or as
// far as the solution is known, s, clock of the run. It looks at most once in a step of the solver and a few times in
// the wheel's time scale, so that it costs nothing noticeable. So the instants at which results are read may move a
// warning.
void look_at_grip(Wheel& wheel, double t);
// Where road or inputs that were set make the wheel jam at this instant: no force satisfies the equations there, and
// the next step ends the run.
void warn_of_jam(const Wheel& wheel);

// Of very many endings, as in a search that goes back and tries again, the first ones alone are logged.
void log_ending(Wheel& wheel, Event event);
// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const InForce& in_force, Event event);

}  // namespace wheel
