// Co-simulation: a run moves on by one communication step.
#pragma once

#include "wheel.hpp"

namespace wheel {

// How far a step, or a stage of it, has come.
enum class Progress {
  done,
  ended,   // the run, at run.t, by an event
  failed,  // the state is that before the step
};
// (t: s, clock of the run)
[[nodiscard]] Progress advance(Wheel& wheel, double t);

// (h: s, length of the next step) => the first input whose polynomial would leave its bounds in it, the value that it
// would reach, and the limit. Without a limit there is none. A brake whose polynomial falls below zero stays at zero.
struct Excess {
  unsigned input;
  double value;
  Limit limit;
};
Excess excess_of(const Wheel& wheel, double h);

}  // namespace wheel
