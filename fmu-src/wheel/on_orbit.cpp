// A run whose motion is unfolded: its orbit is built at the first step, kept while it is that of the run, and read.
#include <algorithm>
#include <cstring>

#include "simulation.hpp"

namespace wheel {

// Whether the stored orbit belongs to the present run; the instance may have computed other runs before.
bool Simulation::orbit_fits() const {
  return std::equal(demand_.parameters, demand_.parameters + first_input, orbit_origin_) &&
         orbit_origin_[first_input] == demand_.tolerance;
}

// Makes the orbit of the run ready, built from its start. False where the motion cannot be unfolded: the solver has to
// step through it.
bool Simulation::enter_orbit() {
  if (!orbit_fits()) {
    InForce start = run_.in_force;
    Owner owner = {setup_, start};
    const auto pass = [](void* of, int event) {
      if (event == static_cast<int>(Event::contact_changes)) static_cast<Owner*>(of)->in_force.change_contact();
      return event == static_cast<int>(Event::contact_changes);
    };
    const Orbit::Kind kind = orbit_.build(problem_of(owner), demand_.tolerance, pass, setup_.start, solver_);
    std::memcpy(orbit_origin_, demand_.parameters, sizeof demand_.parameters);
    orbit_origin_[first_input] = kind == Orbit::Kind::refused ? 0 : demand_.tolerance;
  }
  orbit_ready_ = orbit_origin_[first_input] != 0;
  if (orbit_ready_) run_.counted = orbit_.counters();
  return orbit_ready_;
}

// With keep_contact on the orbit: reports each instant in (t_from, t_to], and the start, at which N falls below zero.
// Where one communication step has very many of them, only the first ones are reported.
void Simulation::report_pulls_of_orbit(double t_from, double t_to) const {
  constexpr long long most = 100;
  const long long first = t_from == 0 ? 0 : orbit_.falls_until(t_from), end = orbit_.falls_until(t_to);
  for (long long n = first; n < std::min(end, first + most); ++n) tell_pull(orbit_.fall(n));
}

}  // namespace wheel
