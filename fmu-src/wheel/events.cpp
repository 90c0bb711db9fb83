// The table of events, and how they are passed, counted and logged.
#include "events.hpp"

#include <cstdio>
#include <iterator>

namespace wheel {
namespace {

// An input that varies can make a regularized law stiff.
bool varies_and_can_stiffen(const Setup& setup, const InForce& now) {
  return now.inputs.varies && can_stiffen(setup, now);
}

double softness(const Setup& setup, const InForce& now, double t, const double* y) {
  return layer_margin(setup, now.scene_at(t), y);
}

// The law that is decided where the layer of a stiff regularized law is entered, left, or begins to hold the wheel.
bool is_passing(const Setup&, const InForce& now) { return now.layer == Layer::passing; }
bool is_layered(const Setup&, const InForce& now) { return now.layer != Layer::none; }

// What holding leaves unused.
double holding_left(const Setup& setup, const InForce& now, double t, const double* y) {
  return holding_margin(setup, now.scene_at(t), y) / setup.moment_scale;
}

double holding_lacks(const Setup& setup, const InForce& now, double t, const double* y) {
  return -holding_left(setup, now, t, y);
}

double way_to_edge(const Setup& setup, const InForce& now, double, const double* y) {
  const double omega_z = y[setup.formulation->spin_index], edge = layer_edge(setup);
  const bool outside = now.layer == Layer::outside;
  return (outside ? now.scene.friction.sigma * omega_z - edge : edge - std::fabs(omega_z)) / setup.rate_scale;
}

Consequence change_layer(const Setup& setup, Event, double t, double* y, InForce& now) {
  decide_law(setup, t, y, now);
  return Consequence::bends;
}

// How far the mode of friction is from its end: rolling, omega_z over the wheel's own rate; held, what holding leaves
// unused. In model exchange a spin that is set on a held wheel, and a brake where there is no friction, ask for a law.
bool can_change_spin(const Setup& setup, const InForce& now) {
  const WheelFrictionKind law = now.scene.friction.kind;
  if (law == WHEEL_FRICTIONLESS) return setup.kind == Kind::model_exchange;
  return law == WHEEL_HELD || (law == WHEEL_ROLLING && now.layer == Layer::none);
}

double spin_left(const Setup& setup, const InForce& now, double t, const double* y) {
  const WheelFriction& law = now.scene.friction;
  const double spin = y[setup.formulation->spin_index] / setup.rate_scale;
  if (law.kind == WHEEL_ROLLING) return law.sigma * spin;
  if (law.kind == WHEEL_HELD) return std::fabs(spin) > spin_error ? -std::fabs(spin) : holding_left(setup, now, t, y);
  return -now.scene.load.brake / setup.moment_scale;
}

Consequence change_spin(const Setup& setup, Event, double t, double* y, InForce& now) {
  const WheelFrictionKind law = now.scene.friction.kind;
  if (law != WHEEL_FRICTIONLESS) setup.formulation->stop_spin(&now.scene.wheel, y);
  decide_law(setup, t, y, now, law == WHEEL_HELD);
  return Consequence::bends;
}

// (mu_max N)^2 - lambda_t^2 over the weight squared, below zero too where the ground pulls.
double grip_left(const Setup& setup, const InForce& now, double t, const double* y) {
  const WheelScene scene = now.scene_at(t);
  WheelDynamics dynamics;
  setup.formulation->dynamics(&scene, y, &dynamics);
  const double* lambda = dynamics.lambda;
  const double X = lambda[0] / setup.weight, Y = lambda[1] / setup.weight;
  const double normal = setup.mu_max * (lambda[2] / setup.weight);
  constexpr double rounding = 1e-12;
  return normal * std::fabs(normal) - (X * X + Y * Y) + rounding;
}

bool always(const Setup&, const InForce&) { return true; }
bool always_ends(const Setup&) { return true; }

double contact_left(const Setup& setup, const InForce& now, double t, const double* y) {
  double y_dot[WHEEL_MAX_STATES];
  const WheelScene scene = now.scene_at(t);
  return pressure_of(setup, setup.formulation->derivative(&scene, y, y_dot));
}

// The ground begins to pull or to press. Without friction the motion goes on as it was.
Consequence change_contact(const Setup&, Event event, double, double*, InForce& now) {
  now.set_below(event, !now.is_below(event));
  return now.scene.friction.kind == WHEEL_FRICTIONLESS ? Consequence::goes_on : Consequence::bends;
}

// Model exchange leaves a stiff law to the caller's solver.
constexpr EventRow layer_event(Event event, decltype(EventRow::can_occur) can_occur, decltype(EventRow::value) value) {
  return {.event = event, .can_occur = can_occur, .value = value, .exchanged = false, .follow = change_layer};
}

}  // namespace

const EventRow event_rows[] = {
    layer_event(Event::stiffens, varies_and_can_stiffen, softness),
    layer_event(Event::sticks_in_layer, is_passing, holding_lacks),
    layer_event(Event::crosses_layer, is_layered, way_to_edge),
    {.event = Event::spin_changes, .can_occur = can_change_spin, .value = spin_left, .follow = change_spin},
    {.event = Event::lost_grip,
     .can_occur = [](const Setup& setup, const InForce&) { return setup.mu_max > 0; },
     .value = grip_left,
     .ends = always_ends,
     .ending = "needs a coefficient of friction above mu_max = %s",
     .ended = "The wheel %s at t = %s s, theta = %s rad: a model without slip ends here.",
     .refused = "At the start, where N = %s N, the wheel needs a coefficient of friction of %s, above mu_max = %s."},
    {.event = Event::lost_contact,
     .can_occur = always,
     .value = contact_left,
     .rounding = pressure_rounding,
     .by_margin = true,
     .ends = [](const Setup& setup) { return !setup.keep_contact; },
     .follow = change_contact,
     .ending = "lifted off the ground",
     .ended = "The wheel %s at t = %s s, theta = %s rad: the model ends there.",
     .refused = "The ground does not press on the wheel at the start: N = %s N.",
     .observed = "The ground pulls from t = %s s on: keep_contact holds a wheel that would have lifted off.",
     .summary = "The ground has pulled %s times, of which the first %s were logged; last from t = %s s on."},
    {.event = Event::fell_flat,
     .can_occur = always,
     .value = [](const Setup& setup, const InForce&, double, const double* y) { return height_of(setup, y); },
     .by_margin = true,
     .ends = always_ends,
     .ending = "fell flat",
     .ended = "The wheel %s at t = %s s: the model ends there.",
     .refused = "The wheel lies flat at the start: N = %s N."},
};
static_assert(std::size(event_rows) == row_count && row_count <= solver::max_watched);

namespace {

// An instant for messages: it is not found more exactly than to a nanosecond.
double instant_of(const Setup& setup, double t) {
  const double time = setup.start_time + t;
  return std::fabs(time) < 1e6 ? std::nearbyint(time * 1e9) / 1e9 : time;
}

}  // namespace

Consequence observe(const Setup&, Event event, double, double*, InForce& now) {
  now.set_below(event, !now.is_below(event));
  return Consequence::goes_on;
}

double margin_of(const EventRow& row, const Setup& setup, const InForce& now, double t, const double* y) {
  if (!row.observed) return row.value(setup, now, t, y);
  const double value = row.value(setup, now, t, y);
  return (now.is_below(row.event) ? -value : value) + row.rounding;
}

void place_observed(const Setup& setup, double t, const double* y, InForce& now) {
  for (const EventRow& row : event_rows)
    if (is_observed(row, setup) && row.can_occur(setup, now) && margin_of(row, setup, now, t, y) < 0)
      now.set_below(row.event, !now.is_below(row.event));
}

Consequence pass_event(const Setup& setup, Event event, Run& run, const Reporter& reporter) {
  const EventRow& row = row_of(event);
  const WheelFriction before = run.in_force.scene.friction;
  const Consequence consequence = row.follow(setup, event, run.t, run.y, run.in_force);
  if (is_observed(row, setup) && run.in_force.is_below(event)) count_event(setup, event, run.t, run, reporter);
  log_transition(setup, before, run, reporter);
  return consequence;
}

void count_event(const Setup& setup, Event event, double t, Run& run, const Reporter& reporter) {
  Tally& tally = run.tallies[static_cast<int>(event)];
  tally.last = t;
  if (tally.count++ >= logged_one_by_one) return;
  reporter.log(Topic::warning, row_of(event).observed, instant_of(setup, t));
}

// A change to another law is not a transition.
void log_transition(const Setup& setup, const WheelFriction& before, Run& run, const Reporter& reporter) {
  const WheelFriction& friction = run.in_force.scene.friction;
  const auto is_exact = [](WheelFrictionKind law) { return law == WHEEL_ROLLING || law == WHEEL_HELD; };
  if (!is_exact(before.kind) || !is_exact(friction.kind) || !differ(before, friction)) return;
  ++run.transitions;
  const double instant = instant_of(setup, run.t);
  const char* const change = before.kind == WHEEL_HELD ? "release" : "reversal";
  if (friction.kind == WHEEL_HELD)
    reporter.log(Topic::event, "t = %s s: stick, omega_z is held at zero.", instant);
  else
    reporter.log(Topic::event, "t = %s s: %s, omega_z becomes %s.", instant, change,
                 friction.sigma > 0 ? "positive" : "negative");
}

void log_summaries(const Setup& setup, const Run& run, const Reporter& reporter) {
  for (const EventRow& row : event_rows) {
    const Tally& tally = run.tallies[static_cast<int>(row.event)];
    if (row.summary && tally.count > logged_one_by_one)
      reporter.log(Topic::warning, row.summary, static_cast<double>(tally.count),
                   static_cast<double>(logged_one_by_one), instant_of(setup, tally.last));
  }
}

Ending ending_of(const Setup& setup, Event event) {
  Ending ending;
  std::snprintf(ending.text, sizeof ending.text, row_of(event).ending, NumberText(Digits{setup.mu_max}).text);
  return ending;
}

}  // namespace wheel
