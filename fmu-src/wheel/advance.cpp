// How a run moves on by one communication step: `advance_by_stages` lists the stages, the functions before it are the
// stages.
#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool is_known(const Run& run, const Solution& solution, double t) {
  if (run.phase == Phase::stepping) return solution.solver.reaches(t);
  return run.phase == Phase::unfolded && t <= solution.orbit_until;
}

// Whether what was set since the last step differs from what is in force.
bool has_changed(const Setup& setup, const Demand& demand, const Run& run) {
  const InForce& now = run.in_force;
  const double t = run.t;
  const double rounding = 8 * std::numeric_limits<double>::epsilon() * (std::fabs(setup.start_time) + std::fabs(t));
  return now.scene.wheel.s != demand.parameters[variable::s] || now.inputs.change_at(t, rounding, demand.inputs);
}

// Starts the solver at the present instant, from nothing or, again, where it goes on counting.
Outcome start_solver(const Setup& setup, Run& run, Solution& solution, bool again) {
  solution.owner = {&setup, &run.in_force};
  const auto start = again ? &solver::Solver::restart : &solver::Solver::start;
  const solver::Problem problem = problem_of(solution.owner);
  const bool started = (solution.solver.*start)(problem, method_of(setup, run.in_force), run.t, run.y);
  return started ? Outcome::stepped : Outcome::failed;
}

// Stage 1: what was set since the last step takes effect.
Outcome take_demand(const Setup& setup, Demand& demand, Run& run, Solution& solution, const Reporter& reporter) {
  const bool changed = demand.changed && has_changed(setup, demand, run);
  demand.changed = false;
  if (!changed) return Outcome::stepped;
  const WheelFriction before = run.in_force.scene.friction;
  if (run.phase == Phase::unfolded) place_observed(setup, run.t, run.y, run.in_force);
  put_in_force(setup, demand, run.t, run.y, run.in_force);
  log_transition(setup, before, run, reporter);
  if (run.phase == Phase::at_start) return Outcome::stepped;
  const double interval = run.t - run.last_change;
  run.last_change = run.t;
  const bool again = run.phase == Phase::stepping;
  if (!again) ++run.counted.restarts;
  run.phase = Phase::stepping;
  const Outcome outcome = start_solver(setup, run, solution, again);
  if (again) solution.solver.limit_first_step(interval);
  return outcome;
}

// The orbit of a run, from its start.
Shape shape_of(const Demand& demand) {
  Shape shape = {{}, demand.tolerance};
  std::copy_n(demand.parameters, first_input, shape.parameters);
  for (const unsigned v : {variable::psi_start, variable::phi_start, variable::X_O_start, variable::Y_O_start})
    shape.parameters[v] = 0;
  return shape;
}

// Whether the motion is unfolded. Builds the orbit of the run, or keeps that of an earlier run of the same shape.
// False: the solver has to step through the motion.
bool enter_orbit(const Setup& setup, const Demand& demand, Run& run, Solution& solution) {
  orbit::Orbit& orbit = solution.orbit;
  const Shape asked = shape_of(demand);
  solution.owner = {&setup, &run.in_force};
  const solver::Problem problem = problem_of(solution.owner);
  if (solution.orbit_shape != asked) {
    const InForce at_start = run.in_force;  // what is observed on the orbit counts where the run passes it
    const auto kind = orbit.build(problem, demand.tolerance, pass_on_orbit, setup.start, solution.solver);
    run.in_force = at_start;
    solution.orbit_shape = kind == orbit::Orbit::Kind::refused ? Shape() : asked;
  }
  if (solution.orbit_shape != asked || !orbit.start_at(problem, setup.start)) return false;
  run.counted = orbit.counters();
  const bool ends = orbit.end_time() < Demand::never;
  solution.orbit_until = ends ? orbit.end_time() : largest_angle / orbit.fastest_turn();
  return true;
}

