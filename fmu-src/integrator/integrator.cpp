// CVODE set up, restarted, asked for more; how a step is taken is in step.cpp.
#include "integrator.hpp"

#include <cvode/cvode_ls.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "corrector.hpp"
#include "cvode_impl.h"
#include "implementation.hpp"
#include "room.hpp"
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

bool attach_solver(Self& self) {
  if (self.system.method == Method::adams) {
    self.nonlinear = make_corrector(self.context);
    return self.nonlinear && CVodeSetNonlinearSolver(self.cvode, self.nonlinear) == CV_SUCCESS &&
           CVodeSetMaxOrd(self.cvode, highest_adams_order) == CV_SUCCESS &&
           CVodeSetNonlinConvCoef(self.cvode, corrector_share) == CV_SUCCESS;
  }
  self.matrix = SUNDenseMatrix(self.system.states, self.system.states, self.context);
  self.linear = self.matrix ? SUNLinSol_Dense(self.y, self.matrix, self.context) : nullptr;
  if (!self.linear || CVodeSetLinearSolver(self.cvode, self.linear, self.matrix) != CV_SUCCESS) return false;
  auto* memory = static_cast<CVodeMem>(self.cvode);
  // CVODE would make the copy of the Jacobian in its first step, when the room is closed.
  return CVodeSetJacFn(self.cvode, jacobian) == CV_SUCCESS && memory->cv_linit(memory) == 0;
}

// CVODE keeps room for one root function from here on; whether it is watched is arm_event's.
bool install_event(Self& self) {
  int falling = -1;
  return CVodeRootInit(self.cvode, 1, event) == CV_SUCCESS && CVodeSetRootDirection(self.cvode, &falling) == CV_SUCCESS;
}

bool set_up(Self& self) {
  if (SUNContext_Create(SUN_COMM_NULL, &self.context) != SUN_SUCCESS) return false;
  SUNContext_ClearErrHandlers(self.context);
  self.y = make_state_vector(self.system.states, self.context);
  self.scratch = make_state_vector(self.system.states, self.context);
  self.cvode = CVodeCreate(self.system.method == Method::adams ? CV_ADAMS : CV_BDF, self.context);
  if (!self.y || !self.scratch || !self.cvode) return false;
  return CVodeInit(self.cvode, derivative, 0, self.y) == CV_SUCCESS &&
         CVodeSetUserData(self.cvode, &self) == CV_SUCCESS && CVodeWFtolerances(self.cvode, weights) == CV_SUCCESS &&
         attach_solver(self) && install_event(self) && CVodeSetMaxHnilWarns(self.cvode, -1) == CV_SUCCESS &&
         CVodeSetNoInactiveRootWarn(self.cvode) == CV_SUCCESS &&
         CVodeSetMaxStep(self.cvode, self.system.longest_step) == CV_SUCCESS &&
         CVodeSetMaxErrTestFails(self.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetMaxConvFails(self.cvode, most_failures) == CV_SUCCESS &&
         CVodeSetEtaFixedStepBounds(self.cvode, keep_step_above, keep_step_below) == CV_SUCCESS;
}

// What CVodeRootInit does for one root function or none, without giving back memory and taking it again.
void arm_event(Self& self, bool armed) {
  auto& memory = *static_cast<CVodeMem>(self.cvode);
  if (armed) memory.cv_gactive[0] = SUNTRUE;
  memory.cv_nrtfn = self.progress.armed = armed;
}

}  // namespace

Integrator* Integrator::create(const System& system, Room& room) {
  static_assert(2 * sizeof(Implementation) < sizeof room.bytes);
  const Furnishing furnishing(room);
  auto* self = ::new (wheel_room_malloc(sizeof(Implementation))) Implementation{};
  self->system = system;
  self->progress.counters.restarts = -1;  // the first start is none
  auto* integrator = ::new (wheel_room_malloc(sizeof(Integrator))) Integrator(self);
  return set_up(*self) ? integrator : nullptr;
}

bool Integrator::restart(double t, const double* y, bool event_armed) {
  std::copy_n(y, self->system.states, data(self->y));
  Progress& progress = self->progress;
  progress.step_start = progress.known_until = t;
  progress.pending = static_cast<int>(Outcome::reached);
  progress.last_event_value = event_armed ? self->system.event(self->system.owner, t, y) : 0;
  ++progress.counters.restarts;
  arm_event(*self, event_armed);
  return CVodeSetInitStep(self->cvode, 0) == CV_SUCCESS && CVodeReInit(self->cvode, t, self->y) == CV_SUCCESS;
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
void Integrator::stop_nowhere() { CVodeClearStopTime(self->cvode); }

double Integrator::known_until() const { return self->progress.known_until; }
double Integrator::event_time() const { return self->progress.event_time; }
const char* Integrator::failure() const { return self->message; }
const Counters& Integrator::counters() const { return self->progress.counters; }

}  // namespace integrator

// In place of CVODE's own (room.h): its messages are kept as the reason of a failure, never printed.
void cvProcessError(CVodeMem memory, int status, int, const char*, const char*, const char* format, ...) {
  if (!memory || !memory->cv_user_data || status == CV_WARNING) return;
  auto& message = static_cast<integrator::Integrator::Implementation*>(memory->cv_user_data)->message;
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(message, sizeof message, format, values);
  va_end(values);
  for (std::size_t end = std::strlen(message); end > 0 && std::strchr(". \n", message[end - 1]); --end)
    message[end - 1] = 0;
}
