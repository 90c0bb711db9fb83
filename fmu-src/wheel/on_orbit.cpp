// A run whose motion is unfolded: its orbit is built at the first step, kept while it is that of the run, and read.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "checks.hpp"
#include "simulation.hpp"

namespace wheel {

// Makes the orbit of the run ready, built from its start, unless it is kept from an earlier run. False where the motion
// cannot be unfolded: the solver has to step through it.
bool Simulation::enter_orbit() {
  if (orbit_origin_[first_input] != demand_.tolerance ||
      !std::equal(demand_.parameters, demand_.parameters + first_input, orbit_origin_)) {
    InForce start = run_.in_force;
    Owner owner = {setup_, start};
    const auto pass = [](void* of, int event) {
      if (event == static_cast<int>(Event::contact_changes)) static_cast<Owner*>(of)->in_force.change_contact();
      return event == static_cast<int>(Event::contact_changes);
    };
    const auto kind = orbit_.build(problem_of(owner), demand_.tolerance, pass, setup_.start, solver_);
    std::memcpy(orbit_origin_, demand_.parameters, sizeof demand_.parameters);
    orbit_origin_[first_input] = kind == orbit::Orbit::Kind::refused ? 0 : demand_.tolerance;
  }
  orbit_ready_ = orbit_origin_[first_input] != 0;
  if (!orbit_ready_) return false;
  run_.counted = orbit_.counters();
  orbit_until_ = std::fmin(orbit_.end_time(), largest_angle / fastest_turn());
  return true;
}

// rad/s: the larger of the mean rates of psi and phi along a motion that repeats.
double Simulation::fastest_turn() const {
  const double period = 2 * orbit_.half_period();
  double first[WHEEL_REDUCED_STATES], second[WHEEL_REDUCED_STATES];
  if (orbit_.end_time() < Demand::never) return 0;
  orbit_.read(0, first);
  orbit_.read(period, second);
  WheelKinematics from, to;
  setup_.formulation->pose(&setup_.wheel, first, &from);
  setup_.formulation->pose(&setup_.wheel, second, &to);
  return std::fmax(std::fabs(to.psi - from.psi), std::fabs(to.phi - from.phi)) / period;
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
