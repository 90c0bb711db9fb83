// One step of the solution: the start of high order or a step of CVODE, and what is looked for inside it.
#include "cvode_impl.h"
#include "implementation.hpp"
#include "start.hpp"
#include "state_vector.hpp"
#include "step_control.hpp"

namespace integrator {
namespace {

using Self = Integrator::Implementation;

constexpr int reached = static_cast<int>(Outcome::reached);

void stop_at(Progress& progress, double t, Outcome why) {
  progress.known_until = progress.event_time = t;
  progress.pending = static_cast<int>(why);
}

// First zero of g, which is g_start and g_end at the ends of the last step: also where it dips below zero between them.
// The start of high order is as long as five steps of CVODE: it is looked at in pieces.
bool find_zero_in_step(const Integrator& solution, const Self& self, Watched g, double g_start, double g_end,
                       int pieces, double* t_zero) {
  const double start = self.progress.step_start, end = self.progress.known_until;
  Bracket piece = {start, g_start, start, g_start};
  for (int i = 1; i <= pieces; ++i) {
    piece.t_lo = piece.t_hi, piece.g_lo = piece.g_hi;
    piece.t_hi = i == pieces ? end : start + i * ((end - start) / pieces);
    double y[max_states];
    if (i < pieces) solution.read(piece.t_hi, y);
    piece.g_hi = i == pieces ? g_end : g(self.system.owner, piece.t_hi, y);
    if (find_first_zero(solution, self.system, g, piece, t_zero)) return true;
  }
  return false;
}

void watch_event(const Integrator& solution, Self& self, double event_before, int pieces) {
  Progress& progress = self.progress;
  double t_zero;
  if (progress.armed && progress.pending == reached &&
      find_zero_in_step(solution, self, self.system.event, event_before, progress.last_event_value, pieces, &t_zero))
    stop_at(progress, t_zero, Outcome::event);
}

void watch_boundary(const Integrator& solution, Self& self, int pieces) {
  Progress& progress = self.progress;
  const System& system = self.system;
  if (!system.near_boundary(system.owner, data(self.y))) return;
  double y[max_states], t_zero;
  solution.read(progress.step_start, y);
  const double before = system.boundary(system.owner, progress.step_start, y);
  solution.read(progress.known_until, y);
  const double after = system.boundary(system.owner, progress.known_until, y);
  if (find_zero_in_step(solution, self, system.boundary, before, after, pieces, &t_zero))
    stop_at(progress, t_zero, Outcome::ended);
}

// One step of CVODE, from t; false where it fails.
bool step_on(Integrator& solution, Self& self, double t) {
  auto& m = *static_cast<CVodeMem>(self.cvode);
  Progress& progress = self.progress;
  const auto step_once = [&] {
    return CVode(&m, t + self.system.longest_step, self.y, &progress.known_until, CV_ONE_STEP);
  };
  if (m.cv_nst == 0) fit_before_stop(m);
  int flag = step_once();
  // A bend of the right-hand side (an input whose slope changed) can be too much for a history of high order.
  if ((flag == CV_ERR_FAILURE || flag == CV_CONV_FAILURE) && progress.step_start < t &&
      solution.restart(t, data(self.y), progress.armed != 0))
    flag = step_once();
  if (flag < 0) return progress.known_until = t, false;
  if (self.system.method == Method::adams) follow_trend(m, &progress.trend);
  progress.step_start = t;
  if (flag == CV_ROOT_RETURN) stop_at(progress, progress.known_until, Outcome::event);
  return true;
}

}  // namespace

bool take_step(Integrator& solution) {
  Self& self = *solution.self;
  Progress& progress = self.progress;
  const double event_before = progress.last_event_value;
  const bool high =
      self.system.method == Method::adams && !has_history(*static_cast<CVodeMem>(self.cvode)) && start_high(self);
  if (!high && !step_on(solution, self, progress.known_until)) return false;
  if (high && progress.armed)
    progress.last_event_value = self.system.event(self.system.owner, progress.known_until, data(self.y));
  ++progress.counters.steps;
  const int pieces = high ? 4 : 1;
  watch_event(solution, self, event_before, pieces);
  watch_boundary(solution, self, pieces);
  return true;
}

}  // namespace integrator
