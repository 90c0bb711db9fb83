// Derivatives by difference quotients (quotients.hpp). The reactions are linear in the load, so quotients by an input
// are exact up to rounding. The derivative of a variable that is not linear in the forces follows from those of forces
// and motion (Row::by_force). A rate that the equations give is read (Row::read_rate).
#include "slopes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "exchange.hpp"
#include "law.hpp"
#include "quotients.hpp"
#include "setting.hpp"

namespace wheel {
namespace {

// The derivatives of the variables that are asked for by one quantity x: `ask` for each, `take` or `refine` once, and
// read them by `of`. `instant_with`: (x) => the instant with this value of x, or none where there is no such wheel.
class Slopes {
 public:
  void ask(unsigned variable) {
    asked_[variable - stored_count] = true;
    asks_what_acts_ |= row_of(variable).by_force != nullptr;
  }

  // With steps of h. tau_rate: the part of the rate of tau that the instants leave out.
  template <class F>
  void take(double x, double h, const F& instant_with, double tau_rate = 0) {
    quotients_.take(x, h, [&](double moved) { return numbers_of(instant_with(moved)); });
    complete(tau_rate);
  }

  // With steps that become smaller, for what bends within the first; false where none is possible.
  template <class F>
  bool refine(double x, double scale, const F& instant_with) {
    const bool done = quotients_.refine(x, scale, [&](double moved) { return numbers_of(instant_with(moved)); });
    complete(0);
    return done;
  }

  double of(unsigned variable) const { return slopes_[variable - stored_count]; }

 private:
  using Parts = std::array<double, sizeof(Acting) / sizeof(double)>;
  static constexpr std::size_t computed = variable_count - stored_count;
  // Of the computed variables, and behind them, where one needs it, of what acts.
  using Numbers = std::array<double, computed + std::tuple_size_v<Parts>>;

  std::optional<Numbers> numbers_of(const std::optional<Instant>& instant) const {
    if (!instant) return std::nullopt;
    Reading reading(*instant);
    Numbers numbers = {};
    for (unsigned k = 0; k < computed; ++k)
      if (asked_[k]) numbers[k] = row_of(stored_count + k).read(reading);
    if (!asks_what_acts_) return numbers;
    const auto parts = std::bit_cast<Parts>(acting_of(reading));
    std::copy(parts.begin(), parts.end(), numbers.begin() + computed);
    return numbers;
  }
  static Acting acting_in(const Numbers& numbers) {
    Parts parts;
    std::copy_n(numbers.begin() + computed, parts.size(), parts.begin());
    return std::bit_cast<Acting>(parts);
  }

  // What is not linear in the forces follows from them.
  void complete(double tau_rate) {
    slopes_ = quotients_.slopes();
    slopes_[variable::tau - stored_count] += tau_rate;
    const Acting acting = acting_in(quotients_.values());
    Acting rate = acting_in(slopes_);
    rate.axle.tau += tau_rate;
    for (unsigned k = 0; k < computed; ++k)
      if (asked_[k] && row_of(stored_count + k).by_force) slopes_[k] = row_of(stored_count + k).by_force(acting, rate);
  }

