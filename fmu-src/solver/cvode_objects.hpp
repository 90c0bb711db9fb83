// What SUNDIALS allocates for one solver, and what the functions that CVODE calls are given.
#pragma once

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>

#include "cvode_vector.hpp"
#include "problem.hpp"

namespace solver {

// Of the step under way. CVODE keeps copies of its address: it never moves.
struct CvodeCall {
  const Problem* problem;
  Counters* counters;
  double lowest_margin;
};

struct CvodeObjects {
  CvodeCall call;
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
