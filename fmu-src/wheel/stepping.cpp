// How a run moves on: changes of inputs, transitions of the rolling friction after Filippov (docs/equations.md), the
// unfolded free wheel, endings.
#include <algorithm>
#include <cmath>
#include <limits>

#include "decisions.hpp"
#include "digits.hpp"
#include "scene.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

// The most work that one call may do, in internal steps, however long its communication step is: some seconds of
// computing.
constexpr long long most_work = 1000000;
// The work of passing an event, in internal steps: the search for it, a new start, the short steps after it.
constexpr long long work_per_event = 20;
// The work of one internal step of the multibody form, whose system is larger.
constexpr long long work_per_multibody_step = 8;

// For messages: an instant is not found more exactly than to a nanosecond.
double to_nanosecond(double t) { return std::fabs(t) < 1e6 ? std::nearbyint(t * 1e9) / 1e9 : t; }

}  // namespace

// Whether what was set since the last step differs from what is in force, or makes another method the right one.
bool Simulation::has_changed() const {
  const Motion& motion = state_.motion;
  const double t = state_.t;
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * (std::fabs(state_.start_time) + std::fabs(t));
  if (motion.scene.wheel.s != state_.parameters[s] || motion.inputs.change_at(t, rounding)) return true;
  if (!motion.inputs.varies || !state_.moving) return false;
  WheelScene now = motion.scene;
  motion.inputs.load_at(t, &now.load);
  return choose_method(state_.parameters, now, true) != state_.method;
}

// Inputs and tunable parameters set since the last step take effect.
bool Simulation::settle_changes() {
  if (!state_.changes_pending) return true;
  const double t = state_.t;
  if (!has_changed()) {
    state_.changes_pending = false;
    return true;
  }
  const WheelFriction before = state_.motion.scene.friction;
  const bool was_unfolded = state_.unfolded;
  const double* y = y_now();
  state_.jumped = state_.moving;
  take_changes(state_, y);
  reading_fresh_ = false;
  announce_transition(t, before);
  if (!state_.moving) return true;
  solver_.change_interval(t - state_.last_change);
  state_.last_change = t;
  if (was_unfolded) return ++state_.counted.restarts, start_solver();
  return solver_.restart(problem_of(state_.motion), state_.method, t, y);
}

// Starts the solver from nothing at the present instant.
bool Simulation::start_solver() { return solver_.start(problem_of(state_.motion), state_.method, state_.t, y_now()); }

// Counts and reports a change between held, positive and negative spin. A change to another law is not a transition.
void Simulation::announce_transition(double t, const WheelFriction& before) {
  const auto switches = [](const WheelFriction& f) { return f.kind == WHEEL_HELD || f.kind == WHEEL_ROLLING; };
  const WheelFriction& friction = state_.motion.scene.friction;
  if (!switches(before) || !switches(friction)) return;
  if (before.kind == friction.kind && before.sigma == friction.sigma) return;
  ++state_.transitions;
  const support::Digits instant(to_nanosecond(state_.start_time + t));
  if (friction.kind == WHEEL_HELD)
    tell(Topic::event, "t = %s s: stick, omega_z is held at zero.", instant.text);
  else
    tell(Topic::event, "t = %s s: %s, omega_z becomes %s.", instant.text,
         before.kind == WHEEL_HELD ? "release" : "reversal", friction.sigma > 0 ? "positive" : "negative");
}

// The solver stands at a transition: omega_z has reached zero, or friction and brake can no longer hold it there.
bool Simulation::pass_transition() {
  const double t = solver_.event_time();
  Motion& motion = state_.motion;
  double y[WHEEL_MAX_STATES];
  solver_.read(t, y);
  if (motion.inputs.varies) motion.inputs.load_at(t, &motion.scene.load);
  const WheelFriction before = motion.scene.friction;
  motion.formulation->stop_spin(&motion.scene.wheel, y);
  if (before.kind == WHEEL_HELD) {
    WheelDynamics held;
    motion.formulation->dynamics(&motion.scene, y, &held);
    motion.scene.friction = {WHEEL_ROLLING, held.tau > 0 ? -1.0 : 1.0, 0};
  } else {
    motion.scene.friction =
        friction_at(state_.parameters, *motion.formulation, motion.scene, motion.inputs.braked, motion.weight, y);
  }
  announce_transition(t, before);
  return solver_.restart(problem_of(motion), state_.method, t, y);
}

// The solver stands where the ground begins to pull or to press. Without friction the motion goes on as it was.
bool Simulation::pass_contact() {
  Motion& motion = state_.motion;
  const double t = solver_.event_time();
  change_contact(motion);
  if (pulls(motion)) tell_pull(t);
  if (motion.scene.friction.kind == WHEEL_FRICTIONLESS) return solver_.resume(), true;
  double y[WHEEL_MAX_STATES];
  solver_.read(t, y);
  return solver_.restart(problem_of(motion), state_.method, t, y);
}

