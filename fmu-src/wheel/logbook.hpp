// Counts and messages of a run: events that are observed, changes of the friction and of the contact, its end.
#pragma once

#include "wheel.hpp"

namespace wheel {

// The run stands at an event that does not end it: what follows is in force, counted and logged.
solver::Consequence pass_event(Wheel& wheel, Event event);
// An event that is observed has occurred at t, s, clock of the run: the first of a run is logged.
void log_observation(Wheel& wheel, Event event, double t);
// Counts and logs what has changed since `before`, by an event or by what was set: between held, positive and negative
// spin, and between rolling and sliding. A wheel that still slides where its slip ends has started to slide anew.
void log_changes(Wheel& wheel, const InForce& before, Event by = Event::none);
// Warns once per run where a loaded wheel, on a road without a limit, needs a friction coefficient above 1: at t, or as
// far as the solution is known, s, clock of the run. It looks a few times in the wheel's time scale, so that it costs
// nothing noticeable.
void look_at_grip(Wheel& wheel, double t);
// Where a road that was set makes the wheel jam: the reading has no force that satisfies the equations, and the next
// step ends the run.
void warn_of_jam(const Wheel& wheel, const Reading& reading);

// Of very many endings, as in a search that goes back and tries again, the first ones alone are logged.
void log_ending(Wheel& wheel, Event event);
// What ended a run, to stand behind "the wheel", with its limit.
struct Ending {
  char text[96];
};
Ending ending_of(const InForce& now, Event event);

}  // namespace wheel
