// The run: starting, stepping, passing events, ending. Rolling friction after Filippov, docs/equations.md.
#include "simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>

#include "callbacks.hpp"
#include "scene.hpp"

namespace wheel {

Simulation::Simulation(const Reporter& reporter) : reporter_(reporter) { reset(); }

void Simulation::reset() {
  solver_ = nullptr;
  for (unsigned v = 0; v < stored_count; ++v) stored_[v] = row_of(v).start;
  inputs_ = Inputs();
  now_ = Reading();
  start_time_ = lowest_force_ = 0;
  tolerance_ = default_tolerance;
  touched_ = lifted_ = false;
  scene_ = {};
  method_ = integrator::Method::adams;
  formulation_ = nullptr;
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
  start_time_ = start_time;
  tolerance_ = tolerance > 0 ? std::clamp(tolerance, tightest_tolerance, loosest_tolerance) : default_tolerance;
  if (tolerance > 0 && tolerance != tolerance_)
    tell(Topic::warning, "The tolerance %g is outside [%g, %g]; %g is used.", tolerance, tightest_tolerance,
         loosest_tolerance, tolerance_);
}

void Simulation::store(unsigned variable, double value) {
  const bool is_input = variable >= first_input;
  const int input = static_cast<int>(variable - first_input);
  const bool same = is_input ? inputs_.holds(input, value) : stored_[variable] == value;
  stored_[variable] = value;
  if (same) return;
  if (is_input) inputs_.set_value(input, value);
  touched_ = true;
  now_.forget_dynamics();
}

void Simulation::set_input_derivative(unsigned variable, int order, double value) {
  inputs_.set_derivative(static_cast<int>(variable - first_input), order, value);
  touched_ = true;
  now_.forget_dynamics();
}

bool Simulation::prepare(bool report) {
  if (!check_parameters(report)) return formulation_ = nullptr, false;
  formulation_ = &choose_formulation(stored_);
  method_ = choose_method(stored_);
  scene_ = {};
  scene_.wheel = parameters_from(stored_);
  const WheelMotion motion = initial_motion(stored_);
  double y[WHEEL_MAX_STATES] = {};
  formulation_->start(&scene_.wheel, &motion, y);
  inputs_.take_over(0);
  inputs_.load_at(0, &scene_);
  scene_.friction = friction_at(stored_, *formulation_, scene_, y);
  error_scales(scene_.wheel, *formulation_, y, scales_);
  now_ = Reading(*formulation_, *this);
  now_.set_state(0, y);
  touched_ = false;
  if (!check_start(report)) formulation_ = nullptr;
  return exists();
}

bool Simulation::start() {
  integrator::System system = solver_system(*this);
  system.states = formulation_->states;
  system.closed_states = formulation_->closed_states;
  system.method = method_;
  const double own_time = time_scale(scene_.wheel, now_.kinematics());
  system.longest_step = 0.5 * own_time;
  weight_ = scene_.wheel.m * (scene_.wheel.r_0 + scene_.wheel.r) / (own_time * own_time);
  solver_ = integrator::Integrator::create(system, room_);
  return solver_ && restart_from(0, now_.state());
}

bool Simulation::restart_from(double t, const double* y) {
  double start[WHEEL_MAX_STATES];
  std::copy_n(y, formulation_->states, start);
  now_.set_state(t, start);
  lowest_force_ = std::numeric_limits<double>::infinity();
  return solver_->restart(t, start, watches_event(scene_));
}

// With what was set since the last step, if anything was.
WheelScene Simulation::scene_at(double t, const double* y) const {
  WheelScene scene = scene_;
  if (touched_) {
    scene.wheel.s = stored_[s];
    inputs_.pending_load(&scene);
    scene.friction = friction_at(stored_, *formulation_, scene, y);
  } else {
    inputs_.load_at(t, &scene);
  }
  return scene;
}

WheelLoad Simulation::load_rate_at(double t) const { return touched_ ? inputs_.pending_rate() : inputs_.rate_at(t); }

// Whether the solver can go on with its history: it stands at t, and the new right-hand side joins the old one there.
bool Simulation::joins(double t, const double* y, const WheelScene& next) const {
  if (solver_->known_until() > t || next.friction.kind != scene_.friction.kind) return false;
  WheelScene last = scene_;
  inputs_.load_at(t, &last);
  double before[WHEEL_MAX_STATES], after[WHEEL_MAX_STATES];
  formulation_->derivative(&last, y, before);
  formulation_->derivative(&next, y, after);
  return !solver_->notices(before, after);
}

// Inputs and tunable parameters set since the last step take effect: a restart only where the solver would notice.
bool Simulation::settle_changes() {
  if (!touched_) return true;
  const double t = now_.time();
  const bool changed = scene_.wheel.s != stored_[s] || inputs_.differ_from_current(t);
  if (!changed) return touched_ = false, true;
  const double* y = now_.state();
  const WheelScene next = scene_at(t, y);
  const bool goes_on = joins(t, y, next);
  const WheelFriction before = scene_.friction;
  scene_ = next;
  touched_ = false;
  inputs_.take_over(t);
  inputs_.load_at(t, &scene_);
  now_.forget_dynamics();
  announce_transition(t, before);
  return goes_on || restart_from(t, y);
}

// Counts and tells a change between held, positive and negative spin; a change of the law itself is none.
void Simulation::announce_transition(double t, const WheelFriction& before) {
  const auto switches = [](const WheelFriction& f) { return f.kind == WHEEL_HELD || f.kind == WHEEL_ROLLING; };
  const WheelFriction& friction = scene_.friction;
  if (!switches(before) || !switches(friction)) return;
  if (before.kind == friction.kind && before.sigma == friction.sigma) return;
  ++now_.events;
  if (friction.kind == WHEEL_HELD)
    tell(Topic::event, "t = %.9f s: stick, omega_z is held at zero.", start_time_ + t);
  else
    tell(Topic::event, "t = %.9f s: %s, omega_z becomes %s.", start_time_ + t,
         before.kind == WHEEL_HELD ? "release" : "slip reverses", friction.sigma > 0 ? "positive" : "negative");
}

// The solver stands at a transition of the friction: omega_z came to zero, or friction can hold it no longer.
bool Simulation::pass_event() {
  const double t = solver_->event_time();
  double y[WHEEL_MAX_STATES];
  solver_->read(t, y);
  inputs_.load_at(t, &scene_);
  const WheelFriction before = scene_.friction;
  formulation_->stop_spin(&scene_.wheel, y);
  if (before.kind == WHEEL_HELD) {
    WheelDynamics held;
    formulation_->dynamics(&scene_, y, &held);
    scene_.friction = {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0};
  } else {
    scene_.friction = friction_at(stored_, *formulation_, scene_, y);
  }
  announce_transition(t, before);
  return restart_from(t, y);
}

integrator::Outcome Simulation::run_to(double t) {
  solver_->allow_steps(most_steps(scene_.wheel, now_.state()[formulation_->spin_index], t - now_.time()));
  while (solver_->known_until() < t) {
    inputs_.varies() ? solver_->stop_before(t) : solver_->stop_nowhere();
    const integrator::Outcome outcome = solver_->advance(t);
    if (outcome != integrator::Outcome::event) return outcome;
    if (!pass_event()) return integrator::Outcome::failed;
  }
  return integrator::Outcome::reached;
}

Progressed Simulation::end_run() {
  now_.move_to(solver_->event_time());
  const double theta = now_.state()[formulation_->tilt_index];
  if (std::sin(theta) < 2 * flat_sine)
    tell(Topic::discard, "The wheel fell flat at t = %.9f s: the model ends there.", time());
  else
    tell(Topic::discard, "The wheel lifted off the ground at t = %.9f s, theta = %.6g rad: the model ends there.",
         time(), theta);
  return Progressed::ended;
}

Progressed Simulation::advance(double t) {
  t -= start_time_;
  if (!settle_changes()) return Progressed::failed;
  if (solver_->known_until() < t) {
    const double t_before = now_.time();
    double y_before[WHEEL_MAX_STATES];
    std::copy_n(now_.state(), formulation_->states, y_before);
    const integrator::Outcome outcome = run_to(t);
    if (outcome == integrator::Outcome::ended) return end_run();
    if (outcome == integrator::Outcome::failed) {
      now_.move_to(solver_->known_until());
      tell(Topic::error, "The solver stopped at t = %.9f s, where omega_z = %.4g rad/s: %s.", time(),
           now_.state()[formulation_->spin_index], solver_->failure());
      now_.set_state(t_before, y_before);
      return Progressed::failed;
    }
  }
  const bool moved = t > now_.time();
  now_.move_to(t);
  if (moved && inputs_.varies()) inputs_.hold_from(t), touched_ = true;
  return Progressed::reached;
}

double Simulation::time() const { return start_time_ + now_.time(); }

double Simulation::value(unsigned variable) {
  return variable < stored_count ? stored_[variable] : row_of(variable).read(now_);
}

double Simulation::rate(unsigned variable) { return row_of(variable).read_rate(now_); }

// Only the reactions answer an input at once. They are linear in the inputs: the rate that a unit rate of the input
// adds is the derivative.
double Simulation::sensitivity(unsigned output, unsigned input) {
  const int reaction = row_of(output).reaction;
  if (reaction == Row::none) return 0;
  WheelLoad still = {}, unit = {};
  (input < M_1 ? unit.F[input - F_X] : unit.M[input - M_1]) = 1;
  double with[3], without[3];
  formulation_->reaction_rates(&now_.scene(), &unit, now_.state(), with);
  formulation_->reaction_rates(&now_.scene(), &still, now_.state(), without);
  return with[reaction] - without[reaction];
}

}  // namespace wheel
