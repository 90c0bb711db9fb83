// CVODE set up, restarted and asked for one step at a time.
#include "cvode_engine.hpp"

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cstdlib>

#include "cvode_objects.hpp"

namespace solver {
namespace {

// The error that one step may make, as a fraction of the tolerance of the whole solution. Tuned on the wheel's scenes.
constexpr double cvode_share = 0.003;

// The step size is kept while it would change by a factor between these two. CVODE's defaults, 0 and 1.5, avoid the
// cost of a new matrix in stiff problems; here a changed step costs nothing. Version 7.1.1 ignores a lower bound of 1.
constexpr double keep_step_above = 0.9999, keep_step_below = 1.02;

// Share of the step's error that the corrector may leave: half of CVODE's default of 0.1. Two evaluations per step are
// then the rule, which saves more in steps than it costs.
constexpr double corrector_share = 0.05;

// A step that meets the thin layer of a regularized law shrinks many times over before it fits.
constexpr int most_failures = 30;

// Adams methods above this order gain nothing on the wheel's scenes, and prediction costs the square of the order.
constexpr int highest_adams_order = 9;

int derivative(double t, N_Vector y, N_Vector y_dot, void* user) {
  CvodeCall& call = *static_cast<CvodeCall*>(user);
  ++call.counters->rhs;
  const double margin = call.problem->derivative(call.problem->owner, t, data(y), data(y_dot));
  if (margin < call.lowest_margin) call.lowest_margin = margin;
  return std::isnan(margin) ? 1 : 0;
}

int weights(N_Vector y, N_Vector w, void* user) {
  const Problem& problem = *static_cast<CvodeCall*>(user)->problem;
  problem.weights(problem.owner, cvode_share * problem.share, data(y), data(w));
  return 0;
}

// In words of our own: SUNDIALS's messages give times of the solver's clock.
const char* reason_of(int flag) {
  if (flag == CV_FIRST_RHSFUNC_ERR) return "the rates of the states are not finite";
  for (const int at_smallest : {CV_ERR_FAILURE, CV_CONV_FAILURE, CV_REPTD_RHSFUNC_ERR})
    if (flag == at_smallest) return step_too_small;
  return "CVODE failed";
}

bool attach_solver(CvodeObjects& o, Method method) {
  if (method == Method::adams) {
    o.corrector = SUNNonlinSol_FixedPoint(o.y, 0, o.context);
    return o.corrector && CVodeSetNonlinearSolver(o.cvode, o.corrector) == CV_SUCCESS &&
           CVodeSetNonlinConvCoef(o.cvode, corrector_share) == CV_SUCCESS &&
           CVodeSetMaxOrd(o.cvode, highest_adams_order) == CV_SUCCESS;
  }
  o.matrix = SUNDenseMatrix(o.states, o.states, o.context);
  o.linear = o.matrix ? SUNLinSol_Dense(o.y, o.matrix, o.context) : nullptr;
  return o.linear && CVodeSetLinearSolver(o.cvode, o.linear, o.matrix) == CV_SUCCESS;
}

// CVODE counts from its last start on.
long jacobians_of(const CvodeObjects& o) {
  long count = 0;
  if (o.linear) CVodeGetNumJacEvals(o.cvode, &count);
  return count;
}

bool set_up(CvodeObjects& o, Method method) {
  if (SUNContext_Create(SUN_COMM_NULL, &o.context) != SUN_SUCCESS) return false;
  SUNContext_ClearErrHandlers(o.context);  // nothing is printed
  o.y = make_vector(o.states, o.context);
  o.cvode = CVodeCreate(method == Method::adams ? CV_ADAMS : CV_BDF, o.context);
  return o.y && o.cvode && CVodeInit(o.cvode, derivative, 0, o.y) == CV_SUCCESS &&
         CVodeSetUserData(o.cvode, &o.call) == CV_SUCCESS && CVodeWFtolerances(o.cvode, weights) == CV_SUCCESS &&
         attach_solver(o, method) && CVodeSetMaxErrTestFails(o.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetMaxConvFails(o.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetEtaFixedStepBounds(o.cvode, keep_step_above, keep_step_below) == CV_SUCCESS;
}

}  // namespace

void Cvode::free_objects(CvodeObjects* objects) {
  CvodeObjects& o = *objects;
  if (o.cvode) CVodeFree(&o.cvode);
  if (o.corrector) SUNNonlinSolFree(o.corrector);
  if (o.linear) SUNLinSolFree(o.linear);
  if (o.matrix) SUNMatDestroy(o.matrix);
  if (o.y) N_VDestroy(o.y);
  if (o.context) SUNContext_Free(&o.context);
  std::free(objects);
}

bool Cvode::start(const Problem& problem) {
  failure_ = "CVODE could not be set up";
  next_ = Next::starts;
  if (!objects_ || objects_->states != problem.states) {
    objects_.reset(static_cast<CvodeObjects*>(std::calloc(1, sizeof(CvodeObjects))));
    if (!objects_) return false;
    objects_->states = problem.states;
    if (!set_up(*objects_, method_)) objects_.reset();
  }
  return objects_ && CVodeSetMaxStep(objects_->cvode, problem.longest_step) == CV_SUCCESS;
}

bool Cvode::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  CvodeObjects& o = *objects_;
  o.call = {&problem, counters, INFINITY};
  double t = step->end;
  int flag = CV_SUCCESS;
  // Where the slope of an input has changed, a history of high order can fail. Then one more attempt starts anew.
  for (int attempt = 0; attempt < 2; ++attempt) {
    const bool first = next_ != Next::goes_on;
    if (next_ == Next::starts_after_stop) ++counters->restarts;
    if (first) {
      std::copy_n(step->y_end, o.states, data(o.y));
      flag = CVodeReInit(o.cvode, step->end, o.y);
      next_ = Next::goes_on;
    }
    if (flag >= 0) flag = std::isfinite(stop) ? CVodeSetStopTime(o.cvode, stop) : CVodeClearStopTime(o.cvode);
    // At a state that is zero CVODE's first step is next to nothing, and shorter than the rounding of time.
    if (flag >= 0) flag = CVodeSetMinStep(o.cvode, std::fmin(rounding_at(step->end), problem.longest_step));
    if (flag < 0) break;
    const long jacobians = first ? 0 : jacobians_of(o);  // CVODE's own count starts anew with its first step
    // The size of CVODE's first step depends on the time it is asked for, so it is always asked for the same time
    // ahead.
    flag = CVode(o.cvode, step->end + problem.longest_step, o.y, &t, CV_ONE_STEP);
    counters->jacobians += std::max(0L, jacobians_of(o) - jacobians);
    if (flag >= 0 || first || (flag != CV_ERR_FAILURE && flag != CV_CONV_FAILURE)) break;
    next_ = Next::starts_after_stop;
  }
  failure_ = reason_of(flag);
  if (flag < 0) {
    next_ = Next::starts;
    return false;
  }
  step->end = t;
  std::copy_n(data(o.y), problem.states, step->y_end);
  step->lowest_margin = o.call.lowest_margin;
  next_ = flag == CV_TSTOP_RETURN ? Next::starts_after_stop : Next::goes_on;
  return true;
}

void Cvode::expand(const Problem& problem, Step* step) {
  const double h = step->end - step->start;
  double factor = 1;
  CVodeGetLastOrder(objects_->cvode, &step->degree);
  std::copy_n(step->y_end, problem.states, step->c[0]);
  for (int k = 1; k <= step->degree; ++k) {
    factor *= h / k;
    CVodeGetDky(objects_->cvode, step->end, k, objects_->y);
    for (int i = 0; i < problem.states; ++i) step->c[k][i] = factor * data(objects_->y)[i];
  }
}

}  // namespace solver
