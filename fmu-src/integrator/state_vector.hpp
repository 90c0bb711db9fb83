// Making vectors of fixed length; what they are and can do is in state_vector.h.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
extern "C" {
#include "state_vector.h"
}
#pragma GCC diagnostic pop

namespace integrator {

// A zeroed vector of `states` (8 or 12) doubles; in the room being furnished. Null if the length is another.
N_Vector make_state_vector(int states, SUNContext context);

inline double* data(N_Vector v) { return state_data(v); }

}  // namespace integrator
