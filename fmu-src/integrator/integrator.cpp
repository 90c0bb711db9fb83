// CVODE set up, restarted, asked for more; how a step is taken is in step.cpp.
#include "integrator.hpp"

#include <cvode/cvode_ls.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "corrector.hpp"
#include "implementation.hpp"
#include "state_vector.hpp"

namespace integrator {
namespace {

using Self = Integrator::Implementation;

// Where CVODE sizes a step itself (bdf; Adams where it changes the order), a step is kept while it would change by less
// than this. CVODE's own 0 and 1.5 spare set-up costs of stiff problems; here a changed step costs nothing.
constexpr double keep_step_above = 1, keep_step_below = 1.02;

// A step that meets the thin layer of a regularized law shrinks many times over before it fits.
constexpr int most_failures = 30;

// Share of the step's error that the corrector may leave: half of CVODE's own 0.1, which makes two evaluations a step
// the rule and saves more in steps than it costs.
constexpr double corrector_share = 0.05;

// Adams methods above this order gain nothing on these scenes, and prediction costs the square of the order.
constexpr int highest_adams_order = 10;

int derivative(double t, N_Vector y, N_Vector y_dot, void* user) {
  Self& self = *static_cast<Self*>(user);
  ++self.progress.counters.rhs;
  return self.system.derivative(self.system.owner, t, data(y), data(y_dot), self.system.states) ? 0 : 1;
}

int jacobian(double t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector, N_Vector) {
  Self& self = *static_cast<Self*>(user);
  ++self.progress.counters.jacobians;
  self.system.jacobian(self.system.owner, t, data(y), SUNDenseMatrix_Data(J));
  return 0;
}

int event(double t, N_Vector y, double* g, void* user) {
  Self& self = *static_cast<Self*>(user);
  ++self.progress.counters.roots;
  *g = self.progress.last_event_value = self.system.event(self.system.owner, t, data(y));
  return 0;
}

int weights(N_Vector y, N_Vector ewt, void* user) {
  Self& self = *static_cast<Self*>(user);
  self.system.weights(self.system.owner, data(y), data(ewt));
  return 0;
}

// SUNDIALS' own messages: kept as the reason of a failure, never printed.
void keep_message(int, const char*, const char*, const char* message, SUNErrCode, void* user, SUNContext) {
  Self& self = *static_cast<Self*>(user);
  std::snprintf(self.message, sizeof self.message, "%s", message ? message : "no reason given");
  for (std::size_t end = std::strlen(self.message); end > 0 && std::strchr(". \n", self.message[end - 1]); --end)
    self.message[end - 1] = 0;
}

bool attach_solver(Self& self) {
  if (self.system.method == Method::adams) {
    self.nonlinear = make_corrector(self.context);
    return self.nonlinear && CVodeSetNonlinearSolver(self.cvode, self.nonlinear) == CV_SUCCESS &&
           CVodeSetMaxOrd(self.cvode, highest_adams_order) == CV_SUCCESS &&
           CVodeSetNonlinConvCoef(self.cvode, corrector_share) == CV_SUCCESS;
  }
  self.matrix = SUNDenseMatrix(self.system.states, self.system.states, self.context);
  self.linear = self.matrix ? SUNLinSol_Dense(self.y, self.matrix, self.context) : nullptr;
  return self.linear && CVodeSetLinearSolver(self.cvode, self.linear, self.matrix) == CV_SUCCESS &&
         CVodeSetJacFn(self.cvode, jacobian) == CV_SUCCESS;
}

bool set_up(Self& self) {
  if (SUNContext_Create(SUN_COMM_NULL, &self.context) != SUN_SUCCESS) return false;
  SUNContext_ClearErrHandlers(self.context);
  if (SUNContext_PushErrHandler(self.context, keep_message, &self) != SUN_SUCCESS) return false;
  self.y = make_state_vector(self.system.states, self.context);
  self.scratch = make_state_vector(self.system.states, self.context);
  self.cvode = CVodeCreate(self.system.method == Method::adams ? CV_ADAMS : CV_BDF, self.context);
  if (!self.y || !self.scratch || !self.cvode) return false;
  return CVodeInit(self.cvode, derivative, 0, self.y) == CV_SUCCESS &&
         CVodeSetUserData(self.cvode, &self) == CV_SUCCESS && CVodeWFtolerances(self.cvode, weights) == CV_SUCCESS &&
         attach_solver(self) && CVodeSetMaxHnilWarns(self.cvode, -1) == CV_SUCCESS &&
         CVodeSetNoInactiveRootWarn(self.cvode) == CV_SUCCESS &&
         CVodeSetMaxStep(self.cvode, self.system.longest_step) == CV_SUCCESS &&
         CVodeSetMaxErrTestFails(self.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetMaxConvFails(self.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetEtaFixedStepBounds(self.cvode, keep_step_above, keep_step_below) == CV_SUCCESS;
}

bool arm_event(Self& self, bool armed) {
  if (self.progress.armed == int{armed}) return true;
  int falling = -1;
  self.progress.armed = armed;
  if (CVodeRootInit(self.cvode, armed ? 1 : 0, armed ? event : nullptr) != CV_SUCCESS) return false;
  return !armed || CVodeSetRootDirection(self.cvode, &falling) == CV_SUCCESS;
}

}  // namespace

Integrator* Integrator::create(const System& system) {
  auto* self = static_cast<Implementation*>(std::calloc(1, sizeof(Implementation)));
  auto* memory = self ? std::malloc(sizeof(Integrator)) : nullptr;
  if (!memory) {
    std::free(self);
    return nullptr;
  }
  self->system = system;
  self->progress.counters.restarts = -1;  // the first start is none
  auto* integrator = ::new (memory) Integrator(self);
  if (set_up(*self)) return integrator;
  destroy(integrator);
  return nullptr;
}

void Integrator::destroy(Integrator* integrator) {
  if (!integrator) return;
  Implementation& self = *integrator->self;
  if (self.cvode) CVodeFree(&self.cvode);
  if (self.nonlinear) SUNNonlinSolFree(self.nonlinear);
  if (self.linear) SUNLinSolFree(self.linear);
  if (self.matrix) SUNMatDestroy(self.matrix);
  if (self.y) N_VDestroy(self.y);
  if (self.scratch) N_VDestroy(self.scratch);
  if (self.context) SUNContext_Free(&self.context);
  std::free(integrator->self);
  std::free(integrator);
}

bool Integrator::restart(double t, const double* y, bool event_armed) {
  std::copy_n(y, self->system.states, data(self->y));
  Progress& progress = self->progress;
  progress.step_start = progress.known_until = t;
  progress.pending = static_cast<int>(Outcome::reached);
  progress.last_event_value = event_armed ? self->system.event(self->system.owner, t, y) : 0;
  ++progress.counters.restarts;
  return arm_event(*self, event_armed) && CVodeSetInitStep(self->cvode, 0) == CV_SUCCESS &&
         CVodeReInit(self->cvode, t, self->y) == CV_SUCCESS;
}

void Integrator::allow_steps(long long most) { self->last_step = self->progress.counters.steps + most; }

Outcome Integrator::advance(double t) {
  while (self->progress.known_until < t) {
    if (self->progress.pending != static_cast<int>(Outcome::reached))
      return static_cast<Outcome>(self->progress.pending);
    if (self->progress.counters.steps >= self->last_step) {
      std::snprintf(self->message, sizeof self->message, "it took all the internal steps allowed in one call");
      return Outcome::failed;
    }
    if (!take_step(*this)) return Outcome::failed;
  }
  return Outcome::reached;
}

void Integrator::stop_before(double t) { CVodeSetStopTime(self->cvode, t); }

double Integrator::known_until() const { return self->progress.known_until; }
double Integrator::event_time() const { return self->progress.event_time; }
const char* Integrator::failure() const { return self->message; }
const Counters& Integrator::counters() const { return self->progress.counters; }

}  // namespace integrator
