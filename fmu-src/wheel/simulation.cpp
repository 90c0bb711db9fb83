// A run from its parameters to its initial state, and what is read of it.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "checks.hpp"
#include "digits.hpp"
#include "law.hpp"

namespace wheel {

void Reporter::log(Topic topic, const char* format, ...) const {
  if (!wants(topic)) return;
  char message[longest];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  take(owner, topic, message);
}

void Simulation::reset() {
  demand_.change() = Demand(kind());
  run_.change() = Run();
}

void Simulation::set_experiment(double start_time, double stop_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  Demand& demand = demand_.change();
  demand.start_time = start_time;
  demand.stop_time = stop_time;
  demand.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    reporter_.log(Topic::warning, "The tolerance %s is outside [%s, %s]; %s is used.",
                  support::Digits(tolerance, 6).text, support::Digits(tightest_tolerance, 6).text,
                  support::Digits(loosest_tolerance, 6).text, support::Digits(taken, 6).text);
}

double Simulation::stored(unsigned variable) const {
  return variable < first_input ? demand_->parameters[variable] : demand_->inputs[variable - first_input][0];
}

void Simulation::store(unsigned variable, double value) {
  if (phase() == Phase::faulty || phase() == Phase::initial) enter(Phase::initializing);
  if (stored(variable) == value) return;
  Demand& demand = demand_.change();
  (variable < first_input ? demand.parameters[variable] : demand.inputs[variable - first_input][0]) = value;
  demand.changed = true;
  if (kind() == Kind::model_exchange && is_running(phase())) take_at_once(setup_, demand, run_.change());
}

void Simulation::set_input_derivative(unsigned variable, int order, double value) {
  Demand& demand = demand_.change();
  demand.inputs[variable - first_input][order] = value / factorial[order];
  demand.changed = true;
}

bool Simulation::prepare(bool report) {
  const Reporter reporter = report ? reporter_ : Reporter();
  Run& run = run_.change();
  run = Run();
  run.phase = Phase::faulty;
  solution_.orbit_until = Solution::none;
  if (!check_values(*demand_, reporter)) return false;
  setup_ = setup_of(*demand_);
  put_in_force(setup_, *demand_, 0, setup_.start, run.in_force);
  std::copy_n(setup_.start, setup_.formulation->states, run.y);
  demand_.change().changed = false;
  if (check_start(*demand_, reading(), reporter)) run.phase = Phase::initial;
  return phase() == Phase::initial;
}

bool Simulation::start() {
  const bool exchanged = kind() == Kind::model_exchange;
  const bool sound = prepare() && (!exchanged || starts_inside(setup_, *run_, reporter_));
  enter(!sound ? Phase::without_start : exchanged ? Phase::event_mode : Phase::at_start);
  return sound;
}

void Simulation::close() {
  if (phase() != Phase::ended) log_summaries(setup_, *run_, reporter_);
  freeze(run_.change(), solution_, Phase::closed);
}

solver::Outcome Simulation::advance(double t) {
  return wheel::advance(setup_, demand_.change(), run_.change(), solution_, reporter_, t - demand_->start_time);
}

void Simulation::set_time(double t) {
  Run& run = run_.change();
  run.t = run.y_time = t - demand_->start_time;
}

void Simulation::set_states(const double* x) { std::copy_n(x, state_count, run_.change().y); }

void Simulation::set_state(int index, double value) {
  Run& run = run_.change();
  run.y[index] = value;
  decide_law(setup_, run.t, run.y, run.in_force);
}

bool Simulation::decide() {
  Event ending;
  const bool bends = wheel::decide(setup_, run_.change(), reporter_, &ending);
  if (ending != Event::none) end_run(setup_, ending, run_.change(), solution_, reporter_);
  return bends;
}

// With what was set since the last step.
InForce Simulation::in_force_now() const {
  InForce now = run_->in_force;
  if (demand_->changed) put_in_force(setup_, *demand_, run_->t, run_->y, now);
  return now;
}

// The scene at the present instant; where nothing was set, without a copy of all that is in force.
WheelScene Simulation::scene_now() const {
  WheelScene scene = demand_->changed ? in_force_now().scene : run_->in_force.scene_at(run_->t);
  scene.ground = WHEEL_GROUND_BY_FORCE;
  return scene;
}

Present Simulation::present() const {
  return {setup_.formulation, run_->y, scene_now(), &demand_->inputs, counters_of(*run_, solution_), run_->transitions};
}

Reading& Simulation::reading() {
  if (!reading_.is_of(version())) {
    state_now(run_.change(), solution_);
    reading_.set(present(), version());
  }
  return reading_;
}

// The same as it answers a change of one known: a brake that is not in use has the law that it would have in use. In
// model exchange that law waits for an event.
Present Simulation::present_for(unsigned known) {
  state_now(run_.change(), solution_);
  Present now = present();
  const bool brake = known == first_input + brake_input && kind() == Kind::co_simulation;
  if (!brake || now.scene.friction.kind != WHEEL_FRICTIONLESS) return now;
  InForce used = in_force_now();
  used.inputs.braked = true;
  decide_law(setup_, run_->t, now.y, used);
  now.scene.friction = used.scene.friction;
  return now;
}

// Of co-simulation's outputs only the reactions depend on the inputs of the same instant.
double Simulation::sensitivity(unsigned unknown, unsigned known) {
  const auto component = row_of(unknown).reaction_rate;
  const bool exchanged = kind() == Kind::model_exchange && has_begun(phase());
  if (exchanged || (!component && row_of(unknown).role == Role::local)) return partial(unknown, known);
  if (!component) return 0;
  WheelLoad unit = {};
  *load_entry(unit, static_cast<int>(known - first_input)) = 1;
  Reading answer;
  answer.set(present_for(known));
  return component(answer.response(unit));
}

// By differences of fourth order, the law and the sign of N kept. Steps are small parts of what each known turns on,
// those of a load of the whole weight or of the load: all but mu_required is linear in it.
double Simulation::partial(unsigned unknown, unsigned known) {
  constexpr double share = 1e-3;
  double y[WHEEL_MAX_STATES], scales[WHEEL_MAX_STATES];
  Present now = present_for(known);
  std::copy_n(now.y, WHEEL_MAX_STATES, y);
  scales_at(setup_, 0, scales);
  now.y = y;
  now.scene.ground = reading().dynamics().lambda[2] > 0 ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS;
  const int state = kind() == Kind::model_exchange ? state_index_of(known) : -1;
  double& place = state >= 0 ? y[state] : *load_entry(now.scene.load, static_cast<int>(known - first_input));
  double h = state >= 0 ? scales[state] : std::fmax(setup_.whole_weight, std::fabs(place));
  if (state == setup_.formulation->tilt_index) h *= std::sin(place);
  const bool soft = state == setup_.formulation->spin_index && now.scene.friction.kind == WHEEL_REGULARIZED;
  h = share * (soft ? std::fmin(h, setup_.omega_s) : h);
  Reading reading;
  const double centre = place;
  const auto value_at = [&](double steps) {
    place = centre + steps * h;
    reading.set(now);
    return row_of(unknown).read(reading);
  };
  return (8 * (value_at(1) - value_at(-1)) - (value_at(2) - value_at(-2))) / (12 * h);
}

}  // namespace wheel
