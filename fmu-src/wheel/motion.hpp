// One communication step of co-simulation, in stages. Times in s on the own clock.
//
//   stage           writes, besides `solution`
//   take_demand     run: in_force, phase (an orbit is left), last_change, transitions; demand.changed
//   set_in_motion   run: phase, counted
//   proceed         run: t, y, in_force, tallies, transitions, at events that do not end the run
//   arrive          run: t, tallies; demand: inputs and changed, where an input varies
//   end             run: t, y, phase, ended_by, counted
//   fail            run: as before the step, but for the phase; demand.changed: as before
#pragma once

#include "wheel.hpp"

namespace wheel {

// To t. `stepped`: it was reached; `event`: the run ended at run.t; `failed`: the state is that before the call.
[[nodiscard]] solver::Outcome advance(Wheel& wheel, double t);
// To a phase without further steps: the solution is not needed any more.
void freeze(Wheel& wheel, Phase phase);
// The run ends at the instant reached, by an event.
void end_run(Wheel& wheel, Event event);

}  // namespace wheel
