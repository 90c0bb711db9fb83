// A run whose motion is unfolded: its orbit is built at the first step, kept while it is that of the run, and read.
#include <algorithm>
#include <cstring>

#include "decisions.hpp"
#include "simulation.hpp"

namespace wheel {

// Whether the stored orbit belongs to the present run; the instance may have computed other runs before.
bool Simulation::orbit_fits() const {
  return std::equal(state_.parameters, state_.parameters + first_input, orbit_origin_) &&
         orbit_origin_[first_input] == state_.motion.tolerance;
}

// Builds the orbit from the start of the run. Where the motion cannot be unfolded, the solver has to step through it.
void Simulation::build_orbit() {
  State start = state_;
  set_initial_state(start);
  Motion& motion = start.motion;
  const auto pass = [](void* owner, int event) {
    return event == static_cast<int>(Event::contact_changes) && (change_contact(*static_cast<Motion*>(owner)), true);
  };
  const Orbit::Kind kind = orbit_.build(problem_of(motion), motion.tolerance, pass, start.y, solver_);
  state_.unfolded = kind != Orbit::Kind::refused;
  std::memcpy(orbit_origin_, state_.parameters, sizeof state_.parameters);
  orbit_origin_[first_input] = state_.unfolded ? motion.tolerance : 0;
}

// Makes the orbit ready, if the run is on one.
void Simulation::enter_orbit() {
  if (!orbit_fits()) build_orbit();
  orbit_ready_ = state_.unfolded;
  if (state_.unfolded) state_.counted = orbit_.counters();
}

// With keep_contact on the orbit: reports each instant in (t_from, t_to], and the start, at which N falls below zero.
// Where one communication step has very many of them, only the first ones are reported.
void Simulation::report_pulls_of_orbit(double t_from, double t_to) const {
  constexpr long long most = 100;
  const long long first = t_from == 0 ? 0 : orbit_.falls_until(t_from), end = orbit_.falls_until(t_to);
  for (long long n = first; n < std::min(end, first + most); ++n) tell_pull(orbit_.fall(n));
}

}  // namespace wheel
