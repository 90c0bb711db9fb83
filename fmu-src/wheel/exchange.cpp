// Model exchange: states, indicators, decisions at events, by the functions that co-simulation uses.
#include "exchange.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "events.hpp"
#include "law.hpp"
#include "logbook.hpp"

namespace wheel {
namespace {

// Added to every indicator: one that rests at zero after an event must not count as a second one. At 1e-6 the instants
// would be wrong by as much.
constexpr double distance = 1e-12;

// An event that lies ahead by less than this, in units of the time scale, has happened: some solvers stop a little
// before the sign changes, and would stop there again and again.
constexpr double soon = 1e-7;

constexpr unsigned state_variables[] = {variable::X_O, variable::Y_O,       variable::psi,     variable::theta,
                                        variable::phi, variable::theta_dot, variable::psi_dot, variable::omega_z};
static_assert(std::size(state_variables) == state_count);

void keep_above_ground(const Setup& setup, double* y) {
  double& theta = y[setup.formulation->tilt_index];
  theta = std::clamp(theta, flat_angle, 2 * upright - flat_angle);
}

// (row, ahead: s) => its margin at the instant reached, or `ahead` later along the present rates
double margin_at(const EventRow& row, const Setup& setup, const Run& run, double ahead = 0) {
  double y[WHEEL_MAX_STATES];
  std::copy_n(run.y, WHEEL_MAX_STATES, y);
  if (ahead > 0) {
    const Rates rates = rates_of(setup, run.in_force.scene, run.y);
    for (int i = 0; i < state_count; ++i) y[i] += ahead * rates.y_dot[i];
  }
  if (row.event != Event::lies_flat) keep_above_ground(setup, y);
  return margin_of(row, setup, run.in_force, run.t + ahead, y);
}

double indicator(const EventRow& row, const Setup& setup, const Run& run) {
  return row.can_occur(setup, run.in_force) ? margin_at(row, setup, run) + distance : 1;
}

// Whether an event has occurred at the instant reached, or lies so close ahead that it counts as occurred.
bool has_occurred(const EventRow& row, const Setup& setup, const Run& run) {
  if (!row.exchanged || !row.can_occur(setup, run.in_force)) return false;
  return margin_at(row, setup, run) <= 0 || margin_at(row, setup, run, soon * setup.time_scale) <= 0;
}

// Whether the motion can have led the spin across zero, or away from where it was held, within its longest step. Else
// the caller has set it, and it is kept.
bool is_led(const Setup& setup, const Run& run) {
  const WheelScene& scene = run.in_force.scene;
  const double spin = run.y[setup.formulation->spin_index] / setup.rate_scale;
  if (scene.friction.kind == WHEEL_HELD) return std::fabs(spin) <= spin_error;
  const double omega_z_dot = rates_of(setup, scene, run.y).y_dot[setup.formulation->spin_index];
  const double rate = scene.friction.sigma * omega_z_dot / setup.rate_scale;
  return scene.friction.sigma * spin >= std::fmin(rate, 0) * setup.longest_step - spin_error;
}

// (run) => the event by which the model ends at the instant reached
Event ending_at(const Setup& setup, const Run& run) {
  Event ending = Event::none;
  for (const EventRow& row : event_rows)
    if (ends_run(row, setup) && has_occurred(row, setup, run)) ending = row.event;
  return ending;
}

void decide_friction(const Setup& setup, Run& run, bool led) {
  const EventRow& row = row_of(Event::spin_changes);
  if (led && has_occurred(row, setup, run))
    pass(row, setup, run.t, run.y, run.in_force);
  else
    decide_law(setup, run.t, run.y, run.in_force);
}

}  // namespace

int indicator_count() {
  const auto is_exchanged = [](const EventRow& row) { return row.exchanged; };
  return static_cast<int>(std::count_if(std::begin(event_rows), std::end(event_rows), is_exchanged));
}

int state_index_of(unsigned variable) {
  const auto* found = std::find(std::begin(state_variables), std::end(state_variables), variable);
  return found == std::end(state_variables) ? -1 : static_cast<int>(found - state_variables);
}

void apply_at_once(Wheel& w) {
  InForce& now = w.run.in_force;
  const InForce before = now;
  apply_loads(w.setup, road_asked(w.demand), w.run.t, w.demand.inputs, now);
  w.demand.news = News::none;
  if (now.road == before.road || w.run.phase == Phase::event_mode) return;
  decide_law(w.setup, w.run.t, w.run.y, now);
  log_changes(w, before);
}

void states(Wheel& w, double* x) { std::copy_n(w.run.y, state_count, x); }

void nominals(Wheel& w, double* x) { scales_at(w.setup, w.run.y[w.setup.formulation->spin_index], x); }

void derivatives(Wheel& w, double* x_dot) {
  double y[WHEEL_MAX_STATES];
  std::copy_n(w.run.y, WHEEL_MAX_STATES, y);
  keep_above_ground(w.setup, y);
  ++w.run.counted.rhs;
  w.setup.formulation->derivative(&w.run.in_force.scene, y, x_dot);
}

void indicators(Wheel& w, double* z) {
  ++w.run.counted.roots;
  for (const EventRow& row : event_rows)
    if (row.exchanged) *z++ = indicator(row, w.setup, w.run);
}

bool has_event(Wheel& w) {
  ++w.run.counted.roots;
  return std::any_of(std::begin(event_rows), std::end(event_rows),
                     [&](const EventRow& row) { return row.exchanged && indicator(row, w.setup, w.run) <= 0; });
}

bool decide(Wheel& w) {
  const Setup& setup = w.setup;
  Run& run = w.run;
  const InForce before = run.in_force;
  const WheelFriction& law = before.scene.friction;
  double& omega_z = run.y[setup.formulation->spin_index];
  const double spin = omega_z;
  const bool led = is_led(setup, run);
  if (law.kind == WHEEL_HELD && led) omega_z = 0;
  const auto ends_here = [&] {
    const Event ending = ending_at(setup, run);
    if (ending != Event::none) end_run(w, ending);
    return ending != Event::none;
  };
  if (ends_here()) return false;
  for (const EventRow& row : event_rows)
    if (row.event != Event::spin_changes && !ends_run(row, setup) && has_occurred(row, setup, run))
      pass_event(w, row.event);
  decide_friction(setup, run, led);
  log_changes(w, before);
  if (ends_here()) return false;  // under the law that was decided
  const WheelScene& scene = run.in_force.scene;
  return omega_z != spin || differ(law, scene.friction) || scene.ground != before.scene.ground;
}

bool starts_inside(const Wheel& w) {
  const Event ending = ending_at(w.setup, w.run);
  if (ending == Event::none) return true;
  const WheelDynamics dynamics = dynamics_of(w.setup, w.run.in_force.scene, w.run.y);
  w.reporter.log(Topic::error, "At the start the wheel %s (N = %s N, mu_required = %s): the run ends there.",
                 ending_of(w.run.in_force, ending).text, Digits{dynamics.lambda[2], 6},
                 Digits{wheel_required_friction(dynamics.lambda), 6});
  return false;
}

}  // namespace wheel
