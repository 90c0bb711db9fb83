// One step by sweeps: fixed-point iteration for all states but those that settle, Newton's method for each of these.
//
// y_j = y_start + h sum of integral_jk f_k, f_j = f(t_j, y_j), at the points t_j; in the settling state u_j f_j =
// turn_j (u_j = 1 without a speed). Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.5; the dense
// output is the collocation polynomial.
#include "collocation.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace solver {
namespace {

using Square = Eigen::Matrix<double, radau_points, radau_points, Eigen::RowMajor>;
using Row = Eigen::Matrix<double, 1, max_states>;
using Column = Eigen::Matrix<double, radau_points, 1>;
using Rates = Eigen::Matrix<double, radau_points, max_states, Eigen::RowMajor>;

// s = (t - end) / h of the points: c - 1, c the zeros of P_6 - P_5 on (0, 1], P Legendre's polynomials.
constexpr double places[radau_points] = {-0.96019014293854872, -0.80198658212639185,  -0.56202518975261390,
                                         -0.30453572664636388, -0.098535085798826426, 0};

// Lagrange's polynomials of the points, by powers of s; their integrals from the start to each point; the last Legendre
// coefficient of the polynomial through values at the points, as weights on them.
struct Table {
  double power[radau_points][radau_points] = {}, integral[radau_points][radau_points] = {}, last[radau_points] = {};
};

constexpr double integral_of(const double (&power)[radau_points], double s) {
  double at_s = 0, at_start = 0;
  for (int m = radau_points - 1; m >= 0; --m) {
    at_s = (at_s + power[m] / (m + 1)) * s;
    at_start = -(at_start + power[m] / (m + 1));
  }
  return at_s - at_start;
}

constexpr Table make_table() {
  Table table;
  for (int k = 0; k < radau_points; ++k) {
    double (&power)[radau_points] = table.power[k];
    power[0] = 1;
    for (int j = 0, degree = 0; j < radau_points; ++j) {
      if (j == k) continue;
      for (int m = ++degree; m >= 0; --m)
        power[m] = ((m > 0 ? power[m - 1] : 0) - places[j] * (m < degree ? power[m] : 0)) / (places[k] - places[j]);
    }
    for (int j = 0; j < radau_points; ++j) table.integral[j][k] = integral_of(power, places[j]);
  }
  for (int k = 0; k < radau_points; ++k) {  // sum of (2 n + 1) w_k P_n(x_k) f_k, n = 5
    const double x = 2 * places[k] + 1, x_2 = x * x;
    table.last[k] = 11 * table.integral[radau_points - 1][k] * x * ((63 * x_2 - 70) * x_2 + 15) / 8;
  }
  return table;
}
constexpr Table radau = make_table();

// The error that one step may make, as a fraction of the tolerance of the whole solution.
constexpr double part_of_tolerance = 0.2;
// How far the sweeps may be from their limit, over the error of the step; the error of the polynomial against its last
// term, which falls less fast where the turning is steep.
constexpr double distance = 0.1, error_of_last = 0.005, error_of_steep = 0.05;
constexpr int most_sweeps = 30, most_tries = 40;
constexpr double longer = 1.01;  // of the stop
// The shortest step, in roundings of time: the settling states may do in it what they will, the others hardly move.
constexpr double roundings = 2;

// At the point j of a step of this size.
Row state_at(int j, const Step& step, double size, const double (&f)[radau_points][max_states]) {
  const Eigen::Map<const Rates> rates(&f[0][0]);
  return Eigen::Map<const Row>(step.y_start) + size * (Eigen::Map<const Square>(&radau.integral[0][0]).row(j) * rates);
}

}  // namespace

// Newton's matrices for the rates of the settling states at the points, and what follows a steep turning.
struct Collocation::Newton {
  Eigen::PartialPivLU<Square> matrix[2];
  Row others = Row::Zero();
};

