// One communication step of co-simulation: `advance` lists its stages. Times in s on the own clock.
#pragma once

#include "solution.hpp"

namespace wheel {

// To t. `stepped`: it was reached; `event`: the run ended at run.t; `failed`: the state is that before the call.
solver::Outcome advance(const Setup& setup, Demand& demand, Run& run, Solution& solution, const Reporter& reporter,
                        double t);

// The run ends at the instant reached, by an event.
void end_run(const Setup& setup, Event event, Run& run, const Solution& solution, const Reporter& reporter);

}  // namespace wheel
