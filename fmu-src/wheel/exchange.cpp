// Model exchange: states, indicators, decisions at events, by the functions that co-simulation uses.
#include "exchange.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "constant.hpp"
#include "events.hpp"
#include "law.hpp"
#include "logbook.hpp"
#include "transitions.hpp"

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

// (x, and y there) => x_dot, under what is in force
void rates_of_x(const Record& r, const double* x, const double* y, double* x_dot) {
  wheel_euler_rates(x, rates_of(r.setup, r.run.in_force.scene_at(r.run.t), y).y_dot, x_dot);
}

// (row, ahead: s) => its margin at the instant reached, or `ahead` later along the present rates
double margin_at(const EventRow& row, const Record& r, double ahead = 0) {
  double x[state_count], x_dot[state_count], y[max_states] = {};
  std::copy_n(r.run.x(), state_count, x);
  if (ahead > 0) {
    rates_of_x(r, r.run.x(), r.run.y(), x_dot);
    for (int i = 0; i < state_count; ++i) x[i] += ahead * x_dot[i];
  }
  if (row.event != Event::lies_flat) keep_above_ground(x);
  wheel_reduced_state(x, y);
  return margin_of(row, r.setup, r.run.in_force, r.run.t + ahead, y);
}

double indicator(const EventRow& row, const Record& r) {
  return row.can_occur(r.setup, r.run.in_force) ? margin_at(row, r) + distance : 1;
}

// Whether an event has occurred at the instant reached, or lies so close ahead that it counts as occurred. Of an
// observed event the side ahead alone counts: a second decision at the same instant changes nothing. Without friction
// `spin_changes` always has occurred, by its value of zero; then the mode is decided, as it is without the event.
bool has_occurred(const EventRow& row, const Record& r) {
  if (!row.in_model_exchange || !row.can_occur(r.setup, r.run.in_force)) return false;
  const bool now = !is_observed(row, r.setup) && margin_at(row, r) <= 0;
  return now || margin_at(row, r, soon * r.setup.time_scale) <= 0;
}

// Whether the motion can have led the spin across zero, or away from where it was held, within its longest step. If
// not, the caller has set the spin, and it is kept.
bool is_led(const Record& r) {
  const WheelScene scene = r.run.in_force.scene_at(r.run.t);
  const double spin = r.run.y()[WHEEL_OMEGA_3] / r.setup.rate_scale;
  if (scene.friction.kind == WHEEL_HELD) return !has_left_hold(r.setup, r.run.y());
  const double omega_z_dot = rates_of(r.setup, scene, r.run.y()).y_dot[WHEEL_OMEGA_3];
  const double rate = scene.friction.sigma * omega_z_dot / r.setup.rate_scale;
  return scene.friction.sigma * spin >= std::fmin(rate, 0) * r.setup.longest_step - spin_error;
}

// The event by which the model ends at the instant reached.
Event ending_at(const Record& r) {
  Event ending = Event::none;
  for (const EventRow& row : event_rows)
    if (ends_run(row, r.setup) && has_occurred(row, r)) ending = row.event;
  return ending;
}

}  // namespace

int indicator_count() {
  const auto is_exchanged = [](const EventRow& row) { return row.in_model_exchange; };
  return static_cast<int>(std::count_if(std::begin(event_rows), std::end(event_rows), is_exchanged));
}

int place_in_x(unsigned variable) {
  for (int i = 0; i < state_count; ++i)
    if (states_of_x[i].variable == variable) return i;
  return -1;
}

int place_in_y(int in_x) { return states_of_x[in_x].in_y; }

void act_at_once(Wheel& w) {
  InForce& in_force = w.run.in_force;
  const InForce before = in_force;
  in_force.take_over(w.setup, road_asked(w.demand), w.run.t, w.demand.inputs);
  w.run.pending = Pending::nothing;
  if (in_force.road == before.road || w.run.phase == Phase::event_mode) return;
  decide_mode(w.setup, w.run.t, w.run.y(), in_force);
  note_changes(w, before);
}

