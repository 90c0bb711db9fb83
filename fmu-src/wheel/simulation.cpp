// A run from its parameters to its end.
#include "simulation.hpp"

#include "law.hpp"
#include "motion.hpp"

namespace wheel {

void Simulation::reset() {
  Wheel& w = change();
  w.demand = Demand(kind());
  w.run = Run();
  w.endings = 0;
}

void Simulation::set_experiment(double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  Demand& demand = change().demand;
  demand.start_time = start_time;
  demand.stop_time = stop_time;
  demand.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    wheel_.reporter.log(Topic::warning, "The tolerance %s is outside [%s, %s]; %s is used.", Digits{tolerance, 6},
                        Digits{tightest_tolerance, 6}, Digits{loosest_tolerance, 6}, Digits{taken, 6});
}

void Simulation::set(unsigned variable, double value, int order) {
  if (variable >= stored_count) {
    Wheel& w = change();
    w.run.y[state_index_of(variable)] = value;
    return decide_law(w.setup, w.run.t, w.run.y, w.run.in_force);
  }
  if (phase() == Phase::faulty || phase() == Phase::initial) enter(Phase::initializing);
  if (wheel_.demand.value(variable, order) == value / factorial[order]) return;
  Wheel& w = change();
  w.demand.value(variable, order) = value / factorial[order];
  w.demand.changed = true;
  if (kind() == Kind::model_exchange && is_running(phase())) take_at_once(w);
}

bool Simulation::start() {
  const bool exchanged = kind() == Kind::model_exchange;
  const bool sound = prepare(change(), wheel_.reporter) && (!exchanged || starts_inside(wheel_));
  enter(!sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start);
  return sound;
}

void Simulation::close() {
  if (phase() != Phase::ended) log_summaries(wheel_);
  freeze(change(), Phase::closed);
}

solver::Outcome Simulation::advance(double t) { return wheel::advance(change(), t - wheel_.demand.start_time); }

void Simulation::set_time(double t) {
  Run& run = change().run;
  run.t = run.y_time = t - wheel_.demand.start_time;
}

}  // namespace wheel
