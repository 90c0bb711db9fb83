// A run whose motion is unfolded: its orbit is built at the first step, kept while it is that of the run, and read.
#include <algorithm>

#include "checks.hpp"
#include "solution.hpp"

namespace wheel {
namespace {

Shape shape_of(const Demand& demand) {
  Shape shape = {{}, demand.tolerance};
  std::copy_n(demand.parameters, first_input, shape.parameters);
  for (const unsigned v : {stored::psi_start, stored::phi_start, stored::X_O_start, stored::Y_O_start})
    shape.parameters[v] = 0;
  return shape;
}

}  // namespace

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

}  // namespace wheel
