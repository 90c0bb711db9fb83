// Transitions of a run: events, changes of mode and contact, counted and logged, and its end.
#pragma once

#include "wheel.hpp"

namespace wheel {

// The run stands at an event that does not end it: what follows is in force, counted and logged.
solver::Consequence pass_event(Wheel& wheel, Event event);
// Counts and logs what has changed since `before`, by an event or by what was set: between held, positive and negative
// spin; between grip and slide; from one slide to another that starts anew.
void note_changes(Wheel& wheel, const InForce& before, Event by = Event::none);

// The run ends at the instant reached, by an event.
void end_run(Wheel& wheel, Event event);
// The caller ends the run.
void close(Wheel& wheel);

}  // namespace wheel
