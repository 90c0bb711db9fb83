// The table of events.
#include "events.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "law.hpp"

namespace wheel {
namespace {

bool can_change_layer(const Setup& setup, const InForce& in_force) {
  return setup.has_layer() && in_force.mode().kind != WHEEL_FRICTIONLESS;
}

// (y) => how far the spin is from the edge of the layer
double way_to_layer(const Setup& setup, const InForce& in_force, double, const double* y) {
  const double omega_z = y[WHEEL_OMEGA_3], limit = layer_edge(setup);
  const double inside = limit - std::fabs(omega_z), outside = in_force.mode().sigma * omega_z - limit;
  return (in_force.mode().kind == WHEEL_REGULARIZED ? inside : outside) / setup.rate_scale;
}

// In model exchange a spin that is set on a held wheel, and a brake where there is no friction, ask for a mode.
bool can_change_spin(const Setup& setup, const InForce& in_force) {
  const WheelFrictionKind mode = in_force.mode().kind;
  if (mode == WHEEL_FRICTIONLESS) return setup.model_exchange;
  return mode == WHEEL_HELD || (mode == WHEEL_ROLLING && !setup.has_layer());
}

// (t, y) => how far the mode of friction is from its end: of a wheel that rolls, omega_z over the scale of rates; of
// one that is held, the reserve of holding; without friction, zero until a brake is set, which asks for a mode
double spin_left(const Setup& setup, const InForce& in_force, double t, const double* y) {
  const WheelFriction& mode = in_force.mode();
  const double spin = y[WHEEL_OMEGA_3] / setup.rate_scale;
  if (mode.kind == WHEEL_ROLLING) return mode.sigma * spin;
  if (mode.kind == WHEEL_HELD)
    return has_left_hold(setup, y) ? -std::fabs(spin)
                                   : hold_at(setup, in_force.scene_at(t), y).reserve / setup.moment_scale;
  return -in_force.scene_at(t).load.brake / setup.moment_scale;
}

int spin_alone(const InForce& in_force) {
  return in_force.mode().kind == WHEEL_ROLLING ? WHEEL_OMEGA_3 : all_states(in_force);
}

void change_spin(const Setup& setup, double t, double* y, InForce& in_force) {
  const WheelFrictionKind mode = in_force.mode().kind;
  if (mode != WHEEL_FRICTIONLESS) y[WHEEL_OMEGA_3] = 0;
  mode == WHEEL_HELD ? release(setup, t, y, in_force) : decide_mode(setup, t, y, in_force);
}

bool is_sliding(const Setup&, const InForce& in_force) { return in_force.slides(); }

// (t, y) => slip above the least; what is left of it at its end falls at once
double slip_left(const Setup& setup, const InForce& in_force, double t, const double* y) {
  CONSTANT(double, near, 1e3, "least slips", "farther from its end a slip cannot fall to it before the next sample");
  double least = least_slip(setup, t);
  if (y[WHEEL_SLIP] < near * least) {  // a slip that falls or turns faster than by g needs more digits of the instant
    const Rates rates = rates_of(setup, in_force.scene_at(t), y);
    const double fall = std::fmin(rates.y_dot[WHEEL_SLIP], 0), turning = y[WHEEL_SLIP] * rates.y_dot[WHEEL_CHI];
    const double rate = std::sqrt(fall * fall + turning * turning);
    least *= std::fmax(1, rate * setup.time_scale * setup.time_scale / setup.length);
  }
  return (y[WHEEL_SLIP] - least) / setup.slip_scale;
}

void end_slip(const Setup& setup, double t, double* y, InForce& in_force) {
  y[WHEEL_SLIP] = 0;
  decide_contact(setup, t, y, in_force);
}

bool always(const Setup&, const InForce&) { return true; }
bool always_ends(const Setup&) { return true; }

// (N) => N over the weight
double contact_left(const Setup& setup, const double*, double N) { return N / setup.weight; }
// (N) => below zero where it is infinite: the wheel jams
double jam_left(const Setup&, const double*, double N) { return N < solver::never ? 1 : -1; }
// (y) => rad from where the wheel counts as flat
double lean_left(const Setup&, const double* y, double) { return angle_from_flat(y[WHEEL_THETA]) - flat_angle; }

void change_layer(const Setup& setup, double t, double* y, InForce& in_force) { decide_mode(setup, t, y, in_force); }

}  // namespace

constexpr EventRow event_rows[] = {
    {.event = Event::changes_layer,
     .can_occur = can_change_layer,
     .value = way_to_layer,
     .in_model_exchange = false,  // it leaves the law to the caller's solver
     .follow = change_layer},
    {.event = Event::spin_changes,
     .can_occur = can_change_spin,
     .value = spin_left,
     .state = spin_alone,
     .follow = change_spin},
    {.event = Event::lost_grip,
     .can_occur = [](const Setup& setup,
                     const InForce& in_force) { return is_limited(setup, in_force.road) && !in_force.slides(); },
     .value = grip_left,
     .ends = [](const Setup& setup) { return !setup.can_slide(); },
     .follow = begin_slide,
     .ending = "needs a friction coefficient above mu_max",
     .limit = [](const InForce& in_force) { return in_force.road.mu_max; }},
    {.event = Event::slip_ends,
     .can_occur = is_sliding,
     .value = slip_left,
     .in_model_exchange = false,
     .follow = end_slip,
     .slides_anew = true},
    {.event = Event::lost_contact,
     .can_occur = always,
     .quick_value = contact_left,
     .rounding = 1e-9,
     .ends = [](const Setup& setup) { return !setup.keep_contact; },
     .bends_friction = true,
     .ending = "lifted off the road",
     .observation = "the road pulls, and the wheel would lift off without keep_contact"},
    {.event = Event::jams,
     .can_occur = is_sliding,
     .quick_value = jam_left,
     .in_model_exchange = false,
     .ends = always_ends,
     .ending = "jams (Painleve's paradox) with mu_slide",
     .limit = [](const InForce& in_force) { return in_force.mu_slide(); }},
    {.event = Event::lies_flat,
     .can_occur = always,
     .quick_value = lean_left,
     .needs_N = false,
     .ends = always_ends,
     .ending = "lies flat"},
};

namespace {

// A row that does not always end the run bends the motion, or has a text for what is observed.
constexpr bool is_sound(const EventRow& row) {
  return row.event == static_cast<Event>(&row - event_rows + 1) && !row.value == !!row.quick_value && row.can_occur &&
         !row.ends == !row.ending && (row.follow || row.observation || row.ends == always_ends);
}
static_assert(std::size(event_rows) == row_count && row_count <= solver::max_watched);
static_assert(std::all_of(event_rows, event_rows + row_count, is_sound), "order of Event, one value, what follows");

// Extreme loads on a tiny wheel would overflow, but a saved state holds margins as finite numbers.
constexpr double largest_margin = 1e100;

void change_side(Event event, InForce& in_force) { in_force.set_below(event, !in_force.is_below(event)); }

// (value) => margin: below zero where the event has occurred. That of an observed event is the margin of its next
// change: where the value lies below zero already, it falls to zero as the value rises.
double signed_margin(const EventRow& row, const InForce& in_force, double value) {
  return row.observation ? (in_force.is_below(row.event) ? -value : value) + row.rounding : value;
}

}  // namespace

Consequence follow_event(const EventRow& row, const Setup& setup, double t, double* y, InForce& in_force) {
  if (row.follow) row.follow(setup, t, y, in_force);
  if (row.observation) change_side(row.event, in_force);
  const bool has_friction = in_force.mode().kind != WHEEL_FRICTIONLESS || in_force.slides();
  return row.follow || (row.bends_friction && has_friction) ? Consequence::bends : Consequence::goes_on;
}

double margin_of(const EventRow& row, const Setup& setup, const InForce& in_force, double t, const double* y) {
  const auto normal_force = [&] { return row.needs_N ? rates_of(setup, in_force.scene_at(t), y).N : 0; };
  const double value = row.value ? row.value(setup, in_force, t, y) : row.quick_value(setup, y, normal_force());
  return std::clamp(signed_margin(row, in_force, value), -largest_margin, largest_margin);
}

double least_margin(const Setup& setup, const InForce& in_force, const double* y, double N) {
  double least = solver::never;
  const auto take = [&]<std::size_t i>() {
    constexpr const EventRow& row = event_rows[i];
    if constexpr (row.quick_value != nullptr) {
      if (!row.can_occur(setup, in_force)) return;
      if (const double margin = signed_margin(row, in_force, row.quick_value(setup, y, N)); margin < least)
        least = margin;
    }
  };
  // By index, so that the compiler inlines the values: a plain loop costs 2 % of a motion's instructions.
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (take.template operator()<i>(), ...);
  }(std::make_index_sequence<row_count>());
  return least < -largest_margin ? -largest_margin : least;
}

void set_sides(const Setup& setup, double t, const double* y, InForce& in_force) {
  for (const EventRow& row : event_rows)
    if (is_observed(row, setup) && row.can_occur(setup, in_force) && margin_of(row, setup, in_force, t, y) < 0)
      change_side(row.event, in_force);
}

}  // namespace wheel
