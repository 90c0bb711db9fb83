// A run whose motion is unfolded: its orbit is built at the first step, kept while it is that of the run, and read.
#include <algorithm>

#include "checks.hpp"
#include "simulation.hpp"

namespace wheel {

// The parameters that shape the motion on an orbit. Heading, roll angle and place of the start do not: they are zero
// here.
Simulation::Shape Simulation::shape() const {
  Shape shape = {{}, demand_.tolerance};
  std::copy_n(demand_.parameters, first_input, shape.parameters);
  for (const unsigned v : {psi_start, phi_start, X_O_start, Y_O_start}) shape.parameters[v] = 0;
  return shape;
}

// Makes the orbit of the run ready: built from its start, or kept from an earlier run of the same shape. False where
// the motion cannot be unfolded: the solver has to step through it.
bool Simulation::enter_orbit() {
  const Shape asked = shape();
  InForce start = run_.in_force;
  Owner owner = {setup_, start};
  const solver::Problem problem = problem_of(owner);
  if (orbit_shape_ != asked) {
    const auto pass = [](void* of, int event) {
      if (event == static_cast<int>(Event::contact_changes)) static_cast<Owner*>(of)->in_force.change_contact();
      return event == static_cast<int>(Event::contact_changes);
    };
    const auto kind = orbit_.build(problem, demand_.tolerance, pass, setup_.start, solver_);
    orbit_shape_ = kind == orbit::Orbit::Kind::refused ? Shape() : asked;
  }
  orbit_ready_ = orbit_shape_ == asked && orbit_.start_at(problem, setup_.start);
  if (!orbit_ready_) return false;
  run_.counted = orbit_.counters();
  const bool ends = orbit_.end_time() < Demand::never;
  orbit_until_ = ends ? orbit_.end_time() : largest_angle / orbit_.fastest_turn();
  return true;
}

// With keep_contact on the orbit: reports each instant up to t at which N falls below zero. Those that are not told one
// by one are counted, however many they are.
void Simulation::report_pulls_of_orbit(double t) {
  const long long falls = orbit_.falls_until(t);
  while (run_.pulls < std::min(falls, told_pulls)) tell_pull(orbit_.fall(run_.pulls));
  if (falls > run_.pulls) run_.last_pull = orbit_.fall(falls - 1);
  run_.pulls = falls;
}

}  // namespace wheel