// Stage 2, at the first step of a run and after a restored one: the motion is unfolded, or the solver starts.
Outcome set_in_motion(const Setup& setup, const Demand& demand, Run& run, Solution& solution) {
  const bool is_ready = run.phase == Phase::unfolded && solution.orbit_until != Solution::none;
  if (run.phase == Phase::stepping || is_ready) return Outcome::stepped;
  const bool unfolds = is_unfoldable(setup, run.in_force) && enter_orbit(setup, demand, run, solution);
  run.phase = unfolds ? Phase::unfolded : Phase::stepping;
  return unfolds ? Outcome::stepped : start_solver(setup, run, solution, false);
}

// Counts and logs what is observed on the orbit up to t.
void observe_orbit(const Setup& setup, const orbit::Orbit& orbit, double t, Run& run, const Reporter& reporter) {
  const auto next_of = [&](int event) {
    const long long next = run.tallies[event].count, falls = orbit.falls_until(event, t);
    return next < std::min(falls, logged_one_by_one) ? orbit.fall(event, next) : Demand::never;
  };
  for (;;) {  // in the order of time
    int first = 0;
    for (int event = 1; event < event_count; ++event)
      if (next_of(event) < next_of(first)) first = event;
    const double instant = next_of(first);
    if (instant == Demand::never) break;
    count_event(setup, static_cast<Event>(first), instant, run, reporter);
  }
  for (int event = 0; event < event_count; ++event) {
    const long long falls = orbit.falls_until(event, t);
    if (falls > run.tallies[event].count) run.tallies[event] = {falls, orbit.fall(event, falls - 1)};
  }
}

void move_to(const Setup& setup, double t, Run& run, const Solution& solution, const Reporter& reporter) {
  if (run.phase == Phase::unfolded && solution.orbit.recurs()) observe_orbit(setup, solution.orbit, t, run, reporter);
  run.t = t;
}

// The next corner of a prescribed input after t that a step may meet: no step goes across it. One next to t has been
// met.
double corner_of(const Setup& setup, const Inputs& inputs, double t) {
  const double ahead = 2 * setup.longest_step;
  return inputs.corner(t + solver::rounding_at(t) + 1e-12 * ahead, t + ahead);
}

// Stage 3 of a motion that is stepped through: up to t, or up to an event that ends the run.
Outcome step_to(const Setup& setup, double t, Run& run, Solution& solution, const Reporter& reporter) {
  solver::Solver& solver = solution.solver;
  const long long work_per_step = setup.formulation == &wheel_multibody ? work_per_multibody_step : 1;
  for (long long work = 0; !solver.reaches(t);) {
    if (work >= most_work) {
      solution.failure = "one call may take no more internal steps; use shorter communication steps";
      return Outcome::failed;
    }
    // CVODE may step past the communication point although an input varies: the input's polynomial may go on there, and
    // a step that is cut short costs CVODE its history. Runge-Kutta has no history to lose.
    const Inputs& inputs = run.in_force.inputs;
    if (inputs.varies && solver.method() == solver::Method::runge_kutta) solver.stop_before(t);
    if (inputs.varies && inputs.braked) solver.stop_before(corner_of(setup, inputs, solver.known_until()));
    const Outcome outcome = solver.step();
    if (outcome == Outcome::failed) return outcome;
    work += (outcome == Outcome::event ? work_per_event : 1) * work_per_step;
    if (outcome != Outcome::event || solver.reaches(t)) continue;  // an event after t waits until it is reached
    move_to(setup, solver.event_time(), run, solution, reporter);
    state_now(run, solution);
    const auto event = static_cast<Event>(solver.event());
    if (ends_run(row_of(event), setup)) return outcome;
    if (pass_event(setup, event, run, reporter) == Consequence::goes_on)
      solver.resume();
    else if (start_solver(setup, run, solution, true) == Outcome::failed)
      return Outcome::failed;
  }
  return Outcome::stepped;
}

// Stage 3: the solution becomes known up to t, or up to an event that ends the run.
Outcome proceed(const Setup& setup, double t, Run& run, Solution& solution, const Reporter& reporter) {
  if (run.phase == Phase::stepping) return step_to(setup, t, run, solution, reporter);
  if (t <= solution.orbit_until) return Outcome::stepped;
  if (solution.orbit_until == solution.orbit.end_time()) return Outcome::event;
  solution.failure = "psi or phi would turn so far that the angle has too few digits";
  return Outcome::failed;
}

