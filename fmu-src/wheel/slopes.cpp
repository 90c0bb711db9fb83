// Difference quotients of fourth order. The reactions are linear in the load, so those by an input are exact up to
// rounding; a variable that is not linear in the forces follows from those of the forces (Row::by_force).
#include "slopes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "exchange.hpp"
#include "law.hpp"

namespace wheel {
namespace {

// f at four places, in steps from x, and their weights, exact for polynomials of degree four: about x, or to one side
// where a limit is near.
struct Stencil {
  int places[4];
  double weights[4];
};
constexpr Stencil stencils[] = {{{-2, -1, 1, 2}, {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12}},
                                {{1, 2, 3, 4}, {4, -3, 4.0 / 3, -1.0 / 4}},
                                {{-1, -2, -3, -4}, {-4, 3, -4.0 / 3, 1.0 / 4}}};

// sum + weight (at - centre), number by number.
Force sum_of(const Force& sum, double weight, const Force& at, const Force& centre) {
  constexpr std::size_t count = sizeof(Force) / sizeof(double);
  using Numbers = std::array<double, count>;
  Numbers total = std::bit_cast<Numbers>(sum);
  const Numbers there = std::bit_cast<Numbers>(at), here = std::bit_cast<Numbers>(centre);
  for (std::size_t i = 0; i < count; ++i) total[i] += weight * (there[i] - here[i]);
  return std::bit_cast<Force>(total);
}

// Of the variables that are asked for: the value at x, and the derivative.
struct Pass {
  bool asked[variable_count] = {}, forces_asked = false;
  double centre[variable_count], slope[variable_count];

  void ask(unsigned variable) {
    asked[variable] = true;
    forces_asked = forces_asked || row_of(variable).by_force;
  }

  // Differences from the value at x itself, so that what does not depend on x has the derivative zero. `read_at` gives
  // the reading at a place, null where there is none.
  template <class ReadAt>
  bool take(const Stencil& stencil, double x, double h, const ReadAt& read_at) {
    Force force = {}, rate = {};
    for (int k = -1; k < 4; ++k) {
      Reading* const reading = read_at(k < 0 ? x : x + stencil.places[k] * h);
      if (!reading) return false;
      for (unsigned v = stored_count; v < variable_count; ++v) {
        if (!asked[v]) continue;
        const double value = row_of(v).read(*reading);
        slope[v] = k < 0 ? 0 : slope[v] + stencil.weights[k] * (value - centre[v]) / h;
        if (k < 0) centre[v] = value;
      }
      if (!forces_asked) continue;
      const Force there = reading->force();
      if (k < 0)
        force = there;
      else
        rate = sum_of(rate, stencil.weights[k] / h, there, force);
    }
    for (unsigned v = stored_count; v < variable_count; ++v)
      if (asked[v] && row_of(v).by_force) slope[v] = row_of(v).by_force(force, rate);
    return true;
  }
};

// In the initial state; an integer or boolean parameter moves nothing. The step is relative to the parameter where it
// cannot be negative; for an angle, a place or a rate it is relative to the parameter or to 1, whichever is larger.
bool take_by_parameter(Wheel& w, unsigned parameter, Pass& pass) {
  const Row& row = row_of(parameter);
  const bool turns = parameter == variable::psi_start || parameter == variable::phi_start ||
                     parameter == variable::slope_direction;  // the same after a whole turn
  const double set = w.demand.value(parameter), x = turns ? wheel_less_turns(set) : set, size = std::fabs(x);
  const double scale = row.min == 0 && x != 0 ? size : std::fmax(size, 1);
  Reading reading;
  const auto read_at = [&](double near_x) -> Reading* {
    w.demand.value(parameter) = near_x;
    if (!prepare(w, Reporter())) return nullptr;
    reading.set(present(w));
    return &reading;
  };
  bool done = false;
  for (const double share : {1e-3, 1e-6, 1e-9})
    for (const Stencil& stencil : stencils) done = done || pass.take(stencil, x, share * scale, read_at);
  return read_at(set) && done;
}

// The same as it answers a change of one known: a brake that is not in use has the law that it would have in use. In
// model exchange that law waits for an event.
Present present_for(Wheel& w, unsigned known) {
  Present now = present(w);
  const bool brake = known == first_input + brake_input && w.demand.kind == Kind::co_simulation;
  if (!brake || now.scene.friction.kind != WHEEL_FRICTIONLESS) return now;
  double y[WHEEL_MAX_STATES];
  std::copy_n(now.y, WHEEL_MAX_STATES, y);
  InForce used = in_force_now(w, y);
  used.inputs.braked = true;
  decide_law(w.setup, w.run.t, now.y, used);
  now.scene.friction = used.scene.friction;
  return now;
}

// The law and the sign of N are kept. Steps are small parts of what each known turns on, those of a load of the whole
// weight or of the load.
bool take_at_instant(Wheel& w, unsigned known, Pass& pass) {
  const Setup& setup = w.setup;
  const WheelFormulation& f = *setup.formulation;
  double y[WHEEL_MAX_STATES], scales[WHEEL_MAX_STATES];
  Present now = present_for(w, known);
  Reading reading;
  reading.set(now);
  now.scene.ground = reading.dynamics().lambda[2] > 0 ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS;
  std::copy_n(now.y, WHEEL_MAX_STATES, y);
  now.y = y;
  scales_at(setup, 0, scales);
  const bool exchanged = w.demand.kind == Kind::model_exchange;
  if (exchanged)  // a small step must not vanish in the rounding of a large angle
    for (const unsigned angle : {variable::psi, variable::phi})
      y[state_index_of(angle)] = wheel_less_turns(y[state_index_of(angle)]);
  const int state = exchanged ? state_index_of(known) : -1;
  double& place = state >= 0 ? y[state] : *load_entry(now.scene.load, static_cast<int>(known - first_input));
  double h = state >= 0 ? scales[state] : std::fmax(setup.weight, std::fabs(place));
  if (state == f.tilt_index) h *= std::sin(place);
  if (state == f.spin_index && now.scene.friction.kind == WHEEL_REGULARIZED) h = std::fmin(h, setup.omega_s);
  const auto read_at = [&](double x) {
    place = x;
    reading.set(now);
    return &reading;
  };
  return pass.take(stencils[0], place, 1e-3 * h, read_at);
}

}  // namespace

bool add_slopes(Wheel& w, unsigned known, double seed, const unsigned* unknowns, std::size_t count, double* sums) {
  const bool parameter = known < first_input;
  if (parameter && row_of(known).type != Type::real) return true;
  const bool of_slip =
      known == variable::slip_x_start || known == variable::slip_y_start || known == variable::mu_slide;
  if (of_slip && !w.setup.sliding) return true;  // a wheel that never slides has no slip
  Pass pass;
  for (std::size_t k = 0; k < count; ++k) pass.ask(unknowns[k]);
  if (!(parameter ? take_by_parameter(w, known, pass) : take_at_instant(w, known, pass))) return false;
  for (std::size_t k = 0; k < count; ++k) sums[k] += seed * pass.slope[unknowns[k]];
  return true;
}

}  // namespace wheel
