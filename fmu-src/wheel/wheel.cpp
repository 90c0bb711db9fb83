// A wheel's initial state, and its present.
#include "wheel.hpp"

#include <algorithm>

#include "law.hpp"

namespace wheel {
namespace {

// Whether the initial state is inside the model, with a message: values that are sound one by one can have products
// that are not finite.
bool check_start(const Demand& demand, Reading& start, const Reporter& reporter) {
  if (is_inside(start)) return true;
  const auto set = [&](variable::Reference v) { return Digits{demand.parameters[v], 3}; };
  reporter.log(Topic::error,
               "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, g = %s m/s2, "
               "omega_z = %s rad/s.",
               set(variable::m), set(variable::J_z), set(variable::r_0), set(variable::g),
               Digits{start.kinematics().omega_z, 3});
  return false;
}

}  // namespace

const double* state_now(Wheel& w) {
  Run& run = w.run;
  if (run.y_time == run.t) return run.y;
  run.phase == Phase::unfolded ? w.solution.orbit.read(run.t, run.y) : w.solution.solver.read(run.t, run.y);
  run.y_time = run.t;
  return run.y;
}

bool is_inside(Reading& now) {
  double sum = now.energy() + now.dynamics().tau;
  for (const double force : now.dynamics().lambda) sum += force;
  return angle_from_flat(now.pose().theta) > 0 && std::isfinite(sum);
}

bool prepare(Wheel& w, const Reporter& reporter) {
  Run& run = w.run;
  run = Run();
  run.phase = Phase::faulty;
  w.solution.orbit_until = Solution::none;
  if (!check_values(w.demand, reporter, true)) return false;
  w.setup = setup_of(w.demand);
  std::copy_n(w.setup.start, WHEEL_MAX_STATES, run.y);
  run.in_force.scene.contact = w.setup.starts_sliding ? WHEEL_SLIDES : WHEEL_GRIPS;
  put_in_force(w.setup, w.demand, 0, run.y, run.in_force);
  w.demand.changed = false;
  Reading start;
  start.set(present(w));
  if (check_start(w.demand, start, reporter)) run.phase = Phase::initial;
  return run.phase == Phase::initial;
}

InForce in_force_now(const Wheel& w, double* y) {
  InForce now = w.run.in_force;
  if (w.demand.changed) put_in_force(w.setup, w.demand, w.run.t, y, now);
  return now;
}

// Where nothing was set, without a copy of all that is in force.
Present present(Wheel& w) {
  const double* y = state_now(w);
  if (w.demand.changed) y = std::copy_n(y, WHEEL_MAX_STATES, w.y_ahead) - WHEEL_MAX_STATES;
  const WheelScene scene = w.demand.changed ? in_force_now(w, w.y_ahead).scene : w.run.in_force.scene_at(w.run.t);
  Present now = {&w.setup, y, scene, &w.run, &w.solution.solver};
  now.scene.ground = WHEEL_GROUND_BY_FORCE;
  return now;
}

}  // namespace wheel
