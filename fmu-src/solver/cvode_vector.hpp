// An N_Vector of SUNDIALS of fixed width, 8 or 12 doubles in one block, by SUNDIALS's public interface.
#pragma once

#include <sundials/sundials_nvector.h>

namespace solver {

// All entries zero; those beyond `states` stay zero and count in no norm. Null where there is no memory.
N_Vector make_vector(int states, SUNContext context);

inline double* data(N_Vector v) { return static_cast<double*>(v->content); }

}  // namespace solver
