// Fixed-point iteration of the Adams corrector, y = y_predicted + (h f(y) - z_1) / l_1, no acceleration.
//
// Same formula and same test as CVODE's own solver. That one makes nine vector calls an iteration through function
// pointers; here they are two passes over 8 or 12 numbers. Measured in docs/results/work_precision.md.
#include "corrector.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cvode_impl.h"
#include "state_vector.hpp"

namespace integrator {
namespace {

struct Content {
  long iterations, failures;
};

Content& content(SUNNonlinearSolver solver) { return *static_cast<Content*>(solver->content); }

// One iteration: evaluates f at y = z_0 + correction, replaces the correction, returns the norm of its change.
int iterate(CVodeMemRec& m, N_Vector correction, N_Vector weights, double* change) {
  state_linear_sum(1, m.cv_zn[0], 1, correction, m.cv_y);
  const int status = m.nls_f(m.cv_tn, m.cv_y, m.cv_ftemp, m.cv_user_data);
  ++m.cv_nfe;
  if (status != 0) return status < 0 ? CV_RHSFUNC_FAIL : RHSFUNC_RECVR;
  const StatePair *f = state_pairs(m.cv_ftemp), *z_1 = state_pairs(m.cv_zn[1]), *w = state_pairs(weights);
  StatePair *x = state_pairs(correction), sum = {0, 0};
  const int pairs = state_count(correction) / 2;
  for (int i = 0; i < pairs; ++i) {
    const StatePair next = m.cv_rl1 * (m.cv_h * f[i] - z_1[i]), weighted = (next - x[i]) * w[i];
    x[i] = next;
    sum += weighted * weighted;
  }
  *change = std::sqrt((sum[0] + sum[1]) / (2 * pairs));
  return 0;
}

// Whether an iteration has converged, CVODE's rule; the convergence rate is estimated from the second one on.
bool converged(CVodeMemRec& m, int iteration, double change, double tolerance) {
  constexpr double slowest_forgetting = 0.3;
  if (iteration > 0) m.cv_crate = std::max(slowest_forgetting * m.cv_crate, change / m.cv_delp);
  return change * std::min(1.0, m.cv_crate) <= tolerance;
}

int solve(SUNNonlinearSolver solver, N_Vector, N_Vector correction, N_Vector weights, double tolerance, sunbooleantype,
          void* memory) {
  auto& m = *static_cast<CVodeMem>(memory);
  constexpr int most_iterations = 3;
  constexpr double divergence = 2;
  content(solver) = {};  // CVODE adds up what each solve reports
  double change = 0;
  for (int i = 0; i < most_iterations; ++i) {
    const int status = iterate(m, correction, weights, &change);
    ++content(solver).iterations;
    if (status != 0) return status;
    if (converged(m, i, change, tolerance)) {
      m.cv_acnrm = i == 0 ? change : state_wrms_norm(correction, weights);
      m.cv_acnrmcur = SUNTRUE;
      return SUN_SUCCESS;
    }
    if (i > 0 && change > divergence * m.cv_delp) break;
    m.cv_delp = change;
  }
  ++content(solver).failures;
  return SUN_NLS_CONV_RECVR;
}

SUNNonlinearSolver_Type type(SUNNonlinearSolver) { return SUNNONLINEARSOLVER_FIXEDPOINT; }

SUNErrCode reset(SUNNonlinearSolver solver) {
  content(solver) = {};
  return SUN_SUCCESS;
}

SUNErrCode keep_system(SUNNonlinearSolver, SUNNonlinSolSysFn) { return SUN_SUCCESS; }

SUNErrCode count_iterations(SUNNonlinearSolver solver, long* count) {
  *count = content(solver).iterations;
  return SUN_SUCCESS;
}

SUNErrCode count_failures(SUNNonlinearSolver solver, long* count) {
  *count = content(solver).failures;
  return SUN_SUCCESS;
}

SUNErrCode destroy(SUNNonlinearSolver solver) {
  std::free(solver->content);
  solver->content = nullptr;
  SUNNonlinSolFreeEmpty(solver);
  return SUN_SUCCESS;
}

}  // namespace

SUNNonlinearSolver make_corrector(SUNContext context) {
  SUNNonlinearSolver solver = SUNNonlinSolNewEmpty(context);
  if (!solver) return nullptr;
  solver->ops->gettype = type;
  solver->ops->initialize = reset;
  solver->ops->solve = solve;
  solver->ops->setsysfn = keep_system;
  solver->ops->getnumiters = count_iterations;
  solver->ops->getnumconvfails = count_failures;
  solver->ops->free = destroy;
  solver->content = std::calloc(1, sizeof(Content));
  if (solver->content) return solver;
  SUNNonlinSolFreeEmpty(solver);
  return nullptr;
}

}  // namespace integrator