// A model that has ended stays ended: some importers go on to continuous-time mode before they heed the event info.
void enter_mode(Wheel& w, Phase phase) {
  if (w.run.phase != Phase::ended) w.run.phase = phase;
}

void set_time(Wheel& w, double time) { w.run.set_time_alone(time - w.demand.start_time); }

void try_states(Wheel& w, const double* x) { w.run.set_x(x); }

void impose_state(Wheel& w, unsigned variable, double value) {
  double x[state_count];
  read_states(w, x);
  x[place_in_x(variable)] = value;
  w.run.set_x(x);
  decide_mode(w.setup, w.run.t, w.run.y(), w.run.in_force);
}

void read_states(const Wheel& w, double* x) { std::copy_n(w.run.x(), state_count, x); }

void read_nominals(const Wheel& w, double* x) {
  double scales[max_states];
  scales_at(w.setup, w.run.y()[WHEEL_OMEGA_3], scales);
  for (int i = 0; i < state_count; ++i) x[i] = scales[place_in_y(i)];
}

void read_derivatives(Wheel& w, double* x_dot) {
  double x[state_count], y[max_states] = {};
  std::copy_n(w.run.x(), state_count, x);
  keep_above_ground(x);
  wheel_reduced_state(x, y);
  ++w.run.counted.rhs;
  rates_of_x(w, x, y, x_dot);
}

void read_indicators(Wheel& w, double* z) {
  ++w.run.counted.roots;
  for (const EventRow& row : event_rows)
    if (row.in_model_exchange) *z++ = indicator(row, w);
}

bool has_event(Wheel& w) {
  ++w.run.counted.roots;
  return std::any_of(std::begin(event_rows), std::end(event_rows),
                     [&](const EventRow& row) { return row.in_model_exchange && indicator(row, w) <= 0; });
}

//   1  a held wheel loses what its spin has of the solver's error
//   2  the run ends where it does so in the mode that held up to here
//   3  what is observed changes its side: the ground may pull from here on
//   4  the mode follows from the motion, or anew where the caller has set the spin
//   5  the run ends where it does so in the mode that was decided
// Of the state, an event changes omega_z alone. The side of the ground counts as a bend even without friction: its
// indicator has changed its sign.
bool decide_in_event_mode(Wheel& w) {
  Run& run = w.run;
  const InForce before = run.in_force;
  const double spin = run.y()[WHEEL_OMEGA_3];
  const bool led = is_led(w);
  const auto pass = [&](Event event) {
    pass_event(w, event);
    run.set_spin(run.y()[WHEEL_OMEGA_3]);
  };
  const auto end_if_due = [&] {
    const Event ending = ending_at(w);
    if (ending != Event::none) end_run(w, ending);
    return ending != Event::none;
  };
  if (before.mode().kind == WHEEL_HELD && led) run.set_spin(0);
  if (end_if_due()) return false;
  for (const EventRow& row : event_rows)
    if (row.event != Event::spin_changes && !ends_run(row, w.setup) && has_occurred(row, w)) pass(row.event);
  if (led && has_occurred(event_row(Event::spin_changes), w)) {
    pass(Event::spin_changes);
  } else {
    const InForce passed = run.in_force;
    decide_mode(w.setup, run.t, run.y(), run.in_force);
    note_changes(w, passed);
  }
  if (end_if_due()) return false;
  return run.y()[WHEEL_OMEGA_3] != spin || differ(before.mode(), run.in_force.mode()) ||
         before.is_below(Event::lost_contact) != run.in_force.is_below(Event::lost_contact);
}

bool starts_inside(const Wheel& w) {
  const Event ending = ending_at(w);
  if (ending == Event::none) return true;
  const WheelDynamics dynamics = dynamics_of(w.setup, w.run.in_force.scene_at(w.run.t), w.run.y());
  w.reporter.log(Topic::error, "At the start the wheel %s (N = %s N, mu_required = %s): the run ends there.",
                 ending_of(w.run.in_force, ending).text, Digits{dynamics.lambda[2], 6},
                 Digits{wheel_required_friction(dynamics.lambda), 6});
  return false;
}

}  // namespace wheel
