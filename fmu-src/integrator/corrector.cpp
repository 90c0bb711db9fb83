// Fixed-point iteration of the Adams corrector, y = y_predicted + (h f(y) - z_1) / l_1, no acceleration.
//
// Same formula and same test as CVODE's own solver. That one makes nine vector calls an iteration through function
// pointers; here they are two passes over 8 or 12 numbers. Measured in docs/results/work_precision.md.
#include "corrector.hpp"

#include <algorithm>
#include <cmath>

#include "cvode_impl.h"
#include "implementation.hpp"
#include "room.hpp"
#include "state_vector.hpp"

namespace integrator {
namespace {

struct Content {
  long iterations, failures;
};

Content& content(SUNNonlinearSolver solver) { return *static_cast<Content*>(solver->content); }

// One iteration: evaluates f at y = z_0 + correction and replaces the correction of the first `wanted` states. The
// change is the norm over the closed states: quadratures do not come back.
int iterate(CVodeMemRec& m, N_Vector correction, N_Vector weights, int wanted, double* change) {
  auto& self = *static_cast<Integrator::Implementation*>(m.cv_user_data);
  const System& system = self.system;
  state_linear_sum(1, m.cv_zn[0], 1, correction, m.cv_y);
  ++m.cv_nfe, ++self.progress.counters.rhs;
  if (!system.derivative(system.owner, m.cv_tn, data(m.cv_y), data(m.cv_ftemp), wanted)) return RHSFUNC_RECVR;
  const StatePair *f = state_pairs(m.cv_ftemp), *z_1 = state_pairs(m.cv_zn[1]), *w = state_pairs(weights);
  StatePair *x = state_pairs(correction), sum = {0, 0};
  const auto next = [&](int i) { return m.cv_rl1 * (m.cv_h * f[i] - z_1[i]); };
  for (int i = 0; i < system.closed_states / 2; ++i) {
    const StatePair weighted = (next(i) - x[i]) * w[i];
    x[i] = next(i);
    sum += weighted * weighted;
  }
  for (int i = system.closed_states / 2; i < wanted / 2; ++i) x[i] = next(i);
  *change = std::sqrt((sum[0] + sum[1]) / system.closed_states);
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
  const System& system = static_cast<Integrator::Implementation*>(m.cv_user_data)->system;
  double change = 0;
  // The first iteration leaves the quadratures alone, unless the last step (its correction is cv_acnrm) tells that one
  // iteration will do.
  for (int i = 0; i < most_iterations; ++i) {
    const int wanted = i == 0 && m.cv_acnrm > tolerance ? system.closed_states : system.states;
    const int status = iterate(m, correction, weights, wanted, &change);
    ++content(solver).iterations;
    if (status != 0) return status;
    if (converged(m, i, change, tolerance) && wanted == system.states) {
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
  solver->content = wheel_room_calloc(1, sizeof(Content));
  return solver->content ? solver : nullptr;
}

}  // namespace integrator
