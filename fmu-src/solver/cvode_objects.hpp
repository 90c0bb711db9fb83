// What SUNDIALS allocates for one solver.
#pragma once

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>

#include "cvode_vector.hpp"
#include "problem.hpp"

namespace solver {

struct CvodeObjects {
  Method method;
  int states;
  SUNContext context;
  N_Vector y;
  void* cvode;
  SUNNonlinearSolver corrector;  // Adams
  SUNMatrix matrix;              // BDF
  SUNLinearSolver linear;        // BDF
};

}  // namespace solver
