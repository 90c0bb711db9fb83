// Parameters are checked as a whole, with one message per fault: what, which value, what is allowed. The setup follows
// from them: formulation, initial state, and the scales of time, force, errors and steps.
#include "setup.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "constant.hpp"

namespace wheel {
namespace {

// (x > 0) => largest power of two below or at it
double power_of_two_below(double x) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000;
  return std::fmax(std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & exponent),
                   std::numeric_limits<double>::min());
}

// The time scale is sqrt(length / g). Where the weight does not matter, it is the inverse of the initial rate. The
// slope changes no scale, because it may change during a run.
void set_scales(Setup& setup, const WheelKinematics& start) {
  CONSTANT(double, longest, 0.6, "time scales",
           "at an unstable rest the error estimate is zero: steps would grow without limit");
  CONSTANT(double, least_gravity, 1e-30, "of length times rate squared", "a smaller one has no part in the motion");
  const WheelParameters& wheel = setup.wheel;
  const double gravity = wheel.g_n, length = wheel.r_0 + wheel.r;
  const double rate = std::fabs(start.psi_dot) + std::fabs(start.theta_dot) + std::fabs(start.phi_dot);
  const bool matters = gravity > least_gravity * length * rate * rate;
  setup.length = length;
  setup.time_scale = matters ? std::sqrt(length / gravity) : rate > 0 ? 1 / rate : 1;
  setup.longest_step = longest * setup.time_scale;
  setup.weight = wheel.m * length / (setup.time_scale * setup.time_scale);
  setup.rate_scale = power_of_two_below(1 / setup.time_scale);
  setup.moment_scale = power_of_two_below(setup.weight * length);
  const double omega_2 = start.psi_dot * std::sin(start.theta);
  setup.tilting = std::sqrt(start.theta_dot * start.theta_dot + omega_2 * omega_2);
}

// The scale of theta and chi is 1 rad. The scale of rates is the inverse of the time scale or the initial tilting,
// whichever is larger.
void set_error_scales(Setup& setup) {
  CONSTANT(double, slip, 0.15, "lengths over the time scale", "error of a slip that counts as one of 1 rad");
  CONSTANT(double, loose, 3, "rad, or lengths", "error of heading, roll angle, place that counts as 1 rad in theta");
  const double length = setup.length, slowest = 1 / setup.time_scale;
  const double rate = std::max(slowest, setup.tilting);
  setup.slip_scale = slip * slowest * length;
  // Errors of X_O and Y_O do not feed back into the motion, those of psi only under a force along the road, those of
  // phi only where J_x differs from J_y: they grow little, and may be larger.
  const double scales[max_states] = {
      1, rate, rate, rate, loose, loose, loose * length, loose * length, setup.slip_scale, 1};
  std::copy_n(scales, max_states, setup.slow_scales);
}

bool check_value(const Reporter& reporter, unsigned v, double value) {
  using namespace variable;
  const Row& row = row_of(v);
  const Digits shown = {value, 9};
  const Limit broken = broken_limit(v, value);
  if (!std::isfinite(value)) return reporter.check(false, "%s = %s: a finite number is needed.", row.name, shown);
  if (v == theta_start)
    return reporter.check(angle_from_flat(value) > flat_angle,
                          "%s = %s rad: it must lie between 0 and pi, where the wheel lies flat, and more than %s rad "
                          "from both.",
                          row.name, shown, Digits{flat_angle, 6});
  return reporter.check(!broken.message, broken.message, row.name, shown, Digits{broken.value, 6});
}

// Chooses the equations of rolling and of sliding by the formulation.
void choose_equations(Setup& setup, const Demand& demand, bool can_slide) {
  const bool multibody = choice_of(demand.parameters[variable::formulation]) == multibody_formulation;
  setup.rolling_equations = multibody ? &wheel_multibody : &wheel_reduced;
  if (can_slide) setup.sliding_equations = multibody ? &wheel_multibody_sliding : &wheel_sliding;
}

}  // namespace

void Demand::end_derivatives(const Inputs& arrived, double t) {
  for (int i = 0; i < inputs_count; ++i) {
    std::fill_n(inputs[i] + 1, max_order, 0.0);
    inputs[i][0] = arrived.value_of(i, t);
  }
}

