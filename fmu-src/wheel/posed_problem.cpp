// Answers to the solver: right-hand side, error weights, watched functions.
#include "posed_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constant.hpp"
#include "events.hpp"
#include "law.hpp"

namespace wheel {
namespace {

const Record& record_of(const void* owner) { return *static_cast<const Record*>(owner); }

// (t, y) => y_dot; returns the least margin. A problem of eight states is that of a wheel that rolls.
template <int states>
double derivative(void* owner, double t, const double* y, double* y_dot) {
  const Setup& setup = record_of(owner).setup;
  const InForce& in_force = record_of(owner).run.in_force;
  WheelScene room;
  const WheelScene& scene = in_force.scene_at(t, room);
  const WheelFormulation& formulation =
      states == WHEEL_REDUCED_STATES ? *setup.rolling_equations : formulation_of(setup, scene.contact);
  const double N = formulation.derivative(&scene, y, y_dot);
  double sum = 0;
  for (int i = 0; i < states; ++i) sum += y_dot[i];
  if (!std::isfinite(sum)) return std::numeric_limits<double>::quiet_NaN();
  return least_margin(setup, in_force, y, N);
}

// (y) => relative rounding of the rates. It grows near flat, for two reasons:
//   psi_dot = omega_2 / sin(theta) magnifies the rounding of theta;
//   in (24) accelerations of the size of r_0 psi_dot^2 cancel. The rounding that is left acts on a rate for less than
//   1 / psi_dot in a step, but at once on the direction of a slip. The reduced form has no such cancellation.
double rounding_of_rates(const Setup& setup, const InForce& in_force, const double* y) {
  CONSTANT(double, remains, 0.1, "1",
           "of the rounding of theta, whose sign changes from step to step, over many steps");
  const double theta = y[WHEEL_THETA], magnified = remains * theta / angle_from_flat(theta);
  double cancelled = 0;
  if (setup.is_multibody()) {
    const double heading_rate = std::fabs(y[WHEEL_OMEGA_2] / std::sin(theta)) * setup.time_scale;
    cancelled = in_force.slides() ? heading_rate * heading_rate : heading_rate;
  }
  return std::numeric_limits<double>::epsilon() * std::fmax(magnified, cancelled);
}

// (share, y) => weights[i] = 1 / (tolerance scale_i + rounding |y_i|). The scale is the range of the state (scales_at),
// and the tolerance is that of a slow wheel, share * setup.tolerance, times share_at for a fast one. Two floors keep it
// from more than the numbers can express: the share of a fast wheel stops at the rounding of a state, and no tolerance
// falls below the rounding of the rates.
// A regularized law turns errors of omega_z into moments, over its width omega_s. There the spin must be accurate to a
// part of that width too.
template <int states>
void weights(void* owner, double share, const double* y, double* weights) {
  const Setup& setup = record_of(owner).setup;
  const InForce& in_force = record_of(owner).run.in_force;
  const double spin = y[WHEEL_OMEGA_3];
  CONSTANT(double, rounding, 32 * std::numeric_limits<double>::epsilon(), "1", "of a state after some hundred steps");
  CONSTANT(double, width, 10, "omega_s sqrt(tolerance)", "error of the spin in a regularized law, of second order");
  const double of_slow = share * setup.tolerance, of_fast = of_slow * share_at(setup, spin);
  const double floor_of_fast = std::fmin(of_slow, rounding), floor = rounding_of_rates(setup, in_force, y);
  const double tolerance = std::fmax(of_fast, std::fmax(floor_of_fast, floor));
  double scales[max_states];
  scales_at(setup, spin, scales);
  for (int i = 0; i < states; ++i) weights[i] = 1 / (tolerance * scales[i] + rounding * std::fabs(y[i]));
  if (in_force.mode().kind != WHEEL_REGULARIZED) return;
  const double in_law = width * std::sqrt(tolerance) * setup.omega_s + tolerance * std::fabs(spin);
  weights[WHEEL_OMEGA_3] = 1 / (std::fmin(tolerance * scales[WHEEL_OMEGA_3], in_law) + rounding * std::fabs(spin));
}

// (event, t, y) => its margin
double margin(void* owner, int event, double t, const double* y) {
  return margin_of(event_row(static_cast<Event>(event)), record_of(owner).setup, record_of(owner).run.in_force, t, y);
}

// (t, y, directions chi of the slip) => slopes of |u| chi_dot by chi: that of the last direction for all, which is
// where a slip settles. The collocation's iteration converges with it, to the solution that it has with each one's own.
void slopes_of_turning(void* owner, double t, const double* y, std::span<const double> chi, double* slopes, double*) {
  WheelScene room;
  const WheelScene& scene = record_of(owner).run.in_force.scene_at(t, room);
  std::fill_n(slopes, chi.size(), -wheel_slip(&scene, y, chi.back()).settling);
}

// (t, y, omega_z) => slopes of omega_z_dot by omega_z under the regularized law. They follow from the rates under the
// whole moment forward and backward, and are zero where the ground pulls and no brake acts. `others` are the changes of
// each rate by that of omega_z.
void slopes_of_spin(void* owner, double t, const double* y, std::span<const double> omega_z, double* slopes,
                    double* others) {
  const Setup& setup = record_of(owner).setup;
  WheelScene scene = record_of(owner).run.in_force.scene_at(t);
  scene.friction = {WHEEL_ROLLING, 1, 0};
  const Rates forward = rates_of(setup, scene, y);
  scene.friction = {WHEEL_ROLLING, -1, 0};
  const Rates backward = rates_of(setup, scene, y);
  const WheelFormulation& formulation = formulation_of(setup, scene.contact);
  const auto change = [&](int i) { return (forward.y_dot[i] - backward.y_dot[i]) / 2; };
  const double spin_change = change(WHEEL_OMEGA_3);
  for (int i = 0; i < formulation.states; ++i) others[i] = spin_change == 0 ? 0 : change(i) / spin_change;
  for (const double omega : omega_z) {
    const double part = std::tanh(omega / setup.omega_s);
    *slopes++ = spin_change * (1 - part * part) / setup.omega_s;
  }
}

int extremes(void* owner, double t_lo, double t_hi, double* instants) {
  static_assert(most_extremes <= solver::max_extremes);
  return record_of(owner).run.in_force.inputs.extremes(t_lo, t_hi, instants);
}

}  // namespace

solver::Problem problem_of(Record& record) {
  const Setup& setup = record.setup;
  const InForce& in_force = record.run.in_force;
  solver::Problem problem = {};
  const bool few = formulation_of(setup, in_force.contact()).states == WHEEL_REDUCED_STATES;
  problem.states = few ? WHEEL_REDUCED_STATES : max_states;
  problem.owner = &record;
  problem.derivative = few ? derivative<WHEEL_REDUCED_STATES> : derivative<max_states>;
  problem.weights = few ? weights<WHEEL_REDUCED_STATES> : weights<max_states>;
  if (in_force.inputs.varies) problem.extremes = extremes;
  CONSTANT(double, near, 0.1, "weights, or rad from lying flat", "what N or theta may do between two stages of a step");
  CONSTANT(double, first_step, 0.25, "of the edge", "an eighth of the layer: long enough to see the law");
  problem.near = near;
  problem.longest_step = setup.longest_step;
  if (in_force.mode().kind == WHEEL_REGULARIZED) {
    problem.steep = {WHEEL_OMEGA_3, solver::Settling::none, slopes_of_spin, setup.omega_s};
    const double rate = rates_of(setup, in_force.scene_at(record.run.t), record.run.y()).y_dot[WHEEL_OMEGA_3];
    problem.first_step = first_step * layer_edge(setup) / std::fabs(rate);
  }
  if (in_force.slides()) problem.turning = {WHEEL_CHI, WHEEL_SLIP, slopes_of_turning};
  for (const EventRow& row : event_rows)
    if (row.can_occur(setup, in_force)) {
      problem.watch({static_cast<int>(row.event), margin, row.quick_value != nullptr, row.state(in_force)});
    }
  return problem;
}

Consequence follow_on_orbit(void* owner, int event, double t, double* y) {
  auto& record = *static_cast<Record*>(owner);
  const EventRow& row = event_row(static_cast<Event>(event));
  if (ends_run(row, record.setup)) return Consequence::ends;
  double state[max_states] = {};  // longer than that of the orbit, which no event moves
  std::copy_n(y, WHEEL_REDUCED_STATES, state);
  return follow_event(row, record.setup, t, state, record.run.in_force);
}

solver::Method method_of(const Setup& setup, const InForce& in_force) {
  const bool cvode = setup.method == adams_method || setup.method == bdf_method;
  if (in_force.slides() || (cvode && in_force.mode().kind == WHEEL_REGULARIZED)) return solver::Method::collocation;
  if (setup.method == bdf_method) return solver::Method::bdf;
  return setup.method == adams_method ? solver::Method::adams : solver::Method::runge_kutta;
}

}  // namespace wheel