  bool asked_[computed] = {}, asks_what_acts_ = false;
  Quotients<std::tuple_size_v<Numbers>> quotients_;
  Numbers slopes_ = {};
};

// By what is set: a parameter, in the initial state, or a rate of the carrier, which jumps. The step is relative to the
// parameter where it cannot be negative. For an angle, a place or a rate it is relative to the parameter or to 1,
// whichever is larger.
bool take_by_setting(const Wheel& w, unsigned parameter, Slopes& slopes) {
  const Row& row = row_of(parameter);
  const bool turns = parameter == variable::psi_start || parameter == variable::phi_start ||
                     parameter == variable::slope_direction;  // the same after a whole turn
  const double asked = w.demand.value(parameter), value = turns ? wheel_less_turns(asked) : asked;
  const double scale = row.min == 0 && value != 0 ? std::fabs(value) : std::fmax(std::fabs(value), 1);
  Record moved = static_cast<const Record&>(w);
  double y_now[max_states];
  read_state(w, y_now);
  const bool begun = has_left_initialization(w.run.phase);
  const auto instant_with = [&](double moved_value) -> std::optional<Instant> {
    moved.demand.value(parameter) = moved_value;
    if (!begun && !prepare(moved, Reporter())) return std::nullopt;
    if (!begun) return Instant(moved, moved.run.y());
    // A rate of the carrier, to which it jumps from the present state: enforced even where nothing has moved.
    double y[max_states];
    std::copy_n(y_now, max_states, y);
    moved.run.in_force = w.run.in_force;
    moved.run.pending = Pending::nothing;
    catch_up_with_orbit(moved, y, moved.run.in_force);
    enforce(moved.setup, moved.demand, moved.run.t, y, moved.run.in_force);
    return Instant(moved, y);
  };
  return slopes.refine(value, scale, instant_with);
}

// The ground as it is at this instant, by the sign of N.
void keep_ground(Instant& instant) {
  const double N = rates_of(*instant.setup, instant.scene, instant.y).N;
  instant.scene.ground = N > 0 ? WHEEL_GROUND_PRESSES : WHEEL_GROUND_PULLS;
}

// A brake that is not in use gets the mode that it would have in use. In model exchange that mode waits for an event.
void put_brake_in_use(const InForce& in_force, Instant& instant) {
  if (instant.setup->model_exchange || instant.scene.friction.kind != WHEEL_FRICTIONLESS) return;
  WheelScene scene = instant.scene;
  scene.ground = in_force.ground();
  instant.scene.friction = braked_mode(*instant.setup, scene, instant.y);
}

// (state of y, or below zero a load, and its value) => the size in which it acts: of a load the whole weight or the
// load.
double size_of(const Setup& setup, const WheelFriction& mode, int state, double value) {
  if (state < 0) return std::fmax(setup.weight, std::fabs(value));
  double scales[max_states];
  scales_at(setup, 0, scales);
  const bool is_tilt = state == WHEEL_THETA, is_spin = state == WHEEL_OMEGA_3;
  if (is_spin && mode.kind == WHEEL_REGULARIZED) return std::fmin(scales[state], setup.omega_s);
  return is_tilt ? scales[state] * std::sin(value) : scales[state];
}

// By an input or a state. The mode and the sign of N are kept. Where a slide begins here, the loads decide the
// direction of the slip.
void take_at_instant(const Wheel& w, unsigned known, Slopes& slopes) {
  const Setup& setup = w.setup;
  Instant here = instant_of(w);
  double y[max_states];
  read_state(w, y);
  if (known == variable::M_brake) put_brake_in_use(in_force_now(w, y), here);
  keep_ground(here);
  if (setup.model_exchange)  // a small step must not vanish in the rounding of a large angle
    for (const int angle : {WHEEL_EULER_PSI, WHEEL_EULER_PHI}) here.x[angle] = wheel_less_turns(here.x[angle]);
  const int place = setup.model_exchange ? place_in_x(known) : -1;
  const auto known_of = [&](Instant& instant) -> double& {
    return place >= 0 ? instant.x[place] : *load_entry(instant.scene.load, static_cast<int>(known - first_input));
  };
  const double value = known_of(here);
  const double size = size_of(setup, here.scene.friction, place >= 0 ? place_in_y(place) : -1, value);
  const WheelContactMode before = has_left_initialization(w.run.phase) ? w.run.in_force.contact() : setup.first_contact;
  const bool begins = here.scene.contact == WHEEL_SLIDES && before == WHEEL_GRIPS;
  const auto instant_with = [&](double moved_value) {
    Instant moved = here;
    known_of(moved) = moved_value;
    if (setup.model_exchange) wheel_reduced_state(moved.x, moved.y);
    if (begins) moved.y[WHEEL_CHI] = first_direction(moved.scene, moved.y);
    return moved;
  };
  if (begins)
    slopes.refine(value, size, instant_with);
  else
    slopes.take(value, first_part * size, instant_with);
}

// (y, y_dot) => how fast the wheel moves, 1/s.
double pace_of(const double* y, const double* y_dot, bool slides) {
  double swing = 0;
  for (const int rate : {WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) swing += std::fabs(y_dot[rate]);
  const double tilting = (std::fabs(y[WHEEL_OMEGA_1]) + std::fabs(y[WHEEL_OMEGA_2])) / std::sin(y[WHEEL_THETA]);
  const double chi_dot = slides ? std::fabs(y_dot[WHEEL_CHI]) : 0;
  return tilting + std::fabs(y[WHEEL_OMEGA_3]) + std::sqrt(swing) + chi_dot;
}

// By time along the motion, with a step that is a small part of the time in which the wheel moves. Between the steps
// kappa of a regularized law is kept. Its rate, which can be large, is added as the rate of a moment about the axle.
void take_along_motion(const Wheel& w, Slopes& slopes) {
  const Setup& setup = w.setup;
  Instant start = instant_of(w);
  for (const int angle : {WHEEL_PSI, WHEEL_PHI})  // a small step must not vanish in the rounding of a large angle
    start.y[angle] = wheel_less_turns(start.y[angle]);
  keep_ground(start);
  const WheelFormulation& formulation = formulation_of(setup, start.scene.contact);
  const Rates rates = rates_of(setup, start.scene, start.y);
  Inputs inputs = w.run.in_force.inputs;
  if (takes_effect(w)) inputs.take_over(w.run.t, w.demand.inputs);
  WheelLoad rate = inputs.load_rate_at(w.run.t);
  WheelFriction& mode = start.scene.friction;
  double tau_rate = 0;
  if (mode.kind == WHEEL_REGULARIZED) {
    const double omega_z = start.y[WHEEL_OMEGA_3], steepness = std::cosh(omega_z / mode.omega_s);
    const double kappa_dot = rates.y_dot[WHEEL_OMEGA_3] / mode.omega_s / steepness / steepness;
    tau_rate = -kappa_dot * wheel_axle_capacity(start.scene.wheel.s, rates.N, start.scene.load.brake);
    rate.M[2] += tau_rate;
    mode = {WHEEL_ROLLING, wheel_kappa(&mode, omega_z), 0};
  }
  const auto instant_after = [&](double t) {
    Instant moved = start;
    for (int i = 0; i < formulation.states; ++i) moved.y[i] += t * rates.y_dot[i];
    for (int i = 0; i < inputs_count; ++i) *load_entry(moved.scene.load, i) += t * *load_entry(rate, i);
    return moved;
  };
  const double pace = pace_of(start.y, rates.y_dot, start.scene.contact == WHEEL_SLIDES);
  slopes.take(0, pace > 0 ? first_part / pace : 1, instant_after, tau_rate);
}

}  // namespace

void read_rates(const Wheel& w, Listed outputs, std::size_t count, double* out) {
  Slopes slopes;
  Reading reading(w);
  bool missing = false;
  for (std::size_t k = 0; k < count; ++k) {
    if (row_of(outputs[k]).read_rate) continue;
    slopes.ask(outputs[k]);
    missing = true;
  }
  if (missing) take_along_motion(w, slopes);
  for (std::size_t k = 0; k < count; ++k) {
    const Row& row = row_of(outputs[k]);
    out[k] = row.read_rate ? row.read_rate(reading) : slopes.of(outputs[k]);
  }
}

bool add_slopes(const Wheel& w, unsigned known, double seed, Listed unknowns, std::size_t count, double* sums) {
  const bool parameter = known < first_input;
  if (parameter && row_of(known).type != Type::real) return true;
  const bool of_slip =
      known == variable::slip_x_start || known == variable::slip_y_start || known == variable::mu_slide;
  if (of_slip && !w.setup.can_slide()) return true;  // a wheel that never slides has no slip
  const bool of_carrier = known == variable::psi_dot_start || known == variable::theta_dot_start;
  if (of_carrier && w.demand.value(variable::guided) != 0) return true;  // it stays
  const bool guides = is_guide_rate(known);
  if (guides && !w.setup.steered) return true;
  Slopes slopes;
  for (std::size_t k = 0; k < count; ++k) slopes.ask(unknowns[k]);
  if (!parameter && !guides)
    take_at_instant(w, known, slopes);
  else if (!take_by_setting(w, known, slopes))
    return false;
  for (std::size_t k = 0; k < count; ++k) sums[k] += seed * slopes.of(unknowns[k]);
  return true;
}

}  // namespace wheel