// Stage 4: the run stands at t, up to which the solution is known. Inputs that vary stay where they arrived, unless
// they are set again.
void arrive(const Setup& setup, double t, Demand& demand, Run& run, const Solution& solution,
            const Reporter& reporter) {
  if (!(t > run.t)) return;
  move_to(setup, t, run, solution, reporter);
  const Inputs& inputs = run.in_force.inputs;
  if (!inputs.varies) return;
  inputs.hold(t, demand.inputs);
  demand.changed = true;
}

// The event of the solution that ends the run.
void end(const Setup& setup, Run& run, const Solution& solution, const Reporter& reporter) {
  const bool unfolded = run.phase == Phase::unfolded;
  if (unfolded) move_to(setup, solution.orbit.end_time(), run, solution, reporter);
  const int event = unfolded ? solution.orbit.event() : solution.solver.event();
  end_run(setup, static_cast<Event>(event), run, solution, reporter);
}

// The state is that before the step, and stays so.
void fail(const Setup& setup, const Run& before, Run& run, const Solution& solution, const Reporter& reporter) {
  if (run.phase == Phase::stepping) move_to(setup, solution.solver.known_until(), run, solution, reporter);
  reporter.log(Topic::error, "The solver stopped at t = %s s, where omega_z = %s rad/s: %s.", setup.start_time + run.t,
               Digits{state_now(run, solution)[setup.formulation->spin_index], 4},
               solution.failure ? solution.failure : solution.solver.failure());
  run = before;
  run.phase = Phase::failed;
}

Outcome advance_by_stages(const Setup& setup, Demand& demand, Run& run, Solution& solution, const Reporter& reporter,
                          double t) {
  state_now(run, solution);
  Run before = run;
  before.counted = counters_of(run, solution);
  const bool changed = demand.changed, moves = t > run.t;
  solution.failure = nullptr;
  Outcome outcome = take_demand(setup, demand, run, solution, reporter);
  if (outcome == Outcome::stepped && moves) outcome = set_in_motion(setup, demand, run, solution);
  if (outcome == Outcome::stepped && moves) outcome = proceed(setup, t, run, solution, reporter);
  if (outcome == Outcome::stepped) arrive(setup, t, demand, run, solution, reporter);
  if (outcome == Outcome::event) end(setup, run, solution, reporter);
  if (outcome == Outcome::failed) {
    fail(setup, before, run, solution, reporter);
    demand.changed = changed;
  }
  return outcome;
}

}  // namespace

Outcome advance(const Setup& setup, Demand& demand, Run& run, Solution& solution, const Reporter& reporter, double t) {
  if (demand.changed || !is_known(run, solution, t))
    return advance_by_stages(setup, demand, run, solution, reporter, t);
  arrive(setup, t, demand, run, solution, reporter);
  return Outcome::stepped;
}

const double* state_now(Run& run, const Solution& solution) {
  if (run.y_time == run.t) return run.y;
  run.phase == Phase::unfolded ? solution.orbit.read(run.t, run.y) : solution.solver.read(run.t, run.y);
  run.y_time = run.t;
  return run.y;
}

solver::Counters counters_of(const Run& run, const Solution& solution) {
  const solver::Counters& a = run.counted;
  const solver::Counters b = run.phase == Phase::stepping ? solution.solver.counters() : solver::Counters{};
  return {a.steps + b.steps, a.rhs + b.rhs, a.jacobians + b.jacobians, a.roots + b.roots, a.restarts + b.restarts};
}

void freeze(Run& run, const Solution& solution, Phase phase) {
  state_now(run, solution);
  run.counted = counters_of(run, solution);
  run.phase = phase;
}

void end_run(const Setup& setup, Event event, Run& run, const Solution& solution, const Reporter& reporter) {
  run.ended_by = event;
  freeze(run, solution, Phase::ended);
  log_summaries(setup, run, reporter);
  reporter.log(Topic::discard, row_of(event).ended, ending_of(setup, event).text, setup.start_time + run.t,
               Digits{run.y[setup.formulation->tilt_index], 6});
}

}  // namespace wheel
