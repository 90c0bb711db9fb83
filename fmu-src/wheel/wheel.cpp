// A wheel's initial state, and its present.
#include "wheel.hpp"

#include <algorithm>

#include "law.hpp"
#include "motion.hpp"

namespace wheel {

bool prepare(Wheel& w, const Reporter& reporter) {
  Run& run = w.run;
  run = Run();
  run.phase = Phase::faulty;
  w.solution.orbit_until = Solution::none;
  if (!check_values(w.demand, reporter)) return false;
  w.setup = setup_of(w.demand);
  put_in_force(w.setup, w.demand, 0, w.setup.start, run.in_force);
  std::copy_n(w.setup.start, w.setup.formulation->states, run.y);
  w.demand.changed = false;
  Reading start;
  start.set(present(w));
  if (check_start(w.demand, start, reporter)) run.phase = Phase::initial;
  return run.phase == Phase::initial;
}

InForce in_force_now(const Wheel& w) {
  InForce now = w.run.in_force;
  if (w.demand.changed) put_in_force(w.setup, w.demand, w.run.t, w.run.y, now);
  return now;
}

// Where nothing was set, without a copy of all that is in force.
Present present(Wheel& w) {
  const double* const y = state_now(w);
  const WheelScene scene = w.demand.changed ? in_force_now(w).scene : w.run.in_force.scene_at(w.run.t);
  Present now = {&w.setup, y, scene, &w.demand.inputs, &w.run, &w.solution.solver};
  now.scene.ground = WHEEL_GROUND_BY_FORCE;
  return now;
}

}  // namespace wheel