Collocation::Newton Collocation::prepare(const Problem& problem, const Step& step) const {
  const Eigen::Map<const Square> integral(&radau.integral[0][0]);
  const Eigen::Map<const Rates> f(&f_[0][0]);
  const auto along = [&](int i) -> Column { return (size_ * integral * f.col(i)).array() + step.y_start[i]; };
  const Row y_end = state_at(radau_points - 1, step, size_, f_);
  Newton newton;
  for (int i = 0; i < problem.settling_count; ++i) {
    const auto& [state, speed, slopes_of] = problem.settling[i];
    const Column values = along(state);
    Column slopes;
    slopes_of(problem.owner, step.end, y_end.data(), {values.data(), radau_points}, slopes.data(),
              newton.others.data());
    Square matrix = size_ * slopes.asDiagonal() * integral;
    if (speed < 0)
      matrix.diagonal().array() -= 1;
    else
      matrix.diagonal() -= along(speed);
    newton.matrix[i].compute(matrix);
  }
  return newton;
}

// The change of the states by one sweep, in units of the weights; infinite where rates are not finite.
double Collocation::sweep(const Problem& problem, const double* weights, const Newton& newton, Counters* counters,
                          Step* step) {
  Eigen::Map<Rates> before(&f_[0][0]);
  Rates f = Rates::Zero();
  Column speeds[2];
  for (int j = 0; j < radau_points; ++j) {
    const Row y = state_at(j, *step, size_, f_);
    const double t = step->start + (1 + places[j]) * size_;
    const double margin = problem.derivative(problem.owner, t, y.data(), f.row(j).data());
    ++counters->rhs;
    if (std::isnan(margin)) return INFINITY;
    step->lowest_margin = j == 0 ? margin : std::fmin(step->lowest_margin, margin);
    for (int i = 0; i < problem.settling_count; ++i) {
      const int speed = problem.settling[i].speed;
      speeds[i][j] = speed < 0 ? 1 : y[speed];
    }
  }
  for (int i = 0; i < problem.settling_count; ++i) {
    const int state = problem.settling[i].state;
    const Column turning = speeds[i].cwiseProduct(f.col(state) - before.col(state));
    const Column settled = before.col(state) - newton.matrix[i].solve(turning);
    // Newton's method has moved the state, and with a steep turning all that follows it.
    if (problem.settling[i].speed < 0) f += (settled - f.col(state)) * newton.others;
    f.col(state) = settled;
  }
  const Rates change = size_ * (f - before);
  double largest = 0;
  for (int j = 0; j < radau_points; ++j)
    if (const double norm = weighted_norm<max_states>(&change(j, 0), weights); !(norm <= largest)) largest = norm;
  before = f;
  return std::isfinite(largest) ? largest : INFINITY;
}

// First rates: those of the last step's polynomial, which goes on, or the rates at the start. Where a speed changes by
// its own size within the step, the turning at its start is most often rounding over the speed: zero is nearer.
bool Collocation::predict(const Problem& problem, const Step& last, Counters* counters, Step* step) {
  if (last.degree != radau_points) {
    ++counters->rhs;
    if (std::isnan(problem.derivative(problem.owner, step->start, step->y_start, f_[0]))) return false;
    for (int i = 0; i < problem.settling_count; ++i) {
      const auto& [state, speed, slopes_of] = problem.settling[i];
      if (speed >= 0 && !(std::fabs(size_ * f_[0][speed]) < step->y_start[speed])) f_[0][state] = 0;
    }
    for (int j = 1; j < radau_points; ++j) std::copy_n(f_[0], max_states, f_[j]);
    return true;
  }
  const double length = last.end - last.start;
  for (int j = 0; j < radau_points; ++j) {
    Row f = Row::Zero();
    for (int m = radau_points; m > 0; --m)
      f = f * ((1 + places[j]) * size_ / length) + Eigen::Map<const Row>(last.c[m]) * (m / length);
    std::copy_n(f.data(), max_states, f_[j]);
  }
  return true;
}

