// CVODE set up, restarted and asked for one step at a time.
#include "cvode_engine.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cstdlib>

#include "constant.hpp"

namespace solver {

// What SUNDIALS allocates for one solver.
struct CvodeObjects {
  // What the functions that CVODE calls are given, of the step under way. CVODE keeps copies of its address: it never
  // moves.
  struct Call {
    const Problem* problem;
    Counters* counters;
    double least_margin;
  } call;
  int states;
  SUNContext context;
  N_Vector y;
  void* cvode;
  SUNNonlinearSolver corrector;  // Adams
  SUNMatrix matrix;              // BDF
  SUNLinearSolver linear;        // BDF
};

namespace {

double* data(N_Vector v) { return N_VGetArrayPointer(v); }

CONSTANT(double, cvode_share, 0.003, "1", "error of a step over that of the solution, tuned on the wheel's scenes");

// The step size is kept while it would change by a factor between these two. CVODE's defaults, 0 and 1.5, avoid the
// cost of a new matrix in stiff problems; here a changed step costs nothing. Version 7.1.1 ignores a lower bound of 1.
constexpr double keep_step_above = 0.9999, keep_step_below = 1.02;

CONSTANT(double, corrector_share, 0.05, "1", "of the step's error: two evaluations a step, which saves steps");
CONSTANT(int, highest_adams_order, 9, "1", "higher ones gain nothing, and prediction costs its square");

int derivative(double t, N_Vector y, N_Vector y_dot, void* user) {
  auto& call = *static_cast<CvodeObjects::Call*>(user);
  ++call.counters->rhs;
  const double margin = call.problem->derivative(call.problem->owner, t, data(y), data(y_dot));
  if (margin < call.least_margin) call.least_margin = margin;
  return std::isnan(margin) ? 1 : 0;
}

int weights(N_Vector y, N_Vector w, void* user) {
  const Problem& problem = *static_cast<CvodeObjects::Call*>(user)->problem;
  problem.weights(problem.owner, cvode_share * problem.share, data(y), data(w));
  return 0;
}

// (flag) => reason in place of SUNDIALS's message, whose times are those of the solver's clock
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
  o.y = N_VNew_Serial(o.states, o.context);
  o.cvode = CVodeCreate(method == Method::adams ? CV_ADAMS : CV_BDF, o.context);
  return o.y && o.cvode && CVodeInit(o.cvode, derivative, 0, o.y) == CV_SUCCESS &&
         CVodeSetUserData(o.cvode, &o.call) == CV_SUCCESS && CVodeWFtolerances(o.cvode, weights) == CV_SUCCESS &&
         attach_solver(o, method) &&
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

// The solution starts from nothing at the end of the last step.
int Cvode::start_at(const Step& step) {
  start_ = step.end;
  std::copy_n(step.y_end, objects_->states, y_start_);
  steps_ = 0;
  std::copy_n(y_start_, objects_->states, data(objects_->y));
  return CVodeReInit(objects_->cvode, start_, objects_->y);
}

// One step from t to the new t, in o.y. The size of CVODE's first step depends on the time it is asked for, so it is
// always asked for the same time ahead. At a state that is zero that size is next to nothing, and shorter than the
// rounding of time.
int Cvode::make_step(double stop, double* t) {
  const CvodeObjects& o = *objects_;
  const double longest = o.call.problem->longest_step;
  int flag = std::isfinite(stop) ? CVodeSetStopTime(o.cvode, stop) : CVodeClearStopTime(o.cvode);
  if (flag >= 0) flag = CVodeSetMinStep(o.cvode, std::fmin(rounding_at(*t), longest));
  return flag < 0 ? flag : CVode(o.cvode, *t + longest, o.y, t, CV_ONE_STEP);
}

bool Cvode::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  CvodeObjects& o = *objects_;
  o.call = {&problem, counters, INFINITY};
  if (next_ == Next::starts_after_stop) ++counters->restarts;
  const bool first = next_ != Next::goes_on || steps_ == most_steps;
  int flag = first ? start_at(*step) : CV_SUCCESS;
  const long jacobians = first ? 0 : jacobians_of(o);  // CVODE's count starts anew with its first step
  if (flag >= 0) flag = make_step(stop, &step->end);
  counters->jacobians += std::max(0L, jacobians_of(o) - jacobians);
  failure_ = reason_of(flag);
  next_ = flag < 0 ? Next::starts : flag == CV_TSTOP_RETURN ? Next::starts_after_stop : Next::goes_on;
  if (flag < 0) return false;
  ++steps_;
  std::copy_n(data(o.y), problem.states, step->y_end);
  step->least_margin = o.call.least_margin;
  return true;
}

// Read, the steps since the last start are made again, bit-identically: none of them ended at a stop.
void Cvode::visit(support::Archive& archive, const Problem& problem, const Step& step) {
  Next next = next_;
  archive.count(next, 0, static_cast<int>(Next::starts_after_stop));
  if (archive.reads() && !start(problem)) return archive.refuse();
  if (next != Next::goes_on) {
    next_ = next;
    return;
  }
  archive.number(start_);
  archive.numbers(y_start_, problem.states);
  archive.count(steps_, 1, most_steps);
  if (!archive.reads() || !archive.fits()) return;
  Counters uncounted = {};
  Step again;
  again.set_point(start_, y_start_, problem.states);
  for (int left = steps_; left > 0; --left)
    if (!advance(problem, never, &uncounted, &again)) return archive.refuse();
  if (again.end != step.end) archive.refuse();
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
