// A run from its parameters to its initial state, and what is read of it. How it moves on is in advance.cpp.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "checks.hpp"
#include "digits.hpp"

namespace wheel {

void Reporter::tell(Topic topic, const char* format, ...) const {
  if (!wants(topic)) return;
  char sentence[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  take(owner, topic, sentence);
}

void Simulation::reset() {
  const Kind kind = demand_.kind;
  demand_ = Demand();
  demand_.kind = kind;
  run_ = Run();
  fresh_ = Fresh::nothing;
}

void Simulation::set_experiment(double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  demand_.start_time = start_time;
  demand_.stop_time = stop_time;
  demand_.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    reporter_.tell(Topic::warning, "The tolerance %s is outside [1e-13, 0.0001]; %s is used.",
                   support::Digits(tolerance, 6).text, support::Digits(taken, 6).text);
}

void Simulation::store(unsigned variable, double value) {
  if (run_.phase == Phase::faulty || run_.phase == Phase::initial) run_.phase = Phase::initializing;
  double& stored = variable < first_input ? demand_.parameters[variable] : demand_.inputs[variable - first_input][0];
  if (stored == value) return;
  stored = value;
  demand_.changed = true;
  fresh_ = std::min(fresh_, Fresh::state);
  if (demand_.kind == Kind::model_exchange && is_running(run_.phase)) take_at_once();
}

void Simulation::set_input_derivative(unsigned variable, int order, double value) {
  demand_.inputs[variable - first_input][order] = value / factorial[order];
  demand_.changed = true;
  fresh_ = std::min(fresh_, Fresh::state);
}

bool Simulation::prepare(bool report) {
  const Reporter reporter = report ? reporter_ : Reporter();
  run_ = Run();
  run_.phase = Phase::faulty;
  if (!check_values(demand_, reporter)) return false;
  setup_ = setup_of(demand_);
  put_in_force(setup_, demand_, 0, setup_.start, run_.in_force);
  std::copy_n(setup_.start, setup_.formulation->states, run_.y);
  demand_.changed = orbit_ready_ = false;
  fresh_ = Fresh::state;
  if (check_start(reporter)) run_.phase = Phase::initial;
  return run_.phase == Phase::initial;
}

bool Simulation::start() {
  const bool exchanged = demand_.kind == Kind::model_exchange;
  const bool sound = prepare() && (!exchanged || starts_inside());
  run_.phase = !sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start;
  return sound;
}

void Simulation::close() {
  if (run_.phase != Phase::ended) sum_up();
  freeze(Phase::closed);
}

// To a phase without further steps: the solution is not needed any more.
void Simulation::freeze(Phase phase) {
  y_now();
  run_.counted = counters();
  run_.phase = phase;
}

const double* Simulation::y_now() {
  if (fresh_ == Fresh::nothing) {
    run_.phase == Phase::unfolded ? orbit_.read(run_.t, run_.y) : solver_.read(run_.t, run_.y);
    fresh_ = Fresh::state;
  }
  return run_.y;
}

// The counts of the run: those of the solver at work and those before it was last started from nothing.
solver::Counters Simulation::counters() const {
  const solver::Counters& a = run_.counted;
  const solver::Counters b = run_.phase == Phase::stepping ? solver_.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

// The scene at the present instant, with what was set since the last step.
WheelScene Simulation::scene_now() {
  WheelScene scene = run_.in_force.scene_at(run_.t);
  if (demand_.changed) {
    InForce next = run_.in_force;
    put_in_force(setup_, demand_, run_.t, y_now(), next);
    scene = next.scene;
  }
  scene.ground = WHEEL_GROUND_BY_FORCE;
  return scene;
}

Present Simulation::present() {
  return {setup_.formulation, y_now(), scene_now(), &demand_.inputs, counters(), run_.transitions};
}

Reading& Simulation::reading() {
  if (fresh_ != Fresh::reading) reading_.set(present());
  fresh_ = Fresh::reading;
  return reading_;
}

double Simulation::value(unsigned variable) {
  if (variable < first_input) return demand_.parameters[variable];
  if (variable < stored_count) return demand_.inputs[variable - first_input][0];
  return row_of(variable).read(reading());
}

double Simulation::rate(unsigned variable) { return row_of(variable).read_rate(reading()); }

// The same as it answers a change of one known: a brake that is not in use has the law that it would have in use. In
// model exchange that law waits for an event.
Present Simulation::present_for(unsigned known) {
  Present now = present();
  const bool brake = known == first_input + brake_input && demand_.kind == Kind::co_simulation;
  if (brake && now.scene.friction.kind == WHEEL_FRICTIONLESS)
    now.scene.friction = friction_at(setup_, now.scene, true, now.y);
  return now;
}

// Of co-simulation's outputs only the reactions depend on the inputs of the same instant.
double Simulation::sensitivity(unsigned unknown, unsigned known) {
  const auto component = row_of(unknown).reaction_rate;
  const bool exchanged = demand_.kind == Kind::model_exchange && has_begun(run_.phase);
  if (exchanged || (!component && row_of(unknown).role == Role::local)) return partial(unknown, known);
  if (!component) return 0;
  WheelLoad unit = {};
  *load_entry(unit, static_cast<int>(known - first_input)) = 1;
  Reading answer;
  answer.set(present_for(known));
  return component(answer.response(unit));
}

}  // namespace wheel