// The error of the step over size_ in units of the weights; infinite where the sweeps do not converge. One that is not
// predicted may have begun so far off that the first fall of the changes is not that of the next.
double Collocation::try_size(const Problem& problem, const double* weights, bool predicted, Counters* counters,
                             Step* step) {
  Newton newton = prepare(problem, *step);
  double change = INFINITY;
  ++counters->jacobians;
  const double largest_last = predicted ? INFINITY : 1;
  bool converged = false;
  for (int sweeps = 0; !converged; ++sweeps) {
    const double before = change;
    // A steep turning bends between two sweeps.
    if (sweeps > 0 && problem.is_steep()) newton = prepare(problem, *step);
    change = sweep(problem, weights, newton, counters, step);
    const bool falls = sweeps < most_sweeps && change < before;
    if (!falls && !(change < 1)) return INFINITY;
    // The changes that would follow sum to change^2 / (before - change). Small ones that do not fall are rounding.
    converged = !falls || change < distance ||
                (sweeps > 0 && change < largest_last && change * change < distance * (before - change));
  }
  const Row last =
      (problem.is_steep() ? error_of_steep : error_of_last) * size_ *
      (Eigen::Map<const Eigen::Matrix<double, 1, radau_points>>(radau.last) * Eigen::Map<Rates>(&f_[0][0]));
  return weighted_norm<max_states>(last.data(), weights);
}

bool Collocation::advance(const Problem& problem, double stop, Counters* counters, Step* step) {
  double weights[max_states] = {};
  problem.weights(problem.owner, part_of_tolerance * problem.share, step->y_start, weights);
  Step last = {};
  last.start = step->start - size_;
  last.end = step->start;
  if (known_) expand(problem, &last);
  const double shortest = roundings * rounding_at(step->start);
  failure_ = step_too_small;
  for (int attempts = 0; attempts < most_tries; ++attempts) {
    size_ = std::fmin(std::fmax(liked_, shortest), problem.longest_step);
    const bool stops = step->start + longer * size_ >= stop;
    if (stops) size_ = stop - step->start;
    step->end = stops ? stop : step->start + size_;
    if (!predict(problem, last, counters, step)) {
      failure_ = "the rates of the states are not finite";
      break;
    }
    const bool is_shortest = size_ <= shortest;
    if (is_shortest)
      for (int i = 0; i < problem.settling_count; ++i) weights[problem.settling[i].state] = 0;
    const double error = try_size(problem, weights, last.degree == radau_points, counters, step);
    const double fitting = 0.8 / eighth_root(std::fmax(error, 1e-6));
    known_ = error <= 1;
    // Where the direction starts off its limit, errors hardly depend on the size of long steps.
    const double next = size_ * (known_ || attempts < 2 ? std::clamp(fitting, 0.15, 3.0) : 0.25);
    if (!known_ || !stops || next < liked_) liked_ = next;
    if (!known_ && is_shortest) break;
    if (!known_) continue;
    const Row y_end = state_at(radau_points - 1, *step, size_, f_);
    std::copy_n(y_end.data(), max_states, step->y_end);
    // A state that settles at a speed changes as 1 / speed.
    for (int i = 0; i < problem.settling_count; ++i)
      if (const int speed = problem.settling[i].speed; speed >= 0)
        liked_ *= std::clamp(y_end[speed] / step->y_start[speed], 0.4, 1.0);
    failure_ = nullptr;
    return true;
  }
  return false;
}

void Collocation::expand(const Problem&, Step* step) {
  const Eigen::Map<const Square> power(&radau.power[0][0]);
  const Eigen::Map<const Rates> f(&f_[0][0]);
  step->degree = known_ ? radau_points : 0;
  std::copy_n(step->y_end, max_states, step->c[0]);
  for (int m = 0; m < radau_points; ++m)
    Eigen::Map<Row>(step->c[m + 1]) = size_ / (m + 1) * (power.col(m).transpose() * f);
}

void Collocation::visit(support::Archive& archive, const Problem& problem, const Step&) {
  for (double* size : {&liked_, &size_}) archive.range(*size, 0, archive.greatest);
  archive.count(known_, 0, 1);
  for (int j = 0; known_ && j < radau_points; ++j) archive.numbers(f_[j], problem.states);
}

}  // namespace solver
