// Derivatives of calculated variables by one known: an input or a state at the present instant, or, before the run, a
// parameter.
#pragma once

#include <cstddef>

#include "wheel.hpp"

namespace wheel {

// Adds seed times the derivative by `known` to sums[k] of each of the unknowns, `count` of them. All unknowns are read
// in one pass. What depends on inputs only through time has the derivative zero. False where no initial states lie near
// a parameter. Before the run it writes setup and run, and leaves the initial state of the present parameters.
bool add_slopes(Wheel& wheel, unsigned known, double seed, const unsigned* unknowns, std::size_t count, double* sums);

}  // namespace wheel
