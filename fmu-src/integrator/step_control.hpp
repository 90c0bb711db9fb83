// Size of the next step: CVODE's choice, corrected by the trend of the errors.
#pragma once

#include "cvode_impl.h"
#include "implementation.hpp"

namespace integrator {

// After a step of CVODE that succeeded: sets the size of the next one, unless CVODE changes the order. `trend` is that
// of the step before.
void follow_trend(CVodeMemRec& m, Trend* trend);

}  // namespace integrator
