// A wheel's initial state, its present, and its run from the parameters to the end.
#include "wheel.hpp"

#include <algorithm>

#include "events.hpp"
#include "exchange.hpp"
#include "law.hpp"
#include "logbook.hpp"

namespace wheel {
namespace {

// Whether the initial state is inside the model, with a message: no force of the ground holds a wheel that jams, and
// values that are sound one by one can have products that are not finite.
bool check_start(const Wheel& w, Reading& start, const Reporter& reporter) {
  const InForce& now = w.run.in_force;
  if (now.slides() && margin_of(row_of(Event::jams), w.setup, now, 0, w.run.y) < 0)
    return reporter.check(false, "At the start the wheel %s: the run ends there.", ending_of(now, Event::jams).text);
  double sum = row_of(variable::E).read(start) + start.dynamics().tau;
  for (const double force : start.dynamics().lambda) sum += force;
  const auto set = [&](variable::Place v) { return Digits{w.demand.parameters[v], 3}; };
  return reporter.check(angle_from_flat(start.kinematics().theta) > 0 && std::isfinite(sum),
                        "The initial energy or reaction force overflows: m = %s kg, J_z = %s kg m2, r_0 = %s m, "
                        "g = %s m/s2, omega_z = %s rad/s.",
                        set(variable::m), set(variable::J_z), set(variable::r_0), set(variable::g),
                        Digits{start.kinematics().omega_z, 3});
}

// Once, at the end of the initialization.
void warn_of_paper_start(const Wheel& w) {
  const double* v = w.demand.parameters;
  const auto unset = [&](unsigned parameter) { return v[parameter] == row_of(parameter).start; };
  if (v[variable::guided] != 0 && unset(variable::psi_start) && unset(variable::theta_start))
    w.reporter.log(Topic::warning,
                   "The guided wheel keeps the paper's psi_start and theta_start: it heads along Y, and its axle is 15 "
                   "degrees off the road's plane; a vehicle's wheel has psi_start = 0 and theta_start = pi/2.");
}

// To a phase without further steps: the solution is not needed any more.
void freeze(Wheel& w, Phase phase) {
  state_now(w);
  w.run.counted = counters_of(w.run, w.solver);
  w.run.phase = phase;
}

}  // namespace

const double* state_now(Wheel& w) {
  Run& run = w.run;
  if (run.y_time == run.t) return run.y;
  run.phase == Phase::unfolded ? w.orbit.read(run.t, run.y) : w.solver.read(run.t, run.y);
  run.y_time = run.t;
  return run.y;
}

bool prepare(Wheel& w, const Reporter& reporter) {
  Run& run = w.run;
  run = Run();
  run.phase = Phase::faulty;
  w.demand.slides = w.demand.parameters[variable::mu_slide] > 0;
  if (!check_values(w.demand, reporter, true)) return false;
  w.setup = setup_of(w.demand);
  std::copy_n(w.setup.start, max_states, run.y);
  run.in_force.scene = w.setup.scene;
  if (w.setup.steered()) set_guide_rates(w.setup, w.demand, run.in_force.scene, true, run.y);
  enforce(w.setup, w.demand, 0, run.y, run.in_force);
  if (w.setup.exchanged) wheel_euler_states(run.y, w.demand.parameters[variable::psi_dot_start], run.x);
  w.demand.news = News::none;
  Reading start(w);
  if (check_start(w, start, reporter)) run.phase = Phase::initial;
  return run.phase == Phase::initial;
}

InForce in_force_now(const Wheel& w, double* y) {
  InForce now = w.run.in_force;
  if (w.demand.news != News::none) enforce(w.setup, w.demand, w.run.t, y, now);
  return now;
}

Reading::Reading(Wheel& w) : setup(&w.setup), counters(counters_of(w.run, w.solver)), transitions(w.run.transitions) {
  std::copy_n(state_now(w), max_states, y);
  std::copy_n(w.run.x, WHEEL_EULER_STATES, x);
  scene = acts_on(w) ? w.run.in_force.scene_at(w.run.t) : in_force_now(w, y).scene;
  scene.ground = WHEEL_GROUND_BY_FORCE;
}

void reset(Wheel& w) {
  w.demand = Demand(w.demand.kind);
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
    w.run.x[place_in_x(variable)] = value;
    wheel_reduced_state(w.run.x, w.run.y);
    return decide_law(w.setup, w.run.t, w.run.y, w.run.in_force);
  }
  if (w.run.phase == Phase::faulty || w.run.phase == Phase::initial) w.run.phase = Phase::initializing;
  double& asked = w.demand.value(variable, order);
  const double taken = value / factorial[order];
  if (asked == taken && w.demand.news != News::stays) return;  // what is set to where it stays counts as set
  asked = taken;
  w.demand.news = News::set;
  if (w.demand.kind == Kind::model_exchange && is_running(w.run.phase)) act_at_once(w);
}

bool is_prepared(Wheel& w) {
  const Reporter nobody;
  const bool faulty = w.run.phase == Phase::faulty;
  return (w.run.phase != Phase::initializing && !faulty) || prepare(w, faulty ? nobody : w.reporter);
}

bool start(Wheel& w) {
  const bool exchanged = w.demand.kind == Kind::model_exchange;
  const bool sound = prepare(w, w.reporter) && (!exchanged || starts_inside(w));
  InForce before;
  before.scene = w.setup.scene;
  if (sound) {
    warn_of_paper_start(w);
    log_changes(w, before);
  }
  w.run.phase = !sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start;
  return sound;
}

void end_run(Wheel& w, Event event) {
  w.run.ended_by = event;
  freeze(w, Phase::ended);
  log_ending(w, event);
}

void close(Wheel& w) { freeze(w, Phase::closed); }

double value_of(Wheel& w, unsigned variable) {
  if (variable < stored_count) return w.demand.value(variable);
  if (!w.reading) {
    w.reading.emplace(w);
    if (w.demand.news != News::none) warn_of_jam(w, w.reading->scene, w.reading->y);
  }
  return row_of(variable).read(*w.reading);
}

}  // namespace wheel