bool check_values(const Demand& demand, bool can_slide, Checked when, const Reporter& reporter) {
  using namespace variable;
  const double* v = demand.parameters;
  bool sound = true, fine[stored_count];
  for (unsigned k = 0; k < stored_count; ++k) sound &= fine[k] = check_value(reporter, k, demand.value(k));
  // A rule about several parameters counts where each of them is fine by itself.
  const auto require = [&](bool holds, const char* message, auto... parameters) {
    sound &= reporter.check(holds || !(fine[parameters] && ...), message, Digits{v[parameters], 9}...);
  };
  // No mass distribution has one principal moment above the sum of the others; the limit is the flat disc.
  constexpr double rounding = 1e-12;
  const double sum = v[J_x] + v[J_y] + v[J_z], largest = std::fmax(v[J_x], std::fmax(v[J_y], v[J_z]));
  require(largest <= (sum - largest) * (1 + rounding) || !std::isfinite(sum),
          "J_x, J_y, J_z = %s, %s, %s kg m2: none may exceed the sum of the other two.", J_x, J_y, J_z);
  // Another solver is offered the reduced equations alone, and has no states for a slip. The number may be any: a
  // restored state is judged here too.
  const bool exchange = demand.kind == Kind::model_exchange;
  require(!exchange || v[formulation] != int{multibody_formulation},
          "formulation = 3 (multibody): model exchange needs 1 (automatic) or 2 (reduced).");
  require(v[guided] == 0 || (v[psi_dot_start] == 0 && v[theta_dot_start] == 0),
          "psi_dot_start, theta_dot_start = %s, %s rad/s: a guided wheel needs 0 for both; in "
          "co-simulation psi_dot_guide and theta_dot_guide turn it.",
          psi_dot_start, theta_dot_start);
  require(when == Checked::during_run || !(v[mu_slide] > v[mu_max]),
          "mu_slide = %s: mu_max must be at least as large, and is %s.", mu_slide, mu_max);
  require(can_slide || !(std::fabs(v[slip_x_start]) + std::fabs(v[slip_y_start]) > 0),
          "slip_x_start, slip_y_start = %s, %s m/s: an initial slip needs mu_slide.", slip_x_start, slip_y_start);
  require(!can_slide || !exchange, "mu_slide = %s: model exchange has no states for a slip and needs 0.", mu_slide);
  sound &= reporter.check(!is_guiding(demand.inputs) || demand.is_steered(),
                          "psi_dot_guide, theta_dot_guide = %s, %s rad/s: these inputs need guided = true "
                          "and co-simulation; otherwise they and their derivatives must be 0.",
                          Digits{demand.value(psi_dot_guide), 9}, Digits{demand.value(theta_dot_guide), 9});
  return sound;
}

// omega_z = phi_dot + psi_dot cos(theta). Where both parts cancel, only rounding remains, whose sign means nothing.
void start_state(const WheelFormulation& formulation, const WheelParameters& wheel, const WheelMotion& motion,
                 double* y) {
  const double axial = motion.psi_dot * std::cos(motion.theta), rounding = 4 * std::numeric_limits<double>::epsilon();
  formulation.start(&wheel, &motion, y);
  if (std::fabs(motion.phi_dot + axial) <= rounding * (std::fabs(motion.phi_dot) + std::fabs(motion.psi_dot)))
    y[WHEEL_OMEGA_3] = 0;
}

Setup setup_of(const Demand& demand, bool can_slide) {
  using namespace variable;
  const double* v = demand.parameters;
  Setup setup = {};
  setup.model_exchange = demand.kind == Kind::model_exchange;
  setup.guided = v[guided] != 0;
  setup.steered = demand.is_steered();
  choose_equations(setup, demand, can_slide);
  // clang-format off
  setup.wheel = {.m = v[m], .r_0 = v[r_0], .r = v[r], .J_x = v[J_x], .J_y = v[J_y], .J_z = v[J_z], .g_n = v[g],
                 .s = 0, .g_X = 0, .g_Y = 0};
  // clang-format on
  setup.friction_law = static_cast<FrictionLaw>(choice_of(v[friction_law]));
  setup.omega_s = v[omega_s];
  setup.method = static_cast<SolverMethod>(choice_of(v[method]));
  setup.may_unfold = (v[J_x] == v[J_y] || setup.guided) && choice_of(v[formulation]) == automatic_formulation &&
                     setup.method == automatic_method;
  setup.keep_contact = v[keep_contact] != 0;
  setup.tolerance = demand.tolerance;
  const auto origin = [&](double start, double state) { return Origin{start, setup.model_exchange ? start : state}; };
  setup.psi = origin(v[psi_start], wheel_less_turns(v[psi_start]));
  setup.phi = origin(v[phi_start], wheel_less_turns(v[phi_start]));
  setup.X_O = origin(v[X_O_start], 0);
  setup.Y_O = origin(v[Y_O_start], 0);
  const WheelMotion motion = {setup.psi.state,  v[theta_start],  setup.phi.state, v[psi_dot_start], v[theta_dot_start],
                              v[phi_dot_start], setup.X_O.state, setup.Y_O.state, v[slip_x_start],  v[slip_y_start]};
  WheelKinematics start;
  if (setup.can_slide() && (motion.slip_x != 0 || motion.slip_y != 0)) setup.first_contact = WHEEL_SLIDES;
  const WheelFormulation& formulation = formulation_of(setup, setup.first_contact);
  start_state(formulation, setup.wheel, motion, setup.initial_state);
  formulation.kinematics(&setup.wheel, setup.initial_state, &start);
  set_scales(setup, start);
  set_error_scales(setup);
  return setup;
}

void scales_at(const Setup& setup, double omega_z, double* out) {
  std::copy_n(setup.slow_scales, max_states, out);
  const double spin = std::fabs(omega_z), slowest = 1 / setup.time_scale;
  if (!(spin > slowest)) return;
  const double nutation = slowest * slowest / spin + setup.tilting;  // rad/s
  out[WHEEL_THETA] = std::fmin(out[WHEEL_THETA], nutation / spin);
  for (const int rate : {WHEEL_OMEGA_1, WHEEL_OMEGA_2, WHEEL_OMEGA_3}) out[rate] = std::fmin(out[rate], nutation);
}

double share_at(const Setup& setup, double omega_z) {
  CONSTANT(double, many, 12, "rad", "turning in a time scale, above which errors add up over the turns");
  const double spin = std::fabs(omega_z), slowest = 1 / setup.time_scale;
  return spin > many * slowest ? many * slowest / spin : 1;
}

}  // namespace wheel
