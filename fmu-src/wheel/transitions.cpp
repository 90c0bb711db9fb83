// How a run passes an event, what has changed since, and how it ends.
#include "transitions.hpp"

#include "events.hpp"
#include "law.hpp"
#include "logbook.hpp"

namespace wheel {
namespace {

// Leads to a phase without further steps: the solution is not needed any more.
void freeze(Wheel& w, Phase phase) {
  update_state(w);
  w.run.counted = counters_of(w.run, w.solver);
  w.run.phase = phase;
}

}  // namespace

Consequence pass_event(Wheel& wheel, Event event) {
  Run& run = wheel.run;
  const EventRow& row = event_row(event);
  const InForce before = run.in_force;
  const Consequence consequence = follow_event(row, wheel.setup, run.t, run.y(), run.in_force);
  if (is_observed(row, wheel.setup) && run.in_force.is_below(event)) log_observation(wheel, event, run.t);
  note_changes(wheel, before, event);
  return consequence;
}

void note_changes(Wheel& wheel, const InForce& before, Event by) {
  Run& run = wheel.run;
  const double t = shown_time(wheel, run.t);
  const WheelFriction &old = before.mode(), &now = run.in_force.mode();
  // To or from a regularized mode, or none, is no transition.
  const auto is_exact = [](const WheelFriction& f) { return f.kind == WHEEL_ROLLING || f.kind == WHEEL_HELD; };
  if (is_exact(old) && is_exact(now) && differ(old, now)) {
    ++run.transitions;
    if (now.kind == WHEEL_HELD)
      wheel.reporter.log(Topic::event, "t = %s s: stick, omega_z is held at zero.", t);
    else
      wheel.reporter.log(Topic::event, "t = %s s: %s, omega_z becomes %s.", t,
                         old.kind == WHEEL_HELD ? "release" : "reversal", now.sigma > 0 ? "positive" : "negative");
  }
  const bool slid = before.slides(), slides = run.in_force.slides();
  const bool anew = slides && by != Event::none && event_row(by).slides_anew;
  if (slides == slid && !anew) return;
  ++run.transitions;
  wheel.reporter.log(Topic::event, "t = %s s: the wheel %s.", t,
                     !slides ? "stops sliding"
                     : slid  ? "slides in another direction"
                             : "starts to slide");
}

void end_run(Wheel& w, Event event) {
  w.run.ended_by = event;
  freeze(w, Phase::ended);
  log_ending(w, event);
}

void close(Wheel& w) { freeze(w, Phase::closed); }

}  // namespace wheel
