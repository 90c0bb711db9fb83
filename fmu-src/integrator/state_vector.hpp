// A SUNDIALS vector of fixed length: 8 or 12 doubles in one block with its operations unrolled by the compiler.
// No paper equation, no frame. CVODE's cost on so small a system is its vector operations, not the right-hand side.
#pragma once

#include <sundials/sundials_nvector.h>

namespace integrator {

// A zeroed vector of `states` (8 or 12) doubles; null if memory is short or the length is another.
N_Vector make_state_vector(int states, SUNContext context);

double* data(N_Vector v);

}  // namespace integrator
