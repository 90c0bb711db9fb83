// A run moves on by one communication step. `advance_by_stages` lists the stages, which are marked in the functions
// before it. Times are in s on the clock of the run.
#include "motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "constant.hpp"
#include "events.hpp"
#include "law.hpp"
#include "logbook.hpp"
#include "posed_problem.hpp"
#include "transitions.hpp"

namespace wheel {
namespace {

using solver::Outcome;

CONSTANT(long long, most_work, 1000000, "internal steps", "of one call, however long its step is: some seconds");
CONSTANT(long long, work_per_event, 20, "internal steps", "the search for it, a new start, the short steps after it");
CONSTANT(unsigned, evaluations_per_step, 16, "evaluations", "that count as one internal step");
CONSTANT(long long, work_per_multibody_step, 8, "internal steps", "of the multibody form, whose system is larger");

// Whether the solution is known up to t.
bool is_known(const Wheel& w, double t) {
  if (w.run.phase == Phase::stepping) return w.solver.reaches(t);
  return w.run.phase == Phase::unfolded && t <= w.orbit.until();
}

struct Result {
  Progress progress = Progress::done;
  Event ending = Event::none;     // the event by which the run has ended, where it stands
  const char* failure = nullptr;  // its reason; null: see the solver
  bool is_done() const { return progress == Progress::done; }
};
Result run_ends(Event event) { return {Progress::ended, event}; }
Result failed(const char* reason = nullptr) { return {Progress::failed, Event::none, reason}; }

// From here on the solver steps through the motion. It starts at the present instant: from nothing, or where it has
// stepped before, anew with its counts.
Result start_solver(Wheel& w) {
  solver::Solver& solver = w.solver;
  const bool again = w.run.phase == Phase::stepping;
  w.run.phase = Phase::stepping;
  const solver::Problem problem = problem_of(w);
  const auto method = method_of(w.setup, w.run.in_force);
  const bool done =
      again ? solver.restart(problem, method, w.run.t, w.run.y()) : solver.start(problem, method, w.run.t, w.run.y());
  return done ? Result() : failed();
}

// Stage 1: what was set since the last step is in force. From an orbit the motion goes on by steps. The solver then
// starts from nothing, so the restart is counted here, and its first step has no limit. A motion that is stepped
// through already starts anew, most often because an input is set at every step: the first step is no longer than the
// time since the last change.
Result apply_demand(Wheel& w) {
  Run& run = w.run;
  const bool changed = run.pending != Pending::nothing && differs_from_demand(w);
  run.pending = Pending::nothing;
  if (!changed) return {};
  const InForce before = run.in_force;
  catch_up_with_orbit(w, run.y(), run.in_force);
  enforce(w.setup, w.demand, run.t, run.y(), run.in_force);
  note_changes(w, before);
  if (run.phase == Phase::at_start) return {};
  const double interval = run.t - run.last_change;
  run.last_change = run.t;
  const bool unfolded = run.phase == Phase::unfolded;
  if (unfolded) ++run.counted.restarts;
  const Result result = start_solver(w);
  if (!unfolded) w.solver.limit_first_step(interval);
  return result;
}

// The numbers that determine the motion on an orbit.
using Key = std::array<double, first_input + 2>;
static_assert(std::tuple_size_v<Key> <= orbit::longest_key);
Key key_of(const Record& record) {
  Key key;
  std::copy_n(record.demand.parameters, first_input, key.begin());
  for (const unsigned v : {variable::psi_start, variable::phi_start, variable::X_O_start, variable::Y_O_start})
    key[v] = 0;
  key[first_input] = record.demand.tolerance;
  key[first_input + 1] = record.setup.can_slide();
  return key;
}

// Enters the orbit of this run, or of an earlier one with the same key. False where the motion does not repeat: the
// solver has to step through it.
bool enter_orbit(Wheel& w) {
  const InForce& in_force = w.run.in_force;
  const bool acted_on =
      in_force.mode().kind != WHEEL_FRICTIONLESS || in_force.inputs.loaded || in_force.road.slope != 0;
  // A carrier that turned at the start, and has stopped since, has turned the wheel away from its initial state.
  const bool turned =
      w.run.phase == Phase::at_start && !std::equal(w.run.y(), w.run.y() + max_states, w.setup.initial_state);
  if (!w.setup.may_unfold || acted_on || in_force.slides() || turned) return false;
  Record ahead = static_cast<const Record&>(w);  // events on the orbit are in force for it alone, not yet for the run
  const Key key = key_of(w);
  const orbit::FreeMotion motion = {problem_of(ahead),
                                    w.demand.tolerance,
                                    w.setup.time_scale,
                                    follow_on_orbit,
                                    w.setup.initial_state,
                                    largest_angle,
                                    key};
  const bool entered = w.orbit.enter(motion, w.solver);
  if (entered) w.run.counted = w.orbit.course().counters;
  return entered;
}

// Stage 2, at the first step of a run and after a restored one: the motion is unfolded, or the solver starts.
Result set_in_motion(Wheel& w) {
  if (is_known(w, w.run.t)) return {};
  if (!enter_orbit(w)) return start_solver(w);
  w.run.phase = Phase::unfolded;
  return {};
}

// The run goes on to t. What is observed on the orbit is logged where it first occurs.
void move_to(Wheel& w, double t) {
  w.run.t = t;
  if (w.run.phase != Phase::unfolded || w.orbit.course().first_time > t) return;
  for (const EventRow& row : event_rows)
    if (const double first = w.orbit.course().first_times[static_cast<int>(row.event)]; first <= t)
      log_observation(w, row.event, first);
}

// Latest end of the next step on the way to t, s. Where an input varies, it is t, where its polynomial may end, and no
// step goes across a corner of a brake's. A corner so close ahead that rounding separates it has been met.
double stop_of(const Wheel& w, double t) {
  CONSTANT(double, met, 1e-12, "two longest steps", "a corner nearer than this has been met");
  const Inputs& inputs = w.run.in_force.inputs;
  if (!inputs.varies) return solver::never;
  if (!inputs.braked) return t;
  const double reached = w.solver.known_until(), ahead = 2 * w.setup.longest_step;
  return std::fmin(t, inputs.corner(reached + solver::rounding_at(reached) + met * ahead, reached + ahead));
}

// Near a jam N grows as 1 / sqrt(time left), and by 1 / sqrt(|u|): where the slip is small, time has too few digits for
// the rest of the way.
bool is_about_to_jam(const Wheel& w) {
  CONSTANT(double, little_room, 1e-2, "1", "WheelSlip.room, below which a step that fails has met the jam");
  if (!w.run.in_force.slides()) return false;
  const double reached = w.solver.known_until();
  double y[max_states];
  w.solver.read(reached, y);
  const WheelScene scene = w.run.in_force.scene_at(reached);
  return wheel_slip(&scene, y, y[WHEEL_CHI]).room < little_room;
}

// Stage 3 of a motion that is stepped through, until
//   t is known: done;
//   an event ends the run, or a step fails where the wheel is about to jam: ended;
//   a step fails elsewhere, or the solver cannot start: failed;
//   most_work is done: failed.
Result step_to(Wheel& w, double t) {
  solver::Solver& solver = w.solver;
  const long long work_per_step = w.setup.is_multibody() ? work_per_multibody_step : 1;
  for (long long work = 0; !solver.reaches(t);) {
    if (work >= most_work)
      return failed(
          "one call may take no more internal steps: a coupling diverges, a force, a brake or a regularized law is "
          "extreme, or the communication step is too long");
    const long long before = solver.counters().rhs;
    const Outcome outcome = solver.step(stop_of(w, t));
    if (outcome == Outcome::failed) {
      if (!is_about_to_jam(w)) return failed();
      move_to(w, solver.known_until());
      return run_ends(Event::jams);
    }
    if (w.run.in_force.inputs.loaded) look_at_grip(w, t);
    const auto evaluations = static_cast<unsigned>(solver.counters().rhs - before);
    const long long steps = std::max(evaluations / evaluations_per_step, 1U);
    work += (outcome == Outcome::event ? work_per_event : steps) * work_per_step;
    if (outcome != Outcome::event || solver.reaches(t)) continue;  // an event at t or later waits for the next step
    move_to(w, solver.known_until());
    update_state(w);
    const auto event = static_cast<Event>(solver.event());
    if (ends_run(event_row(event), w.setup)) return run_ends(event);
    if (pass_event(w, event) == Consequence::goes_on)
      solver.resume();
    else if (const Result result = start_solver(w); !result.is_done())
      return result;
  }
  return {};
}

// Stage 3: the solution becomes known up to t, or up to an event that ends the run.
Result proceed(Wheel& w, double t) {
  if (w.run.phase == Phase::stepping) return step_to(w, t);
  if (t <= w.orbit.until()) return {};
  const std::optional<int> ending = w.orbit.course().ending;
  if (!ending) return failed("psi or phi would turn so far that the angle has too few digits");
  move_to(w, w.orbit.until());
  return run_ends(static_cast<Event>(*ending));
}

// Stage 4: the run stands at t, up to which the solution is known.
void arrive(Wheel& w, double t) {
  if (!(t > w.run.t)) return;
  move_to(w, t);
  const Inputs& inputs = w.run.in_force.inputs;
  if (!inputs.varies) return;
  w.demand.end_derivatives(inputs, t);
  w.run.pending = Pending::ended_derivatives;
}

// A step has failed: the state is that before the step, and stays so.
void fail(Wheel& w, const Run& before, const char* failure) {
  if (w.run.phase == Phase::stepping) move_to(w, w.solver.known_until());
  update_state(w);
  const double spin = w.run.y()[WHEEL_OMEGA_3], slip = before.in_force.slides() ? before.y()[WHEEL_SLIP] : 0;
  w.reporter.log(
      Topic::error,
      "The solver stopped at t = %s s, where omega_z = %s rad/s, in a step that began with a slip of %s m/s: %s.",
      w.time(), Digits{spin, 4}, Digits{slip, 4}, failure ? failure : w.solver.failure());
  w.run = before;
  w.run.phase = Phase::broken;
}

Progress advance_by_stages(Wheel& w, double t) {
  update_state(w);
  Run before = w.run;
  before.counted = counters_of(w.run, w.solver);
  const bool moves = t > w.run.t;
  Result result = apply_demand(w);
  if (result.is_done() && moves) result = set_in_motion(w);
  if (result.is_done() && moves) result = proceed(w, t);
  if (result.is_done()) arrive(w, t);
  if (result.progress == Progress::ended) end_run(w, result.ending);
  if (result.progress == Progress::failed) fail(w, before, result.failure);
  return result.progress;
}

}  // namespace

Excess excess_of(const Wheel& w, double h) {
  const bool may_vary = w.run.pending != Pending::nothing || w.run.in_force.inputs.varies;
  if (!may_vary || !varies(w.demand.inputs)) return {};
  for (unsigned i = 0; i < inputs_count; ++i) {
    const auto& c = w.demand.inputs[i];
    if (!has_derivatives(c)) continue;
    const Span span = span_of(c, h);
    const unsigned input = first_input + i;
    if (const Limit limit = broken_limit(input, span.largest); limit.relation) return {input, span.largest, limit};
    if (i == brake_input) continue;
    if (const Limit limit = broken_limit(input, span.least); limit.relation) return {input, span.least, limit};
  }
  return {};
}

Progress advance(Wheel& w, double t) {
  if (w.run.pending != Pending::nothing || !is_known(w, t)) return advance_by_stages(w, t);
  arrive(w, t);
  return Progress::done;
}

}  // namespace wheel
