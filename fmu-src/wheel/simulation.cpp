// A run from its parameters to its initial state, and what is read of it. How it moves on is in stepping.cpp.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "decisions.hpp"
#include "digits.hpp"

namespace wheel {

void Simulation::reset() {
  state_ = State();
  for (unsigned v = 0; v < first_input; ++v) state_.parameters[v] = row_of(v).start;
  state_.motion.tolerance = default_tolerance;
  reading_fresh_ = orbit_ready_ = false;
}

bool Simulation::tell(Topic topic, const char* format, ...) const {
  if (!reporter_.wanted(reporter_.owner, topic)) return false;
  char sentence[512];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  reporter_.tell(reporter_.owner, topic, sentence);
  return true;
}

void Simulation::set_experiment(double start_time, double tolerance) {
  const double taken = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  state_.start_time = start_time;
  state_.motion.tolerance = taken;
  if (tolerance > 0 && tolerance != taken)
    tell(Topic::warning, "The tolerance %g is outside [%g, %g]; %g is used.", tolerance, tightest_tolerance,
         loosest_tolerance, taken);
}

void Simulation::store(unsigned variable, double value) {
  const bool is_input = variable >= first_input;
  const bool changed = is_input ? state_.motion.inputs.set_value(static_cast<int>(variable - first_input), value)
                                : state_.parameters[variable] != value;
  if (!changed) return;
  if (!is_input) state_.parameters[variable] = value;
  if (!is_input && variable != s) state_.prepared = false;  // the initial state belongs to other parameters
  state_.changes_pending = true;
  reading_fresh_ = false;
}

void Simulation::set_input_derivative(unsigned variable, int order, double value) {
  state_.motion.inputs.set_derivative(static_cast<int>(variable - first_input), order, value);
  state_.changes_pending = true;
  reading_fresh_ = false;
}

bool Simulation::prepare(bool report) {
  state_.prepared = false;
  reading_fresh_ = orbit_ready_ = false;
  if (!check_parameters(report)) return false;
  set_initial_state(state_);
  state_.prepared = true;
  return state_.prepared = check_start(report);
}

const double* Simulation::y_now() {
  if (!state_.y_known) {
    state_.unfolded ? orbit_.read(state_.t, state_.y) : solver_.read(state_.t, state_.y);
    state_.y_known = true;
  }
  return state_.y;
}

// The counts of the run: those of the solver at work and those before it was last started from nothing.
solver::Counters Simulation::counters() const {
  const solver::Counters& a = state_.counted;
  const solver::Counters b = state_.is_stepping() ? solver_.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

// The present instant, with what was set since the last step.
Instant Simulation::instant() {
  const Inputs& inputs = state_.motion.inputs;
  Instant now = {state_.motion.formulation, y_now(),    state_.motion.scene,
                 inputs.pending_rate(),     counters(), state_.transitions};
  if (state_.changes_pending)
    now.scene = pending_scene(state_);
  else if (inputs.varies)
    inputs.load_at(state_.t, &now.scene.load);
  now.scene.ground = WHEEL_GROUND_BY_FORCE;
  return now;
}

Reading& Simulation::reading() {
  if (!reading_fresh_) reading_.set(instant());
  reading_fresh_ = true;
  return reading_;
}

double Simulation::value(unsigned variable) {
  if (variable < first_input) return state_.parameters[variable];
  if (variable < stored_count) return state_.motion.inputs.value(static_cast<int>(variable - first_input));
  return row_of(variable).read(reading());
}

double Simulation::rate(unsigned variable) { return row_of(variable).read_rate(reading()); }

// Only the reactions depend on the inputs of the same instant.
double Simulation::sensitivity(unsigned output, unsigned input) {
  const auto component = row_of(output).reaction_rate;
  if (!component) return 0;
  const int i = static_cast<int>(input - first_input);
  WheelLoad unit = {};
  *load_entry(unit, i) = 1;
  Instant now = instant();
  if (i == Inputs::brake) now.scene.friction = braked_friction(state_, now.scene, now.y);
  Reading answer;
  answer.set(now);
  return component(answer.response(unit));
}

// A clause that other messages continue.
const char* Simulation::ending() const {
  if (state_.ending == Event::none) return nullptr;
  const char* what = state_.ending == Event::fell_flat ? "fell flat" : "lifted off the ground";
  std::snprintf(ending_, sizeof ending_, "the wheel %s at t = %s s", what, support::Digits(time()).text);
  return ending_;
}

}  // namespace wheel
