// Model exchange: the caller's own solver moves the wheel, and asks for derivatives, event indicators and decisions.
//
// The states are those of wheel_euler, in the paper's own variables. An input acts from the instant at which it is set;
// the law of friction is decided anew at events only, after Filippov, by the function that co-simulation uses.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "digits.hpp"
#include "simulation.hpp"

namespace wheel {
namespace {

// Added to every indicator: one that rests at zero after an event must not count as a second one. At 1e-6 the instants
// would be wrong by as much.
constexpr double distance = 1e-12;

// An event that lies ahead by less than this, in units of the wheel's own time, has happened: some solvers stop a
// little before the sign changes, and would stop there again and again.
constexpr double soon = 1e-7;

// omega_z over the wheel's own rate: a spin beyond zero by less is the error of the solver that brought it there.
constexpr double spin_error = 1e-3;

constexpr Computed states[] = {Computed::X_O, Computed::Y_O,       Computed::psi,     Computed::theta,
                               Computed::phi, Computed::theta_dot, Computed::psi_dot, Computed::omega_z};
static_assert(std::size(states) == state_count);

bool is_finite(double number) { return std::isfinite(number); }

bool falls(double margin, double rate, double time) { return margin <= 0 || margin + rate * time <= 0; }

}  // namespace

int state_of(unsigned variable) {
  const auto* found = std::find(std::begin(states), std::end(states), static_cast<Computed>(variable));
  return found == std::end(states) ? -1 : static_cast<int>(found - states);
}

void Simulation::set_time(double t) {
  run_.t = t - demand_.start_time;
  fresh_ = Fresh::state;
}

void Simulation::set_states(const double* x) {
  std::copy_n(x, state_count, run_.y);
  fresh_ = Fresh::state;
}

void Simulation::set_state(int index, double value) {
  run_.y[index] = value;
  decide_law();
}

// What was set takes effect: at once, except for the law. A changed s asks for another law, whatever the mode is.
void Simulation::take_at_once() {
  InForce& now = run_.in_force;
  now.inputs.take_over(run_.t, demand_.inputs);
  now.scene.load = load_of(demand_.inputs);
  demand_.changed = false;
  const bool other_s = now.scene.wheel.s != demand_.parameters[s];
  now.scene.wheel.s = demand_.parameters[s];
  if (other_s) decide_law();
}

void Simulation::decide_law() {
  run_.in_force.scene.friction = friction_at(setup_, run_.in_force.scene, run_.in_force.inputs.braked, run_.y);
  fresh_ = Fresh::state;
}

// A solver may try states beyond flat: there rates and margins are those of the flat wheel, which are finite.
std::array<double, WHEEL_MAX_STATES> Simulation::trial() const {
  std::array<double, WHEEL_MAX_STATES> x = std::to_array(run_.y);
  double& theta = x[static_cast<std::size_t>(setup_.formulation->tilt_index)];
  theta = std::clamp(theta, flat_angle, 3.141592653589793 - flat_angle);
  return x;
}

bool Simulation::derivatives(double* x_dot) {
  ++run_.counted.rhs;
  setup_.formulation->derivative(&run_.in_force.scene, trial().data(), x_dot);
  return std::all_of(x_dot, x_dot + state_count, is_finite);
}

void Simulation::nominals(double* x) const { scales_at(setup_, run_.y[setup_.formulation->spin_index], x); }

// How far the mode of friction is from its end: rolling, omega_z over the wheel's own rate; held, what holding leaves
// unused, or negative where a spin was set; without friction, the brake, which asks for a law as soon as it is set.
double Simulation::friction_margin() const {
  const WheelScene& scene = run_.in_force.scene;
  const double moment = setup_.weight * (scene.wheel.r_0 + scene.wheel.r);
  const WheelFriction& law = scene.friction;
  const double spin = run_.y[setup_.formulation->spin_index] * setup_.own_time;
  if (law.kind == WHEEL_ROLLING) return law.sigma * spin;
  if (law.kind == WHEEL_HELD && std::fabs(spin) > spin_error) return -std::fabs(spin);
  if (law.kind == WHEEL_HELD) return holding_margin(setup_, scene, trial().data()) / moment;
  return law.kind == WHEEL_FRICTIONLESS ? -scene.load.brake / moment : 1;
}

// Its rate along the motion, 1/s.
double Simulation::friction_rate() {
  const WheelScene& scene = run_.in_force.scene;
  Reading& now = reading();
  if (scene.friction.kind == WHEEL_ROLLING) return scene.friction.sigma * now.dynamics().omega_z_dot * setup_.own_time;
  if (scene.friction.kind != WHEEL_HELD) return 0;
  const double grip_dot = now.dynamics().lambda[2] > 0 ? scene.wheel.s * now.reaction_rates().lambda_dot[2] : 0;
  const double tau_dot = std::copysign(now.reaction_rates().tau_dot, now.dynamics().tau * now.reaction_rates().tau_dot);
  return (grip_dot - tau_dot) / (setup_.weight * (scene.wheel.r_0 + scene.wheel.r));
}

// Another solver cannot be told that the model ends where it starts: that is a fault of the start values.
bool Simulation::starts_inside() {
  const Margins start = margins();
  if (start.flat > 0 && (start.contact > 0 || setup_.keep_contact)) return true;
  reporter_.tell(Topic::error,
                 start.flat > 0 ? "The ground does not press on the wheel at the start: N = %s N."
                                : "The wheel lies flat at the start: N = %s N.",
                 support::Digits(reading().dynamics().lambda[2], 6).text);
  return false;
}

Simulation::Margins Simulation::margins() {
  ++run_.counted.roots;
  return {friction_margin(), angle_from_flat(run_.y[setup_.formulation->tilt_index]) - flat_angle,
          contact_margin(owner_, run_.t, trial().data())};
}

bool Simulation::indicators(double* z) {
  const Margins now = margins();
  z[0] = now.friction + distance;
  z[1] = now.flat + distance;
  z[2] = now.contact + distance;
  return std::all_of(z, z + indicator_count, is_finite);
}

bool Simulation::has_event() {
  const Margins now = margins();
  return std::fmin(now.friction, std::fmin(now.flat, now.contact)) + distance <= 0;
}

// Event mode: the law that holds from here on, and whether the model ends here. True where the motion bends here, a
// state or the law: some solvers go on from a step that they took under the old law, unless the states are called new.
bool Simulation::decide() {
  WheelScene& scene = run_.in_force.scene;
  const WheelFriction before = scene.friction;
  const bool pulled = run_.in_force.pulls();
  const double time = soon * setup_.own_time, spin = run_.y[setup_.formulation->spin_index];
  const double margin = friction_margin(), rate = friction_rate();
  // A spin that the motion cannot have led across zero within its longest step was set there, and is kept.
  const bool led = margin >= std::fmin(rate, 0) * setup_.longest_step - spin_error;
  const bool stops = before.kind == WHEEL_ROLLING && falls(margin, rate, time) && led;
  const bool held = before.kind == WHEEL_HELD && std::fabs(spin) * setup_.own_time <= spin_error;
  if (held || stops) setup_.formulation->stop_spin(&scene.wheel, run_.y);
  fresh_ = Fresh::state;
  decide_contact(time);
  if (run_.phase == Phase::ended) return false;
  decide_law();
  if (scene.friction.kind == WHEEL_HELD && falls(friction_margin(), friction_rate(), time))
    scene.friction = released(setup_, scene, run_.y);
  fresh_ = Fresh::state;
  announce_transition(before);
  const bool jumped = run_.y[setup_.formulation->spin_index] != spin;
  return jumped || differ(before, scene.friction) || pulled != run_.in_force.pulls();
}

// The wheel lies flat or lifts off, or, with keep_contact, the ground begins to pull or to press.
void Simulation::decide_contact(double time) {
  const Margins now = margins();
  const WheelKinematics& pose = reading().pose();
  const double upright = 1.5707963267948966, sign = run_.in_force.pulls() ? -1 : 1;
  if (falls(now.flat, pose.theta < upright ? pose.theta_dot : -pose.theta_dot, time)) return end_as(Event::fell_flat);
  if (!falls(now.contact, sign * reading().reaction_rates().lambda_dot[2] / setup_.weight, time)) return;
  if (!setup_.keep_contact) return end_as(Event::lifted_off);
  run_.in_force.change_contact();
  if (run_.in_force.pulls()) tell_pull(run_.t);
  fresh_ = Fresh::state;
}

// By differences of fourth order, the law and the sign of N kept. Steps are small parts of what each known turns on.
double Simulation::partial(unsigned unknown, unsigned known) {
  constexpr double share = 1e-3;
  double y[WHEEL_MAX_STATES], scales[WHEEL_MAX_STATES];
  std::copy_n(y_now(), WHEEL_MAX_STATES, y);
  scales_at(setup_, 0, scales);
  Present now = present_for(known);
  now.y = y;
  const int state = setup_.formulation == &wheel_euler ? state_of(known) : -1;
  double& place = state >= 0 ? y[state] : *load_entry(now.scene.load, static_cast<int>(known - first_input));
  double h = state >= 0 ? scales[state] : setup_.weight;
  if (state == setup_.formulation->tilt_index) h *= std::sin(place);
  const bool soft = state == setup_.formulation->spin_index && now.scene.friction.kind == WHEEL_REGULARIZED;
  h = share * (soft ? std::fmin(h, setup_.omega_s) : h);
  Reading reading;
  const double centre = place;
  const auto value_at = [&](double steps) {
    place = centre + steps * h;
    reading.set(now);
    return row_of(unknown).read(reading);
  };
  return (8 * (value_at(1) - value_at(-1)) - (value_at(2) - value_at(-2))) / (12 * h);
}

}  // namespace wheel
