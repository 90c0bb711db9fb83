// A wheel's present: the state, what is in force, and what can be read.
#include "wheel.hpp"

#include <algorithm>
#include <cmath>

#include "events.hpp"
#include "law.hpp"

namespace wheel {

void read_state(const Wheel& w, double* y) {
  const Run& run = w.run;
  std::copy_n(run.latest_y(), max_states, y);
  if (!run.lags()) return;
  run.phase == Phase::unfolded ? w.orbit.read(run.t, y) : w.solver.read(run.t, y);
}

bool differs_from_demand(const Record& r) {
  const InForce& in_force = r.run.in_force;
  const double t = r.run.t, rounding = solver::rounding_at(std::fabs(r.demand.start_time) + std::fabs(t));
  return in_force.road != road_asked(r.demand) || in_force.inputs.change_at(t, rounding, r.demand.inputs);
}

void catch_up_with_orbit(const Record& r, const double* y, InForce& in_force) {
  if (r.run.phase == Phase::unfolded) set_sides(r.setup, r.run.t, y, in_force);
}

// Out of line: most readings follow no call that sets.
[[gnu::noinline]] InForce in_force_now(const Record& r, double* y) {
  InForce in_force = r.run.in_force;
  catch_up_with_orbit(r, y, in_force);
  if (takes_effect(r)) enforce(r.setup, r.demand, r.run.t, y, in_force);
  return in_force;
}

Instant::Instant(const Record& r, const double* y_reached)
    : setup(&r.setup),
      scene(r.run.in_force.scene_at(r.run.t)),
      counters(r.run.counted),
      transitions(r.run.transitions) {
  std::copy_n(y_reached, max_states, y);
  std::copy_n(r.run.x(), WHEEL_EULER_STATES, x);
  if (takes_effect(r)) scene = in_force_now(r, y).scene_at(r.run.t);
  scene.ground = WHEEL_GROUND_BY_FORCE;
}

Instant instant_of(const Wheel& w) {
  double y[max_states];
  read_state(w, y);
  Instant instant(w, y);
  instant.counters = counters_of(w.run, w.solver);
  return instant;
}

Reading::Reading(const Wheel& w) : at(instant_of(w)) {}

}  // namespace wheel
