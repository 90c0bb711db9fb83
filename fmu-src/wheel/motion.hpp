// Co-simulation: a run moves on by one communication step.
#pragma once

#include "wheel.hpp"

namespace wheel {

// (t: s, clock of the run) => `stepped`: it was reached; `event`: the run ended at run.t; `failed`: the state is that
// before the call
[[nodiscard]] solver::Outcome advance(Wheel& wheel, double t);

}  // namespace wheel
