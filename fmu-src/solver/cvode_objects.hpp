// What SUNDIALS allocates for one solver, and what the functions that CVODE calls are given. By its public interface.
#pragma once

#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_nvector.h>

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
  int states;
  SUNContext context;
  N_Vector y;
  void* cvode;
  SUNNonlinearSolver corrector;  // Adams
  SUNMatrix matrix;              // BDF
  SUNLinearSolver linear;        // BDF
};

inline double* data(N_Vector v) { return N_VGetArrayPointer(v); }

}  // namespace solver
