// Model exchange: states, indicators, decisions at events.
#include "exchange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "law.hpp"
#include "logbook.hpp"
#include "motion.hpp"

namespace wheel {
namespace {

// Added to every indicator: one that rests at zero after an event must not count as a second one. At 1e-6 the instants
// would be wrong by as much.
constexpr double distance = 1e-12;

// An event that lies ahead by less than this, in units of the wheel's own time, has happened: some solvers stop a
// little before the sign changes, and would stop there again and again.
constexpr double soon = 1e-7;

constexpr unsigned state_variables[] = {variable::X_O, variable::Y_O,       variable::psi,     variable::theta,
                                        variable::phi, variable::theta_dot, variable::psi_dot, variable::omega_z};
static_assert(std::size(state_variables) == state_count);

auto above_ground(const Setup& setup, const double* y) {
  std::array<double, WHEEL_MAX_STATES> trial = {};
  std::copy_n(y, state_count, trial.data());
  double& theta = trial[setup.formulation->tilt_index];
  theta = std::clamp(theta, flat_angle, 2 * upright - flat_angle);
  return trial;
}

double margin_at(const EventRow& row, const Setup& setup, const InForce& now, double t, const double* y) {
  const bool tilts = row.event == Event::fell_flat;
  return margin_of(row, setup, now, t, tilts ? y : above_ground(setup, y).data());
}

double indicator(const EventRow& row, const Setup& setup, const Run& run) {
  if (!row.can_occur(setup, run.in_force)) return 1;
  return margin_at(row, setup, run.in_force, run.t, run.y) + distance;
}

// Whether the motion can have led the spin across zero, or away from where it was held, within its longest step. Else
// the caller has set it, and it is kept.
bool is_led(const Setup& setup, const Run& run) {
  const WheelScene& scene = run.in_force.scene;
  const double spin = run.y[setup.formulation->spin_index] / setup.rate_scale;
  if (scene.friction.kind == WHEEL_HELD) return std::fabs(spin) <= spin_error;
  double rates[WHEEL_MAX_STATES];
  setup.formulation->derivative(&scene, run.y, rates);
  const double rate = scene.friction.sigma * rates[setup.formulation->spin_index] / setup.rate_scale;
  return scene.friction.sigma * spin >= std::fmin(rate, 0) * setup.longest_step - spin_error;
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

bool has_occurred(const EventRow& row, const Setup& setup, const Run& run) {
  const InForce& now = run.in_force;
  if (!row.exchanged || !row.can_occur(setup, now)) return false;
  if (margin_at(row, setup, now, run.t, run.y) <= 0) return true;
  const double time = soon * setup.own_time;
  double ahead[WHEEL_MAX_STATES], rates[WHEEL_MAX_STATES];
  setup.formulation->derivative(&now.scene, run.y, rates);
  for (int i = 0; i < state_count; ++i) ahead[i] = run.y[i] + time * rates[i];
  return margin_at(row, setup, now, run.t + time, ahead) <= 0;
}

void take_at_once(Wheel& w) {
  InForce& now = w.run.in_force;
  const Road before = now.road;
  let_act(w.setup, road_asked(w.demand), w.run.t, w.demand.inputs, now);
  w.demand.changed = false;
  if (now.road == before || w.phase() == Phase::event_mode) return;
  const WheelFriction law = now.scene.friction;
  decide_law(w.setup, w.run.t, w.run.y, now);
  log_transition(w, law);
}

void states(Wheel& w, double* x) { std::copy_n(w.run.y, state_count, x); }

void nominals(Wheel& w, double* x) { scales_at(w.setup, w.run.y[w.setup.formulation->spin_index], x); }

void derivatives(Wheel& w, double* x_dot) {
  ++w.run.counted.rhs;
  w.setup.formulation->derivative(&w.run.in_force.scene, above_ground(w.setup, w.run.y).data(), x_dot);
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
  InForce& now = run.in_force;
  const WheelFriction law = now.scene.friction;
  const WheelGround ground = now.scene.ground;
  const double spin = run.y[setup.formulation->spin_index];
  const bool led = is_led(setup, run);
  if (law.kind == WHEEL_HELD && led) setup.formulation->stop_spin(&now.scene.wheel, run.y);
  Event ending = Event::none;
  for (const EventRow& row : event_rows)
    if (ends_run(row, setup) && has_occurred(row, setup, run)) ending = row.event;
  if (ending != Event::none) {
    end_run(w, ending);
    return false;
  }
  const EventRow& changes = row_of(Event::spin_changes);
  for (const EventRow& row : event_rows)
    if (&row != &changes && !ends_run(row, setup) && has_occurred(row, setup, run)) pass_event(w, row.event);
  // The law is decided anew in each event mode. A wheel that has just been stopped can be let go at once.
  const auto change = [&] { changes.follow(setup, changes.event, run.t, run.y, now); };
  if (led && has_occurred(changes, setup, run))
    change();
  else
    decide_law(setup, run.t, run.y, now);
  const bool sticks = law.kind != WHEEL_HELD && now.scene.friction.kind == WHEEL_HELD;
  if (sticks && has_occurred(changes, setup, run)) change();
  log_transition(w, law);
  const bool jumps = run.y[setup.formulation->spin_index] != spin;
  return jumps || differ(law, now.scene.friction) || ground != now.scene.ground;
}

bool starts_inside(const Wheel& w) {
  const EventRow* fault = nullptr;
  for (const EventRow& row : event_rows)
    if (ends_run(row, w.setup) && has_occurred(row, w.setup, w.run)) fault = &row;
  if (!fault) return true;
  WheelDynamics dynamics;
  w.setup.formulation->dynamics(&w.run.in_force.scene, w.run.y, &dynamics);
  w.reporter.log(Topic::error, "At the start the wheel %s (N = %s N, mu_required = %s): the run ends there.",
                 ending_of(w.run.in_force, fault->event).text, Digits{dynamics.lambda[2], 6},
                 Digits{wheel_required_friction(dynamics.lambda), 6});
  return false;
}

}  // namespace wheel
