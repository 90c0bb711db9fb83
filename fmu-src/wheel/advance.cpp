// How a run moves on by one communication step: `advance` lists the stages, the functions below it are the stages.
#include <algorithm>
#include <cmath>
#include <limits>

#include "digits.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

using solver::Outcome;

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

Outcome Simulation::advance(double caller_time) {
  const double t = caller_time - demand_.start_time;
  if (demand_.changed || !knows(t)) return advance_by_stages(t);
  return arrive(t), Outcome::stepped;
}

Outcome Simulation::advance_by_stages(double t) {
  y_now();
  Run before = run_;
  before.counted = counters();
  const bool changed = demand_.changed;
  failure_ = nullptr;
  const bool moves = t > run_.t;
  Outcome outcome = take_demand();
  if (outcome == Outcome::stepped && moves) outcome = begin();
  if (outcome == Outcome::stepped && moves) outcome = proceed(t);
  if (outcome == Outcome::stepped) arrive(t);
  if (outcome == Outcome::event) end_run();
  if (outcome == Outcome::failed) fail(before, changed);
  return outcome;
}

bool Simulation::knows(double t) const {
  if (run_.phase == Phase::stepping) return solver_.reaches(t);
  return run_.phase == Phase::unfolded && orbit_ready_ && t <= orbit_until_;
}

// Whether what was set since the last step differs from what is in force.
bool Simulation::has_changed() const {
  const InForce& now = run_.in_force;
  const double t = run_.t;
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * (std::fabs(demand_.start_time) + std::fabs(t));
  return now.scene.wheel.s != demand_.parameters[s] || now.inputs.change_at(t, rounding, demand_.inputs);
}

// Stage 1: what was set since the last step takes effect.
Outcome Simulation::take_demand() {
  const bool changed = demand_.changed && has_changed();
  demand_.changed = false;
  if (!changed) return Outcome::stepped;
  const WheelFriction before = run_.in_force.scene.friction;
  const bool leaves_orbit = run_.phase == Phase::unfolded;
  if (leaves_orbit && setup_.keep_contact && contact_margin(owner_, run_.t, run_.y) < 0) run_.in_force.change_contact();
  put_in_force(setup_, demand_, run_.t, run_.y, run_.in_force);
  fresh_ = Fresh::state;
  announce_transition(before);
  if (run_.phase == Phase::at_start) return Outcome::stepped;
  const double interval = run_.t - run_.last_change;
  run_.last_change = run_.t;
  const bool again = run_.phase == Phase::stepping;
  if (!again) ++run_.counted.restarts;
  run_.phase = Phase::stepping;
  const Outcome outcome = start_solver(again);
  if (again) solver_.limit_first_step(interval);
  return outcome;
}

// Stage 2, at the first step of a run and after a restored one: the motion is unfolded, or the solver starts.
Outcome Simulation::begin() {
  if (run_.phase == Phase::stepping || (run_.phase == Phase::unfolded && orbit_ready_)) return Outcome::stepped;
  const bool unfolds = is_unfoldable(setup_, run_.in_force) && enter_orbit();
  run_.phase = unfolds ? Phase::unfolded : Phase::stepping;
  return unfolds ? Outcome::stepped : start_solver(false);
}

// Starts the solver at the present instant, from nothing or, again, where it goes on counting.
Outcome Simulation::start_solver(bool again) {
  const auto start = again ? &solver::Solver::restart : &solver::Solver::start;
  const bool started = (solver_.*start)(problem_of(owner_), method_of(setup_, run_.in_force), run_.t, run_.y);
  return started ? Outcome::stepped : Outcome::failed;
}

// Stage 3: the solution becomes known up to t, or up to an event that ends the run.
Outcome Simulation::proceed(double t) {
  if (run_.phase == Phase::stepping) return step_to(t);
  if (t <= orbit_until_) return Outcome::stepped;
  if (orbit_until_ == orbit_.end_time()) return Outcome::event;
  return failure_ = "psi or phi would turn so far that the angle has too few digits", Outcome::failed;
}

Outcome Simulation::step_to(double t) {
  const bool large = setup_.formulation == &wheel_multibody;
  const long long work_per_step = large ? work_per_multibody_step : 1;
  for (long long work = 0; !solver_.reaches(t);) {
    if (work >= most_work)
      return failure_ = "one call may take no more internal steps; use shorter communication steps", Outcome::failed;
    // CVODE may step past the communication point although an input varies: the input's polynomial may go on there, and
    // a step that is cut short costs CVODE its history. Runge-Kutta has no history to lose.
    if (run_.in_force.inputs.varies && solver_.method() == solver::Method::runge_kutta) solver_.stop_before(t);
    Outcome outcome = solver_.step();
    if (outcome == Outcome::failed) return outcome;
    work += (outcome == Outcome::event ? work_per_event : 1) * work_per_step;
    if (outcome != Outcome::event || solver_.reaches(t)) continue;  // an event after t waits until it is reached
    move_to(solver_.event_time());
    outcome = pass_event();
    if (outcome != Outcome::stepped) return outcome;
  }
  return Outcome::stepped;
}

