// A wheel's initial state, its present, and its run from the parameters to the end.
#include "wheel.hpp"

#include <algorithm>

#include "contact.hpp"
#include "exchange.hpp"
#include "law.hpp"
#include "logbook.hpp"
#include "motion.hpp"

namespace wheel {
namespace {

// Whether the initial state is inside the model, with a message: no force of the ground holds a wheel that jams, and
// values that are sound one by one can have products that are not finite.
bool check_start(const Wheel& w, Reading& start, const Reporter& reporter) {
  const InForce& now = w.run.in_force;
  if (now.slides() && margin_of(row_of(Event::jams), w.setup, now, 0, w.run.y) < 0)
    return reporter.check(false, "At the start the wheel %s: the run ends there.", ending_of(now, Event::jams).text);
  if (is_inside(start)) return true;
  const auto set = [&](variable::Reference v) { return Digits{w.demand.parameters[v], 3}; };
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
  return angle_from_flat(now.kinematics().theta) > 0 && std::isfinite(sum);
}

bool prepare(Wheel& w, const Reporter& reporter) {
  Run& run = w.run;
  run = Run();
  run.phase = Phase::faulty;
  w.solution.orbit_until = Solution::none;
  w.demand.slides = w.demand.parameters[variable::mu_slide] > 0;
  if (!check_values(w.demand, reporter, true)) return false;
  w.setup = setup_of(w.demand);
  std::copy_n(w.setup.start, WHEEL_MAX_STATES, run.y);
  run.in_force.scene.contact = w.setup.starts_sliding ? WHEEL_SLIDES : WHEEL_GRIPS;
  put_in_force(w.setup, w.demand, 0, run.y, run.in_force);
  w.demand.changed = false;
  Reading start;
  start.set(present(w));
  if (check_start(w, start, reporter)) run.phase = Phase::initial;
  return run.phase == Phase::initial;
}

InForce in_force_now(const Wheel& w, double* y) {
  InForce now = w.run.in_force;
  if (w.demand.changed) put_in_force(w.setup, w.demand, w.run.t, y, now);
  return now;
}

// Where nothing was set, without a copy of all that is in force.
Present present(Wheel& w) {
  Present now = {&w.setup, state_now(w), {}, &w.run, &w.solution.solver};
  if (w.demand.changed) {
    std::copy_n(now.y, WHEEL_MAX_STATES, w.y_ahead);
    now.y = w.y_ahead;
    now.scene = in_force_now(w, w.y_ahead).scene;
  } else {
    now.scene = w.run.in_force.scene_at(w.run.t);
  }
  now.scene.ground = WHEEL_GROUND_BY_FORCE;
  return now;
}

void reset(Wheel& w) {
  w.demand = Demand(w.kind());
  w.run = Run();
  w.endings = 0;
}

void set_experiment(Wheel& w, double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  w.demand.start_time = start_time;
  w.demand.stop_time = stop_time;
  w.demand.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    w.reporter.log(Topic::warning, "The tolerance %s is outside [%s, %s]; %s is used.", Digits{tolerance, 6},
                   Digits{tightest_tolerance, 6}, Digits{loosest_tolerance, 6}, Digits{taken, 6});
}

void set(Wheel& w, unsigned variable, double value, int order) {
  if (variable >= stored_count) {
    w.run.y[state_index_of(variable)] = value;
    return decide_law(w.setup, w.run.t, w.run.y, w.run.in_force);
  }
  if (w.phase() == Phase::faulty || w.phase() == Phase::initial) w.run.phase = Phase::initializing;
  double& asked = w.demand.value(variable, order);
  if (asked == value / factorial[order]) return;
  asked = value / factorial[order];
  w.demand.changed = true;
  if (w.kind() == Kind::model_exchange && is_running(w.phase())) take_at_once(w);
}

bool is_prepared(Wheel& w) {
  const bool faulty = w.phase() == Phase::faulty;
  return (w.phase() != Phase::initializing && !faulty) || prepare(w, faulty ? Reporter() : w.reporter);
}

bool start(Wheel& w) {
  const bool exchanged = w.kind() == Kind::model_exchange;
  const bool sound = prepare(w, w.reporter) && (!exchanged || starts_inside(w));
  if (sound) log_contact(w, w.setup.starts_sliding, true);
  w.run.phase = !sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start;
  return sound;
}

void close(Wheel& w) {
  if (w.phase() != Phase::ended) log_summaries(w);
  freeze(w, Phase::closed);
}

Reading& reading_of(Wheel& w) {
  if (w.reading.is_set()) return w.reading;
  const Present now = present(w);
  w.reading.set(now);
  if (w.demand.changed) warn_of_jam(w, now.scene, now.y);
  return w.reading;
}

double value_of(Wheel& w, unsigned variable) {
  return variable < stored_count ? w.demand.value(variable) : row_of(variable).read(reading_of(w));
}

}  // namespace wheel
