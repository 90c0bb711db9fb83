// Derivatives of calculated variables: by time along the motion, or by one known variable. That is an input or a state
// at the present instant, or a parameter before the run.
#pragma once

#include "wheel.hpp"

namespace wheel {

// (outputs) => their d/dt at the present instant, for co-simulation. The mode and the sign of N last, and inputs follow
// their polynomials; after a step, these are the polynomials of the step.
void read_rates(const Wheel& wheel, Listed outputs, std::size_t count, double* out);

// (known, seed, unknowns, `count` of them) => sums[k] += seed times the derivative of each unknown by the known. All
// unknowns are read in one pass. What depends on inputs only through time has the derivative zero. False where no
// initial states lie near a parameter.
bool add_slopes(const Wheel& wheel, unsigned known, double seed, Listed unknowns, std::size_t count, double* sums);

}  // namespace wheel