// `event`: it ends the run.
solver::Outcome Simulation::pass_event() {
  const auto passed = [](bool well) { return well ? solver::Outcome::stepped : solver::Outcome::failed; };
  switch (static_cast<Event>(solver_.event())) {
    case Event::spin_changes:
      return passed(pass_transition());
    case Event::contact_changes:
      return passed(pass_contact());
    default:
      return solver::Outcome::event;
  }
}

void Simulation::tell_pull(double t) const {
  tell(Topic::warning, "The ground pulls from t = %s s on: keep_contact holds a wheel that would have lifted off.",
       support::Digits(to_nanosecond(state_.start_time + t)).text);
}

bool Simulation::knows(double t) const {
  if (!state_.moving) return false;
  return state_.unfolded ? orbit_ready_ && t <= orbit_.end_time() : solver_.reaches(t);
}

solver::Outcome Simulation::run_to(double t) {
  using solver::Outcome;
  const bool starts = !state_.moving || state_.unfolded;  // a restored state may claim a motion that does not unfold
  if (state_.unfolded && !orbit_ready_) enter_orbit();
  if (state_.unfolded) return t <= orbit_.end_time() ? Outcome::stepped : Outcome::event;
  if (starts && !start_solver()) return Outcome::failed;
  const bool large = state_.motion.formulation == &wheel_multibody;
  const long long work_per_step = large ? work_per_multibody_step : 1;
  for (long long work = 0; !solver_.reaches(t);) {
    if (work >= most_work)
      return failure_ = "one call may take no more internal steps; use shorter communication steps", Outcome::failed;
    // CVODE may step past the communication point although an input varies: the input's polynomial may go on there, and
    // a step that is cut short costs CVODE its history. Runge-Kutta has no history to lose.
    if (state_.motion.inputs.varies && solver_.method() == solver::Method::runge_kutta) solver_.stop_before(t);
    const Outcome outcome = solver_.step();
    if (outcome == Outcome::failed) return outcome;
    if (solver_.reaches(t)) break;  // an event after t waits until it is reached
    work += (outcome == Outcome::event ? work_per_event : 1) * work_per_step;
    if (outcome != Outcome::event) continue;
    const Outcome passed = pass_event();
    if (passed != Outcome::stepped) return passed;
  }
  return Outcome::stepped;
}

Progressed Simulation::end_run() {
  move_to(state_.unfolded ? orbit_.end_time() : solver_.event_time());
  state_.ending = static_cast<Event>(state_.unfolded ? orbit_.event() : solver_.event());
  const double theta = y_now()[state_.motion.formulation->tilt_index];
  const char* sentence =
      state_.ending == Event::fell_flat ? "T%s: the model ends there." : "T%s, theta = %.6g rad: the model ends there.";
  tell(Topic::discard, sentence, ending() + 1, theta);
  return Progressed::ended;
}

Progressed Simulation::fail(const State& before) {
  move_to(state_.unfolded ? state_.t : solver_.known_until());
  tell(Topic::error, "The solver stopped at t = %s s, where omega_z = %.4g rad/s: %s.", support::Digits(time()).text,
       y_now()[state_.motion.formulation->spin_index], failure_);
  state_ = before;
  reading_fresh_ = false;
  if (!state_.is_stepping()) return Progressed::failed;
  // The solver has lost the history before the step. It stands at the state, and `counted` holds its counts.
  solver::Problem problem = problem_of(state_.motion);
  problem.watched_count = 0;
  solver_.start(problem, state_.method, state_.t, state_.y);
  return Progressed::failed;
}

void Simulation::move_to(double t) {
  state_.t = t;
  state_.y_known = reading_fresh_ = false;
}

// What a communication step needs if the solution is not known up to t yet: pending changes take effect, and the
// solver takes internal steps.
solver::Outcome Simulation::extend_to(double t) {
  failure_ = nullptr;
  solver::Outcome outcome = settle_changes() ? solver::Outcome::stepped : solver::Outcome::failed;
  if (outcome == solver::Outcome::stepped && t > state_.t) {
    outcome = run_to(t);
    state_.moving = true;
  }
  if (!failure_) failure_ = solver_.failure();
  return outcome;
}

Progressed Simulation::advance(double t) {
  t -= state_.start_time;
  if (state_.ending != Event::none) return Progressed::ended;
  if (state_.changes_pending || !knows(t)) {
    y_now();
    State before = state_;
    before.counted = counters();
    switch (extend_to(t)) {
      case solver::Outcome::failed:
        return fail(before);
      case solver::Outcome::event:
        return end_run();
      default:
        break;
    }
  }
  if (!(t > state_.t)) return Progressed::reached;
  if (state_.motion.keep_contact && state_.unfolded) report_pulls_of_orbit(state_.t, t);
  move_to(t);
  if (state_.motion.inputs.varies) state_.motion.inputs.hold_from(t), state_.changes_pending = true;
  return Progressed::reached;
}

}  // namespace wheel