// The run stands at an event. `event`: it ends the run.
Outcome Simulation::pass_event() {
  switch (static_cast<Event>(solver_.event())) {
    case Event::spin_changes:
      return pass_transition();
    case Event::layer_changes:
      return pass_layer();
    case Event::contact_changes:
      return pass_contact();
    default:
      return Outcome::event;
  }
}

// omega_z has reached zero, or friction and brake can no longer hold it there.
Outcome Simulation::pass_transition() {
  const WheelScene scene = run_.in_force.scene_at(run_.t);
  const WheelFriction before = scene.friction;
  y_now();
  setup_.formulation->stop_spin(&scene.wheel, run_.y);
  WheelFriction& friction = run_.in_force.scene.friction;
  friction = before.kind == WHEEL_HELD ? released(setup_, scene, run_.y)
                                       : friction_at(setup_, scene, run_.in_force.inputs.braked, run_.y);
  announce_transition(before);
  return start_solver(true);
}

// A regularized law has become stiff, or omega_z has entered or left its layer, or begins to stick in it.
Outcome Simulation::pass_layer() {
  enter_layer(setup_, run_.in_force, run_.t, y_now());
  return start_solver(true);
}

// The ground begins to pull or to press. Without friction the motion goes on as it was.
Outcome Simulation::pass_contact() {
  run_.in_force.change_contact();
  if (run_.in_force.pulls()) tell_pull(run_.t);
  if (run_.in_force.scene.friction.kind == WHEEL_FRICTIONLESS) return solver_.resume(), Outcome::stepped;
  y_now();
  return start_solver(true);
}

// Counts and reports a change between held, positive and negative spin. A change to another law is not a transition.
void Simulation::announce_transition(const WheelFriction& before) {
  const WheelFriction& friction = run_.in_force.scene.friction;
  const auto is_exact = [](WheelFrictionKind law) { return law == WHEEL_ROLLING || law == WHEEL_HELD; };
  if (!is_exact(before.kind) || !is_exact(friction.kind) || !differ(before, friction)) return;
  ++run_.transitions;
  if (!reporter_.wants(Topic::event)) return;
  const support::Digits instant(to_nanosecond(time()));
  if (friction.kind == WHEEL_HELD)
    reporter_.tell(Topic::event, "t = %s s: stick, omega_z is held at zero.", instant.text);
  else
    reporter_.tell(Topic::event, "t = %s s: %s, omega_z becomes %s.", instant.text,
                   before.kind == WHEEL_HELD ? "release" : "reversal", friction.sigma > 0 ? "positive" : "negative");
}

// Stage 4: the run stands at t, up to which the solution is known. Inputs that vary stay where they arrived, unless
// they are set again.
void Simulation::arrive(double t) {
  if (!(t > run_.t)) return;
  move_to(t);
  const Inputs& inputs = run_.in_force.inputs;
  if (inputs.varies) inputs.hold(t, demand_.inputs), demand_.changed = true;
}

void Simulation::move_to(double t) {
  if (setup_.keep_contact && run_.phase == Phase::unfolded) report_pulls_of_orbit(t);
  run_.t = t;
  fresh_ = Fresh::nothing;
}

void Simulation::tell_pull(double t) {
  run_.last_pull = t;
  if (run_.pulls++ >= told_pulls) return;
  reporter_.tell(Topic::warning,
                 "The ground pulls from t = %s s on: keep_contact holds a wheel that would have lifted off.",
                 support::Digits(to_nanosecond(demand_.start_time + t)).text);
}

// At the end of a run: the pulls that were not told one by one.
void Simulation::sum_up() const {
  if (run_.pulls > told_pulls)
    reporter_.tell(Topic::warning,
                   "The ground has pulled %lld times, of which the first %lld were told; last from t = %s s on.",
                   run_.pulls, told_pulls, support::Digits(to_nanosecond(demand_.start_time + run_.last_pull)).text);
}

void Simulation::end_run() {
  const bool unfolded = run_.phase == Phase::unfolded;
  if (unfolded) move_to(orbit_.end_time());
  end_as(static_cast<Event>(unfolded ? orbit_.event() : solver_.event()));
}

void Simulation::end_as(Event event) {
  run_.ended_by = event;
  freeze(Phase::ended);
  sum_up();
  reporter_.tell(Topic::discard,
                 event == Event::fell_flat ? "The wheel %s at t = %s s: the model ends there."
                                           : "The wheel %s at t = %s s, theta = %s rad: the model ends there.",
                 ending(), support::Digits(time()).text,
                 support::Digits(run_.y[setup_.formulation->tilt_index], 6).text);
}

// The state is that before the step, and stays so.
void Simulation::fail(const Run& before, bool changed) {
  if (run_.phase == Phase::stepping) move_to(solver_.known_until());
  reporter_.tell(Topic::error, "The solver stopped at t = %s s, where omega_z = %s rad/s: %s.",
                 support::Digits(time()).text, support::Digits(y_now()[setup_.formulation->spin_index], 4).text,
                 failure_ ? failure_ : solver_.failure());
  run_ = before;
  run_.phase = Phase::failed;
  demand_.changed = changed;
  fresh_ = Fresh::state;
}

}  // namespace wheel
