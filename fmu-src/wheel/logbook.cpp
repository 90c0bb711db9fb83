// Messages of a run's events, with instants on the caller's clock.
#include "logbook.hpp"

#include <cstdio>

#include "constant.hpp"
#include "events.hpp"
#include "law.hpp"

namespace wheel {
double shown_time(const Wheel& wheel, double t) {
  const double time = wheel.demand.start_time + t;
  return std::fabs(time) < 1e6 ? std::nearbyint(time * 1e9) / 1e9 : time;
}

void log_observation(Wheel& wheel, Event event, double t) {
  bool& observed = wheel.run.logged[static_cast<int>(event)];
  if (!observed)
    wheel.reporter.log(Topic::warning, "t = %s s: %s.", shown_time(wheel, t), event_row(event).observation);
  observed = true;
}

void look_at_grip(Wheel& wheel, double t) {
  CONSTANT(double, looks, 16, "in a time scale", "at most: enough to see a swing, so few that they cost nothing");
  CONSTANT(double, dry_road, 1, "1", "the friction coefficient of a good tyre on a dry road");
  const Setup& setup = wheel.setup;
  const InForce& in_force = wheel.run.in_force;
  t = std::fmin(t, wheel.solver.known_until());
  if (t < wheel.run.grip_due || is_limited(setup, in_force.road)) return;
  double y[max_states];
  wheel.solver.read(t, y);
  const double mu = wheel_required_friction(dynamics_of(setup, in_force.scene_at(t), y).lambda);
  const bool exceeds = std::isfinite(mu) && mu > dry_road;
  wheel.run.grip_due = exceeds ? solver::never : t + setup.time_scale / looks;
  if (exceeds)
    wheel.reporter.log(Topic::warning,
                       "t = %s s: mu_required = %s, more than a dry road gives; mu_max = 0 sets no limit.",
                       shown_time(wheel, t), Digits{mu, 3});
}

void warn_of_jam(const Wheel& wheel) {
  if (!wheel.setup.can_slide() || !takes_effect(wheel)) return;
  double y[max_states];
  read_state(wheel, y);
  const InForce in_force = in_force_now(wheel, y);
  if (in_force.slides() && margin_of(event_row(Event::jams), wheel.setup, in_force, wheel.run.t, y) < 0)
    wheel.reporter.log(Topic::warning, "t = %s s: the wheel %s.", shown_time(wheel, wheel.run.t),
                       ending_of(in_force, Event::jams).text);
}

void log_ending(Wheel& wheel, Event event) {
  constexpr long long most_logged = 100;
  const Run& run = wheel.run;
  const Setup& setup = wheel.setup;
  if (wheel.endings++ >= most_logged) return;
  constexpr double rounding = 1e-15;  // of the cosine of a right angle
  if (event == Event::lies_flat && setup.tilting == 0 &&
      std::fabs(std::cos(setup.initial_state[WHEEL_THETA])) < rounding)
    wheel.reporter.log(Topic::warning,
                       "The wheel started exactly upright: unless a force tipped it, rounding decided when and to "
                       "which side; guided = true keeps it upright.");
  if (event == Event::lost_contact && run.in_force.scene_at(run.t).load.F[2] > 0)
    wheel.reporter.log(Topic::warning, "F_Z > 0 lifts the wheel; a load on it is a negative F_Z.");
  wheel.reporter.log(Topic::discard, "The wheel %s at t = %s s, theta = %s rad: the run ends there.",
                     ending_of(run.in_force, event).text, wheel.time(), Digits{run.y()[WHEEL_THETA], 6});
  if (wheel.endings == most_logged)
    wheel.reporter.log(Topic::discard, "%lld ends were logged; further ones are not logged until a reset.",
                       most_logged);
}

Ending ending_of(const InForce& in_force, Event event) {
  Ending ending;
  NumberText limit;
  const EventRow& row = event_row(event);
  std::snprintf(ending.text, sizeof ending.text, "%s%s%s", row.ending, row.limit ? " = " : "",
                row.limit ? limit.of({row.limit(in_force)}) : "");
  return ending;
}

}  // namespace wheel
