// Model exchange: states, indicators, decisions at events, by the functions that co-simulation uses.
#include "exchange.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "constant.hpp"
#include "events.hpp"
#include "law.hpp"
#include "logbook.hpp"

namespace wheel {
namespace {

CONSTANT(double, distance, 1e-12, "1", "added to every indicator: one at rest at zero is no second event");
CONSTANT(double, soon, 1e-7, "time scales", "an event so close ahead has happened: some solvers stop short of it");

// In the order of x: its variables, and the states of y to which they belong.
constexpr struct {
  unsigned variable;
  int in_y;
} states_of_x[] = {{variable::X_O, WHEEL_X_O},         {variable::Y_O, WHEEL_Y_O},
                   {variable::psi, WHEEL_PSI},         {variable::theta, WHEEL_THETA},
                   {variable::phi, WHEEL_PHI},         {variable::theta_dot, WHEEL_OMEGA_1},
                   {variable::psi_dot, WHEEL_OMEGA_2}, {variable::omega_z, WHEEL_OMEGA_3}};
static_assert(std::size(states_of_x) == state_count);

void keep_above_ground(double* x) {
  double& theta = x[WHEEL_EULER_THETA];
  theta = std::clamp(theta, flat_angle, 2 * upright - flat_angle);
}

// (scene, x, y) => x_dot
void rates_of_x(const Setup& setup, const WheelScene& scene, const double* x, const double* y, double* x_dot) {
  wheel_euler_rates(x, rates_of(setup, scene, y).y_dot, x_dot);
}

// (row, ahead: s) => its margin at the instant reached, or `ahead` later along the present rates
double margin_at(const EventRow& row, const Setup& setup, const Run& run, double ahead = 0) {
  double x[state_count], x_dot[state_count], y[max_states] = {};
  std::copy_n(run.x, state_count, x);
  if (ahead > 0) {
    rates_of_x(setup, run.in_force.scene, run.x, run.y, x_dot);
    for (int i = 0; i < state_count; ++i) x[i] += ahead * x_dot[i];
  }
  if (row.event != Event::lies_flat) keep_above_ground(x);
  wheel_reduced_state(x, y);
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
  const double spin = run.y[WHEEL_OMEGA_3] / setup.rate_scale;
  if (scene.friction.kind == WHEEL_HELD) return std::fabs(spin) <= spin_error;
  const double omega_z_dot = rates_of(setup, scene, run.y).y_dot[WHEEL_OMEGA_3];
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
    follow_event(row, setup, run.t, run.y, run.in_force);
  else
    decide_law(setup, run.t, run.y, run.in_force);
}

// What `decide` does, in y. omega_z is the state that an event changes.
bool decide_anew(Wheel& w) {
  const Setup& setup = w.setup;
  Run& run = w.run;
  const InForce before = run.in_force;
  const WheelFriction& law = before.scene.friction;
  double& omega_z = run.y[WHEEL_OMEGA_3];
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

}  // namespace

int indicator_count() {
  const auto is_exchanged = [](const EventRow& row) { return row.exchanged; };
  return static_cast<int>(std::count_if(std::begin(event_rows), std::end(event_rows), is_exchanged));
}

int place_in_x(unsigned variable) {
  for (int i = 0; i < state_count; ++i)
    if (states_of_x[i].variable == variable) return i;
  return -1;
}

int place_in_y(int in_x) { return states_of_x[in_x].in_y; }

void act_at_once(Wheel& w) {
  InForce& now = w.run.in_force;
  const InForce before = now;
  set_road_and_inputs(w.setup, road_asked(w.demand), w.run.t, w.demand.inputs, now);
  w.demand.news = News::none;
  if (now.road == before.road || w.run.phase == Phase::event_mode) return;
  decide_law(w.setup, w.run.t, w.run.y, now);
  log_changes(w, before);
}

void states(Wheel& w, double* x) { std::copy_n(w.run.x, state_count, x); }

void set_states(Wheel& w, const double* x) {
  std::copy_n(x, state_count, w.run.x);
  wheel_reduced_state(w.run.x, w.run.y);
}

void nominals(Wheel& w, double* x) {
  double scales[max_states];
  scales_at(w.setup, w.run.y[WHEEL_OMEGA_3], scales);
  for (int i = 0; i < state_count; ++i) x[i] = scales[place_in_y(i)];
}

void derivatives(Wheel& w, double* x_dot) {
  double x[state_count], y[max_states] = {};
  std::copy_n(w.run.x, state_count, x);
  keep_above_ground(x);
  wheel_reduced_state(x, y);
  ++w.run.counted.rhs;
  rates_of_x(w.setup, w.run.in_force.scene, x, y, x_dot);
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
  const bool bends = decide_anew(w);
  w.run.x[WHEEL_EULER_OMEGA_Z] = w.run.y[WHEEL_OMEGA_3];  // all that an event changes of the state
  return bends;
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
