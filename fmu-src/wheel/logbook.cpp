// Messages of a run's events, with instants on the caller's clock.
#include "logbook.hpp"

#include <cstdio>

#include "law.hpp"

namespace wheel {
namespace {

// An instant for messages: it is not found more exactly than to a nanosecond.
double instant_of(const Setup& setup, double t) {
  const double time = setup.start_time + t;
  return std::fabs(time) < 1e6 ? std::nearbyint(time * 1e9) / 1e9 : time;
}

}  // namespace

Consequence pass_event(Wheel& wheel, Event event) {
  Run& run = wheel.run;
  const EventRow& row = row_of(event);
  const WheelFriction before = run.in_force.scene.friction;
  const bool slid = run.in_force.slides();
  const Consequence consequence = row.follow(wheel.setup, event, run.t, run.y, run.in_force);
  if (is_observed(row, wheel.setup) && run.in_force.is_below(event)) count_event(wheel, event, run.t);
  log_transition(wheel, before);
  log_contact(wheel, slid, event != Event::slip_ends);
  return consequence;
}

void count_event(Wheel& wheel, Event event, double t) {
  Tally& tally = wheel.run.tallies[static_cast<int>(event)];
  tally.last = t;
  if (tally.count++ >= logged_one_by_one) return;
  wheel.reporter.log(Topic::warning, "t = %s s: %s.", instant_of(wheel.setup, t), row_of(event).observed);
}

// A change to another law is not a transition.
void log_transition(Wheel& wheel, const WheelFriction& before) {
  const WheelFriction& friction = wheel.run.in_force.scene.friction;
  const auto is_exact = [](WheelFrictionKind law) { return law == WHEEL_ROLLING || law == WHEEL_HELD; };
  if (!is_exact(before.kind) || !is_exact(friction.kind) || !differ(before, friction)) return;
  ++wheel.run.transitions;
  const double instant = instant_of(wheel.setup, wheel.run.t);
  const char* const change = before.kind == WHEEL_HELD ? "release" : "reversal";
  if (friction.kind == WHEEL_HELD)
    wheel.reporter.log(Topic::event, "t = %s s: stick, omega_z is held at zero.", instant);
  else
    wheel.reporter.log(Topic::event, "t = %s s: %s, omega_z becomes %s.", instant, change,
                       friction.sigma > 0 ? "positive" : "negative");
}

void log_contact(Wheel& wheel, bool slid, bool goes_on) {
  const bool slides = wheel.run.in_force.slides();
  if (slides == slid && (goes_on || !slides)) return;
  ++wheel.run.transitions;
  wheel.reporter.log(Topic::event, "t = %s s: the wheel %s.", instant_of(wheel.setup, wheel.run.t),
                     !slides ? "stops sliding"
                     : slid  ? "slides in another direction"
                             : "starts to slide");
}

void warn_of_grip(Wheel& wheel, double t, const double* y) {
  constexpr double looks = 16, dry_road = 1;
  const Setup& setup = wheel.setup;
  const WheelScene scene = wheel.run.in_force.scene_at(t);
  WheelDynamics dynamics;
  setup.formulation->dynamics(&scene, y, &dynamics);
  const double mu = wheel_required_friction(dynamics.lambda);
  const bool exceeds = std::isfinite(mu) && mu > dry_road;
  wheel.run.grip_due = exceeds ? solver::never : t + setup.own_time / looks;
  if (exceeds)
    wheel.reporter.log(Topic::warning,
                       "t = %s s: mu_required = %s, more than a dry road gives; mu_max = 0 sets no limit.",
                       instant_of(setup, t), Digits{mu, 3});
}

void warn_of_jam(const Wheel& wheel, const WheelScene& ahead, const double* y) {
  InForce now = wheel.run.in_force;
  now.scene = ahead;
  if (now.slides() && margin_of(row_of(Event::jams), wheel.setup, now, wheel.run.t, y) < 0)
    wheel.reporter.log(Topic::warning, "t = %s s: the wheel %s.", instant_of(wheel.setup, wheel.run.t),
                       ending_of(now, Event::jams).text);
}

void log_ending(Wheel& wheel, Event event) {
  const Run& run = wheel.run;
  const Setup& setup = wheel.setup;
  if (wheel.endings++ >= logged_one_by_one) return;
  constexpr double rounding = 1e-15;  // of the cosine of a right angle
  if (event == Event::fell_flat && setup.tilting == 0 &&
      std::fabs(std::cos(setup.start[setup.formulation->tilt_index])) < rounding)
    wheel.reporter.log(Topic::warning,
                       "The wheel started exactly upright: unless a load tipped it, rounding decided when and to which "
                       "side; guided = true keeps it upright.");
  wheel.reporter.log(Topic::discard, "The wheel %s at t = %s s, theta = %s rad: the run ends there.",
                     ending_of(run.in_force, event).text, setup.start_time + run.t,
                     Digits{run.y[setup.formulation->tilt_index], 6});
  if (wheel.endings == logged_one_by_one)
    wheel.reporter.log(Topic::discard, "%s ends were logged; further ones are not logged until a reset.",
                       static_cast<double>(logged_one_by_one));
}

void log_summaries(const Wheel& wheel) {
  for (const EventRow& row : event_rows) {
    const Tally& tally = wheel.run.tallies[static_cast<int>(row.event)];
    if (row.observed && tally.count > logged_one_by_one)
      wheel.reporter.log(Topic::warning, "%s times, of which the first %s were logged, last at t = %s s: %s.",
                         static_cast<double>(tally.count), static_cast<double>(logged_one_by_one),
                         instant_of(wheel.setup, tally.last), row.observed);
  }
}

Ending ending_of(const InForce& now, Event event) {
  Ending ending;
  const EventRow& row = row_of(event);
  const NumberText limit(Digits{row.limit ? row.limit(now) : 0});
  std::snprintf(ending.text, sizeof ending.text, "%s%s%s", row.ending, row.limit ? " = " : "",
                row.limit ? limit.text : "");
  return ending;
}

}  // namespace wheel
