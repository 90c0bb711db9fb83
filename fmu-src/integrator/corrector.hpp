// The corrector of the Adams method as a SUNDIALS nonlinear solver of our own: CVODE's fixed-point iteration and
// convergence test, on vectors of fixed length and in one loop.
#pragma once

#include <sundials/sundials_nonlinearsolver.h>

namespace integrator {

// In the room being furnished; null if that is full.
SUNNonlinearSolver make_corrector(SUNContext context);

}  // namespace integrator
